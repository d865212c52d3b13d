/* All checks, ended by one without a name. */
#ifndef TURNER_TESTS_ANALYTIC_CHECKS_H
#define TURNER_TESTS_ANALYTIC_CHECKS_H

#include "analytic/analytic.h"

extern const struct analytic_check analytic_checks[];

void check_fresnel_table(struct analytic *a);
void check_fresnel_exact(struct analytic *a);
void check_fresnel_schlick(struct analytic *a);
void check_fresnel_equal(struct analytic *a);
void check_schlick_error(struct analytic *a);
void check_fresnel_identities(struct analytic *a);
void check_conductor(struct analytic *a);
void check_mirror_schlick(struct analytic *a);
void check_slab_depth(struct analytic *a);
void check_slab_angle(struct analytic *a);
void check_slab_shift(struct analytic *a);
void check_apparent_depth(struct analytic *a);
void check_prism(struct analytic *a);
void check_ball_lens(struct analytic *a);
void check_rainbow(struct analytic *a);
void check_furnace_ball(struct analytic *a);
void check_furnace_bubble(struct analytic *a);
void check_furnace_slab(struct analytic *a);
void check_furnace_mirror(struct analytic *a);
void check_furnace_nested(struct analytic *a);
void check_facing_mirrors(struct analytic *a);
void check_cutoff(struct analytic *a);
void check_total_reflection(struct analytic *a);
void check_directions(struct analytic *a);
void check_absorption(struct analytic *a);
void check_absorbing_slab(struct analytic *a);
void check_under_water(struct analytic *a);
void check_priority(struct analytic *a);
void check_union(struct analytic *a);
void check_nine_media(struct analytic *a);
void check_point_light(struct analytic *a);
void check_sun(struct analytic *a);
void check_spot(struct analytic *a);
void check_flux(struct analytic *a);
void check_shadow(struct analytic *a);
void check_tinted_shadow(struct analytic *a);
void check_phong(struct analytic *a);
void check_energy(struct analytic *a);
void check_phong_gain(struct analytic *a);
void check_reciprocity(struct analytic *a);
void check_gradient(struct analytic *a);
void check_environment(struct analytic *a);
void check_coordinates(struct analytic *a);
void check_checker(struct analytic *a);
void check_samples(struct analytic *a);
void check_bent_normals(struct analytic *a);
void check_absorbing_bounces(struct analytic *a);
void check_shadow_medium(struct analytic *a);

#endif

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

#endif

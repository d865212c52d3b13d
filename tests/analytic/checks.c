/* The list, with each check's tolerances. */
#include "analytic/checks.h"

/* The picture itself is in float: a value near 1 is off by 2⁻²⁴ = 6e-8 there, however exact the
 * renderer. PICTURE allows that twice; printed numbers allow half of their last digit.
 *
 * A renderer that is float throughout (the second number) carries some 10 to 30 roundings of 6e-8
 * along a path of a few hits, and starts from corners and directions rounded to float: up to 2e-6. */
#define PICTURE 1.2e-7
#define FLOAT_PATH 2e-6

const struct analytic_check analytic_checks[] = {
    {"fresnel table", check_fresnel_table, 6e-7, FLOAT_PATH},
    {"fresnel exact", check_fresnel_exact, PICTURE, FLOAT_PATH},
    {"fresnel schlick", check_fresnel_schlick, PICTURE, FLOAT_PATH},
    {"fresnel equal indices", check_fresnel_equal, PICTURE, FLOAT_PATH},
    {"fresnel schlick's error", check_schlick_error, PICTURE, FLOAT_PATH},
    {"fresnel 45°, Brewster", check_fresnel_identities, PICTURE, FLOAT_PATH},
    {"metals, complex index", check_conductor, PICTURE, FLOAT_PATH},
    {"metals, k_r as R0", check_mirror_schlick, PICTURE, FLOAT_PATH},
    {"slab, limited depth", check_slab_depth, PICTURE, FLOAT_PATH},
    {"slab, any angle", check_slab_angle, PICTURE, FLOAT_PATH},
    {"slab, lateral shift", check_slab_shift, PICTURE, FLOAT_PATH},
    {"apparent depth", check_apparent_depth, PICTURE, FLOAT_PATH},
    {"prism", check_prism, PICTURE, FLOAT_PATH},
    {"ball lens", check_ball_lens, PICTURE, FLOAT_PATH},
    {"rainbow", check_rainbow, PICTURE, FLOAT_PATH},
    /* the contract: every pixel 1 ± 1e-5 less its pruned weight */
    {"furnace, ball", check_furnace_ball, 4 * PICTURE, 1e-5},
    {"furnace, bubble", check_furnace_bubble, 4 * PICTURE, 1e-5},
    {"furnace, slab", check_furnace_slab, 4 * PICTURE, 1e-5},
    {"furnace, mirror", check_furnace_mirror, PICTURE, 1e-5},
    {"furnace, nested media", check_furnace_nested, 4 * PICTURE, 1e-5},
    {"facing mirrors", check_facing_mirrors, PICTURE, FLOAT_PATH},
    {"cutoff", check_cutoff, PICTURE, FLOAT_PATH},
    {"total reflection, balls", check_total_reflection, PICTURE, FLOAT_PATH},
    {"directions, weights", check_directions, PICTURE, FLOAT_PATH},
    {"interpolated normals", check_bent_normals, PICTURE, FLOAT_PATH},
    {"absorption", check_absorption, PICTURE, FLOAT_PATH},
    {"absorbing slab", check_absorbing_slab, PICTURE, FLOAT_PATH},
    {"absorbing slab, bounces", check_absorbing_bounces, PICTURE, FLOAT_PATH},
    {"camera under water", check_under_water, PICTURE, FLOAT_PATH},
    {"media: priority", check_priority, PICTURE, FLOAT_PATH},
    {"media: union", check_union, PICTURE, FLOAT_PATH},
    {"media: nine", check_nine_media, PICTURE, FLOAT_PATH},
    {"point light", check_point_light, PICTURE, FLOAT_PATH},
    {"sun at 0, 45, 90°", check_sun, PICTURE, FLOAT_PATH},
    {"spot light", check_spot, PICTURE, FLOAT_PATH},
    {"flux", check_flux, PICTURE, FLOAT_PATH},
    {"shadow", check_shadow, PICTURE, FLOAT_PATH},
    {"tinted shadow", check_tinted_shadow, PICTURE, FLOAT_PATH},
    {"shadow in a medium", check_shadow_medium, PICTURE, FLOAT_PATH},
    {"phong, both forms", check_phong, PICTURE, FLOAT_PATH},
    {"energy", check_energy, PICTURE, FLOAT_PATH},
    {"phong's gain", check_phong_gain, PICTURE, FLOAT_PATH},
    {"reciprocity", check_reciprocity, PICTURE, FLOAT_PATH},
    {"background gradient", check_gradient, PICTURE, FLOAT_PATH},
    {"background environment", check_environment, PICTURE, FLOAT_PATH},
    {"coordinates, normals", check_coordinates, PICTURE, FLOAT_PATH},
    {"checker", check_checker, PICTURE, FLOAT_PATH},
    {"samples", check_samples, PICTURE, FLOAT_PATH},
    {NULL, NULL, 0, 0}};

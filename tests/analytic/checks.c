/* The list, with each check's tolerances. */
#include "analytic/checks.h"

/* The picture itself is in float: a value near 1 is off by 2⁻²⁴ = 6e-8 there, however exact the
 * renderer. PICTURE allows that twice; printed numbers allow half of their last digit.
 *
 * A renderer that is float throughout (the second number) carries some 10 to 30 roundings of 6e-8
 * along a path of a few hits, and starts from corners and directions rounded to float: 4e-6 is that
 * with room for its accumulation, and where a check needs more its line says why. */
#define PICTURE 1.2e-7
#define FLOAT_PATH 4e-6

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
    {NULL, NULL, 0, 0}};

/* What a scene needs of the kernel, and that what it does not need is not in it. No device. */
#include "gpu/specialise.h"
#include "render_test.h"

#include "../shaders/shared.h"

#define LAMP "\"lights\": [{\"type\": \"point\", \"position\": [0, 4, 4], \"intensity\": 9}]"
#define DIFFUSE "\"materials\": {\"m\": {\"k_d\": 0.5}}"
#define SPHERE "{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"m\"}"

static struct turner_needs needs_of(const char *rest)
{
    char text[4096];
    snprintf(text, sizeof text, "%s, %s}", SCENE_HEAD, rest);
    struct turner_scene *scene = scene_of(text);
    struct turner_needs needs = turner_needs_of(scene);
    turner_scene_destroy(scene);
    return needs;
}

static void bits_of_scenes(void **state)
{
    (void)state;
    static const struct {
        const char *rest;
        uint32_t bits;
    } cases[] = {
        {"\"background\": 1", TURNER_NEEDS_CONSERVING},
        {"\"settings\": {\"shading\": \"phong\"}", TURNER_NEEDS_PHONG},
        {DIFFUSE ", " LAMP ", \"primitives\": [" SPHERE "]",
         TURNER_NEEDS_CONSERVING | TURNER_NEEDS_SPHERES | TURNER_NEEDS_POINT},
        {"\"materials\": {\"m\": {\"k_r\": 0.5}}, \"primitives\": [" SPHERE "]",
         TURNER_NEEDS_CONSERVING | TURNER_NEEDS_SPHERES | TURNER_NEEDS_REFLECTION},
        {"\"materials\": {\"m\": {\"k_r\": 0.5, \"fresnel\": \"schlick\"}}, \"primitives\": ["
         SPHERE "]",
         TURNER_NEEDS_CONSERVING | TURNER_NEEDS_SPHERES | TURNER_NEEDS_REFLECTION |
             TURNER_NEEDS_SCHLICK},
        {"\"materials\": {\"m\": {\"k_r\": 1, \"metal\": \"gold\"}}, \"primitives\": [" SPHERE "]",
         TURNER_NEEDS_CONSERVING | TURNER_NEEDS_SPHERES | TURNER_NEEDS_REFLECTION |
             TURNER_NEEDS_CONDUCTOR},
        {"\"settings\": {\"shadows\": \"opaque\"}, \"materials\": {\"m\": {\"k_r\": 1, \"k_t\": 1,"
         " \"index\": 1.5, \"absorption\": 2}}, \"primitives\": [" SPHERE "]",
         TURNER_NEEDS_CONSERVING | TURNER_NEEDS_SPHERES | TURNER_NEEDS_REFLECTION |
             TURNER_NEEDS_TRANSMISSION | TURNER_NEEDS_BRANCHING | TURNER_NEEDS_EXACT |
             TURNER_NEEDS_MEDIA | TURNER_NEEDS_ABSORPTION},
        {"\"materials\": {\"m\": {\"k_t\": 1, \"fresnel\": \"none\", \"index\": 1.5}}, "
         "\"primitives\": [" SPHERE "]",
         TURNER_NEEDS_CONSERVING | TURNER_NEEDS_SPHERES | TURNER_NEEDS_TRANSMISSION |
             TURNER_NEEDS_MEDIA | TURNER_NEEDS_TINTED},
        {"\"materials\": {\"m\": {\"k_d\": 1, \"k_s\": 1, \"pattern\": {\"type\": \"checker\", "
         "\"colors\": [0, 1], \"scale\": 1}}}, \"groups\": {\"g\": [{\"type\": \"box\", \"min\": "
         "[0, 0, 0], \"max\": [1, 1, 1], \"material\": \"m\"}]}, \"instances\": [{\"group\": \"g\"}"
         "], \"primitives\": [{\"type\": \"plane\", \"point\": [0, -1, 0], \"normal\": [0, 1, 0], "
         "\"material\": \"m\"}, {\"type\": \"cone\", \"base\": [0, 0, 0], \"apex\": [0, 1, 0], "
         "\"base_radius\": 1, \"material\": \"m\"}], \"background\": {\"type\": \"gradient\", "
         "\"bottom\": 0, \"top\": 1}, \"lights\": [{\"type\": \"directional\", \"direction\": "
         "[0, -1, 0], \"irradiance\": 1}, {\"type\": \"spot\", \"position\": [0, 3, 0], \"at\": "
         "[0, 0, 0], \"inner\": 5, \"outer\": 9, \"intensity\": 1}]",
         TURNER_NEEDS_CONSERVING | TURNER_NEEDS_CONES | TURNER_NEEDS_TRIANGLES |
             TURNER_NEEDS_PLANES | TURNER_NEEDS_INSTANCES | TURNER_NEEDS_CHECKER |
             TURNER_NEEDS_DIRECTIONAL | TURNER_NEEDS_POINT | TURNER_NEEDS_SPOT |
             TURNER_NEEDS_SPECULAR | TURNER_NEEDS_GRADIENT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint32_t bits = needs_of(cases[i].rest).bits;
        if (bits != cases[i].bits)
            fail_msg("%s: needs %#x instead of %#x", cases[i].rest, bits, cases[i].bits);
    }
}

static void auto_takes_what_was_measured(void **state)
{
    (void)state;
    struct turner_gpu_info info = {.ray_query = true, .packets = true, .software = true};
    static const struct {
        bool software;
        enum turner_traversal fastest, chosen;
    } cases[] = {
        {true, TURNER_TRAVERSAL_AUTO, TURNER_TRAVERSAL_BVH_PACKET},
        {false, TURNER_TRAVERSAL_AUTO, TURNER_TRAVERSAL_RAY_QUERY},
        {true, TURNER_TRAVERSAL_RAY_QUERY, TURNER_TRAVERSAL_RAY_QUERY},
        {false, TURNER_TRAVERSAL_BVH_LANE, TURNER_TRAVERSAL_BVH_LANE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        enum turner_traversal chosen;
        info.software = cases[i].software;
        info.fastest = cases[i].fastest;
        assert_ok(turner_choose_traversal(&chosen, &info, TURNER_TRAVERSAL_AUTO));
        assert_int_equal(chosen, cases[i].chosen);
        assert_ok(turner_choose_traversal(&chosen, &info, TURNER_TRAVERSAL_BVH));
        assert_int_equal(chosen, TURNER_TRAVERSAL_BVH_PACKET); /* who asks for it gets it */
    }
}

static void every_bit_has_a_name(void **state)
{
    (void)state;
    for (uint32_t bit = 1; bit & TURNER_NEEDS_ALL; bit <<= 1) {
        assert_string_not_equal(turner_needs_name(bit), "unknown");
        for (uint32_t other = 1; other < bit; other <<= 1)
            assert_string_not_equal(turner_needs_name(bit), turner_needs_name(other));
    }
}

/* Loops are bounded by what the scene can cause at most. */
static void bounds_of_loops(void **state)
{
    (void)state;
    struct turner_needs needs = needs_of(DIFFUSE ", " LAMP ", \"settings\": {\"depth\": 0}, "
                                                 "\"primitives\": [" SPHERE "]");
    assert_int_equal(needs.stack, 1);
    assert_int_equal(needs.max_crossings, 0);
    assert_int_equal(needs.max_steps, 2); /* the camera ray and one shadow ray */

    needs = needs_of("\"materials\": {\"m\": {\"k_r\": 0.5}}, \"settings\": {\"depth\": 7}, "
                     "\"primitives\": [" SPHERE "]");
    assert_int_equal(needs.stack, 1); /* each ray is followed by one at most */
    assert_int_equal(needs.max_steps, 8);

    needs = needs_of("\"materials\": {\"m\": {\"k_r\": 1, \"k_t\": 1, \"index\": 1.5}}, "
                     "\"settings\": {\"depth\": 7}, \"primitives\": [" SPHERE "]");
    assert_int_equal(needs.stack, 7);
    assert_int_equal(needs.max_crossings, 2); /* in and out again */
    assert_int_equal(needs.max_steps, 255 * 3);

    needs = needs_of("\"materials\": {\"m\": {\"k_r\": 1, \"k_t\": 1, \"index\": 1.5}}, "
                     "\"settings\": {\"depth\": 64}, \"primitives\": [" SPHERE "]");
    assert_int_equal(needs.stack, 64);
    assert_int_equal(needs.max_steps, 2147483647);
}

/* Bytes of the kernel as a driver sees it, once it knows the constants; it is valid. */
static size_t specialised_size(const struct turner_kernel *kernel, uint32_t bits, uint32_t stack)
{
    struct turner_needs needs = {.bits = bits, .stack = stack};
    struct turner_kernel_constants constants = turner_kernel_constants(&needs, 0);
    struct turner_spirv special;
    assert_ok(turner_spirv_specialise(&special, &kernel->spirv, constants.at,
                                      sizeof constants.at / sizeof *constants.at));
    assert_ok(turner_spirv_validate(&special));
    size_t bytes = special.count * sizeof *special.words;
    turner_spirv_destroy(&special);
    return bytes;
}

/* A diffuse scene's kernel is a good deal smaller than one with everything, and each step between
 * them is smaller than the next. */
static void what_is_not_needed_is_not_there(void **state)
{
    (void)state;
    static const struct turner_render_options defaults;
    struct turner_needs diffuse =
        needs_of(DIFFUSE ", " LAMP ", \"primitives\": [" SPHERE "]");
    struct turner_needs mirror = needs_of("\"materials\": {\"m\": {\"k_d\": 0.5, \"k_r\": 0.5}}, "
                                          LAMP ", \"primitives\": [" SPHERE "]");
    struct turner_needs glass = needs_of("\"materials\": {\"m\": {\"k_d\": 0.5, \"k_r\": 1, \"k_t\""
                                         ": 1, \"index\": 1.5}}, " LAMP ", \"primitives\": ["
                                         SPHERE "]");
    const unsigned kinds[] = {TURNER_PACKET, 0, TURNER_RAY_QUERY};
#ifdef __SANITIZE_ADDRESS__
    const size_t count = 1; /* the same code as for the others, which take half a minute */
#else
    const size_t count = sizeof kinds / sizeof *kinds;
#endif
    for (size_t i = 0; i < count; i++) {
        struct turner_kernel kernel;
        assert_ok(turner_kernel_create(&kernel, kinds[i], &defaults));
        size_t sizes[] = {specialised_size(&kernel, diffuse.bits, diffuse.stack),
                          specialised_size(&kernel, mirror.bits, mirror.stack),
                          specialised_size(&kernel, glass.bits, glass.stack),
                          specialised_size(&kernel, TURNER_NEEDS_ALL, glass.stack)};
        printf("%s: SPIR-V of %zu bytes; specialised: diffuse %zu, mirror %zu, glass %zu, all "
               "%zu\n", turner_traversal_name(kinds[i]), kernel.spirv.count * 4, sizes[0],
               sizes[1], sizes[2], sizes[3]);
        assert_true(sizes[0] < sizes[1] && sizes[1] < sizes[2] && sizes[2] < sizes[3]);
        assert_true(2 * sizes[0] < sizes[3]);
        size_t bytes;
        assert_ok(turner_kernel_size(&bytes, &kernel, &glass));
        assert_int_equal(bytes, sizes[2]);
        turner_kernel_destroy(&kernel);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_of_scenes),
        cmocka_unit_test(auto_takes_what_was_measured),
        cmocka_unit_test(every_bit_has_a_name),
        cmocka_unit_test(bounds_of_loops),
        cmocka_unit_test(what_is_not_needed_is_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

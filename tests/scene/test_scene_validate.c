/* turner_scene_validate: one wrong thing at a time in a scene that is right. */
#include "scene_reading.h"

static const char whole[] =
    "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"inside\": "
    "[\"water\"]}, \"background\": {\"type\": \"gradient\", \"bottom\": 1, \"top\": 0}, \"media\": "
    "{\"air\": {\"index\": 1}, \"water\": {\"index\": 1.333}}, \"materials\": {\"plain\": {}, "
    "\"glass\": {\"k_r\": 1, \"k_t\": 1, \"medium\": \"air\"}, \"gold\": {\"k_r\": 1, \"metal\": "
    "\"gold\"}, \"tiles\": {\"pattern\": {\"type\": \"checker\", \"colors\": [0, 1]}}}, "
    "\"primitives\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": "
    "\"plain\"}, {\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 1, 0], \"material\": "
    "\"plain\"}], \"groups\": {\"tree\": [{\"type\": \"cone\", \"base\": [0, 0, 0], \"apex\": [0, "
    "1, 0], \"base_radius\": 1, \"material\": \"plain\"}, {\"type\": \"mesh\", \"positions\": [[0, "
    "0, 0], [1, 0, 0], [0, 1, 0]], \"triangles\": [[0, 1, 2]], \"uvs\": [[0, 0], [0, 0], [0, 0]], "
    "\"smooth\": true, \"material\": \"plain\"}]}, \"instances\": [{\"group\": \"tree\"}], "
    "\"lights\": [{\"type\": \"spot\", \"position\": [0, 5, 0], \"at\": [0, 0, 0], \"inner\": 10, "
    "\"outer\": 20, \"intensity\": 1}]}";

/* s is the scene; each line breaks one thing. */
#define CASES(X)                                                                                   \
    X(s->settings.width = 0, "settings: size 0 × 480 is not between 1 and 65536")                  \
    X(s->settings.height = 65537, "settings: size 640 × 65537 is not between 1 and 65536")         \
    X(s->settings.depth = -1, "settings: depth -1 is not between 0 and 1024")                      \
    X(s->settings.depth = 65, "material \"glass\": it both reflects and transmits, so depth 65 "   \
                              "is too much; 64 is the limit")                                      \
    X(s->settings.cutoff = NAN, "settings: cutoff nan must be 0 or above")                         \
    X(s->settings.cutoff = -1, "settings: cutoff -1 must be 0 or above")                           \
    X(s->settings.spp = 0, "settings: spp 0 is not between 1 and 65536")                           \
    X(s->settings.exposure = HUGE_VAL, "settings: exposure is not finite")                         \
    X((s->settings.spd_grid = true, s->settings.height = 2),                                       \
      "settings: spd_grid needs at least 3 rows")                                                  \
    X(s->camera.from.x = NAN, "camera: from, at or up is not finite")                              \
    X(s->camera.at.z = 5, "camera: from and at are the same point")                                \
    X(s->camera.up = turner_vec3_of(0, 0, -3), "camera: up lies along the view; choose another")   \
    X(s->camera.up = turner_vec3_of(0, 0, 0), "camera: up lies along the view; choose another")    \
    X(s->camera.vfov = 0,                                                                          \
      "camera: the angle of view must be above 0 and below 180 degrees")                           \
    X(s->camera.vfov = NAN,                                                                        \
      "camera: the angle of view must be above 0 and below 180 degrees")                           \
    X(s->camera.inside_count = 9, "camera: inside of 9 media; 8 are the limit")                    \
    X(s->camera.inside[0] = 2, "camera: inside of a medium that is not there")                     \
    X(s->ambient.y = -1, "ambient: it is negative or not finite")                                  \
    X(s->background.top.x = NAN, "background: a colour is negative or not finite")                 \
    X(s->background.up.y = 2, "background: up is no unit vector")                                  \
    X(s->background.kind = TURNER_BACKGROUND_ENVIRONMENT,                                          \
      "background: the picture is not there")                                                      \
    X(s->media[0].index = 0, "medium \"air\": index 0 must be above 0")                            \
    X(s->media[1].absorption.x = 1e39,                                                             \
      "medium \"water\": absorption is negative or not finite")                                    \
    X(s->media[0].priority = 1, "medium \"water\": media are not sorted by priority")              \
    X(s->materials[0].k_d.z = -1, "material \"plain\": k_d is negative or not finite")             \
    X(s->materials[0].k_e.z = NAN, "material \"plain\": k_e is negative or not finite")            \
    X(s->materials[0].exponent = -1, "material \"plain\": exponent -1 must be 0 or above")         \
    X(s->materials[0].medium = 0, "material \"plain\": a medium behind a surface with k_t = 0")    \
    X(s->materials[1].medium = TURNER_NONE, "material \"glass\": k_t is above 0, but what is "     \
                                            "behind the surface? Give it an index")                \
    X(s->materials[2].k_t.x = 1,                                                                   \
      "material \"gold\": a metal lets no light through, but k_t is above 0")                      \
    X(s->materials[2].eta.x = NAN, "material \"gold\": eta or k is negative or not finite")        \
    X(s->materials[2].fresnel = TURNER_FRESNEL_NONE,                                               \
      "material \"gold\": a complex index wants fresnel exact")                                    \
    X(s->materials[2].conductor = false,                                                           \
      "material \"gold\": fresnel exact on a mirror needs eta and k")                              \
    X(s->materials[3].checker[1].x = NAN,                                                          \
      "material \"tiles\": a checker colour is negative or not finite")                            \
    X(s->materials[3].uv_scale[0] = NAN, "material \"tiles\": the pattern's scale is not finite")  \
    X(s->materials[3].pattern = TURNER_PATTERN_IMAGE,                                              \
      "material \"tiles\": its picture is not there")                                              \
    X(s->groups[0].spheres[0].radius = 0, "sphere 0: radius 0 must be above 0")                    \
    X(s->groups[0].spheres[0].radius = NAN, "sphere 0: radius nan must be above 0")                \
    X(s->groups[0].spheres[0].center.x = NAN, "sphere 0: its centre is not finite")                \
    X(s->groups[0].spheres[0].material = 4, "sphere 0: its material is not there")                 \
    X(s->planes[0].point.x = NAN, "plane 0: its point is not finite")                              \
    X(s->planes[0].normal.y = 2,                                                                   \
      "plane 0: normal and tangent are not unit vectors at right angles")                          \
    X(s->planes[0].tangent = s->planes[0].normal,                                                  \
      "plane 0: normal and tangent are not unit vectors at right angles")                          \
    X(s->groups[1].cones[0].apex.y = 0,                                                            \
      "cone 0 of group \"tree\": base and apex are the same point")                                \
    X(s->groups[1].cones[0].base_radius = 0, "cone 0 of group \"tree\": radii 0 and 0: none may "  \
                                             "be negative, one must be above 0")                   \
    X(s->groups[1].meshes[0].triangles[0][1] = 3,                                                  \
      "mesh 0 of group \"tree\": triangle 0 uses vertex 3, but there are 3")                       \
    X(s->groups[1].meshes[0].positions[2].x = NAN,                                                 \
      "mesh 0 of group \"tree\": vertex 2 is not finite")                                          \
    X(s->groups[1].meshes[0].normals[1][2] = 2,                                                    \
      "mesh 0 of group \"tree\": the normal of vertex 1 is no unit vector")                        \
    X(s->groups[1].meshes[0].uvs[1][0] = NAN,                                                      \
      "mesh 0 of group \"tree\": the texture coordinates of vertex 1 are not finite")              \
    X(s->groups[1].meshes[0].triangle_count = 0,                                                   \
      "mesh 0 of group \"tree\": it has no triangles")                                             \
    X(s->instances[0].group = 0, "instance 0: its group is not there")                             \
    X(s->instances[0].group = 2, "instance 0: its group is not there")                             \
    X(s->instances[0].material = 4, "instance 0: its material is not there")                       \
    X(s->instances[0].transform.m[0][0] = 0,                                                       \
      "instance 0: its transform flattens space or is not finite")                                 \
    X(s->instances[0].transform.m[0][3] = NAN,                                                     \
      "instance 0: its transform flattens space or is not finite")                                 \
    X(s->lights[0].power.x = -1, "light 0: its power is negative or not finite")                   \
    X(s->lights[0].position.x = NAN, "light 0: its position is not finite")                        \
    X(s->lights[0].direction.x = 1, "light 0: its direction is no unit vector")                    \
    X(s->lights[0].cos_inner = 0, "light 0: its inner angle is larger than its outer one")

static void one_wrong_thing(void **state)
{
    (void)state;
    struct turner_scene *s = must_parse(whole);
    assert_int_equal(turner_scene_validate(s), TURNER_OK);
    turner_scene_destroy(s);
#define CHECK(change, message)                                                                     \
    s = must_parse(whole);                                                                         \
    change;                                                                                        \
    if (turner_scene_validate(s) != TURNER_BAD_INPUT)                                              \
        fail_msg("accepted: %s", #change);                                                         \
    assert_string_equal(turner_message(), message);                                                \
    turner_scene_destroy(s);
    CASES(CHECK)
}

/* Counts are judged before anything they count is looked at, so that they can be claimed here. */
static void limits(void **state)
{
    (void)state;
    struct turner_scene *s = must_parse(whole);
    struct {
        size_t *count, limit;
        const char *message;
    } cases[] = {
        {&s->material_count, TURNER_MAX_MATERIALS, "1048577 materials; 1048576 are the limit"},
        {&s->media_count, TURNER_MAX_MEDIA, "256 media; 255 are the limit"},
        {&s->plane_count, TURNER_MAX_PLANES, "65 planes; 64 are the limit"},
        {&s->light_count, TURNER_MAX_LIGHTS, "4097 lights; 4096 are the limit"},
        {&s->instance_count, TURNER_MAX_INSTANCES, "16777216 instances; 16777215 are the limit"},
        {&s->groups[0].sphere_count, TURNER_MAX_PRIMITIVES, "primitives or more; 268435456 are"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t count = *cases[i].count;
        *cases[i].count = cases[i].limit + 1;
        if (turner_scene_validate(s) != TURNER_BAD_INPUT)
            fail_msg("accepted: %s", cases[i].message);
        if (!strstr(turner_message(), cases[i].message))
            fail_msg("\"%s\" instead of \"%s\"", turner_message(), cases[i].message);
        *cases[i].count = count;
    }
    turner_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_wrong_thing),
                                       cmocka_unit_test(limits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

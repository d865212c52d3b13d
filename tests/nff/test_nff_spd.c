/* The four scenes of the Standard Procedural Databases against what their text says, counted by a
 * line scanner that shares nothing with the reader. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "nff_reading.h"

#define FOLDER TURNER_SHARED_DIR "/scenes/nff/"

struct facts {
    const char *file;
    size_t spheres, polygons, patches, lights, fills, materials, media, meshes, triangles;
    struct turner_vec3 from;
};

/* spheres … fills: lines that start with s, p, pp, l, f; materials: different lines with f;
 * triangles: corners less 2 of each polygon */
static const struct facts scenes[] = {
    {"balls.nff", 7381, 1, 0, 3, 2, 2, 0, 1, 2, {2.1, 1.3, 1.7}},
    {"gears.nff", 0, 9345, 0, 5, 65, 63, 1, 63, 128 * 142 + 9217 * 2, {-1.1, -2.1, 2.6}},
    {"mount.nff", 4, 8192, 0, 1, 2, 2, 1, 1, 8192, {-1.6, 1.6, 1.7}},
    {"teapot.nff", 0, 144, 9120, 2, 3, 3, 0, 3, 144 * 2 + 9120, {4.86, 7.2, 5.4}},
};

/* Lines that start with `word` and a blank or the line's end. */
static size_t count_lines(const char *text, const char *word)
{
    size_t count = 0, length = strlen(word);
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        count += strncmp(line, word, length) == 0 && strchr(" \r\n", line[length]) && line[length];
    }
    return count;
}

static struct turner_scene *read_shared(const char *file, char **text, double *seconds)
{
    char path[1024];
    snprintf(path, sizeof path, FOLDER "%s", file);
    *text = file_text(path);
    if (!*text) {
        print_message("%s is not there\n", path);
        skip();
    }
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    struct turner_scene *scene = read_nff(*text);
    clock_gettime(CLOCK_MONOTONIC, &to);
    *seconds = (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
    if (!scene)
        fail_msg("%s: %s", path, turner_message());
    return scene;
}

static void counts(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const struct facts *f = &scenes[i];
        char *text;
        double seconds;
        struct caught caught = caught_begin();
        struct turner_scene *scene = read_shared(f->file, &text, &seconds);
        char *warnings = caught_end(&caught);
        print_message("%s: %.1f ms\n", f->file, 1000 * seconds);
        assert_string_equal(warnings, ""); /* nothing is left out */
        assert_int_equal(count_lines(text, "s"), f->spheres);
        assert_int_equal(count_lines(text, "p"), f->polygons);
        assert_int_equal(count_lines(text, "pp"), f->patches);
        assert_int_equal(count_lines(text, "l"), f->lights);
        assert_int_equal(count_lines(text, "f"), f->fills);

        const struct turner_group *world = &scene->groups[0];
        assert_int_equal(world->sphere_count, f->spheres);
        assert_int_equal(world->cone_count, 0);
        assert_int_equal(world->mesh_count, f->meshes);
        size_t triangles = 0, smooth = 0;
        for (size_t k = 0; k < world->mesh_count; k++) {
            triangles += world->meshes[k].triangle_count;
            smooth += world->meshes[k].normals ? world->meshes[k].triangle_count : 0;
        }
        assert_int_equal(triangles, f->triangles);
        assert_int_equal(smooth, f->patches);
        assert_int_equal(scene->light_count, f->lights);
        assert_int_equal(scene->material_count, f->materials);
        assert_int_equal(scene->media_count, f->media);
        double power = 1 / sqrt((double)f->lights);
        for (size_t k = 0; k < f->lights; k++)
            assert_true(scene->lights[k].power.x == power && scene->lights[k].power.z == power);
        const struct turner_camera *c = &scene->camera;
        assert_true(c->from.x == f->from.x && c->from.y == f->from.y && c->from.z == f->from.z);
        assert_true(c->at.x == 0 && c->at.y == 0 && c->at.z == 0 && c->up.z == 1);
        assert_true(fabs(c->vfov - acos(-1) / 4) < 1e-15);
        assert_true(scene->settings.width == 512 && scene->settings.height == 512);
        assert_true(scene->background.color.x == 0.078 && scene->background.color.z == 0.753);
        turner_scene_destroy(scene);
        free(warnings);
        free(text);
    }
}

/* The cut polygons of gears cover what Newell's normals say the whole ones do. */
static void areas_of_the_gears(void **state)
{
    (void)state;
    char *text;
    double seconds;
    struct turner_scene *scene = read_shared("gears.nff", &text, &seconds);
    double expected = 0;
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, "p ", 2) != 0)
            continue;
        char *rest;
        long count = strtol(line + 2, &rest, 10);
        struct turner_vec3 sum = {0, 0, 0}, first = {0, 0, 0}, last = {0, 0, 0};
        for (long i = 0; i < count; i++) {
            struct turner_vec3 p;
            p.x = strtod(rest, &rest);
            p.y = strtod(rest, &rest);
            p.z = strtod(rest, &rest);
            if (i == 0)
                first = p;
            if (i >= 2)
                sum = turner_vec3_add(sum, turner_vec3_cross(turner_vec3_sub(last, first),
                                                             turner_vec3_sub(p, first)));
            last = p;
        }
        expected += turner_vec3_length(sum) / 2;
    }
    double area = 0;
    for (size_t k = 0; k < scene->groups[0].mesh_count; k++) {
        const struct turner_mesh *mesh = &scene->groups[0].meshes[k];
        for (uint32_t i = 0; i < mesh->triangle_count; i++) {
            const uint32_t *t = mesh->triangles[i];
            struct turner_vec3 a = mesh->positions[t[0]];
            area += turner_vec3_length(
                        turner_vec3_cross(turner_vec3_sub(mesh->positions[t[1]], a),
                                          turner_vec3_sub(mesh->positions[t[2]], a))) / 2;
        }
    }
    if (!(fabs(area - expected) <= 1e-6 * expected)) /* the sides are flat to six digits only */
        fail_msg("%.12g instead of %.12g", area, expected);
    turner_scene_destroy(scene);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts),
        cmocka_unit_test(areas_of_the_gears),
    };
    char *text = file_text(FOLDER "balls.nff");
    if (!text) {
        print_message("skipped: no " FOLDER "balls.nff\n");
        return 77;
    }
    free(text);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

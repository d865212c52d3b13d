/* Neutral File Format (Eric Haines, "A Proposal for Standard Graphics Environments", 1987), the
 * format of the Standard Procedural Databases; mapped as docs/model.md has it under NFF. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/polygon.h"
#include "scene/readers.h"
#include "scene/tokens.h"

#define BUCKETS 4096
#define RADIANS (3.14159265358979323846 / 180)

/* A mesh that grows. */
struct growing_mesh {
    struct turner_mesh mesh;
    size_t position_capacity, normal_capacity, triangle_capacity;
};

/* What is kept of each material beside the scene's own list. */
struct fill {
    uint32_t next;      /* in the same bucket */
    uint32_t meshes[2]; /* its flat and its smooth mesh in `meshes`, or TURNER_NONE */
};

struct nff {
    struct turner_tokens tokens;
    struct turner_scene *scene;
    struct turner_group *world;
    struct fill *fills; /* one for each of the scene's materials */
    size_t fill_count, fill_capacity;
    uint32_t buckets[BUCKETS]; /* hash of a material -> the first such one, or TURNER_NONE */
    uint32_t material;         /* the current one, or TURNER_NONE */
    struct growing_mesh *meshes;
    size_t mesh_count, mesh_capacity;
    struct turner_polygon polygon; /* the one being read */
    size_t triangle_count;
    size_t skipped; /* primitives without area */
    bool has_view, has_background;
};

/* Reads numbers with their names, each at least `low`. */
static enum turner_result read_numbers(struct nff *nff, double *values, size_t count,
                                       const char *const *names, double low)
{
    for (size_t i = 0; i < count; i++)
        TURNER_TRY(turner_tokens_number(&nff->tokens, &values[i], names[i], low, HUGE_VAL));
    return TURNER_OK;
}

static enum turner_result read_vec3(struct nff *nff, struct turner_vec3 *v,
                                    const char *const names[3], double low)
{
    double values[3];
    TURNER_TRY(read_numbers(nff, values, 3, names, low));
    *v = turner_vec3_of(values[0], values[1], values[2]);
    return TURNER_OK;
}

static enum turner_result read_background(struct nff *nff)
{
    static const char *const names[] = {"r of the background (b)", "g of the background (b)",
                                        "b of the background (b)"};
    if (nff->has_background)
        return turner_tokens_fail(&nff->tokens, &nff->tokens.last, "a second background (b)");
    nff->has_background = true;
    nff->scene->background.kind = TURNER_BACKGROUND_CONSTANT;
    return read_vec3(nff, &nff->scene->background.color, names, 0);
}

static enum turner_result read_view(struct nff *nff)
{
    static const char *const from[] = {"x of \"from\"", "y of \"from\"", "z of \"from\""};
    static const char *const at[] = {"x of \"at\"", "y of \"at\"", "z of \"at\""};
    static const char *const up[] = {"x of \"up\"", "y of \"up\"", "z of \"up\""};
    struct turner_tokens *tokens = &nff->tokens;
    struct turner_camera *camera = &nff->scene->camera;
    struct turner_settings *settings = &nff->scene->settings;
    struct turner_token start = tokens->last;
    if (nff->has_view)
        return turner_tokens_fail(tokens, &start, "a second viewpoint (v)");
    nff->has_view = true;
    TURNER_TRY(turner_tokens_word(tokens, "from"));
    TURNER_TRY(read_vec3(nff, &camera->from, from, -HUGE_VAL));
    TURNER_TRY(turner_tokens_word(tokens, "at"));
    TURNER_TRY(read_vec3(nff, &camera->at, at, -HUGE_VAL));
    TURNER_TRY(turner_tokens_word(tokens, "up"));
    TURNER_TRY(read_vec3(nff, &camera->up, up, -HUGE_VAL));
    enum turner_camera_state state = turner_camera_check(camera);
    if (state != TURNER_CAMERA_GOOD)
        return turner_tokens_fail(tokens, &start, "the viewpoint (v) has no direction: %s",
                                  state == TURNER_CAMERA_NO_DIRECTION
                                      ? "\"from\" is \"at\""
                                      : "\"up\" lies along the view");

    double degrees, hither;
    TURNER_TRY(turner_tokens_word(tokens, "angle"));
    TURNER_TRY(turner_tokens_number(tokens, &degrees, "degrees of \"angle\"", 0, 180));
    if (degrees == 0 || degrees == 180)
        return turner_tokens_fail(tokens, &tokens->last,
                                  "the \"angle\" must lie between 0 and 180, without these");
    camera->vfov = degrees * RADIANS;
    TURNER_TRY(turner_tokens_word(tokens, "hither")); /* means nothing to a ray tracer */
    TURNER_TRY(turner_tokens_number(tokens, &hither, "distance of \"hither\"", -HUGE_VAL,
                                    HUGE_VAL));
    TURNER_TRY(turner_tokens_word(tokens, "resolution"));
    TURNER_TRY(turner_tokens_integer(tokens, &settings->width, "width of \"resolution\"", 1,
                                     TURNER_MAX_SIZE));
    return turner_tokens_integer(tokens, &settings->height, "height of \"resolution\"", 1,
                                 TURNER_MAX_SIZE);
}

static enum turner_result read_light(struct nff *nff)
{
    static const char *const place[] = {"x of a light (l)", "y of a light (l)", "z of a light (l)"};
    static const char *const color[] = {"r of a light (l)", "g of a light (l)", "b of a light (l)"};
    struct turner_scene *scene = nff->scene;
    struct turner_light light = {.kind = TURNER_LIGHT_POINT, .falloff = TURNER_FALLOFF_NONE,
                                 .power = {1, 1, 1}};
    TURNER_TRY(read_vec3(nff, &light.position, place, -HUGE_VAL));
    if (turner_tokens_at_number(&nff->tokens))
        TURNER_TRY(read_vec3(nff, &light.power, color, 0));
    if (scene->light_count == TURNER_MAX_LIGHTS)
        return turner_tokens_fail(&nff->tokens, &nff->tokens.last, "more than %d lights",
                                  TURNER_MAX_LIGHTS);
    *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) = light;
    return TURNER_OK;
}

/* The medium of refractive index `index`; equal ones are one. */
static enum turner_result find_medium(struct nff *nff, uint32_t *medium, double index)
{
    struct turner_scene *scene = nff->scene;
    for (*medium = 0; *medium < scene->media_count; ++*medium) {
        if (scene->media[*medium].index == index)
            return TURNER_OK;
    }
    if (scene->media_count == TURNER_MAX_MEDIA)
        return turner_tokens_fail(&nff->tokens, &nff->tokens.last,
                                  "more than %d different indices of refraction", TURNER_MAX_MEDIA);
    *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) =
        (struct turner_medium){.index = index};
    return TURNER_OK;
}

static bool same_vec3(struct turner_vec3 a, struct turner_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* For materials made by read_fill; what is not compared follows from what is. */
static bool same_material(const struct turner_material *a, const struct turner_material *b)
{
    return same_vec3(a->k_d, b->k_d) && same_vec3(a->k_s, b->k_s) && same_vec3(a->k_t, b->k_t) &&
           a->exponent == b->exponent && a->medium == b->medium;
}

static uint32_t hash_material(const struct turner_material *m)
{
    double parts[] = {m->k_d.x, m->k_d.y, m->k_d.z, m->k_s.x, m->k_t.x, m->exponent, m->medium};
    uint64_t hash = 0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        double part = parts[i] + 0.0; /* −0 equals 0 */
        uint64_t bits;
        memcpy(&bits, &part, sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return (uint32_t)(hash % BUCKETS);
}

static enum turner_result read_fill(struct nff *nff)
{
    static const char *const names[] = {"r of a fill (f)", "g of a fill (f)", "b of a fill (f)",
                                        "Kd of a fill (f)", "Ks of a fill (f)",
                                        "Shine of a fill (f)", "T of a fill (f)"};
    struct turner_scene *scene = nff->scene;
    double v[7], index;
    TURNER_TRY(read_numbers(nff, v, 7, names, 0));
    TURNER_TRY(turner_tokens_number(&nff->tokens, &index, "index of refraction of a fill (f)",
                                    -HUGE_VAL, HUGE_VAL));
    struct turner_material m = {.exponent = v[5], .fresnel = TURNER_FRESNEL_NONE,
                                .medium = TURNER_NONE, .uv_scale = {1, 1}, .image = TURNER_NONE};
    m.k_d = m.k_a = turner_vec3_scale(turner_vec3_of(v[0], v[1], v[2]), v[3]);
    if (!turner_color_usable(m.k_d))
        return turner_tokens_fail(&nff->tokens, &nff->tokens.last,
                                  "a fill's (f) colour times Kd is beyond 3.4e38");
    m.k_s = m.k_r = turner_vec3_of(v[4], v[4], v[4]);
    m.k_t = turner_vec3_of(v[6], v[6], v[6]);
    if (v[6] > 0) {
        if (index <= 0)
            return turner_tokens_fail(&nff->tokens, &nff->tokens.last,
                                      "a transparent fill (T = %g) needs an index of refraction "
                                      "above 0, not %g", v[6], index);
        TURNER_TRY(find_medium(nff, &m.medium, index));
    }
    uint32_t *bucket = &nff->buckets[hash_material(&m)];
    for (uint32_t i = *bucket; i != TURNER_NONE; i = nff->fills[i].next) {
        if (same_material(&scene->materials[i], &m)) {
            nff->material = i;
            return TURNER_OK;
        }
    }
    if (scene->material_count == TURNER_MAX_MATERIALS)
        return turner_tokens_fail(&nff->tokens, &nff->tokens.last,
                                  "more than %d different fills (f)", TURNER_MAX_MATERIALS);
    *TURNER_PUSH(nff->fills, nff->fill_count, nff->fill_capacity) =
        (struct fill){*bucket, {TURNER_NONE, TURNER_NONE}};
    nff->material = *bucket = (uint32_t)scene->material_count;
    *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) = m;
    return TURNER_OK;
}

static enum turner_result read_sphere(struct nff *nff)
{
    static const char *const names[] = {"x of a sphere (s)", "y of a sphere (s)",
                                        "z of a sphere (s)", "radius of a sphere (s)"};
    double v[4];
    TURNER_TRY(read_numbers(nff, v, 4, names, -HUGE_VAL));
    if (v[3] == 0) {
        nff->skipped++;
        return TURNER_OK;
    }
    *TURNER_PUSH(nff->world->spheres, nff->world->sphere_count, nff->world->sphere_capacity) =
        (struct turner_sphere){{v[0], v[1], v[2]}, fabs(v[3]), nff->material};
    return TURNER_OK;
}

static enum turner_result read_cone(struct nff *nff)
{
    static const char *const names[] = {
        "x of a cone's (c) base", "y of a cone's (c) base", "z of a cone's (c) base",
        "radius of a cone's (c) base", "x of a cone's (c) apex", "y of a cone's (c) apex",
        "z of a cone's (c) apex", "radius of a cone's (c) apex"};
    double v[8];
    TURNER_TRY(read_numbers(nff, v, 8, names, -HUGE_VAL));
    struct turner_cone cone = {{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, fabs(v[3]), fabs(v[7]),
                               false, nff->material};
    if (same_vec3(cone.base, cone.apex) || (cone.base_radius == 0 && cone.apex_radius == 0)) {
        nff->skipped++;
        return TURNER_OK;
    }
    *TURNER_PUSH(nff->world->cones, nff->world->cone_count, nff->world->cone_capacity) = cone;
    return TURNER_OK;
}

/* The current material's mesh of flat (0) or smooth (1) triangles. */
static struct growing_mesh *current_mesh(struct nff *nff, int smooth)
{
    uint32_t *index = &nff->fills[nff->material].meshes[smooth];
    if (*index == TURNER_NONE) {
        *index = (uint32_t)nff->mesh_count;
        *TURNER_PUSH(nff->meshes, nff->mesh_count, nff->mesh_capacity) =
            (struct growing_mesh){.mesh.material = nff->material};
    }
    return &nff->meshes[*index];
}

static void add_triangle(struct nff *nff, struct growing_mesh *g, uint32_t a, uint32_t b,
                         uint32_t c)
{
    uint32_t *triangle =
        *TURNER_PUSH(g->mesh.triangles, g->mesh.triangle_count, g->triangle_capacity);
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
    nff->triangle_count++;
}

/* The number of corners of a polygon that starts here. */
static enum turner_result read_corner_count(struct nff *nff, int *count)
{
    return turner_tokens_integer(&nff->tokens, count, "count of a polygon's (p, pp) corners", 3,
                                 TURNER_MAX_POLYGON_CORNERS);
}

static enum turner_result check_triangle_count(const struct nff *nff,
                                               const struct turner_token *start)
{
    if (nff->triangle_count > TURNER_MAX_PRIMITIVES)
        return turner_tokens_fail(&nff->tokens, start, "more than %u triangles up to here",
                                  TURNER_MAX_PRIMITIVES);
    return TURNER_OK;
}

static const char *const corner_names[] = {"x of a polygon's (p, pp) corner",
                                           "y of a polygon's (p, pp) corner",
                                           "z of a polygon's (p, pp) corner"};

static enum turner_result read_polygon(struct nff *nff)
{
    struct turner_polygon *polygon = &nff->polygon;
    struct turner_token start = nff->tokens.last;
    int count;
    TURNER_TRY(read_corner_count(nff, &count));
    polygon->corner_count = 0;
    for (int i = 0; i < count; i++) {
        struct turner_vec3 corner;
        TURNER_TRY(read_vec3(nff, &corner, corner_names, -HUGE_VAL));
        *TURNER_PUSH(polygon->corners, polygon->corner_count, polygon->corner_capacity) = corner;
    }
    if (turner_polygon_triangulate(polygon) != TURNER_OK)
        return turner_fail_within(TURNER_BAD_INPUT, "%s:%zu:%zu", nff->tokens.path, start.line,
                                  start.column);
    if (!polygon->triangle_count) {
        nff->skipped++;
        return TURNER_OK;
    }
    struct growing_mesh *g = current_mesh(nff, 0);
    uint32_t first = g->mesh.vertex_count;
    for (size_t i = 0; i < polygon->corner_count; i++)
        *TURNER_PUSH(g->mesh.positions, g->mesh.vertex_count, g->position_capacity) =
            polygon->corners[i];
    for (size_t i = 0; i < polygon->triangle_count; i++) {
        const uint32_t *t = polygon->triangles[i];
        add_triangle(nff, g, first + t[0], first + t[1], first + t[2]);
    }
    return check_triangle_count(nff, &start);
}

/* A corner of a patch, with its normal as the file has it. */
struct patch_corner {
    struct turner_vec3 position, normal;
};

/* Every triangle has vertices of its own: where a normal is zero it takes the triangle's. False
 * for a triangle without area. */
static bool add_patch_triangle(struct nff *nff, const struct patch_corner corners[3])
{
    struct turner_vec3 ng = turner_vec3_normalize(
        turner_vec3_cross(turner_vec3_sub(corners[1].position, corners[0].position),
                          turner_vec3_sub(corners[2].position, corners[0].position)));
    if (!(fabs(turner_vec3_length(ng) - 1) < 1e-6))
        return false;
    struct growing_mesh *g = current_mesh(nff, 1);
    struct turner_mesh *mesh = &g->mesh;
    uint32_t first = mesh->vertex_count;
    for (int i = 0; i < 3; i++) {
        struct turner_vec3 n = turner_vec3_normalize(corners[i].normal);
        if (!(fabs(turner_vec3_length(n) - 1) < 1e-6)) /* zero, or too long to have a length */
            n = ng;
        mesh->normals = turner_grow(mesh->normals, mesh->vertex_count, &g->normal_capacity,
                                    sizeof *mesh->normals);
        float *normal = mesh->normals[mesh->vertex_count];
        normal[0] = (float)n.x;
        normal[1] = (float)n.y;
        normal[2] = (float)n.z;
        *TURNER_PUSH(mesh->positions, mesh->vertex_count, g->position_capacity) =
            corners[i].position;
    }
    add_triangle(nff, g, first, first + 1, first + 2);
    return true;
}

static enum turner_result read_patch(struct nff *nff)
{
    static const char *const normal_names[] = {"x of a patch's (pp) normal",
                                               "y of a patch's (pp) normal",
                                               "z of a patch's (pp) normal"};
    struct turner_token start = nff->tokens.last;
    int count;
    TURNER_TRY(read_corner_count(nff, &count));
    struct patch_corner fan[3]; /* corners 0, i − 1, i */
    bool has_area = false;
    for (int i = 0; i < count; i++) {
        struct patch_corner *corner = &fan[i < 2 ? i : 2];
        TURNER_TRY(read_vec3(nff, &corner->position, corner_names, -HUGE_VAL));
        TURNER_TRY(read_vec3(nff, &corner->normal, normal_names, -HUGE_VAL));
        if (i >= 2) {
            has_area |= add_patch_triangle(nff, fan);
            fan[1] = fan[2];
        }
    }
    nff->skipped += !has_area;
    return check_triangle_count(nff, &start);
}

struct keyword {
    const char *word;
    bool needs_material;
    enum turner_result (*read)(struct nff *nff);
};

static const struct keyword keywords[] = {
    {"b", false, read_background}, {"v", false, read_view},   {"l", false, read_light},
    {"f", false, read_fill},       {"s", true, read_sphere},  {"c", true, read_cone},
    {"p", true, read_polygon},     {"pp", true, read_patch},
};

static enum turner_result read_item(struct nff *nff)
{
    struct turner_tokens *tokens = &nff->tokens;
    const struct keyword *nearest = NULL;
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++) {
        const struct keyword *k = &keywords[i];
        if (!turner_tokens_at(tokens, k->word)) {
            if (!nearest && k->word[0] == (tokens->token.text[0] | 0x20)) /* as a small letter */
                nearest = k;
            continue;
        }
        if (k->needs_material && nff->material == TURNER_NONE)
            return turner_tokens_expected(tokens, "a fill (f) before the first primitive");
        turner_tokens_advance(tokens);
        return k->read(nff);
    }
    if (turner_tokens_at_number(tokens))
        return turner_tokens_expected(
            tokens, "a keyword (b v l f s c p pp) because the one before has all its numbers");
    if (nearest)
        return turner_tokens_expected(tokens, "a keyword (b v l f s c p pp; perhaps \"%s\")",
                                      nearest->word);
    return turner_tokens_expected(tokens, "a keyword (b v l f s c p pp)");
}

/* Hands the meshes over to the world, without their spare room. */
static void add_meshes(struct nff *nff)
{
    for (size_t i = 0; i < nff->mesh_count; i++) {
        struct turner_mesh *mesh = &nff->meshes[i].mesh;
        mesh->positions =
            turner_realloc(mesh->positions, mesh->vertex_count, sizeof *mesh->positions);
        mesh->triangles =
            turner_realloc(mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
        if (mesh->normals)
            mesh->normals =
                turner_realloc(mesh->normals, mesh->vertex_count, sizeof *mesh->normals);
        turner_group_add_mesh(nff->world, mesh);
    }
}

static enum turner_result read_items(struct nff *nff)
{
    while (nff->tokens.token.length)
        TURNER_TRY(read_item(nff));
    if (!nff->has_view)
        return turner_tokens_expected(&nff->tokens, "a viewpoint (v)");
    return TURNER_OK;
}

enum turner_result turner_scene_read_nff(struct turner_scene *scene, const char *text,
                                         size_t length, const char *path)
{
    struct nff *nff = turner_calloc(1, sizeof *nff);
    nff->scene = scene;
    nff->world = &scene->groups[0];
    nff->material = TURNER_NONE;
    memset(nff->buckets, 0xff, sizeof nff->buckets); /* TURNER_NONE */
    struct turner_settings *settings = &scene->settings;
    settings->depth = 4;
    settings->cutoff = 0;
    settings->shading = TURNER_SHADING_PHONG;
    settings->shadows = TURNER_SHADOWS_OPAQUE;
    settings->transfer = TURNER_TRANSFER_LINEAR;
    scene->ambient = turner_vec3_of(0, 0, 0);

    turner_tokens_begin(&nff->tokens, text, length, path);
    enum turner_result result = read_items(nff);
    if (result == TURNER_OK) {
        for (size_t i = 0; i < scene->light_count; i++)
            scene->lights[i].power = turner_vec3_scale(scene->lights[i].power,
                                                       1 / sqrt((double)scene->light_count));
        add_meshes(nff);
        if (nff->skipped)
            turner_warn("%s: %zu primitive%s without area left out", path, nff->skipped,
                        nff->skipped == 1 ? "" : "s");
    }
    for (size_t i = 0; i < nff->mesh_count; i++)
        turner_mesh_destroy(&nff->meshes[i].mesh);
    free(nff->meshes);
    free(nff->fills);
    turner_polygon_destroy(&nff->polygon);
    free(nff);
    return result;
}

/* Materials. A layered texture of POV-Ray adds up what each layer gives, times what the layers
 * above let through (f·colour + t); ambient, diffuse and emission of a layer are scaled by
 * 1 − f − t, phong and reflection are not. So each of our terms gets a layer of its own, those above
 * the last with t = ½ and colours made up for it by powers of two. */
#include <stdlib.h>

#include "scene/pov_parts.h"

enum layer_kind { LAYER_DIFFUSE, LAYER_EMISSION, LAYER_TINT, LAYER_BASE };

struct layer {
    enum layer_kind kind;
    struct turner_vec3 color; /* the base's is what it lets through */
    bool patterned;
};

struct layers {
    struct layer list[5]; /* from the top */
    int count;
    struct turner_vec3 k_s; /* of the highlight … */
    int highlight;          /* … and the layer that has it */
};

static bool grey(struct turner_vec3 v)
{
    return v.x == v.y && v.y == v.z;
}

static struct turner_vec3 product(struct turner_vec3 a, struct turner_vec3 b)
{
    return turner_vec3_of(a.x * b.x, a.y * b.y, a.z * b.z);
}

static double largest(struct turner_vec3 v)
{
    return fmax(v.x, fmax(v.y, v.z));
}

static enum turner_fresnel fresnel_of(const struct turner_scene *scene,
                                      const struct turner_material *m)
{
    if (turner_pov_zero(m->k_t))
        return m->fresnel;
    switch (scene->settings.methods.fresnel) {
    case TURNER_OVERRIDE_NONE: return TURNER_FRESNEL_NONE;
    case TURNER_OVERRIDE_SCHLICK: return TURNER_FRESNEL_SCHLICK;
    case TURNER_OVERRIDE_EXACT: return TURNER_FRESNEL_EXACT;
    case TURNER_OVERRIDE_MATERIAL: break;
    }
    return m->fresnel;
}

static void add_layer(struct layers *layers, enum layer_kind kind, struct turner_vec3 color,
                      bool patterned)
{
    if (kind == LAYER_BASE || !turner_pov_zero(color))
        layers->list[layers->count++] = (struct layer){kind, color, patterned};
}

/* A highlight of POV-Ray has the colour of the light alone: a coloured one lies under a tint. */
static struct layers layers_of(const struct turner_scene *scene, const struct turner_material *m)
{
    struct layers layers = {0};
    bool patterned = m->pattern != TURNER_PATTERN_NONE;
    struct turner_vec3 ambient = product(m->k_a, scene->ambient), emission = m->k_e;
    struct turner_vec3 through = m->k_t, k_s = {0};
    double albedo = scene->settings.shading == TURNER_SHADING_PHONG ? 1 : 1 / M_PI;
    if (scene->light_count) {
        k_s = m->k_s;
        add_layer(&layers, LAYER_DIFFUSE, turner_vec3_scale(m->k_d, albedo), patterned);
    }
    if (patterned)
        add_layer(&layers, LAYER_EMISSION, ambient, true);
    else
        emission = turner_vec3_add(emission, ambient);
    add_layer(&layers, LAYER_EMISSION, emission, false);
    layers.k_s = k_s;
    if (!grey(k_s)) {
        double most = largest(k_s);
        struct turner_vec3 tint = turner_vec3_scale(k_s, 1 / most);
        add_layer(&layers, LAYER_TINT, tint, false);
        layers.k_s = turner_vec3_of(most, most, most);
        layers.highlight = layers.count;
        through = turner_vec3_of(tint.x > 0 ? through.x / tint.x : 0,
                                 tint.y > 0 ? through.y / tint.y : 0,
                                 tint.z > 0 ? through.z / tint.z : 0);
    }
    if (!layers.count || layers.highlight || !turner_pov_zero(m->k_t))
        add_layer(&layers, LAYER_BASE, through, false);
    return layers;
}

/* Reflected and transmitted light that is not among POV-Ray's formulas. What it draws at total
 * internal reflection has weight 1, whatever the material. */
enum turner_result turner_pov_check_secondary(const struct turner_scene *scene, uint32_t material,
                                              double n)
{
    const struct turner_material *m = &scene->materials[material];
    const char *name = turner_pov_material_name(scene, material);
    enum turner_fresnel fresnel = fresnel_of(scene, m);
    struct turner_vec3 sum = turner_vec3_add(m->k_r, m->k_t);
    if (turner_pov_zero(m->k_t)) {
        if (fresnel == TURNER_FRESNEL_EXACT && !turner_pov_zero(m->k_r))
            return turner_fail(TURNER_BAD_INPUT, "%s: POV-Ray has no metals with a complex index: "
                               "use \"fresnel\": \"schlick\" with k_r as the colour", name);
        return TURNER_OK;
    }
    if (fresnel == TURNER_FRESNEL_SCHLICK)
        return turner_fail(TURNER_BAD_INPUT, "%s: POV-Ray has Schlick's formula for metals only: "
                                             "use \"fresnel\": \"exact\" for what transmits", name);
    if (fresnel == TURNER_FRESNEL_EXACT && n != 1 && !(m->k_r.x == 1 && grey(m->k_r)))
        return turner_fail(TURNER_BAD_INPUT, "%s: POV-Ray transmits what its Fresnel formula does "
                           "not reflect, after k_r: give it a k_r of 1, or \"fresnel\": \"none\"",
                           name);
    if (fresnel == TURNER_FRESNEL_NONE && n != 1 &&
        !(fabs(sum.x - 1) < 1e-9 && fabs(sum.y - 1) < 1e-9 && fabs(sum.z - 1) < 1e-9))
        return turner_fail(TURNER_BAD_INPUT, "%s: total internal reflection has weight 1 in "
                           "POV-Ray, not k_r + k_t: let them add up to 1, or use \"fresnel\": "
                           "\"exact\"", name);
    return TURNER_OK;
}

static enum turner_result check_local(const struct turner_scene *scene, uint32_t index)
{
    const struct turner_material *m = &scene->materials[index];
    const char *name = turner_pov_material_name(scene, index);
    struct turner_vec3 s = m->k_s, t = m->k_t;
    bool highlight = scene->light_count && !turner_pov_zero(s);
    if (highlight && scene->settings.shading == TURNER_SHADING_ENERGY_CONSERVING)
        return turner_fail(TURNER_BAD_INPUT, "%s: POV-Ray's highlight lacks the factor N·L of "
                           "\"energy_conserving\": use \"shading\": \"phong\", or no k_s", name);
    if (highlight && ((s.x == 0 && t.x > 0) || (s.y == 0 && t.y > 0) || (s.z == 0 && t.z > 0)))
        return turner_fail(TURNER_BAD_INPUT, "%s: a coloured highlight on what transmits is beyond "
                           "POV-Ray where a channel of k_s is 0: use a grey k_s", name);
    if (m->pattern == TURNER_PATTERN_IMAGE)
        return turner_fail(TURNER_BAD_INPUT, "%s: POV-Ray does not filter a picture as turner "
                           "does: use a checker or a plain colour", name);
    return TURNER_OK;
}

enum turner_result turner_pov_check_materials(const struct turner_scene *scene)
{
    bool *used = turner_pov_materials_used(scene);
    enum turner_result result = TURNER_OK;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (!used[i])
            continue;
        TURNER_TRY_DONE(check_local(scene, i));
        uint32_t medium = scene->materials[i].medium;
        TURNER_TRY_DONE(turner_pov_check_secondary(
            scene, i, medium == TURNER_NONE ? 1 : scene->media[medium].index));
    }
done:
    free(used);
    return result;
}

static void write_finish(FILE *out, const struct turner_scene *scene,
                         const struct turner_material *m, const struct layers *layers, int index)
{
    const struct layer *layer = &layers->list[index];
    bool transmits = !turner_pov_zero(m->k_t);
    fprintf(out, " finish { ambient 0 diffuse %d", layer->kind == LAYER_DIFFUSE);
    if (layer->kind == LAYER_EMISSION)
        fputs(" emission 1", out);
    if (index == layers->highlight && layers->k_s.x > 0) {
        double gain = layers->highlight ? ldexp(1, layers->highlight - 1) : 1; /* undoes each ½ */
        fprintf(out, " phong %.17g phong_size %.17g", layers->k_s.x * gain, m->exponent);
    }
    if (index == (transmits ? layers->count - 1 : 0) && !turner_pov_zero(m->k_r)) {
        enum turner_fresnel fresnel = fresnel_of(scene, m);
        fputs(" reflection { rgb ", out);
        turner_pov_vector(out, transmits && fresnel != TURNER_FRESNEL_NONE ? (struct turner_vec3){0}
                                                                           : m->k_r);
        if (transmits && fresnel == TURNER_FRESNEL_EXACT)
            fputs(", rgb 1 fresnel on } conserve_energy", out);
        else if (fresnel == TURNER_FRESNEL_SCHLICK)
            fputs(", rgb 1 falloff 5 }", out);
        else
            fputs(" }", out);
    }
    fputs(" }", out);
}

static void write_color(FILE *out, struct turner_vec3 color, double filter, double transmit)
{
    fprintf(out, "rgbft <%.17g, %.17g, %.17g, %.17g, %.17g>", color.x, color.y, color.z, filter,
            transmit);
}

/* Where u·su, v·sv and ½ go: floors of all three add up in POV-Ray's checker. */
static void write_checker_place(FILE *out, const struct turner_material *m,
                                const struct turner_plane *plane)
{
    double su = m->uv_scale[0], sv = m->uv_scale[1];
    if (!plane) {
        fprintf(out, " scale <%.17g, %.17g, 1> translate <0, 0, -0.5>", 1 / su, 1 / sv);
        return;
    }
    struct turner_vec3 t = turner_vec3_scale(plane->tangent, 1 / su), n = plane->normal;
    struct turner_vec3 b = turner_vec3_scale(turner_vec3_cross(n, plane->tangent), 1 / sv);
    struct turner_vec3 o = turner_vec3_sub(plane->point, turner_vec3_scale(n, 0.5));
    fprintf(out, " matrix <%.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g, "
                 "%.17g, %.17g>",
            t.x, t.y, t.z, b.x, b.y, b.z, n.x, n.y, n.z, o.x, o.y, o.z);
}

static void write_layer(FILE *out, const struct turner_scene *scene,
                        const struct turner_material *m, const struct layers *layers, int index,
                        const struct turner_plane *plane)
{
    const struct layer *layer = &layers->list[index];
    bool last = index == layers->count - 1;
    bool adds = layer->kind == LAYER_DIFFUSE || layer->kind == LAYER_EMISSION;
    double transmit = adds && !last ? 0.5 : 0;
    double filter = layer->kind == LAYER_TINT ||
                    (layer->kind == LAYER_BASE && !turner_pov_zero(m->k_t));
    double gain = 1; /* undoes the ½ of each layer above, and of its own */
    if (adds)
        gain = ldexp(1, index + !last);
    else if (layer->kind == LAYER_BASE)
        gain = ldexp(1, layers->highlight ? index - 1 : index);
    struct turner_vec3 color = turner_vec3_scale(layer->color, gain);
    fputs("texture { pigment { ", out);
    if (layer->patterned) {
        fputs("checker ", out);
        write_color(out, product(color, m->checker[0]), filter, transmit);
        fputs(", ", out);
        write_color(out, product(color, m->checker[1]), filter, transmit);
        write_checker_place(out, m, plane);
    } else {
        write_color(out, color, filter, transmit);
    }
    fputs(" }", out);
    write_finish(out, scene, m, layers, index);
    fputs(" }\n", out);
}

/* The one on top comes last. */
void turner_pov_texture(FILE *out, const struct turner_scene *scene, uint32_t material,
                        const struct turner_plane *plane)
{
    const struct turner_material *m = &scene->materials[material];
    struct layers layers = layers_of(scene, m);
    for (int i = layers.count - 1; i >= 0; i--)
        write_layer(out, scene, m, &layers, i, plane);
}

/* POV-Ray goes straight on where the index does not change, and counts no bounce; ours is counted.
 * One step of the 32 bits it keeps an index in makes it a surface to be counted. */
static double index_of(const struct turner_medium *medium)
{
    return medium->index == 1 ? 1 + 0x1p-23 : medium->index;
}

void turner_pov_declare_materials(FILE *out, const struct turner_scene *scene)
{
    bool *used = turner_pov_materials_used(scene);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const struct turner_material *m = &scene->materials[i];
        if (!used[i])
            continue;
        if (m->pattern == TURNER_PATTERN_NONE) {
            fprintf(out, "#declare M%u = ", (unsigned)i);
            turner_pov_texture(out, scene, i, NULL);
        }
        if (turner_pov_zero(m->k_t))
            continue;
        const struct turner_medium *medium = &scene->media[m->medium];
        fprintf(out, "#declare I%u = interior { ior %.17g", (unsigned)i, index_of(medium));
        if (!turner_pov_zero(medium->absorption)) {
            fputs(" media { method 1 intervals 1 samples 1, 1 absorption rgb ", out);
            turner_pov_vector(out, medium->absorption);
            fputs(" }", out);
        }
        fputs(" }\n", out);
    }
    free(used);
}

#include "render/advice.h"

#include <stdio.h>

#include "render/depth.h"
#include "render/precision.h"

static bool any(struct turner_vec3 v)
{
    return v.x != 0 || v.y != 0 || v.z != 0;
}

static void advise_depth(const struct turner_scene *scene, const char *name)
{
    const struct turner_settings *settings = &scene->settings;
    struct turner_depth depth = turner_depth_of(scene);
    char text[TURNER_WHY_TEXT];
    if (!settings->depth_asked || settings->depth <= depth.useful)
        return;
    if (depth.weight == 0) {
        turner_warn("%s: depth %d, but nothing reflects or transmits; depth 0 draws the same "
                    "picture", name, settings->depth);
        return;
    }
    turner_why_text(text, scene, &(struct turner_why){TURNER_ASKER_MATERIAL, 0, depth.material, 1});
    turner_warn("%s: depth %d, but no ray deeper than %d reaches the cutoff %g (%s sends on %g of "
                "the light at most); depth %d draws the same picture", name, settings->depth,
                depth.useful, settings->cutoff, text, depth.weight, depth.useful);
}

/* Whether no boundary of the material's medium parts media that absorb differently. */
static bool absorbs_nothing(const struct turner_scene *scene, const struct turner_usage *usage,
                            const struct turner_material *material)
{
    for (uint32_t i = 0; i <= material->medium; i++) {
        if (usage->media[i] && any(scene->media[i].absorption))
            return false;
    }
    return true;
}

static bool lets_all_through(const struct turner_scene *scene, const struct turner_material *m,
                             const struct turner_weights *w)
{
    bool lit = any(m->k_e) || any(m->k_d) || any(m->k_s) || (any(m->k_a) && any(scene->ambient));
    bool shadow = scene->settings.shadows == TURNER_SHADOWS_OPAQUE && scene->light_count > 0;
    return !lit && !shadow && !any(w->reflected) && m->k_t.x == 1 && m->k_t.y == 1 &&
           m->k_t.z == 1;
}

static void advise_materials(const struct turner_scene *scene, const char *name)
{
    struct turner_why empty = {TURNER_ASKER_MATERIAL, 0, 0, 0}, matt = empty;
    struct turner_usage usage;
    turner_usage_create(&usage, scene);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const struct turner_material *m = &scene->materials[i];
        if (!usage.materials[i] || m->medium == TURNER_NONE ||
            turner_material_fresnel(&scene->settings, m) == TURNER_FRESNEL_SCHLICK)
            continue;
        struct turner_weights w = turner_weights_of(scene, &usage, m);
        struct turner_why *why = NULL;
        if (w.flat && lets_all_through(scene, m, &w) && absorbs_nothing(scene, &usage, m))
            why = &empty;
        else if (w.flat && any(m->k_r) && !any(w.reflected))
            why = &matt;
        if (why && why->count++ == 0)
            why->index = i;
    }
    turner_usage_destroy(&usage);

    char text[TURNER_WHY_TEXT];
    turner_why_text(text, scene, &empty);
    if (empty.count)
        turner_warn("%s: %s cannot be seen: the index is that of what is around it, all light "
                    "passes, and nothing is absorbed", name, text);
    turner_why_text(text, scene, &matt);
    if (matt.count)
        turner_warn("%s: k_r of %s never shows: between equal indices nothing is reflected", name,
                    text);
}

static void advise_samples(const struct turner_scene *scene, const char *name)
{
    size_t things = scene->plane_count + scene->instance_count +
                    turner_group_primitive_count(&scene->groups[0]);
    if (scene->settings.spp > 1 && things == 0 &&
        scene->background.kind == TURNER_BACKGROUND_CONSTANT)
        turner_warn("%s: %d samples per pixel, but there is only a background of one colour; one "
                    "sample draws the same picture", name, scene->settings.spp);
}

static void advise_precision(const struct turner_scene *scene, const char *name, int bits)
{
    if (scene->settings.methods.precision != TURNER_PRECISION_F64 || bits == 0 ||
        turner_f64_can_show(scene, bits))
        return;
    struct turner_f32_error error = turner_f32_error_of(scene);
    turner_warn("%s: precision f64, but f32 is at the limit of a picture of %d bits: it moves "
                "edges by %.2g of a pixel at most, half a step is %.2g", name, bits,
                fmax(error.pixels, error.shape), turner_half_step(bits));
}

void turner_advise(const struct turner_scene *scene, const char *name, int bits)
{
    advise_depth(scene, name);
    advise_materials(scene, name);
    advise_samples(scene, name);
    advise_precision(scene, name, bits);
}

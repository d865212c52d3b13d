/* Needs and their reasons in words. */
#include <stdio.h>

#include "render/needs.h"

#include "../shaders/shared.h"

const char *turner_needs_name(uint32_t bit)
{
    switch (bit) {
    case TURNER_NEEDS_SPHERES: return "spheres";
    case TURNER_NEEDS_CONES: return "cones";
    case TURNER_NEEDS_TRIANGLES: return "triangles";
    case TURNER_NEEDS_PLANES: return "planes";
    case TURNER_NEEDS_INSTANCES: return "instances";
    case TURNER_NEEDS_SMOOTH: return "smooth normals";
    case TURNER_NEEDS_CHECKER: return "checker pattern";
    case TURNER_NEEDS_IMAGES: return "image textures";
    case TURNER_NEEDS_DIRECTIONAL: return "directional lights";
    case TURNER_NEEDS_POINT: return "point lights";
    case TURNER_NEEDS_SPOT: return "spot lights";
    case TURNER_NEEDS_PHONG: return "classic Phong";
    case TURNER_NEEDS_CONSERVING: return "energy-conserving Phong";
    case TURNER_NEEDS_SPECULAR: return "highlights";
    case TURNER_NEEDS_REFLECTION: return "reflection";
    case TURNER_NEEDS_TRANSMISSION: return "transmission";
    case TURNER_NEEDS_BRANCHING: return "branching rays";
    case TURNER_NEEDS_SCHLICK: return "Schlick's Fresnel";
    case TURNER_NEEDS_EXACT: return "exact Fresnel";
    case TURNER_NEEDS_CONDUCTOR: return "metals";
    case TURNER_NEEDS_MEDIA: return "media";
    case TURNER_NEEDS_ABSORPTION: return "absorption";
    case TURNER_NEEDS_TINTED: return "tinted shadows";
    case TURNER_NEEDS_GRADIENT: return "gradient background";
    case TURNER_NEEDS_ENVIRONMENT: return "environment picture";
    }
    return "unknown";
}

enum turner_feature_kind turner_needs_kind(uint32_t bit)
{
    static const struct {
        uint32_t bits;
        enum turner_feature_kind kind;
    } kinds[] = {
        {TURNER_NEEDS_SPHERES | TURNER_NEEDS_CONES | TURNER_NEEDS_TRIANGLES |
             TURNER_NEEDS_PLANES | TURNER_NEEDS_INSTANCES | TURNER_NEEDS_SMOOTH,
         TURNER_FEATURE_PRIMITIVES},
        {TURNER_NEEDS_CHECKER | TURNER_NEEDS_IMAGES, TURNER_FEATURE_TEXTURES},
        {TURNER_NEEDS_GRADIENT | TURNER_NEEDS_ENVIRONMENT, TURNER_FEATURE_BACKGROUND},
        {TURNER_NEEDS_DIRECTIONAL | TURNER_NEEDS_POINT | TURNER_NEEDS_SPOT,
         TURNER_FEATURE_LIGHTS},
        {TURNER_NEEDS_PHONG | TURNER_NEEDS_CONSERVING | TURNER_NEEDS_SPECULAR |
             TURNER_NEEDS_TINTED,
         TURNER_FEATURE_SHADING},
        {TURNER_NEEDS_REFLECTION | TURNER_NEEDS_TRANSMISSION | TURNER_NEEDS_BRANCHING,
         TURNER_FEATURE_SECONDARY_RAYS},
        {TURNER_NEEDS_SCHLICK | TURNER_NEEDS_EXACT | TURNER_NEEDS_CONDUCTOR,
         TURNER_FEATURE_FRESNEL},
        {TURNER_NEEDS_MEDIA | TURNER_NEEDS_ABSORPTION, TURNER_FEATURE_MEDIA},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (bit & kinds[i].bits)
            return kinds[i].kind;
    }
    return TURNER_FEATURE_OTHER;
}

const char *turner_feature_kind_name(enum turner_feature_kind kind)
{
    static const char *const names[TURNER_FEATURE_KINDS] = {
        "primitives", "textures", "background", "lights", "shading", "secondary rays", "Fresnel",
        "media", "other"};
    return names[kind];
}

/* The name, "" without one. */
static const char *name_of(const struct turner_scene *scene, const struct turner_why *why)
{
    const char *name = why->asker == TURNER_ASKER_MATERIAL ? scene->materials[why->index].name
                       : why->asker == TURNER_ASKER_MEDIUM ? scene->media[why->index].name
                                                           : NULL;
    return name ? name : "";
}

void turner_why_text(char text[TURNER_WHY_TEXT], const struct turner_scene *scene,
                     const struct turner_why *why)
{
    static const char *const kinds[] = {"sphere", "cone", "mesh", "plane", "instance", "material",
                                        "medium", "light", "camera"};
    text[0] = 0;
    if (why->count == 0)
        return;
    if (why->asker == TURNER_ASKER_SHADING || why->asker == TURNER_ASKER_BACKGROUND) {
        snprintf(text, TURNER_WHY_TEXT, "%s",
                 why->asker == TURNER_ASKER_SHADING ? "settings.shading" : "background.type");
        return;
    }
    if (why->asker == TURNER_ASKER_CAMERA) {
        snprintf(text, TURNER_WHY_TEXT, "the camera is inside a medium");
        return;
    }
    char more[32] = "", place[72] = "";
    if (why->count > 1)
        snprintf(more, sizeof more, " and %llu more", (unsigned long long)why->count - 1);
    if (why->group)
        snprintf(place, sizeof place, " of group \"%.50s\"", scene->groups[why->group].name);
    if (*name_of(scene, why))
        snprintf(text, TURNER_WHY_TEXT, "%s \"%.50s\"%s", kinds[why->asker],
                 name_of(scene, why), more);
    else
        snprintf(text, TURNER_WHY_TEXT, "%s %u%s%s", kinds[why->asker], why->index, place, more);
}

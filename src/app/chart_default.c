/* The grid for those who give none: what matters in this scene, in some 20 to 40 points. */
#include <stdarg.h>
#include <stdio.h>

#include <cjson/cJSON.h>

#include "app/chart.h"
#include "render/needs.h"

#include "../shaders/shared.h"

#define SECONDARY (TURNER_NEEDS_REFLECTION | TURNER_NEEDS_TRANSMISSION)
#define MANY_SAMPLES 64

static void add_number(cJSON *list, double value)
{
    cJSON_AddItemToArray(list, cJSON_CreateNumber(value));
}

/* A single point: `extra` at the middle number of samples. */
TURNER_PRINTF(3, 4)
static void add_also(cJSON *also, int samples, const char *format, ...)
{
    char extra[128], text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(extra, sizeof extra, format, arguments);
    va_end(arguments);
    snprintf(text, sizeof text, "aa=%d%s%s", samples, *extra ? " " : "", extra);
    cJSON_AddItemToArray(also, cJSON_CreateString(text));
}

/* Few, the scene's own or else 4, many, and as many as a pixel wants. */
static int add_samples(cJSON *axes, const struct turner_settings *settings)
{
    cJSON *list = cJSON_AddArrayToObject(axes, "aa");
    bool regular = !(settings->aa_threshold > 0);
    int middle = regular && settings->spp > 1 && settings->spp < 16 ? settings->spp : 4;
    add_number(list, 1);
    add_number(list, middle);
    add_number(list, 16);
    cJSON_AddItemToArray(list, cJSON_CreateString("adaptive:0.05,64"));
    return middle;
}

static int deeper_than(const struct turner_settings *settings, uint32_t needs)
{
    int most = needs & TURNER_NEEDS_BRANCHING ? TURNER_MAX_BRANCH_DEPTH : TURNER_MAX_DEPTH;
    int deep = settings->depth > 1 ? 2 * settings->depth : 4;
    return deep < most ? deep : most;
}

static void add_depths(cJSON *axes, const struct turner_settings *settings, uint32_t needs)
{
    cJSON *list = cJSON_AddArrayToObject(axes, "depth");
    add_number(list, settings->depth);
    add_number(list, deeper_than(settings, needs));
}

static void add_cutoffs(cJSON *axes, const struct turner_settings *settings)
{
    cJSON *list = cJSON_AddArrayToObject(axes, "cutoff");
    add_number(list, settings->cutoff < 1.0 / 64 ? 1.0 / 32 : 1.0 / 512);
    add_number(list, settings->cutoff);
}

/* Without Fresnel a surface that counts on it to share the light between two rays makes light. */
static bool works_without_fresnel(const struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->material_count; i++) {
        struct turner_vec3 k_r = scene->materials[i].k_r, k_t = scene->materials[i].k_t;
        bool transmits = k_t.x > 0 || k_t.y > 0 || k_t.z > 0;
        if (transmits && !(k_r.x + k_t.x <= 1 && k_r.y + k_t.y <= 1 && k_r.z + k_t.z <= 1))
            return false;
    }
    return true;
}

static void add_methods(cJSON *also, const struct turner_scene *scene, uint32_t needs, int samples)
{
    if (needs & TURNER_NEEDS_SPHERES) {
        add_also(also, samples, "sphere=textbook");
        add_also(also, samples, "sphere=f64");
    }
    if (needs & TURNER_NEEDS_TRIANGLES)
        add_also(also, samples, "triangle=moller_trumbore");
    if (needs & (SECONDARY | TURNER_NEEDS_DIRECTIONAL | TURNER_NEEDS_POINT)) {
        add_also(also, samples, "offset=none");
        add_also(also, samples, "offset=tmin:0.001");
        add_also(also, samples, "offset=ulp");
    }
    if (needs & TURNER_NEEDS_TRANSMISSION) {
        add_also(also, samples, "fresnel=schlick");
        add_also(also, samples, "fresnel=schlick schlick_side=incident");
        if (works_without_fresnel(scene))
            add_also(also, samples, "fresnel=none");
        add_also(also, samples, "fresnel_cosine=naive");
    }
    add_also(also, samples, "precision=f64");
    add_also(also, samples, "traversal=ray_query");
}

char *turner_chart_default_grid(const struct turner_scene *scene)
{
    const struct turner_settings *settings = &scene->settings;
    uint32_t needs = turner_needs_of(scene).bits;
    cJSON *grid = cJSON_CreateObject(), *axes = cJSON_AddObjectToObject(grid, "axes");
    int samples = add_samples(axes, settings);
    cJSON *also = cJSON_AddArrayToObject(grid, "also");
    char deep[32] = "", finest[80];
    cJSON_AddItemToArray(also, cJSON_CreateString("")); /* as the scene says */
    if (needs & SECONDARY) {
        add_depths(axes, settings, needs);
        add_cutoffs(axes, settings);
        snprintf(deep, sizeof deep, "depth=%d", deeper_than(settings, needs));
        add_also(also, 1, "depth=%d", settings->depth / 3);
        add_also(also, samples, "depth=%d", settings->depth / 3);
        add_also(also, samples, "cutoff=0.0001 %s", deep);
    }
    add_also(also, MANY_SAMPLES, "%s", deep);
    cJSON_AddItemToArray(also, cJSON_CreateString("aa=adaptive:0.2,16"));
    cJSON_AddItemToArray(also, cJSON_CreateString("error=1/16"));
    cJSON_AddItemToArray(also, cJSON_CreateString("error=1/64"));
    snprintf(finest, sizeof finest, "aa=adaptive:0.01,256 %s", deep);
    cJSON_AddItemToArray(also, cJSON_CreateString(finest));
    add_methods(also, scene, needs, samples);
    char *text = cJSON_Print(grid);
    cJSON_Delete(grid);
    return text;
}

#include "render/device_scene.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/follow.h"

static const char *const array_names[TURNER_ARRAYS] = {
    "BVH nodes", "primitives", "instances", "primitives", "instances", "planes", "triangle corners",
    "normals",   "uvs",        "materials", "media",      "pictures",  "pictures", "lights",
    "the scene"};

static void set_vec3(float out[3], struct turner_vec3 v)
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

/* The same, and what rounding takes from it. */
static void set_both(float out[3], float rest[3], struct turner_vec3 v)
{
    set_vec3(out, v);
    rest[0] = (float)(v.x - (double)out[0]);
    rest[1] = (float)(v.y - (double)out[1]);
    rest[2] = (float)(v.z - (double)out[2]);
}

static enum turner_result upload(struct turner_device_scene *device, struct turner_gpu *gpu,
                                 enum turner_array array, const void *data, size_t bytes)
{
    if (device->arrays[array].buffer) { /* made before: only what is in it changes */
        return turner_buffer_upload(gpu, &device->arrays[array], 0, data, bytes);
    }
    VkBufferUsageFlags extra =
        array == TURNER_ARRAY_PRIMITIVES && gpu->info.ray_query ? TURNER_ACCEL_INPUT : 0;
    TURNER_TRY(turner_buffer_create(&device->arrays[array], gpu, bytes, extra,
                                    TURNER_MEMORY_DEVICE, array_names[array]));
    return bytes ? turner_buffer_upload(gpu, &device->arrays[array], 0, data, bytes) : TURNER_OK;
}

static struct turner_gpu_material gpu_material(const struct turner_settings *settings,
                                               const struct turner_material *m)
{
    enum turner_fresnel fresnel = turner_material_fresnel(settings, m);
    struct turner_gpu_material g = {
        .uv_scale = {(float)m->uv_scale[0], (float)m->uv_scale[1]},
        .exponent = (float)m->exponent,
        .fresnel = m->conductor                            ? TURNER_FRESNEL_KIND_CONDUCTOR
                   : fresnel == TURNER_FRESNEL_EXACT       ? TURNER_FRESNEL_KIND_EXACT
                   : fresnel == TURNER_FRESNEL_SCHLICK     ? TURNER_FRESNEL_KIND_SCHLICK
                                                           : TURNER_FRESNEL_KIND_NONE,
        .medium = m->medium,
        .pattern = m->pattern == TURNER_PATTERN_CHECKER ? TURNER_PATTERN_KIND_CHECKER
                   : m->pattern == TURNER_PATTERN_IMAGE ? TURNER_PATTERN_KIND_IMAGE
                                                        : TURNER_PATTERN_KIND_NONE,
        .image = m->image,
    };
    set_vec3(g.k_e, m->k_e);
    set_vec3(g.k_a, m->k_a);
    set_vec3(g.k_d, m->k_d);
    set_vec3(g.k_s, m->k_s);
    set_vec3(g.k_r, m->k_r);
    set_vec3(g.k_t, m->k_t);
    set_vec3(g.eta, m->eta);
    set_vec3(g.k, m->k);
    set_vec3(g.checker0, m->checker[0]);
    set_vec3(g.checker1, m->checker[1]);
    return g;
}

static uint32_t material_word(const struct turner_scene *scene, uint32_t material)
{
    struct turner_vec3 k_t = scene->materials[material].k_t;
    return material | (k_t.x != 0 || k_t.y != 0 || k_t.z != 0 ? TURNER_MATERIAL_TRANSMISSIVE : 0);
}

static enum turner_result upload_planes(struct turner_device_scene *device, struct turner_gpu *gpu,
                                        const struct turner_scene *scene)
{
    struct turner_gpu_plane planes[TURNER_MAX_PLANES] = {0};
    for (size_t i = 0; i < scene->plane_count; i++) {
        set_both(planes[i].point, planes[i].point_rest, scene->planes[i].point);
        set_both(planes[i].normal, planes[i].normal_rest, scene->planes[i].normal);
        set_both(planes[i].tangent, planes[i].tangent_rest, scene->planes[i].tangent);
        planes[i].material = material_word(scene, scene->planes[i].material);
    }
    return upload(device, gpu, TURNER_ARRAY_PLANES, planes, scene->plane_count * sizeof *planes);
}

static enum turner_result upload_materials(struct turner_device_scene *device,
                                           struct turner_gpu *gpu, const struct turner_scene *scene)
{
    struct turner_gpu_material *materials =
        turner_calloc(scene->material_count + 1, sizeof *materials);
    for (size_t i = 0; i < scene->material_count; i++)
        materials[i] = gpu_material(&scene->settings, &scene->materials[i]);
    enum turner_result result = upload(device, gpu, TURNER_ARRAY_MATERIALS, materials,
                                       scene->material_count * sizeof *materials);
    free(materials);
    return result;
}

static enum turner_result upload_media(struct turner_device_scene *device, struct turner_gpu *gpu,
                                       const struct turner_scene *scene)
{
    struct turner_gpu_medium media[TURNER_MAX_MEDIA] = {0};
    for (size_t i = 0; i < scene->media_count; i++) {
        media[i].index = (float)scene->media[i].index;
        media[i].index_rest = (float)(scene->media[i].index - (double)media[i].index);
        set_vec3(media[i].absorption, scene->media[i].absorption);
    }
    return upload(device, gpu, TURNER_ARRAY_MEDIA, media, scene->media_count * sizeof *media);
}

static enum turner_result upload_lights(struct turner_device_scene *device, struct turner_gpu *gpu,
                                        const struct turner_scene *scene)
{
    struct turner_gpu_light *lights = turner_calloc(scene->light_count + 1, sizeof *lights);
    for (size_t i = 0; i < scene->light_count; i++) {
        const struct turner_light *from = &scene->lights[i];
        struct turner_gpu_light *to = &lights[i];
        to->kind = from->kind == TURNER_LIGHT_DIRECTIONAL ? TURNER_LIGHT_KIND_DIRECTIONAL
                   : from->kind == TURNER_LIGHT_POINT     ? TURNER_LIGHT_KIND_POINT
                                                          : TURNER_LIGHT_KIND_SPOT;
        to->inverse_square = from->kind != TURNER_LIGHT_DIRECTIONAL &&
                             from->falloff == TURNER_FALLOFF_INVERSE_SQUARE;
        to->cos_inner = (float)from->cos_inner;
        to->cos_outer = (float)from->cos_outer;
        set_both(to->position, to->position_rest, from->position);
        set_both(to->direction, to->direction_rest, from->direction);
        set_vec3(to->power, from->power);
    }
    enum turner_result result = upload(device, gpu, TURNER_ARRAY_LIGHTS, lights,
                                       scene->light_count * sizeof *lights);
    free(lights);
    return result;
}

/* All pictures in one buffer, and a table of where each begins. */
static enum turner_result upload_images(struct turner_device_scene *device, struct turner_gpu *gpu,
                                        const struct turner_scene *scene)
{
    size_t bytes = 0;
    for (size_t i = 0; i < scene->texture_image_count; i++) {
        const struct turner_texture_image *image = &scene->texture_images[i];
        bytes += (size_t)image->width * (size_t)image->height * 3 * sizeof(float);
    }
    struct turner_buffer *texels = &device->arrays[TURNER_ARRAY_TEXELS];
    TURNER_TRY(turner_buffer_create(texels, gpu, bytes, 0, TURNER_MEMORY_DEVICE,
                                    array_names[TURNER_ARRAY_TEXELS]));

    struct turner_gpu_image *table =
        turner_calloc(scene->texture_image_count + 1, sizeof *table);
    enum turner_result result = TURNER_OK;
    size_t offset = 0;
    for (size_t i = 0; i < scene->texture_image_count && result == TURNER_OK; i++) {
        const struct turner_texture_image *image = &scene->texture_images[i];
        table[i] = (struct turner_gpu_image){texels->address + offset, (uint32_t)image->width,
                                             (uint32_t)image->height};
        size_t size = (size_t)image->width * (size_t)image->height * 3 * sizeof(float);
        result = turner_buffer_upload(gpu, texels, offset, image->rgb, size);
        offset += size;
    }
    if (result == TURNER_OK)
        result = upload(device, gpu, TURNER_ARRAY_IMAGES, table,
                        scene->texture_image_count * sizeof *table);
    free(table);
    return result;
}

static enum turner_result upload_primitive_rests(struct turner_device_scene *device,
                                                 struct turner_gpu *gpu,
                                                 const struct turner_scene *scene,
                                                 const struct turner_flat *flat)
{
    struct turner_gpu_primitive_rest *primitives =
        turner_calloc(flat->primitive_count + 1, sizeof *primitives);
    turner_flat_primitive_rests(primitives, flat, scene);
    enum turner_result result = upload(device, gpu, TURNER_ARRAY_PRIMITIVE_RESTS, primitives,
                                       flat->primitive_count * sizeof *primitives);
    free(primitives);
    return result;
}

static enum turner_result upload_instance_rests(struct turner_device_scene *device,
                                                struct turner_gpu *gpu,
                                                const struct turner_scene *scene,
                                                const struct turner_flat *flat)
{
    struct turner_gpu_instance_rest *instances =
        turner_calloc(flat->instance_count, sizeof *instances);
    turner_flat_instance_rests(instances, flat, scene);
    enum turner_result result = upload(device, gpu, TURNER_ARRAY_INSTANCE_RESTS, instances,
                                       flat->instance_count * sizeof *instances);
    free(instances);
    return result;
}

static size_t node_size(const struct turner_flat *flat)
{
    return flat->order == TURNER_ORDER_WIDE ? sizeof *flat->wide : sizeof *flat->nodes;
}

/* From node `first` on. */
static enum turner_result upload_nodes(struct turner_device_scene *device, struct turner_gpu *gpu,
                                       const struct turner_flat *flat, size_t first)
{
    struct turner_buffer *buffer = &device->arrays[TURNER_ARRAY_NODES];
    size_t size = node_size(flat), bytes = (flat->node_count - first) * size;
    const char *nodes = flat->wide ? (const char *)flat->wide : (const char *)flat->nodes;
    if (!buffer->buffer)
        TURNER_TRY(turner_buffer_create(buffer, gpu, flat->node_room * size, 0,
                                        TURNER_MEMORY_DEVICE, array_names[TURNER_ARRAY_NODES]));
    return bytes ? turner_buffer_upload(gpu, buffer, first * size, nodes + first * size, bytes)
                 : TURNER_OK;
}

/* The list of media the eye is inside of, as shaders/media.glsl keeps it: highest first. */
static uint64_t media_list(const struct turner_camera *camera)
{
    uint32_t sorted[TURNER_MEDIA_NESTING];
    uint32_t count = 0;
    for (uint32_t i = 0; i < camera->inside_count; i++) {
        uint32_t place = count++;
        for (; place > 0 && sorted[place - 1] < camera->inside[i]; place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = camera->inside[i];
    }
    uint64_t list = 0;
    for (uint32_t i = 0; i < count; i++)
        list |= (uint64_t)(sorted[i] + 1) << (8 * i);
    return list;
}

/* docs/model.md "Camera". */
static void set_camera(struct turner_gpu_scene *block, const struct turner_scene *scene)
{
    const struct turner_camera *camera = &scene->camera;
    double width = scene->settings.width, height = scene->settings.height;
    struct turner_vec3 w = turner_vec3_normalize(turner_vec3_sub(camera->from, camera->at));
    struct turner_vec3 u = turner_vec3_normalize(turner_vec3_cross(camera->up, w));
    struct turner_vec3 v = turner_vec3_cross(w, u);
    double s = 2 * tan(camera->vfov / 2) / (scene->settings.spd_grid ? height - 2 : height);
    set_both(block->eye, block->eye_rest, camera->from);
    set_both(block->right, block->right_rest, turner_vec3_scale(u, s));
    set_both(block->down, block->down_rest, turner_vec3_scale(v, -s));
    set_both(block->forward, block->forward_rest, turner_vec3_scale(w, -1));
    block->center[0] = (float)(0.5 * width);
    block->center[1] = (float)(0.5 * height);
    block->inside = media_list(camera);
}

static void set_background(struct turner_gpu_scene *block,
                           const struct turner_background *background)
{
    block->background = background->kind == TURNER_BACKGROUND_GRADIENT
                            ? TURNER_BACKGROUND_KIND_GRADIENT
                        : background->kind == TURNER_BACKGROUND_ENVIRONMENT
                            ? TURNER_BACKGROUND_KIND_ENVIRONMENT
                            : TURNER_BACKGROUND_KIND_CONSTANT;
    set_vec3(block->background_color, background->color);
    set_vec3(block->background_top, background->top);
    set_vec3(block->background_up, background->up);
    set_vec3(block->background_scale, background->scale);
    block->background_turn = (float)(background->rotation / (2 * 3.14159265358979323846));
    block->background_image = background->image;
}

/* Nodes one ray may visit, or candidates it may be offered by the device's traversal. */
static uint32_t max_visits(const struct turner_flat *flat, bool ray_query)
{
    uint64_t visits = ray_query ? 0 : flat->max_visits;
    for (size_t i = 0; i < flat->instance_count && ray_query; i++) {
        const struct turner_flat_group *group = &flat->groups[flat->instance_groups[i]];
        visits += group->triangle_count + (uint64_t)group->box_count;
    }
    /* at least one turn, in which a ray query that has nothing to offer ends */
    return visits < UINT32_MAX ? (uint32_t)visits + 1 : UINT32_MAX;
}

static struct turner_gpu_scene scene_block(const struct turner_device_scene *device,
                                           const struct turner_scene *scene,
                                           const struct turner_flat *flat,
                                           const struct turner_needs *needs, bool ray_query)
{
    const struct turner_buffer *arrays = device->arrays;
    const struct turner_settings *settings = &scene->settings;
    struct turner_gpu_scene block = {
        .nodes = arrays[TURNER_ARRAY_NODES].address,
        .primitives = arrays[TURNER_ARRAY_PRIMITIVES].address,
        .instances = arrays[TURNER_ARRAY_INSTANCES].address,
        .planes = arrays[TURNER_ARRAY_PLANES].address,
        .corners = arrays[TURNER_ARRAY_CORNERS].address,
        .normals = arrays[TURNER_ARRAY_NORMALS].address,
        .uvs = arrays[TURNER_ARRAY_UVS].address,
        .materials = arrays[TURNER_ARRAY_MATERIALS].address,
        .media = arrays[TURNER_ARRAY_MEDIA].address,
        .images = arrays[TURNER_ARRAY_IMAGES].address,
        .lights = arrays[TURNER_ARRAY_LIGHTS].address,
        .primitive_rests = arrays[TURNER_ARRAY_PRIMITIVE_RESTS].address,
        .instance_rests = arrays[TURNER_ARRAY_INSTANCE_RESTS].address,
        .root = needs->bits & TURNER_NEEDS_INSTANCES
                    ? flat->root
                    : flat->groups[flat->instance_groups[0]].root,
        .plane_count = (uint32_t)scene->plane_count,
        .light_count = (uint32_t)scene->light_count,
        .max_depth = (uint32_t)settings->depth,
        .max_steps = needs->max_steps,
        .max_sent = settings->error > 0 ? TURNER_ERROR_RAYS : UINT32_MAX,
        .max_visits = max_visits(flat, ray_query),
        .max_crossings = needs->max_crossings,
        .shading = settings->shading == TURNER_SHADING_PHONG ? TURNER_NEEDS_PHONG
                                                             : TURNER_NEEDS_CONSERVING,
        .shadows_tinted = settings->shadows == TURNER_SHADOWS_TINTED,
        .spd_rays = settings->spd_rays,
        .cutoff = (float)settings->cutoff,
        .tmin = (float)settings->methods.tmin,
    };
    set_vec3(block.ambient, scene->ambient);
    set_camera(&block, scene);
    set_background(&block, &scene->background);
    return block;
}

enum turner_result turner_device_scene_look(struct turner_device_scene *device,
                                            struct turner_gpu *gpu,
                                            const struct turner_scene *scene,
                                            const struct turner_flat *flat,
                                            const struct turner_needs *needs, bool ray_query)
{
    struct turner_gpu_scene block = scene_block(device, scene, flat, needs, ray_query);
    return turner_buffer_upload(gpu, &device->arrays[TURNER_ARRAY_SCENE], 0, &block, sizeof block);
}

enum turner_result turner_device_scene_create(struct turner_device_scene *device,
                                              struct turner_gpu *gpu,
                                              const struct turner_scene *scene,
                                              const struct turner_flat *flat,
                                              const struct turner_needs *needs, bool ray_query)
{
    memset(device, 0, sizeof *device);
    TURNER_TRY(upload_nodes(device, gpu, flat, 0));
    TURNER_TRY(upload(device, gpu, TURNER_ARRAY_PRIMITIVES, flat->primitives,
                      flat->primitive_count * sizeof *flat->primitives));
    TURNER_TRY(upload(device, gpu, TURNER_ARRAY_INSTANCES, flat->instances,
                      flat->instance_count * sizeof *flat->instances));
    TURNER_TRY(upload(device, gpu, TURNER_ARRAY_CORNERS, flat->corners,
                      flat->corner_count * sizeof *flat->corners));
    TURNER_TRY(upload(device, gpu, TURNER_ARRAY_NORMALS, flat->normals,
                      flat->normals ? flat->vertex_count * sizeof *flat->normals : 0));
    TURNER_TRY(upload(device, gpu, TURNER_ARRAY_UVS, flat->uvs,
                      flat->uvs ? flat->vertex_count * sizeof *flat->uvs : 0));
    TURNER_TRY(upload_planes(device, gpu, scene));
    TURNER_TRY(upload_materials(device, gpu, scene));
    TURNER_TRY(upload_media(device, gpu, scene));
    TURNER_TRY(upload_lights(device, gpu, scene));
    TURNER_TRY(upload_images(device, gpu, scene));
    if (scene->settings.methods.precision == TURNER_PRECISION_F64) {
        TURNER_TRY(upload_primitive_rests(device, gpu, scene, flat));
        TURNER_TRY(upload_instance_rests(device, gpu, scene, flat));
    }
    if (ray_query)
        TURNER_TRY(turner_device_scene_build(device, gpu, flat));
    struct turner_gpu_scene block = scene_block(device, scene, flat, needs, ray_query);
    return upload(device, gpu, TURNER_ARRAY_SCENE, &block, sizeof block);
}

enum turner_result turner_device_scene_paint(struct turner_device_scene *device,
                                             struct turner_gpu *gpu,
                                             const struct turner_scene *scene)
{
    TURNER_TRY(upload_materials(device, gpu, scene));
    return upload_lights(device, gpu, scene);
}

enum turner_result turner_device_scene_move(struct turner_device_scene *device,
                                            struct turner_gpu *gpu,
                                            const struct turner_scene *scene,
                                            const struct turner_flat *flat, bool ray_query)
{
    TURNER_TRY(upload(device, gpu, TURNER_ARRAY_INSTANCES, flat->instances,
                      flat->instance_count * sizeof *flat->instances));
    if (device->arrays[TURNER_ARRAY_INSTANCE_RESTS].buffer)
        TURNER_TRY(upload_instance_rests(device, gpu, scene, flat));
    return ray_query ? turner_device_scene_build_top(device, gpu, flat)
                     : upload_nodes(device, gpu, flat, flat->root);
}

void turner_device_scene_destroy(struct turner_gpu *gpu, struct turner_device_scene *device)
{
    turner_accel_destroy(gpu, &device->top);
    for (size_t i = 0; i < device->accel_count; i++)
        turner_accel_destroy(gpu, &device->accels[i]);
    free(device->accels);
    for (int i = 0; i < TURNER_ARRAYS; i++)
        turner_buffer_destroy(gpu, &device->arrays[i]);
    memset(device, 0, sizeof *device);
}

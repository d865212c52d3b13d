#include "app/bench_embree.h"

#ifdef TURNER_EMBREE

#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#if TURNER_EMBREE == 4
#include <embree4/rtcore.h>
#define LIBRARY "libembree4.so.4"
#else
#include <embree3/rtcore.h>
#define LIBRARY "libembree3.so.3"
#endif

#include "base/memory.h"
#include "render/renderer.h"

#define FUNCTIONS(F)                                                                               \
    F(rtcNewDevice) F(rtcReleaseDevice) F(rtcGetDeviceProperty) F(rtcGetDeviceError)               \
    F(rtcSetDeviceMemoryMonitorFunction)                                                           \
    F(rtcNewScene) F(rtcReleaseScene) F(rtcCommitScene) F(rtcSetSceneBuildQuality)                 \
    F(rtcSetSceneFlags) F(rtcAttachGeometryByID) F(rtcNewGeometry) F(rtcReleaseGeometry)           \
    F(rtcCommitGeometry) F(rtcSetNewGeometryBuffer) F(rtcSetGeometryInstancedScene)                \
    F(rtcSetGeometryTransform) F(rtcIntersect1) F(rtcOccluded1) F(rtcIntersect8) F(rtcOccluded8)

#define MEMBER(name) __typeof__(name) *name;

struct turner_embree {
    void *library;
    FUNCTIONS(MEMBER)
    RTCDevice device;
    int threads;
    char name[32];
    atomic_llong bytes;
};

/* Geometries of a group: `id[g]` is turner's id of the first primitive of geometry g. */
struct group_of_embree {
    RTCScene scene;
    uint32_t *ids;
    uint32_t count;
};

struct turner_embree_scene {
    struct turner_embree *embree;
    struct group_of_embree *groups; /* [0] is the world, with the instances behind its own */
    size_t group_count;
    uint32_t *instance_groups; /* of geometry groups[0].count + i */
};

static bool count_bytes(void *user, ssize_t bytes, bool after)
{
    struct turner_embree *embree = user;
    (void)after;
    atomic_fetch_add(&embree->bytes, bytes);
    return true;
}

struct turner_embree *turner_embree_open(int threads, const char **why)
{
    struct turner_embree *embree = turner_calloc(1, sizeof *embree);
    char config[64];
    *why = LIBRARY " is not installed (Debian: libembree-dev)";
    /* never unloaded: threads of its own (TBB's) outlive its device */
    embree->library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    bool whole = embree->library != NULL;
#define LOAD(name) whole = whole && (*(void **)&embree->name = dlsym(embree->library, #name));
    FUNCTIONS(LOAD)
    embree->threads = threads;
    snprintf(config, sizeof config, "threads=%d", threads);
    if (whole) {
        *why = "Embree does not start";
        embree->device = embree->rtcNewDevice(config);
    }
    if (!embree->device) {
        turner_embree_close(embree);
        return NULL;
    }
    embree->rtcSetDeviceMemoryMonitorFunction(embree->device, count_bytes, embree);
    long version = (long)embree->rtcGetDeviceProperty(embree->device, RTC_DEVICE_PROPERTY_VERSION);
    snprintf(embree->name, sizeof embree->name, "Embree %ld.%ld.%ld", version / 10000,
             version / 100 % 100, version % 100);
    return embree;
}

void turner_embree_close(struct turner_embree *embree)
{
    if (!embree)
        return;
    if (embree->device)
        embree->rtcReleaseDevice(embree->device);
    if (embree->library)
        dlclose(embree->library);
    free(embree);
}

const char *turner_embree_name(const struct turner_embree *embree)
{
    return embree->name;
}

uint64_t turner_embree_bytes(const struct turner_embree *embree)
{
    return (uint64_t)atomic_load(&embree->bytes);
}

bool turner_embree_can(const struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->group_count; i++) {
        if (scene->groups[i].cone_count)
            return false;
    }
    return scene->plane_count == 0;
}

/* ---- scenes ---- */

static void attach(struct group_of_embree *to, struct turner_embree *embree, RTCGeometry geometry,
                   uint32_t id)
{
    embree->rtcCommitGeometry(geometry);
    embree->rtcAttachGeometryByID(to->scene, geometry, to->count);
    embree->rtcReleaseGeometry(geometry);
    to->ids[to->count++] = id;
}

static void add_spheres(struct group_of_embree *to, struct turner_embree *embree,
                        const struct turner_group *group)
{
    RTCGeometry geometry =
        embree->rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float(*spheres)[4] = embree->rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof *spheres,
        group->sphere_count);
    for (size_t i = 0; spheres && i < group->sphere_count; i++) {
        spheres[i][0] = (float)group->spheres[i].center.x;
        spheres[i][1] = (float)group->spheres[i].center.y;
        spheres[i][2] = (float)group->spheres[i].center.z;
        spheres[i][3] = (float)group->spheres[i].radius;
    }
    attach(to, embree, geometry, TURNER_KIND_SPHERE << TURNER_KIND_SHIFT);
}

static void add_mesh(struct group_of_embree *to, struct turner_embree *embree,
                     const struct turner_mesh *mesh, uint32_t first)
{
    RTCGeometry geometry = embree->rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float(*positions)[3] = embree->rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof *positions,
        mesh->vertex_count);
    void *triangles = embree->rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof *mesh->triangles,
        mesh->triangle_count);
    for (size_t i = 0; positions && i < mesh->vertex_count; i++) {
        positions[i][0] = (float)mesh->positions[i].x;
        positions[i][1] = (float)mesh->positions[i].y;
        positions[i][2] = (float)mesh->positions[i].z;
    }
    if (triangles)
        memcpy(triangles, mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    attach(to, embree, geometry, TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT | first);
}

static void fill_group(struct group_of_embree *to, struct turner_embree *embree,
                       const struct turner_group *group, size_t instances, bool robust)
{
    to->ids = turner_calloc(1 + group->mesh_count + instances, sizeof *to->ids);
    to->scene = embree->rtcNewScene(embree->device);
    embree->rtcSetSceneBuildQuality(to->scene, RTC_BUILD_QUALITY_MEDIUM);
    embree->rtcSetSceneFlags(to->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    if (group->sphere_count)
        add_spheres(to, embree, group);
    uint32_t first = 0;
    for (size_t i = 0; i < group->mesh_count; i++) {
        add_mesh(to, embree, &group->meshes[i], first);
        first += group->meshes[i].triangle_count;
    }
}

static void add_instances(struct turner_embree_scene *to, const struct turner_scene *scene)
{
    struct turner_embree *embree = to->embree;
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_instance *instance = &scene->instances[i];
        RTCGeometry geometry = embree->rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_INSTANCE);
        float rows[12];
        for (int j = 0; j < 12; j++)
            rows[j] = (float)instance->transform.m[j / 4][j % 4];
        embree->rtcSetGeometryInstancedScene(geometry, to->groups[instance->group].scene);
        embree->rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
        embree->rtcCommitGeometry(geometry);
        embree->rtcAttachGeometryByID(to->groups[0].scene, geometry,
                                      to->groups[0].count + (uint32_t)i);
        embree->rtcReleaseGeometry(geometry);
        to->instance_groups[i] = instance->group;
    }
}

enum turner_result turner_embree_scene_create(struct turner_embree_scene **out,
                                              struct turner_embree *embree,
                                              const struct turner_scene *scene, bool robust,
                                              double *seconds)
{
    struct turner_embree_scene *to = *out = turner_calloc(1, sizeof *to);
    to->embree = embree;
    to->group_count = scene->group_count;
    to->groups = turner_calloc(scene->group_count, sizeof *to->groups);
    to->instance_groups = turner_calloc(scene->instance_count + 1, sizeof *to->instance_groups);
    for (size_t i = 0; i < scene->group_count; i++)
        fill_group(&to->groups[i], embree, &scene->groups[i], i ? 0 : scene->instance_count,
                   robust);
    double start = turner_seconds();
    for (size_t i = scene->group_count; i-- > 1;)
        embree->rtcCommitScene(to->groups[i].scene);
    add_instances(to, scene);
    embree->rtcCommitScene(to->groups[0].scene);
    *seconds = turner_seconds() - start;
    int error = (int)embree->rtcGetDeviceError(embree->device);
    if (error == RTC_ERROR_NONE)
        return TURNER_OK;
    turner_embree_scene_destroy(to);
    *out = NULL;
    return turner_fail(TURNER_DEVICE, "%s cannot build the scene (error %d); leave it out with "
                                      "--tracers bvh,ray_query", embree->name, error);
}

void turner_embree_scene_destroy(struct turner_embree_scene *scene)
{
    if (!scene)
        return;
    for (size_t i = 0; i < scene->group_count; i++) {
        scene->embree->rtcReleaseScene(scene->groups[i].scene);
        free(scene->groups[i].ids);
    }
    free(scene->groups);
    free(scene->instance_groups);
    free(scene);
}

/* ---- rays ---- */

#define CHUNK 1024 /* rays a thread takes at once; a multiple of 8 */

struct job {
    const struct turner_embree_scene *scene;
    const struct turner_gpu_ray *rays;
    struct turner_gpu_hit *hits;
    size_t count;
    int passes, width;
    bool any, coherent;
    atomic_size_t next; /* chunk of all passes together */
};

#if TURNER_EMBREE == 4
typedef struct RTCIntersectArguments how_t;
typedef struct RTCOccludedArguments how_any_t;
#define FLAG_COHERENT RTC_RAY_QUERY_FLAG_COHERENT
#else
typedef struct RTCIntersectContext how_t;
typedef struct RTCIntersectContext how_any_t;
#define FLAG_COHERENT RTC_INTERSECT_CONTEXT_FLAG_COHERENT
#define rtcInitIntersectArguments rtcInitIntersectContext
#define rtcInitOccludedArguments rtcInitIntersectContext
#define rtcIntersect1(scene, ray, how) rtcIntersect1(scene, how, ray)
#define rtcOccluded1(scene, ray, how) rtcOccluded1(scene, how, ray)
#define rtcIntersect8(valid, scene, ray, how) rtcIntersect8(valid, scene, how, ray)
#define rtcOccluded8(valid, scene, ray, how) rtcOccluded8(valid, scene, how, ray)
#endif

static struct turner_gpu_hit hit_of(const struct turner_embree_scene *scene, float t,
                                    uint32_t geometry, uint32_t primitive, uint32_t instance)
{
    if (geometry == RTC_INVALID_GEOMETRY_ID)
        return (struct turner_gpu_hit){.t = INFINITY};
    uint32_t group = 0, place = 0;
    if (instance != RTC_INVALID_GEOMETRY_ID) {
        place = instance - scene->groups[0].count + 1;
        group = scene->instance_groups[place - 1];
    }
    return (struct turner_gpu_hit){t, scene->groups[group].ids[geometry] + primitive, place};
}

static struct RTCRay ray_of(const struct turner_gpu_ray *ray)
{
    return (struct RTCRay){
        .org_x = ray->origin[0], .org_y = ray->origin[1], .org_z = ray->origin[2],
        .dir_x = ray->direction[0], .dir_y = ray->direction[1], .dir_z = ray->direction[2],
        .tfar = ray->t_max, .mask = UINT32_MAX,
    };
}

static void trace_singly(const struct job *job, size_t first, size_t end)
{
    const struct turner_embree *embree = job->scene->embree;
    RTCScene top = job->scene->groups[0].scene;
    how_t how;
    how_any_t how_any;
    rtcInitIntersectArguments(&how);
    rtcInitOccludedArguments(&how_any);
    for (size_t i = first; i < end && job->any; i++) {
        struct RTCRay ray = ray_of(&job->rays[i]);
        embree->rtcOccluded1(top, &ray, &how_any);
        job->hits[i] = (struct turner_gpu_hit){.t = ray.tfar < 0 ? 0 : INFINITY};
    }
    for (size_t i = first; i < end && !job->any; i++) {
        struct RTCRayHit r;
        r.ray = ray_of(&job->rays[i]);
        r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        embree->rtcIntersect1(top, &r, &how);
        job->hits[i] = hit_of(job->scene, r.ray.tfar, r.hit.geomID, r.hit.primID,
                              r.hit.instID[0]);
    }
}

static void set_lane(struct RTCRay8 *packet, int lane, const struct turner_gpu_ray *ray)
{
    packet->org_x[lane] = ray->origin[0];
    packet->org_y[lane] = ray->origin[1];
    packet->org_z[lane] = ray->origin[2];
    packet->dir_x[lane] = ray->direction[0];
    packet->dir_y[lane] = ray->direction[1];
    packet->dir_z[lane] = ray->direction[2];
    packet->tnear[lane] = packet->time[lane] = 0;
    packet->tfar[lane] = ray->t_max;
    packet->mask[lane] = UINT32_MAX;
    packet->id[lane] = packet->flags[lane] = 0;
}

static void trace_packets(const struct job *job, size_t first, size_t end)
{
    const struct turner_embree *embree = job->scene->embree;
    RTCScene top = job->scene->groups[0].scene;
    how_t how;
    how_any_t how_any;
    rtcInitIntersectArguments(&how);
    rtcInitOccludedArguments(&how_any);
    if (job->coherent) {
        how.flags = FLAG_COHERENT;
        how_any.flags = FLAG_COHERENT;
    }
    for (size_t i = first; i < end; i += 8) {
        struct RTCRayHit8 r;
        _Alignas(32) int valid[8];
        size_t lanes = end - i < 8 ? end - i : 8;
        for (size_t lane = 0; lane < 8; lane++) {
            valid[lane] = lane < lanes ? -1 : 0;
            set_lane(&r.ray, (int)lane, &job->rays[lane < lanes ? i + lane : i]);
            r.hit.geomID[lane] = r.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        if (job->any)
            embree->rtcOccluded8(valid, top, &r.ray, &how_any);
        else
            embree->rtcIntersect8(valid, top, &r, &how);
        for (size_t lane = 0; lane < lanes; lane++)
            job->hits[i + lane] =
                job->any ? (struct turner_gpu_hit){.t = r.ray.tfar[lane] < 0 ? 0 : INFINITY}
                         : hit_of(job->scene, r.ray.tfar[lane], r.hit.geomID[lane],
                                  r.hit.primID[lane], r.hit.instID[0][lane]);
    }
}

static void *work(void *argument)
{
    struct job *job = argument;
    size_t chunks = (job->count + CHUNK - 1) / CHUNK;
#ifdef __SSE__
    _mm_setcsr(_mm_getcsr() | 0x8040); /* no denormals, as Embree's manual advises */
#endif
    for (;;) {
        size_t chunk = atomic_fetch_add(&job->next, 1);
        if (chunk >= chunks * (size_t)job->passes)
            return NULL;
        size_t first = chunk % chunks * CHUNK;
        size_t end = first + CHUNK < job->count ? first + CHUNK : job->count;
        (job->width == 8 ? trace_packets : trace_singly)(job, first, end);
    }
}

enum turner_result turner_embree_trace(double *seconds, struct turner_gpu_hit *hits,
                                       const struct turner_embree_scene *scene,
                                       const struct turner_gpu_ray *rays, size_t count, int passes,
                                       int width, bool coherent)
{
    struct job job = {.scene = scene, .rays = rays, .hits = hits, .count = count,
                      .passes = passes, .width = width, .coherent = coherent,
                      .any = count > 0 && rays[0].kind == TURNER_RAY_ANY};
    int threads = scene->embree->threads, started = 0;
    pthread_t *ids = turner_calloc((size_t)threads, sizeof *ids);
    double start = turner_seconds();
    while (started < threads && pthread_create(&ids[started], NULL, work, &job) == 0)
        started++;
    for (int i = 0; i < started; i++)
        pthread_join(ids[i], NULL);
    *seconds = turner_seconds() - start;
    free(ids);
    if (started < threads)
        return turner_fail(TURNER_DEVICE, "the system gives no more than %d threads of %d", started,
                           threads);
    return TURNER_OK;
}

#else /* built without Embree's headers */

struct turner_embree *turner_embree_open(int threads, const char **why)
{
    (void)threads;
    *why = "turner was built without Embree's headers (Debian: libembree-dev)";
    return NULL;
}

void turner_embree_close(struct turner_embree *embree)
{
    (void)embree;
}

const char *turner_embree_name(const struct turner_embree *embree)
{
    (void)embree;
    return "";
}

uint64_t turner_embree_bytes(const struct turner_embree *embree)
{
    (void)embree;
    return 0;
}

bool turner_embree_can(const struct turner_scene *scene)
{
    (void)scene;
    return false;
}

enum turner_result turner_embree_scene_create(struct turner_embree_scene **out,
                                              struct turner_embree *embree,
                                              const struct turner_scene *scene, bool robust,
                                              double *seconds)
{
    (void)embree, (void)scene, (void)robust;
    *out = NULL;
    *seconds = 0;
    return turner_fail(TURNER_DEVICE, "built without Embree");
}

void turner_embree_scene_destroy(struct turner_embree_scene *scene)
{
    (void)scene;
}

enum turner_result turner_embree_trace(double *seconds, struct turner_gpu_hit *hits,
                                       const struct turner_embree_scene *scene,
                                       const struct turner_gpu_ray *rays, size_t count, int passes,
                                       int width, bool coherent)
{
    (void)hits, (void)scene, (void)rays, (void)count, (void)passes, (void)width, (void)coherent;
    *seconds = 0;
    return turner_fail(TURNER_DEVICE, "built without Embree");
}

#endif

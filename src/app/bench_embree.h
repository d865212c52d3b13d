/* Embree, to measure against: the same rays on the same primitives. Loaded when it is asked for, so
 * that the program does not depend on it; built in where its headers were found. */
#ifndef TURNER_APP_BENCH_EMBREE_H
#define TURNER_APP_BENCH_EMBREE_H

#include "base/result.h"
#include "scene/scene.h"

#include "../shaders/shared.h"

struct turner_embree;       /* the library and its device */
struct turner_embree_scene; /* one scene in it */

/* NULL when there is none; then *why says it in a few words. `threads` are for building and for
 * tracing. */
struct turner_embree *turner_embree_open(int threads, const char **why);
void turner_embree_close(struct turner_embree *embree);

/* "Embree 3.13.5" */
const char *turner_embree_name(const struct turner_embree *embree);

/* Whether Embree has all kinds of primitives of the scene: it knows no cones and planes. */
bool turner_embree_can(const struct turner_scene *scene);

/* Builds a scene that turner_embree_can, in medium quality; *seconds is what the builders took.
 * `robust` asks for watertight tests. TURNER_DEVICE with Embree's error. */
enum turner_result turner_embree_scene_create(struct turner_embree_scene **out,
                                              struct turner_embree *embree,
                                              const struct turner_scene *scene, bool robust,
                                              double *seconds);
void turner_embree_scene_destroy(struct turner_embree_scene *scene);

/* Bytes that all scenes of the device take now, by Embree's count. */
uint64_t turner_embree_bytes(const struct turner_embree *embree);

/* Traces all rays `passes` times on all threads, one by one or in packets of 8 (`width`); nearest
 * hits by rtcIntersect, rays of kind TURNER_RAY_ANY by rtcOccluded (all rays are of one kind).
 * `coherent` tells packets that the rays of each go the same way. hits[count] are as turner's;
 * those of TURNER_RAY_ANY have a t that is finite when something was met, and no id. */
enum turner_result turner_embree_trace(double *seconds, struct turner_gpu_hit *hits,
                                       const struct turner_embree_scene *scene,
                                       const struct turner_gpu_ray *rays, size_t count, int passes,
                                       int width, bool coherent);

#endif

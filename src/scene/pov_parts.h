/* The parts of turner_pov_write. Each prints into `out` or refuses what POV-Ray cannot say
 * (TURNER_BAD_INPUT). */
#ifndef TURNER_SCENE_POV_PARTS_H
#define TURNER_SCENE_POV_PARTS_H

#include <stdio.h>

#include "scene/scene.h"

/* "<x, y, z>" with all digits of a double. */
void turner_pov_vector(FILE *out, struct turner_vec3 v);
bool turner_pov_zero(struct turner_vec3 v);

/* "material "glass"" or "material 3", for messages; valid until the next call on the thread. */
const char *turner_pov_material_name(const struct turner_scene *scene, uint32_t material);

/* Whether the formulas of every material that is used are among POV-Ray's. */
enum turner_result turner_pov_check_materials(const struct turner_scene *scene);

/* The same of its reflected and transmitted light alone, at a surface of that relative index. */
enum turner_result turner_pov_check_secondary(const struct turner_scene *scene, uint32_t material,
                                              double index);

/* Whether patterns are on planes and meshes only. */
enum turner_result turner_pov_check_patterns(const struct turner_scene *scene);

/* Spheres of the world filled with air (index 1, no absorption, of higher priority) in a
 * transmissive sphere or mesh of the world: the only solids in another one that POV-Ray can be told
 * of. */
struct turner_pov_hole {
    const struct turner_sphere *sphere;
    const void *container; /* a struct turner_sphere or turner_mesh */
};
struct turner_pov_holes {
    struct turner_pov_hole *list; /* free */
    size_t count, capacity;
};

/* Whether each transmissive thing is a closed solid of its own, clear of the others but for holes,
 * which it finds, and the camera where it says it is: POV-Ray finds its way in and out of media by
 * that alone. */
enum turner_result turner_pov_check_solids(struct turner_pov_holes *holes,
                                           const struct turner_scene *scene);

/* texture { … } (as many as there are layers) for a surface of `material`. A checker is printed in
 * u, v, 0 (`uv_mapping` on the object) or, with a plane, in its tangent and normal. */
void turner_pov_texture(FILE *out, const struct turner_scene *scene, uint32_t material,
                        const struct turner_plane *plane);

/* Textures by name (M0, M1 …) for all materials without pattern, and interiors (I0, I1 …) for all
 * that transmit. */
void turner_pov_declare_materials(FILE *out, const struct turner_scene *scene);

/* Everything that has a surface. */
void turner_pov_objects(FILE *out, const struct turner_scene *scene,
                        const struct turner_pov_holes *holes);

/* Which materials are on something that is drawn, one flag each (free). */
bool *turner_pov_materials_used(const struct turner_scene *scene);

#endif

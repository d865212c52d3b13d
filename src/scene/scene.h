/* The data model: what a scene is, whatever file it came from. docs/model.md gives the formulas,
 * docs/scenes.md the JSON that fills it.
 *
 * Numbers are kept in double as their author wrote them. Colours are linear RGB in turner_vec3
 * (x = red). Angles are radians here (degrees in files). Every reader ends with
 * turner_scene_validate, so the renderers may rely on all that is stated here. */
#ifndef TURNER_SCENE_SCENE_H
#define TURNER_SCENE_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "base/result.h"
#include "base/vec.h"
#include "turner.h"

/* Limits; a file that goes beyond is refused with the figure. */
#define TURNER_MAX_FILE_BYTES (1u << 30)
#define TURNER_MAX_PRIMITIVES (1u << 28)  /* spheres + cones + triangles after loading */
#define TURNER_MAX_INSTANCES ((1u << 24) - 1)
#define TURNER_MAX_MATERIALS (1u << 20)
#define TURNER_MAX_MEDIA 255
#define TURNER_MAX_PLANES 64
#define TURNER_MAX_LIGHTS 4096
#define TURNER_MAX_CAMERAS 64
#define TURNER_MAX_DEPTH 1024
#define TURNER_MAX_BRANCH_DEPTH 64 /* where a material both reflects and transmits */
#define TURNER_MAX_SPP 65536
#define TURNER_MAX_SIZE 65536 /* picture width and height */
#define TURNER_MEDIA_NESTING 8 /* media a ray may be inside of at once */
#define TURNER_NONE UINT32_MAX

enum turner_shading { TURNER_SHADING_PHONG, TURNER_SHADING_ENERGY_CONSERVING };
enum turner_shadows { TURNER_SHADOWS_OPAQUE, TURNER_SHADOWS_TINTED };
enum turner_transfer { TURNER_TRANSFER_SRGB, TURNER_TRANSFER_LINEAR };
enum turner_fresnel { TURNER_FRESNEL_NONE, TURNER_FRESNEL_SCHLICK, TURNER_FRESNEL_EXACT };

/* Ways to compute the same thing; 0 is the default of each, the one that holds everywhere.
 * src/scene/methods.c says what each is and where it comes from. */
enum turner_sphere_method { TURNER_SPHERE_ROBUST, TURNER_SPHERE_TEXTBOOK, TURNER_SPHERE_DOUBLE };
enum turner_triangle_method { TURNER_TRIANGLE_WATERTIGHT, TURNER_TRIANGLE_MOLLER_TRUMBORE };
enum turner_offset_method {
    TURNER_OFFSET_ERROR_BOUND,
    TURNER_OFFSET_NONE,
    TURNER_OFFSET_TMIN,
    TURNER_OFFSET_ULP
};
enum turner_cosine_method { TURNER_COSINE_STABLE, TURNER_COSINE_NAIVE };
enum turner_schlick_side { TURNER_SCHLICK_TRANSMITTED, TURNER_SCHLICK_INCIDENT };
enum turner_precision { TURNER_PRECISION_F32, TURNER_PRECISION_F64 };
/* In place of what transmissive materials say. The reference honours it, and none of the others. */
enum turner_fresnel_override {
    TURNER_OVERRIDE_MATERIAL,
    TURNER_OVERRIDE_NONE,
    TURNER_OVERRIDE_SCHLICK,
    TURNER_OVERRIDE_EXACT
};

struct turner_methods {
    enum turner_sphere_method sphere;
    enum turner_triangle_method triangle;
    enum turner_offset_method offset;
    double tmin; /* > 0, with TURNER_OFFSET_TMIN: metres from where secondary rays start */
    enum turner_cosine_method fresnel_cosine;
    enum turner_fresnel_override fresnel;
    enum turner_schlick_side schlick_side;
    enum turner_precision precision;
    enum turner_traversal traversal;
};

struct turner_settings {
    int width, height;     /* 1 … TURNER_MAX_SIZE; default 640×480 */
    int depth;             /* max_depth, 0 … TURNER_MAX_DEPTH; default 8 */
    bool depth_asked;      /* somebody said so: it is no default */
    double cutoff;         /* ≥ 0; default 1/512; 0 switches it off */
    int spp;               /* samples per pixel, ≥ 1; default 1; pattern in docs/model.md */
    double aa_threshold;   /* > 0: adaptive, a pixel gets up to spp samples where its corners and
                              centre differ by more in a channel; 0: each gets spp */
    double error;          /* > 0: depth, cutoff and samples are chosen so that pixels are estimated
                              to be off by no more, in a channel; spp is then the most samples */
    struct turner_methods methods;
    enum turner_shading shading;   /* default energy_conserving */
    enum turner_shadows shadows;   /* default tinted */
    double exposure;       /* stops, for 8/16-bit output; default 0 */
    enum turner_transfer transfer; /* for 8/16-bit output; default srgb */
    bool spd_rays;         /* a hit with k_t > 0 sends a reflection ray even of weight 0 */
    bool spd_grid;         /* samples spaced 2·tan(vfov/2)/(height−2) instead of …/height */
};

struct turner_camera {
    struct turner_vec3 from, at, up; /* from ≠ at, up not parallel to at − from */
    double vfov;                     /* full vertical angle, 0 < vfov < π */
    uint32_t inside[TURNER_MEDIA_NESTING]; /* media the eye is in, indices into media */
    uint32_t inside_count;
};

/* Sorted by (priority, order of declaration): the highest index that a ray is inside of is the
 * medium it travels in. */
struct turner_medium {
    char *name;                    /* may be NULL (made for one material) */
    double index;                  /* refractive index > 0 */
    struct turner_vec3 absorption; /* σ_a ≥ 0, 1/m */
    int priority;
};

/* A picture as texture: linear RGB floats, row 0 at the top. */
struct turner_texture_image {
    char *path;
    int width, height;
    float *rgb;
};

enum turner_pattern { TURNER_PATTERN_NONE, TURNER_PATTERN_CHECKER, TURNER_PATTERN_IMAGE };

struct turner_material {
    char *name; /* may be NULL */
    struct turner_vec3 k_e, k_a, k_d, k_s, k_r, k_t; /* all ≥ 0 */
    double exponent;                     /* Phong n ≥ 0 */
    enum turner_fresnel fresnel;
    bool conductor;                      /* complex index eta + i·k, fresnel EXACT, k_t = 0 */
    struct turner_vec3 eta, k;
    uint32_t medium;                     /* what is behind the surface; TURNER_NONE iff k_t = 0 */
    /* The pattern's colour multiplies k_d and k_a. */
    enum turner_pattern pattern;
    double uv_scale[2];                  /* multiplies (u, v) first */
    struct turner_vec3 checker[2];       /* colour where floor(u) + floor(v) is even, odd */
    uint32_t image;                      /* index into texture_images */
};

/* Primitives live in a group, in the group's own coordinates. `material` is an index. */
struct turner_sphere {
    struct turner_vec3 center;
    double radius; /* > 0 */
    uint32_t material;
};

/* Cylinder, cone or truncated cone; open (two-sided sheet) or with flat caps. */
struct turner_cone {
    struct turner_vec3 base, apex; /* centres of the two ends, base ≠ apex */
    double base_radius, apex_radius; /* ≥ 0, not both 0 */
    bool capped;
    uint32_t material;
};

/* Infinite; the interior is the half space on the side opposite to the normal. */
struct turner_plane {
    struct turner_vec3 point, normal; /* normal unit */
    struct turner_vec3 tangent;       /* unit, perpendicular to normal; u = (p − point)·tangent,
                                         v = (p − point)·(normal × tangent), in metres */
    uint32_t material;
};

/* An indexed triangle mesh, counter-clockwise from outside. */
struct turner_mesh {
    struct turner_vec3 *positions; /* vertex_count */
    float (*normals)[3];           /* vertex_count unit vectors, or NULL: flat */
    float (*uvs)[2];               /* vertex_count, or NULL: (u, v) = barycentric (b1, b2) */
    uint32_t (*triangles)[3];      /* triangle_count */
    uint32_t vertex_count, triangle_count;
    uint32_t material;
};

struct turner_group {
    char *name; /* NULL for group 0 */
    struct turner_sphere *spheres;
    struct turner_cone *cones;
    struct turner_mesh *meshes; /* owned; two groups never share */
    size_t sphere_count, cone_count, mesh_count;
    size_t sphere_capacity, cone_capacity, mesh_capacity;
};

struct turner_instance {
    uint32_t group;    /* never 0 */
    uint32_t material; /* TURNER_NONE, or replaces every material of the group */
    struct turner_affine transform; /* group to world, invertible */
};

enum turner_light_kind { TURNER_LIGHT_DIRECTIONAL, TURNER_LIGHT_POINT, TURNER_LIGHT_SPOT };
enum turner_falloff { TURNER_FALLOFF_INVERSE_SQUARE, TURNER_FALLOFF_NONE };

struct turner_light {
    enum turner_light_kind kind;
    struct turner_vec3 position;  /* point, spot */
    struct turner_vec3 direction; /* unit, the way the light travels; directional, spot */
    struct turner_vec3 power;     /* directional: irradiance; point, spot: radiant intensity J
                                     (readers turn flux into J) */
    enum turner_falloff falloff;  /* point, spot */
    double cos_inner, cos_outer;  /* spot: full inside inner, none outside outer; inner ≥ outer */
};

enum turner_background_kind {
    TURNER_BACKGROUND_CONSTANT,
    TURNER_BACKGROUND_GRADIENT,
    TURNER_BACKGROUND_ENVIRONMENT
};

struct turner_background {
    enum turner_background_kind kind;
    struct turner_vec3 color;       /* constant; gradient: straight down (−up) */
    struct turner_vec3 top;         /* gradient: straight up */
    struct turner_vec3 up;          /* gradient: unit; default +y */
    struct turner_vec3 scale;       /* environment: multiplies the picture */
    double rotation;                /* environment: about +y, radians */
    uint32_t image;                 /* environment: index into texture_images */
};

/* What the scene says of a parameter of its shaders (docs/shaders.md). */
struct turner_scene_param {
    char *name, *value;
};

struct turner_scene {
    char *path, *description; /* either may be NULL */
    char *shaders; /* folder of the scene's own, as it is to be opened; NULL: none is said */
    struct turner_settings settings;
    struct turner_camera camera;   /* that draws */
    struct turner_camera *cameras; /* others to choose from; NULL without */
    struct turner_vec3 ambient; /* I_a */
    struct turner_background background;
    struct turner_medium *media;
    struct turner_material *materials;
    struct turner_texture_image *texture_images;
    struct turner_plane *planes; /* world only */
    struct turner_group *groups; /* groups[0] always exists: the world's own primitives */
    struct turner_instance *instances; /* of the other groups; an instance of groups[0] with the
                                          identity is implied and not listed */
    struct turner_light *lights;
    struct turner_scene_param *params;
    uint64_t shader_hash; /* of shaders that are not turner's own; 0: there are none, or nobody has
                             looked (render/params.h) */
    size_t media_count, material_count, texture_image_count, plane_count, group_count,
        instance_count, light_count, param_count, camera_count;
    size_t media_capacity, material_capacity, texture_image_capacity, plane_capacity,
        group_capacity, instance_capacity, light_capacity, param_capacity;
};

/* An empty scene with default settings, a camera at (0,0,5) looking at the origin, and group 0. */
struct turner_scene *turner_scene_create(void);

/* Gives a parameter of the shaders a value, in place of one it may have; which there are, and what
 * they take, only the shaders say. */
void turner_scene_set_param(struct turner_scene *scene, const char *name, const char *value);
/* A copy of one that shares its parameters with another scene has its own from here on; free them
 * with turner_scene_free_params. */
void turner_scene_own_params(struct turner_scene *scene);
void turner_scene_free_params(struct turner_scene *scene);
/* "name=value" in one; TURNER_USAGE when it is not. */
enum turner_result turner_scene_assign_param(struct turner_scene *scene, const char *assignment);

/* Draws with camera `number` of the file: 0 is its "camera", 1 the first of its "cameras". Only once.
 * TURNER_USAGE when there is none. */
enum turner_result turner_scene_use_camera(struct turner_scene *scene, int number);

/* Checks every statement above, finiteness of every number and every limit. The message names the
 * thing ("sphere 3 of group \"tree\": …") for formats that have no better place to point at. */
enum turner_result turner_scene_validate(const struct turner_scene *scene);

/* What `material` does at a boundary, with the override of the settings. */
enum turner_fresnel turner_material_fresnel(const struct turner_settings *settings,
                                            const struct turner_material *material);

/* Triangles, spheres and cones of one group. */
size_t turner_group_primitive_count(const struct turner_group *group);

/* Appends a box with corners lo and hi as a mesh of 12 flat triangles (each face has uv 0…1). */
void turner_group_add_box(struct turner_group *group, struct turner_vec3 lo, struct turner_vec3 hi,
                          uint32_t material);

/* Sorts media as stated above and mends every reference to them. Readers call it once. */
void turner_scene_sort_media(struct turner_scene *scene);

/* Sample `index` of `count` of a pixel, in [0,1)²; one sample lies in the centre. The pattern is
 * Hammersley's: x = (i + ½)/count, y = van der Corput base 2 of i plus half its last step. */
void turner_sample_position(double *x, double *y, int index, int count);

#endif

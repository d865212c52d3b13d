/* The rays that made one sample of a pixel, whoever traced them: the reference tracer and the
 * devices fill the same tree, so that one can be laid beside the other.
 *
 * Numbers are those that the tracer had, widened. Colours are linear RGB. Points, directions and
 * normals are in world space. */
#ifndef TURNER_SCENE_RAY_TREE_H
#define TURNER_SCENE_RAY_TREE_H

#include "scene/scene.h"

/* What is beyond is counted as missing, not kept. */
#define TURNER_RAY_TREE_MAX 65536

enum turner_ray_kind {
    TURNER_RAY_CAMERA,
    TURNER_RAY_SHADOW,
    TURNER_RAY_REFLECTED,
    TURNER_RAY_REFRACTED
};

enum turner_ray_end {
    TURNER_RAY_BACKGROUND,   /* left the scene */
    TURNER_RAY_SURFACE,      /* met a surface, which was shaded */
    TURNER_RAY_CUT,          /* not traced: too deep or of too little weight */
    TURNER_RAY_LIGHT,        /* shadow ray that reached its light */
    TURNER_RAY_BLOCKED,      /* shadow ray that met something opaque */
    TURNER_RAY_GIVEN_UP,     /* shadow ray that had nothing left to bring after `place` */
    TURNER_RAY_FACES_AWAY,   /* no shadow ray: the light is behind the surface */
    TURNER_RAY_OUT_OF_REACH, /* no shadow ray: the light sends nothing there */
    TURNER_RAY_UNFINISHED    /* ran into the bound of a loop */
};

enum turner_primitive_kind {
    TURNER_PRIMITIVE_PLANE,
    TURNER_PRIMITIVE_SPHERE,
    TURNER_PRIMITIVE_CONE,
    TURNER_PRIMITIVE_TRIANGLE
};

/* A thing that a ray met. */
struct turner_ray_place {
    enum turner_primitive_kind kind;
    uint32_t index;    /* among its kind in the group (triangles: of all its meshes), planes in the
                          scene */
    uint32_t instance; /* 0: the world's own group; i: scene->instances[i − 1] */
    uint32_t material;
};

/* A surface that a ray went straight through: one that is none, or a transmissive one in the way of
 * a shadow ray. */
struct turner_ray_crossing {
    uint32_t ray;
    long double t; /* as in turner_ray_record */
    struct turner_ray_place place;
    bool real; /* counted with its k_t; false: the medium is the same on both sides */
};

/* A ray, or one that was not traced (see `end`). A quantity that the kind or the end does not
 * mention is 0. */
struct turner_ray_record {
    enum turner_ray_kind kind;
    enum turner_ray_end end;
    uint32_t parent; /* index of the ray whose hit sent this one; TURNER_NONE for the camera ray */
    uint32_t depth;  /* of a shadow ray: one more than its parent's */
    long double origin[3], direction[3];
    long double weight[3];  /* what its radiance counts in the pixel */
    long double through[3]; /* what absorption leaves of it on its way; of a shadow ray also what
                               the surfaces it crosses let through */
    uint32_t media[TURNER_MEDIA_NESTING]; /* it starts inside of, the one it travels in first */
    uint32_t media_count;
    long double t; /* length of its way from the surface it left (infinite: left the scene) */
    long double contribution[3]; /* to the pixel by itself; all of the tree add up to the pixel */

    /* SURFACE; `place` also of BLOCKED, where the device may have found any of several things, and
     * of GIVEN_UP */
    struct turner_ray_place place;
    long double point[3];
    long double ng[3], ns[3];  /* unit, on the viewer's side */
    long double cosine;        /* N·V */
    long double n1, n2;        /* refractive index on the viewer's side and beyond */
    long double radiance[3];   /* k_e + k_a·I_a there; BACKGROUND: the background's */
    bool secondary;            /* the material reflects or transmits: what follows is set */
    bool total;                /* total internal reflection */
    bool has_fresnel;          /* false: the weights are k_r and k_t as they stand */
    long double fresnel[3];    /* share reflected */

    /* SHADOW */
    uint32_t light;            /* index into scene->lights */
    long double n_l, r_v;      /* N·L and R·V */
    long double irradiance[3]; /* E, before what is in the way */
    long double diffuse[3], specular[3]; /* the two terms of f(V, L) */
};

/* Rays in depth-first order: at a hit first the lights in their order, then the reflected, then the
 * refracted ray. */
struct turner_ray_tree {
    struct turner_ray_record *rays;
    struct turner_ray_crossing *crossings; /* in the order of their rays */
    size_t count, capacity, crossing_count, crossing_capacity;
    bool truncated;             /* there were more than TURNER_RAY_TREE_MAX */
    long double radiance[3];    /* of the pixel's sample as the tracer added it up */
    long double pruned;         /* weights that were cut */
    int mantissa;               /* bits of the numbers that the tracer calculates with */
    uint32_t path[TURNER_MAX_DEPTH + 2]; /* while it grows: the last ray of each depth */
};

void turner_ray_tree_destroy(struct turner_ray_tree *tree);

/* Appends a zeroed ray below the last one of depth `depth` − 1. Returns its index, TURNER_NONE when
 * the tree is full. */
uint32_t turner_ray_tree_add(struct turner_ray_tree *tree, enum turner_ray_kind kind,
                             uint32_t depth);

/* Appends a crossing of the ray `ray`; of TURNER_NONE nothing. */
void turner_ray_tree_cross(struct turner_ray_tree *tree, uint32_t ray,
                           struct turner_ray_place place, long double t, bool real);

/* The ray after the last one below ray `index`. */
uint32_t turner_ray_tree_end(const struct turner_ray_tree *tree, uint32_t index);

/* Where among the crossings those of ray `index` start; *count says how many there are. */
const struct turner_ray_crossing *turner_ray_tree_crossings(const struct turner_ray_tree *tree,
                                                            uint32_t index, size_t *count);

/* Sum of the contributions of ray `index` and all below it. */
void turner_ray_tree_sum(long double sum[3], const struct turner_ray_tree *tree, uint32_t index);

/* The first quantity that is not finite, in the order in which a tracer comes by them: the ray's
 * index, and *quantity its name. Where all are finite and their sum is not, or is more than the
 * floats of a picture hold, it is the ray that carries it there, and "sum of the contributions so
 * far". TURNER_NONE when the pixel is finite. */
uint32_t turner_ray_tree_nonfinite(const struct turner_ray_tree *tree, const char **quantity);

#endif

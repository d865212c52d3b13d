/* Every struct, constant and binding that C and GLSL share, once. GLSL reads the structs through
 * buffer references in scalar layout, which is how C lays them out too: members are 4 bytes wide,
 * or 8 and first. */
#ifndef TURNER_SHADERS_SHARED_H
#define TURNER_SHADERS_SHARED_H

#ifdef GL_core_profile
#define TURNER_STRUCT(name) struct name
#define TURNER_VEC2(name) vec2 name
#define TURNER_VEC3(name) vec3 name
#define TURNER_UINT64 uint64_t
#define TURNER_FACE turner_gpu_face
#else /* C, after <stdint.h> */
#define TURNER_STRUCT(name) struct name
#define TURNER_VEC2(name) float name[2]
#define TURNER_VEC3(name) float name[3]
#define TURNER_UINT64 uint64_t
#define TURNER_FACE struct turner_gpu_face
#define uint uint32_t
#endif

/* ---- bindings and specialisation constants ---- */
#define TURNER_BINDING_TLAS 0       /* ray_query only */
#define TURNER_CONSTANT_NEEDS 0     /* TURNER_NEEDS_… of the scene */
#define TURNER_CONSTANT_STACK 1     /* pending rays kept at once: max_depth where rays branch */
#define TURNER_CONSTANT_BVH_STACK 2 /* nodes kept at once: from the built tree */
#define TURNER_CONSTANT_METHODS 3   /* TURNER_METHOD_… chosen; 0 is the default of each */
#define TURNER_CONSTANT_PIXEL_COUNTS 4 /* 1: rays are counted for each pixel, too */
#define TURNER_CONSTANT_SOON 5 /* 1: what only makes large pictures quicker is left out */
#define TURNER_CONSTANT_PARAMS 64 /* const parameters (//!PARAM) from here on */
#define TURNER_WORKGROUP 8          /* a workgroup is 8×8 pixels in Morton order */

/* ---- what a scene may need; what it does not is not in the kernel ---- */
#define TURNER_NEEDS_SPHERES (1u << 0)
#define TURNER_NEEDS_CONES (1u << 1)
#define TURNER_NEEDS_TRIANGLES (1u << 2)
#define TURNER_NEEDS_PLANES (1u << 3)
#define TURNER_NEEDS_INSTANCES (1u << 4)
#define TURNER_NEEDS_SMOOTH (1u << 5)       /* interpolated normals */
#define TURNER_NEEDS_CHECKER (1u << 6)
#define TURNER_NEEDS_IMAGES (1u << 7)       /* image textures on surfaces */
#define TURNER_NEEDS_DIRECTIONAL (1u << 8)
#define TURNER_NEEDS_POINT (1u << 9)        /* point or spot: a position */
#define TURNER_NEEDS_SPOT (1u << 10)
#define TURNER_NEEDS_PHONG (1u << 11)
#define TURNER_NEEDS_CONSERVING (1u << 12)
#define TURNER_NEEDS_SPECULAR (1u << 13)    /* a k_s that is not 0 */
#define TURNER_NEEDS_REFLECTION (1u << 14)
#define TURNER_NEEDS_TRANSMISSION (1u << 15)
#define TURNER_NEEDS_BRANCHING (1u << 16)   /* a hit may send two rays */
#define TURNER_NEEDS_SCHLICK (1u << 17)
#define TURNER_NEEDS_EXACT (1u << 18)
#define TURNER_NEEDS_CONDUCTOR (1u << 19)
#define TURNER_NEEDS_MEDIA (1u << 20)       /* rays carry what they are inside of */
#define TURNER_NEEDS_ABSORPTION (1u << 21)
#define TURNER_NEEDS_TINTED (1u << 22)      /* shadows through transmissive surfaces */
#define TURNER_NEEDS_GRADIENT (1u << 23)
#define TURNER_NEEDS_ENVIRONMENT (1u << 24)
#define TURNER_NEEDS_ALL ((1u << 25) - 1u)

/* ---- ways to compute, where not the default (src/scene/methods.c says what each is); f64 is a
 * matter of the kernel's source: TURNER_F64, TURNER_SPHERE_F64 ---- */
#define TURNER_METHOD_SPHERE_TEXTBOOK (1u << 0)
#define TURNER_METHOD_MOLLER_TRUMBORE (1u << 1)
#define TURNER_METHOD_OFFSET_NONE (1u << 2)
#define TURNER_METHOD_OFFSET_TMIN (1u << 3)
#define TURNER_METHOD_OFFSET_ULP (1u << 4)
#define TURNER_METHOD_COSINE_NAIVE (1u << 5)
#define TURNER_METHOD_SCHLICK_INCIDENT (1u << 6)

#define TURNER_NO_INDEX 0xffffffffu

/* ---- geometry ---- */
/* An id orders hits at equal t: the kind in the two top bits, then the place in the group. */
#define TURNER_KIND_SPHERE 0u
#define TURNER_KIND_CONE 1u
#define TURNER_KIND_TRIANGLE 2u
#define TURNER_KIND_PLANE 3u /* planes are in no group */
#define TURNER_KIND_SHIFT 30

/* In the material word of primitives, planes and instances. */
#define TURNER_MATERIAL_TRANSMISSIVE 0x80000000u /* shadow rays may pass, tinted */
#define TURNER_MATERIAL_MASK 0x7fffffffu

/* 48 bytes for any primitive, in its group's coordinates:
 * sphere: a centre, b.x radius; cone: a base, b apex, c.x base radius, c.y apex radius,
 * c.z 1 if capped; triangle: the corners. */
TURNER_STRUCT(turner_gpu_primitive)
{
    TURNER_VEC3(a);
    TURNER_VEC3(b);
    TURNER_VEC3(c);
    uint id;
    uint material;
    uint attributes; /* triangle: index into corners, and the two flags; or TURNER_NO_INDEX */
};

/* What rounding to floats took from a primitive, for kernels that compute in double. */
TURNER_STRUCT(turner_gpu_primitive_rest)
{
    TURNER_VEC3(a);
    TURNER_VEC3(b);
    TURNER_VEC3(c);
};

#define TURNER_ATTRIBUTES_NORMALS 0x80000000u
#define TURNER_ATTRIBUTES_UVS 0x40000000u
#define TURNER_ATTRIBUTES_MASK 0x3fffffffu

/* Vertex indices of a triangle that has normals or uvs, into the scene's normals and uvs. */
TURNER_STRUCT(turner_gpu_corners)
{
    uint vertex[3];
};

/* Two children a node, 64 bytes. count 0: child is a node; else the first of count primitives
 * (in the top level: of count instances). An empty child has child 0 and count 0. */
TURNER_STRUCT(turner_gpu_node)
{
    float lo0[3];
    float hi0[3];
    float lo1[3];
    float hi1[3];
    uint child[2];
    uint count[2];
};

/* Four children a node, 64 bytes, for packets (packet.glsl). The boxes lie on a grid of the node's
 * own, along each axis at origin + i·spacing for i from 0 to 255; the spacing is a power of two, so
 * that i·spacing is exact and the sum rounded once. face[2a] has the lower side of all boxes along
 * axis a, byte i of child i, and the grid's origin; face[2a + 1] the upper side and the spacing.
 * A child is 0 for none, the index of a node, or a leaf: TURNER_WIDE_LEAF, how many primitives less
 * one, and the first (in the top level: an instance). No child is node 0. */
#define TURNER_WIDE_LEAF 0x80000000u
#define TURNER_WIDE_COUNT_SHIFT 28
#define TURNER_WIDE_FIRST 0x0fffffffu

TURNER_STRUCT(turner_gpu_face)
{
    uint planes;
    float grid;
};

TURNER_STRUCT(turner_gpu_wide_node)
{
    TURNER_FACE face[6];
    uint child[4];
};

/* An instance of a group; instance 0 is the world's own group, with the identity. */
TURNER_STRUCT(turner_gpu_instance)
{
    float to_world[12]; /* 3 rows of 4 */
    float to_group[12];
    uint root;          /* bvh: the group's root node */
    uint triangles;     /* ray_query: the group's first triangle among the primitives */
    uint boxes;         /* ray_query: its first sphere or cone */
    uint material;      /* TURNER_NO_INDEX: the primitives' own */
    float spawn_scale;  /* group units: size of the numbers that world coordinates are made of */
    uint pad;
};

TURNER_STRUCT(turner_gpu_instance_rest)
{
    float to_world[12];
    float to_group[12];
};

/* x_rest: what rounding took from x, here and below. */
TURNER_STRUCT(turner_gpu_plane)
{
    TURNER_VEC3(point);
    TURNER_VEC3(normal);
    TURNER_VEC3(tangent);
    uint material;
    TURNER_VEC3(point_rest);
    TURNER_VEC3(normal_rest);
    TURNER_VEC3(tangent_rest);
    uint pad;
};

/* ---- appearance ---- */
#define TURNER_FRESNEL_KIND_NONE 0u
#define TURNER_FRESNEL_KIND_SCHLICK 1u
#define TURNER_FRESNEL_KIND_EXACT 2u
#define TURNER_FRESNEL_KIND_CONDUCTOR 3u
#define TURNER_PATTERN_KIND_NONE 0u
#define TURNER_PATTERN_KIND_CHECKER 1u
#define TURNER_PATTERN_KIND_IMAGE 2u

TURNER_STRUCT(turner_gpu_material)
{
    TURNER_VEC3(k_e);
    TURNER_VEC3(k_a);
    TURNER_VEC3(k_d);
    TURNER_VEC3(k_s);
    TURNER_VEC3(k_r);
    TURNER_VEC3(k_t);
    TURNER_VEC3(eta);
    TURNER_VEC3(k);
    TURNER_VEC3(checker0);
    TURNER_VEC3(checker1);
    TURNER_VEC2(uv_scale);
    float exponent;
    uint fresnel;
    uint medium;
    uint pattern;
    uint image;
    uint pad;
};

TURNER_STRUCT(turner_gpu_medium)
{
    TURNER_VEC3(absorption);
    float index;
    float index_rest;
};

TURNER_STRUCT(turner_gpu_image)
{
    TURNER_UINT64 texels; /* RGB floats, row 0 at the top */
    uint width;
    uint height;
};

#define TURNER_LIGHT_KIND_DIRECTIONAL 0u
#define TURNER_LIGHT_KIND_POINT 1u
#define TURNER_LIGHT_KIND_SPOT 2u

TURNER_STRUCT(turner_gpu_light)
{
    TURNER_VEC3(position);
    TURNER_VEC3(direction); /* the way the light travels */
    TURNER_VEC3(power);
    uint kind;
    uint inverse_square; /* 1 or 0 */
    float cos_inner;
    float cos_outer;
    uint pad;
    TURNER_VEC3(position_rest);
    TURNER_VEC3(direction_rest);
};

#define TURNER_BACKGROUND_KIND_CONSTANT 0u
#define TURNER_BACKGROUND_KIND_GRADIENT 1u
#define TURNER_BACKGROUND_KIND_ENVIRONMENT 2u

/* ---- the scene as the kernel sees it ---- */
TURNER_STRUCT(turner_gpu_scene)
{
    TURNER_UINT64 nodes;
    TURNER_UINT64 primitives;
    TURNER_UINT64 instances;
    TURNER_UINT64 planes;
    TURNER_UINT64 corners;
    TURNER_UINT64 normals;
    TURNER_UINT64 uvs;
    TURNER_UINT64 materials;
    TURNER_UINT64 media;
    TURNER_UINT64 images;
    TURNER_UINT64 lights;
    TURNER_UINT64 inside; /* media list of the eye (media.glsl) */
    TURNER_UINT64 primitive_rests; /* these two only for kernels that compute in double */
    TURNER_UINT64 instance_rests;
    uint root;          /* of the top level over instances; of the only group, where there is none */
    uint plane_count;
    uint light_count;
    uint max_depth;
    uint max_steps;     /* rays traced for one sample, at most */
    uint max_sent;      /* reflected and refracted rays are followed no more after so many rays of
                           a sample; what that cuts counts as pruned */
    uint max_visits;    /* nodes visited by one ray, at most */
    uint max_crossings; /* surfaces one shadow ray passes, at most */
    uint shading;       /* TURNER_NEEDS_PHONG or TURNER_NEEDS_CONSERVING */
    uint shadows_tinted;
    uint spd_rays;
    float cutoff;
    float tmin;         /* TURNER_METHOD_OFFSET_TMIN */
    TURNER_VEC3(ambient);
    TURNER_VEC3(eye);
    TURNER_VEC3(eye_rest);
    TURNER_VEC3(right);   /* one pixel to the right on the plane at distance 1 */
    TURNER_VEC3(right_rest);
    TURNER_VEC3(down);    /* one pixel down */
    TURNER_VEC3(down_rest);
    TURNER_VEC3(forward); /* unit, to the picture's centre */
    TURNER_VEC3(forward_rest);
    TURNER_VEC2(center);  /* of the picture, in pixels */
    uint background;
    TURNER_VEC3(background_color);
    TURNER_VEC3(background_top);
    TURNER_VEC3(background_up);
    TURNER_VEC3(background_scale);
    float background_turn; /* rotation / 2π */
    uint background_image;
};

/* ---- one dispatch ---- */
#define TURNER_COUNT_CAMERA 0
#define TURNER_COUNT_REFLECTED 1
#define TURNER_COUNT_REFRACTED 2
#define TURNER_COUNT_SHADOW 3
#define TURNER_COUNT_TIR 4         /* reflected rays that total internal reflection sent */
#define TURNER_COUNT_CAMERA_HITS 5
#define TURNER_COUNT_UNFINISHED 6  /* samples that ran into max_steps or max_crossings */
#define TURNER_COUNTS 7

TURNER_STRUCT(turner_gpu_counters)
{
    uint low[TURNER_COUNTS];
    uint high[TURNER_COUNTS];
    uint largest_depth;
    uint group; /* the next to be taken of turner_gpu_dispatch.groups */
};

/* The same of one pixel. */
TURNER_STRUCT(turner_gpu_pixel_counts)
{
    uint rays;      /* of all kinds and samples; stays at 2³² − 1 */
    uint recursion; /* largest depth */
};

/* Push constants. One sample of every pixel of a tile, or those of a list. */
TURNER_STRUCT(turner_gpu_dispatch)
{
    TURNER_UINT64 scene;
    TURNER_UINT64 pixels;    /* 4 floats a pixel of the tile or sample of the list: sums of
                                radiance and pruned */
    TURNER_UINT64 counters;
    TURNER_UINT64 hits;      /* rays.comp */
    TURNER_UINT64 pixel_counts; /* as many as `pixels`, with TURNER_CONSTANT_PIXEL_COUNTS */
    TURNER_UINT64 params;    /* values of the live parameters, where the kernel has any */
    TURNER_UINT64 positions; /* list: `count` places in the picture, in pixels; or 0: a tile.
                                deferred.comp: what is visible in the tile */
    uint tile_x;             /* the tile's place in the picture */
    uint tile_y;
    uint tile_width;
    uint tile_height;
    float sample_x;          /* of the pixel, in [0,1) */
    float sample_y;
    uint first;              /* 1: the sums start with this sample */
    uint count;
    uint max_depth;
    float cutoff;
    uint groups; /* of TURNER_WORKGROUP² samples or rays, to be taken one by one; 0: each workgroup
                    has its own */
};

/* What the ray through a pixel's centre meets, and the lights that are seen from there
 * (visibility.comp, deferred.comp). */
TURNER_STRUCT(turner_gpu_visible)
{
    TURNER_VEC3(point); /* world */
    TURNER_VEC3(ng);    /* unit, as surface_t has them */
    TURNER_VEC3(ns);
    TURNER_VEC2(uv);
    TURNER_VEC3(weight); /* of what its light arrives; 0: one looks straight on, into the same
                            medium. The background has one, too */
    uint material;       /* as primitives have it; TURNER_NO_INDEX: the background */
    uint lit; /* bit i: nothing opaque is between it and light i; those from TURNER_LIT_LIGHTS on are
                 not asked, and count as seen */
};
#define TURNER_LIT_LIGHTS 32

/* What the ray through a pixel's centre meets (features.comp). */
TURNER_STRUCT(turner_gpu_feature)
{
    TURNER_VEC3(normal);   /* unit, towards the eye; 0 for the background, as are the next two */
    float depth;           /* along the ray; infinite for the background */
    TURNER_VEC3(albedo);
    uint id;               /* as above, in its instance; TURNER_NO_INDEX for the background */
    TURNER_VEC3(position);
    uint instance;
};

/* ---- what a kernel with TURNER_RECORD notes down (record.glsl): a header and events, behind the
 * one pixel of the dispatch ---- */
#define TURNER_RECORDS_OFFSET 16 /* from turner_gpu_dispatch.pixels, */
#define TURNER_RECORDS_HEADER 8  /* and from there */

TURNER_STRUCT(turner_gpu_records)
{
    uint count; /* of events; those beyond the capacity are not kept */
    uint capacity;
};

#define TURNER_RECORD_RAY 1u        /* not a shadow ray; until its end come: */
#define TURNER_RECORD_CROSSING 2u   /* a surface it goes straight through */
#define TURNER_RECORD_BACKGROUND 3u /* its end, or */
#define TURNER_RECORD_SURFACE 4u    /* its end; then the lights, then the rays it sends */
#define TURNER_RECORD_LIGHT 5u      /* if ASKED, crossings and one of the next two: */
#define TURNER_RECORD_LIT 6u
#define TURNER_RECORD_BLOCKED 7u    /* or none: nothing was left after the last crossing */
#define TURNER_RECORD_UNFINISHED 8u

#define TURNER_RECORD_BOUNDARY 1u      /* CROSSING: media differ on both sides */
#define TURNER_RECORD_ASKED 2u         /* LIGHT */
#define TURNER_RECORD_TOTAL 4u         /* SURFACE: total internal reflection */
#define TURNER_RECORD_FRESNEL_KNOWN 8u /* SURFACE: FRESNEL is set */
#define TURNER_RECORD_REFLECTS 16u     /* SURFACE: the ray is followed */
#define TURNER_RECORD_REFRACTS 32u

/* Where in turner_gpu_record.value; those of three numbers go on for three. */
#define TURNER_RECORD_ORIGIN 0
#define TURNER_RECORD_DIRECTION 3
#define TURNER_RECORD_WEIGHT 6
#define TURNER_RECORD_T 9
#define TURNER_RECORD_THROUGH 10
#define TURNER_RECORD_RADIANCE 13
#define TURNER_RECORD_CONTRIBUTION 16
#define TURNER_RECORD_POINT 19 /* from here on SURFACE */
#define TURNER_RECORD_NG 22
#define TURNER_RECORD_NS 25
#define TURNER_RECORD_COSINE 28
#define TURNER_RECORD_N1 29
#define TURNER_RECORD_N2 30
#define TURNER_RECORD_FRESNEL 31
#define TURNER_RECORD_REFLECTED 34
#define TURNER_RECORD_REFLECTED_ORIGIN 37
#define TURNER_RECORD_W_R 40
#define TURNER_RECORD_REFRACTED 43
#define TURNER_RECORD_REFRACTED_ORIGIN 46
#define TURNER_RECORD_W_T 49
#define TURNER_RECORD_IRRADIANCE 19 /* from here on LIGHT */
#define TURNER_RECORD_DIFFUSE 22
#define TURNER_RECORD_SPECULAR 25
#define TURNER_RECORD_N_L 28
#define TURNER_RECORD_R_V 29
#define TURNER_RECORD_VALUES 52

TURNER_STRUCT(turner_gpu_record)
{
    TURNER_UINT64 value[TURNER_RECORD_VALUES]; /* bits of a double with TURNER_F64, of a float else */
    TURNER_UINT64 media; /* the ray starts inside of; SURFACE: what lies beyond (media.glsl) */
    uint what;
    uint flags;
    uint id;             /* of what was met, and its instance */
    uint instance;
    uint material;       /* SURFACE */
    uint light;          /* LIGHT */
};

/* A ray to measure and what became of it (probe.comp): the first of each pair is of the ray itself,
 * the second of the one in direction `leaving` that was sent on from what it met. */
TURNER_STRUCT(turner_gpu_probe)
{
    TURNER_VEC3(origin);
    TURNER_VEC3(direction);
    TURNER_VEC3(leaving); /* 0: no second ray */
    float t[2];           /* infinite: nothing met */
    float t_rest[2];      /* to be added to them: more digits, with doubles */
    uint id[2];
    uint instance[2];
    TURNER_VEC3(radiance);
    float pruned;
};

/* A ray of a list (rays.comp), and what it met. */
#define TURNER_RAY_NEAREST 0u
#define TURNER_RAY_ANY 1u  /* a shadow ray: whether it meets anything */
#define TURNER_RAY_NONE 2u /* there is no such ray */

TURNER_STRUCT(turner_gpu_ray)
{
    TURNER_VEC3(origin);
    float t_max;
    TURNER_VEC3(direction);
    uint kind;
};

TURNER_STRUCT(turner_gpu_hit)
{
    float t; /* infinite: nothing met */
    uint id;
    uint instance;
};

/* What rays.comp sends on with TURNER_RAYS_SEND: turner_gpu_dispatch.first. */
#define TURNER_SEND_CAMERA 0u /* one through the centre of each pixel, 8×8 blocks in rows */
#define TURNER_SEND_SHADOW 1u /* to the first light */
#define TURNER_SEND_MIRROR 2u
#define TURNER_SEND_RANDOM 3u /* as a matt surface scatters: by the cosine */

#ifndef GL_core_profile
#undef uint
#endif
#endif

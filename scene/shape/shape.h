/* shape.h: surfaces in world space: triangle meshes, spheres, cylinders, disks and curves.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6; orientation follows pbrt's:
 * a shape's outside is where its geometric normal points, ReverseOrientation turns it over.
 * Flow: the scene file makes shapes; rays_embree casts rays at them; lights sample points on them.
 * Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_SHAPE_H
#define AFTERGLOW_SHAPE_H

#include "afterglow/base.h"
#include "math/transform.h"
#include "shape/instance.h"
#include "surface.h"

#include <stdint.h>

#define SHAPE_NO_LIGHT UINT32_MAX

/* Rays start this far off a surface, relative to the largest coordinate at hand: some 128 units in the last place of a
 * float, a few times what the traversal's arithmetic loses. */
#define SHAPE_EPSILON_RELATIVE 0x1p-16f

typedef enum shape_kind { SHAPE_MESH, SHAPE_SPHERE, SHAPE_CYLINDER, SHAPE_DISK, SHAPE_CURVES } shape_kind;

/* Flags for arrays that belong to the caller who made the scene. */
enum { MESH_BORROWS_POSITIONS = 1, MESH_BORROWS_UVS = 2, MESH_BORROWS_INDICES = 4 };

/* World space. Arrays are owned by the shape, which is owned by the scene, unless they are borrowed or shared; nobody
 * writes to them once they are in a scene. Behind positions 4 more bytes can be read, so that Embree may read 16 at the
 * last one. */
typedef struct mesh {
    uint32_t vertex_count, triangle_count;
    /* Above 0 the vertices move: positions, normals and tangents hold this many more sets of vertex_count, for evenly
     * spaced times from the shutter's opening to its closing, straight in between (mesh_motion.h). */
    uint32_t motion_segments;
    vec3 *positions;
    vec3 *normals;          /* unit shading normals, or NULL */
    vec2 *uvs;              /* NULL: none */
    vec3 *tangents;         /* of any length, for the shading frame alone, or NULL: then uvs say which way they go */
    uint32_t *indices;      /* 3 per triangle, each < vertex_count */
    float *area_cdf;        /* of emissive meshes, else NULL: [triangle_count], running sum of areas over the total */
    uint32_t *holder_count; /* of shapes that share all arrays but area_cdf; NULL: they are this one's alone */
    unsigned borrowed;      /* of MESH_BORROWS_... */
    uint64_t borrowed_ends; /* see borrowed_arrays.h */
} mesh;

/* A sphere or cylinder around the z axis, of which the part from z_min to z_max exists; or a disk at z = height, from
 * inner to outer radius. Of each, only the part from the x axis as far round the z axis as `turn` says exists. Any
 * affine map may place it. */
typedef struct quadric {
    transform world_from_object;
    float radius;
    float inner_radius, height; /* disk only */
    float z_min, z_max;         /* sphere, within +-radius, and cylinder; z_min < z_max */
    float turn;                 /* phimax / 360 degrees, in (0, 1] */
    /* set by scene_commit */
    vec3 center;          /* world */
    float uniform_radius; /* world radius of a whole sphere that is still a sphere, else 0 */
    float epsilon;        /* as in surface_hit */
    float turn_sin, turn_cos;
    double theta_min, theta_max; /* sphere: the angles from the z axis at z_min and z_max, in turns */
    bool has_even_area;          /* object area and world area have one ratio everywhere */
} quadric;

typedef enum curves_type {
    CURVES_FLAT,     /* turned about its middle line to each ray; its outside is where the ray came from */
    CURVES_CYLINDER, /* a tube, open at its ends */
    CURVES_RIBBON    /* flat, and turned as its normals say */
} curves_type;

typedef struct curve_point {
    vec3 at;
    float radius; /* half the width */
} curve_point;

/* The number of straight pieces that Embree makes of a flat segment; the reader divides those that need more. */
enum { CURVES_FLAT_PIECES = 8 };

/* Cubic Bezier segments, many curves in one shape. World space; arrays are owned as a mesh's. */
typedef struct curves {
    curves_type type;
    uint32_t segment_count, capacity;
    /* Above 0 the points move: each segment has this many more sets of four behind its first, for evenly spaced times
     * from the shutter's opening to its closing, straight in between. 0 of ribbons. */
    uint32_t motion_segments;
    curve_point *points;    /* 4 per segment and set */
    vec3 *normals;          /* of ribbons, else NULL: 4 per segment, control points too (curves_fit_ribbon) */
    vec2 *spans;            /* per segment: the uv.x of its ends, for a curve may have been cut */
    uint32_t *first_points; /* per segment: where its points begin, for Embree */
    uint32_t *holder_count; /* as a mesh's; no more segments can then be added */
} curves;

/* The kinds of shapes by what they do with light. They decide which of two faces counts where these lie on each other
 * (rays/glued_faces.h). They are bits, so that rays can look for several. */
typedef enum shape_role {
    SHAPE_IS_OPAQUE = 1,      /* no light passes it, or it shines */
    SHAPE_IS_TRANSPARENT = 2, /* glass, thin or not, and interfaces */
    SHAPE_IS_TRANSLUCENT = 4  /* light passes it, and it has a colour of its own: paper, leaves */
} shape_role;

typedef struct shape {
    shape_kind kind;
    bool flip_normal; /* ReverseOrientation, and for meshes also a transform that swaps handedness (not both) */
    bool has_medium_interface;              /* the two below differ: a ray that leaves it is in that of its side */
    uint32_t medium_inside, medium_outside; /* of the scene's, or SCENE_NO_MEDIUM; without an interface only of use to
                                             * light that starts here */
    uint32_t material_index;
    uint32_t light_index;   /* SHAPE_NO_LIGHT where it does not shine */
    float alpha;            /* its alpha, [0, 1]: the share of rays that it stops (alpha.h) */
    uint32_t alpha_texture; /* a float texture that multiplies it; SCENE_NO_TEXTURE: none */
    float alpha_cutoff;     /* above 0: the surface is there, wholly, where alpha is at least that */
    uint32_t object_index;  /* the scene's object that it belongs to; SCENE_NO_OBJECT: it stands in the world itself */
    union {
        mesh mesh;
        quadric quadric;
        curves curves;
    } as;
    float area; /* m^2, world; set by scene_commit, unless it is known, above 0 */
    /* set by scene_commit */
    unsigned role; /* of shape_role; 0: none, of curves and of lamps of glass */
    bool is_glued; /* transparent, and on an opaque face somewhere */
} shape;

/* Returns a shape with nothing in it yet: opaque, dark, of the scene's first material, in no medium. */
shape shape_make(shape_kind kind);
/* Frees what it owns. */
void shape_reset(shape *s);
void mesh_reset(mesh *m);
/* Makes a shape that shares another's arrays, whether committed or not: each is reset by itself. Errors:
 * AG_ERROR_MEMORY. */
ag_status shape_share(shape *s, shape *out_other);
/* Returns whether rays would meet the same: surfaces that share their arrays, or are equal by their few numbers. */
bool shape_has_same_surface(const shape *a, const shape *b);
/* Returns whether two meshes, or two curves, hold equal arrays and do not share them yet. */
bool shape_equals(const shape *s, const shape *other);
/* Puts the arrays of an equal shape in the place of a shape's own, so that both share them. Errors: AG_ERROR_MEMORY. */
ag_status shape_share_arrays(shape *from, shape *in_out_shape);
/* Returns a hash of the arrays that a mesh borrows, to detect writes; 0: it borrows none, or they cannot be read. */
uint64_t shape_hash_borrowed(const shape *s);
/* Copies a shape, not one of curves, before its commit, transformed by a map from its world space to another's. NULL:
 * it stays where it is, to the last bit. Errors: AG_ERROR_MEMORY. */
ag_status shape_copy(const shape *s, const transform *map, shape *out_copy);

surface_sample shape_sample_area(const shape *s, vec2 u);
/* Returns the probability with which shape_pick_triangle picks that triangle of a mesh with area_cdf. */
static inline float mesh_area_share(const mesh *m, uint32_t triangle)
{
    return m->area_cdf[triangle] - (triangle > 0 ? m->area_cdf[triangle - 1] : 0.0f);
}

/* Picks a triangle of a mesh that is a lamp with a probability in proportion to its area, and returns its number.
 * *in_out_u is uniform in [0, 1), and afterwards another such number, which does not depend on the triangle. */
uint32_t shape_pick_triangle(const shape *s, float *in_out_u);
/* Returns the sample at a point of a mesh's triangle. barycentrics: the weights of its second and third corner. */
surface_sample shape_sample_triangle(const shape *s, uint32_t triangle, vec2 barycentrics);
/* Computes the whole hit at a sampled point; distance is 0. */
void shape_sample_surface(const shape *s, uint32_t shape_index, const surface_sample *sample, surface_hit *out_hit);
/* Returns the numbers in [0, 1) by which shape_sample_area picks that point of a triangle of such a mesh. */
vec2 shape_sample_numbers(const shape *s, uint32_t triangle, vec2 barycentrics);
/* Finds the random numbers by which shape_sample_area picks a point. Returns false for shapes that are no mesh. */
bool shape_sample_inverse(const shape *s, const surface_hit *hit, vec2 *out_u);
/* Returns the density, 1/m^2, of shape_sample_area at a point on the shape with that geometric normal. */
float shape_pdf_area(const shape *s, vec3 geometric_normal);

/* Completes a hit that Embree has found, for rays_embree.c: all but distance, indices and time. u, v:
 * Embree's barycentrics for meshes, u along curves; for all but meshes `position` comes in as the ray's point and is
 * put onto the surface. direction: the ray's, of any length; read for curves alone. time: of the shutter, [0, 1]. */
void shape_surface_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, vec3 direction,
                      float time, surface_hit *out_hit);
/* Works as shape_surface_at, but may leave uv out. */
void shape_hit_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, vec3 direction, float time,
                  surface_hit *out_hit);
/* Computes the position, geometric normal and epsilon alone, as shape_hit_at does, but for the normal's side. Returns
 * false for curves, for quadrics that are no true spheres, and where vertices move. */
bool shape_bare_point_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position,
                         surface_point *out_point);

/* Returns the area of a shape in world space, m^2, at the opening of the shutter. pbrt's "power" needs it. */
float shape_area(const shape *s);
/* Finds the box, in the shape's space, that holds the shape for as long as the shutter is open. */
void shape_bounds(const shape *s, vec3 *out_min, vec3 *out_max);
/* Fills in what scene_commit sets: centers, areas; area_cdf when it shines. Errors: AG_ERROR_MEMORY. */
ag_status shape_commit(shape *s);

#endif

/* eye_path.h: a path of light followed back from the eye, step by step: trace to the next vertex, on a surface or in a
 * medium, add the light that is met there and the light that a lamp sends there, scatter on.
 * Rests on: Kajiya, "The Rendering Equation", 1986; Veach 1997, ch. 9, 10 (next-event estimation, MIS); Heckbert 1990
 * (path notation, for the parts of the light).
 * Flow: shading, path_tracing and eye_pilot each follow paths by these steps -> eye_sample.
 * Threads: a path belongs to one worker. */
#ifndef AFTERGLOW_EYE_PATH_H
#define AFTERGLOW_EYE_PATH_H

#include "glint_guide.h"
#include "integrator/camera_sample.h"
#include "integrator/transport.h"

/* The shares of light met by the path now that belong to each part of the picture; they sum to 1 in each channel. Where
 * lobes of both groups scatter into one direction, the path stands for both. */
typedef struct part_shares {
    rgb of[LIGHT_PART_COUNT];
} part_shares;

/* From a vertex on, roulette decides whether a path goes on whose throughput is below a level. Behind scatterings by
 * media their own level counts (medium_roulette_level). */
typedef struct eye_roulette {
    int after;   /* the number of that vertex */
    float level; /* > 0; 1: as much as the path began with */
} eye_roulette;

typedef struct eye_path {
    sampler where; /* the branch's; each branch takes other numbers of the same sequences */
    scene_ray ray; /* to be followed next */
    rgb throughput;
    float share;    /* of the camera sample, (0, 1]: those of all branches and ways into which it is split sum to 1 */
    int vertex;     /* the number of the vertex that the ray will meet, from 0 on */
    int ways_taken; /* at how many smooth surfaces the path was split by their two ways */
    int vertex_key; /* added to that number where random numbers are drawn */
    eye_roulette roulette;
    int scatterings;    /* so far; to pass a pane straight may count as none, and then changes no member below */
    int in_media;       /* those of them by media */
    int first_gathered; /* the number, from 1 on, of the first scattering by a gathered lobe; 0: none */
    vec3 scattered_from, scattered_normal; /* position and vertex_light_normal of the last scattering */
    float scattered_pdf; /* per solid angle; 0: the eye or a smooth lobe, for which no shadow ray can stand */
    int scatter_count;   /* how many branches left that position */
    float shared;        /* 1 / the sample's camera rays: the share of light that each of them brings */
    bool is_further;     /* of a further camera ray: see eye_sample.h */
    bool wants_parts;
    part_shares parts; /* valid where wants_parts */
} eye_path;

eye_path eye_path_begin(const camera_sample *from, eye_roulette roulette, bool wants_parts);

/* Returns the number of the vertex by which random numbers are drawn. */
static inline int eye_path_key(const eye_path *path) { return path->vertex + path->vertex_key; }

/* Returns the path's share of the camera sample in light that all camera rays bring. */
static inline float eye_path_shared(const eye_path *path) { return path->share * path->shared; }

/* Returns how many more scatterings the settings allow. */
static inline int eye_path_scatterings_left(const transport *t, const eye_path *path)
{
    return t->settings->max_depth - path->scatterings + (t->media_are_bounded ? 0 : path->in_media);
}

/* Returns whether the settings allow the path no more scatterings, so that it goes on through panes alone. */
static inline bool eye_path_is_last(const transport *t, const eye_path *path)
{
    return eye_path_scatterings_left(t, path) <= 0 || path->in_media >= MEDIUM_SCATTERINGS_MAX;
}

/* Returns the random number that picks the lobe by which the path goes on. */
static inline float eye_path_u_lobe(const eye_path *path)
{
    return sampler_2d(&path->where, SAMPLE_LOBE, eye_path_key(path)).x;
}

/* Follows the ray to the first surface or point of a medium that scatters; returns false where it escapes. Fills the
 * sample's first hit where layers ask for it; sample may be NULL where none do. */
bool eye_path_trace(const transport *t, eye_worker *worker, eye_path *in_out_path, eye_sample *sample,
                    vertex *out_vertex);

/* Adds the radiance of infinite lights along a ray that has escaped, weighted against shadow rays from the position
 * that it left. */
void eye_path_add_escaped(const transport *t, const eye_path *path, eye_sample *in_out_sample);

/* Adds the radiance that the surface at the vertex emits, weighted against shadow rays from the position that
 * the ray left. */
void eye_path_add_emitted(const transport *t, const eye_path *path, const vertex *v, eye_sample *in_out_sample);

/* Next-event estimation: adds light from one lamp by these lobes. scatter_count: how many samples of the same lobes
 * will be taken by eye_path_go_on. */
void eye_path_add_direct(const transport *t, eye_worker *worker, const eye_path *path, const vertex *v,
                         bsdf_lobes lobes, int scatter_count, eye_sample *in_out_sample);

/* Finds where glints come from (glint_guide.h), for the ways on from the vertex by traced lobes. Returns out_guide, or
 * NULL where nothing guides them. */
const glint_guide *eye_path_find_glints(const transport *t, const vertex *v, glint_guide *out_guide);

/* Sends the path on from the vertex by one of these lobes, as one of branch_count branches from there; u_lobe in [0, 1)
 * picks it. glints: see eye_path_find_glints; NULL: nothing guides it. Returns false where the path ends: by the lobes,
 * by roulette, or by the limit of scatterings. */
bool eye_path_go_on(const transport *t, const vertex *v, bsdf_lobes lobes, const glint_guide *glints, float u_lobe,
                    int branch_count, eye_path *in_out_path);

#endif

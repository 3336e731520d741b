/* light.h: lights: sampling them from a lit point, and sampling rays that leave them.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 12 (light sources), 6.2.4
 * (sampling spheres by their cone); Jensen 2001, ch. 5 (photon emission).
 * Flow: the scene file makes lights; scene_commit gives them power; direct lighting and photon emission sample them.
 * Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_LIGHT_H
#define AFTERGLOW_LIGHT_H

#include "afterglow/base.h"
#include "math/vec3.h"

#include <stdint.h>

struct scene;
struct rng;
struct surface_hit;
struct surface_sample;
struct environment;
struct projection;
struct portal;
struct radiance_map;

/* All kinds, each with its light_type (light_type.h). */
#define LIGHT_KIND_LIST(X)                                                                                             \
    X(LIGHT_POINT, point_light)                                                                                        \
    X(LIGHT_SPOT, spot_light)                                                                                          \
    X(LIGHT_GONIOMETRIC, goniometric_light) /* a point whose intensity is a picture over all directions */             \
    X(LIGHT_PROJECTION, projection_light)   /* a point that projects a picture */                                      \
    X(LIGHT_DISTANT, distant_light)                                                                                    \
    X(LIGHT_AREA, area_light)                                                                                          \
    X(LIGHT_INFINITE, infinite_light)

typedef enum light_kind {
#define LIGHT_KIND_ENUM(kind, type) kind,
    LIGHT_KIND_LIST(LIGHT_KIND_ENUM)
#undef LIGHT_KIND_ENUM
        LIGHT_KIND_COUNT
} light_kind;

/* Light by direction: constant, or given by a picture of the sphere of directions. */
typedef struct light_directions {
    rgb value;                   /* of all directions, or the factor of the picture */
    frame world_from_light;      /* of the picture: a rotation or reflection */
    struct environment *picture; /* owned, or NULL */
} light_directions;

/* --- the kinds, in world space; those that are points begin with their position --- */

typedef struct point_source {
    vec3 position;
    rgb intensity; /* W/sr */
} point_source;

typedef struct spot_source {
    vec3 position;
    vec3 direction;                   /* of its axis, in which the light travels, unit */
    rgb intensity;                    /* along the axis, W/sr */
    float falloff_start, falloff_end; /* 1 - cos of the angles below which it is full, and beyond which there is no
                                         light; between them smoothstep in the cosine */
    bool dims_by_cosine;              /* its intensity is also multiplied by the cosine to its axis */
} spot_source;

typedef struct goniometric_source {
    vec3 position;
    light_directions intensity; /* W/sr, by the directions that leave it */
} goniometric_source;

typedef struct projection_source {
    vec3 position;
    frame world_from_light;     /* a rotation or reflection; its axis is z */
    rgb intensity;              /* factor of the picture, W/sr */
    struct projection *picture; /* owned */
} projection_source;

typedef struct distant_source {
    vec3 direction;           /* in which the light travels, unit */
    rgb irradiance;           /* on a surface facing its middle, W/m^2 */
    float disc_one_minus_cos; /* 1 - cos of half its angular diameter; 0: it has no extent */
} distant_source;

typedef struct area_source {
    uint32_t shape_index; /* of its shape */
    bool two_sided;
    rgb radiance;              /* W/m^2/sr */
    uint32_t radiance_texture; /* factor of the radiance over the surface; SCENE_NO_TEXTURE: none */
    struct radiance_map *map;  /* owned; set by scene_commit where the radiance varies, else NULL */
} area_source;

typedef struct infinite_source {
    light_directions radiance; /* W/m^2/sr, by the directions towards it */
    struct portal *portal;     /* the only opening for its light; owned; NULL: none */
} infinite_source;

typedef struct light {
    light_kind kind;
    uint32_t group;  /* index into the scene's light groups; 0: the group of lights that name none */
    float photons;   /* factor of its share of the photons; 0: it emits none */
    uint32_t medium; /* medium around it, except for area lights; SCENE_NO_MEDIUM: none */
    union {
        point_source point; /* its position is at the same place in all point lights */
        spot_source spot;
        goniometric_source goniometric;
        projection_source projection;
        distant_source distant;
        area_source area;
        infinite_source infinite;
    } as;
    rgb power; /* W; set by scene_commit. Distant and infinite lights: through the disc of the scene's bounding sphere;
                  with a portal: what enters there */
} light;

/* Returns a light of a kind, without power, with all members at their defaults. */
light light_make(light_kind kind);
/* Sets a spot's cone: full intensity within the first angle from its axis, none beyond the second; radians in [0,
 * pi]. */
void light_set_cone(light *l, double full_angle, double dark_angle);
/* Sets the angular diameter of a distant light, radians in [0, pi]: a uniform disc, which only shadows show. */
void light_set_disc(light *l, double angle);
/* Frees what the light owns: pictures and tables. */
void light_reset(light *l);

/* Returns whether scattered rays can meet the light: area and infinite lights. The others are found by shadow rays
 * alone. */
bool light_can_be_met(const light *l);
/* Returns whether the light comes from infinitely far away: that of skies and suns. */
bool light_is_everywhere(const light *l);
/* Returns whether rays that meet no surface see the light: infinite lights. */
bool light_is_sky(const light *l);
/* Returns the picture of all directions that the light holds, or NULL. */
struct environment *light_picture_of(const light *l);

/* A sample of the light that arrives at a point. */
typedef struct light_sample {
    vec3 direction;     /* towards the light, unit */
    float distance;     /* INFINITY for distant and infinite lights */
    vec3 shadow_target; /* the end of a shadow ray, just before the lamp's surface; unused where distance is INFINITY */
    rgb radiance;       /* area, infinite: W/m^2/sr; delta lights: irradiance perpendicular to direction, W/m^2 */
    float pdf_solid_angle; /* 1 for delta lights */
    bool is_delta;         /* no scattered ray can meet it: no MIS */
    /* The sampled point of an area light: its geometric normal and, on a mesh alone, triangle and barycentrics as in
     * surface_sample. Undefined for other lights. */
    vec3 lamp_normal;
    uint32_t lamp_triangle;
    vec2 lamp_barycentrics;
} light_sample;

/* Sets the members that are set by scene_commit, once areas and bounds are known. Errors: AG_ERROR_MEMORY. */
ag_status light_commit(const struct scene *s, light *l);

/* Samples the light by u in [0,1)^2. Returns false where none can arrive. */
bool light_sample_from_point(const struct scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample);

/* Returns the density with which light_sample_from_point picks the direction from a point to a hit on the light's
 * shape, 1/sr. For skies see light_escaped_pdf. */
float light_pdf_from_point(const struct scene *s, const light *l, vec3 point, const struct surface_hit *hit);

/* Of a sky: returns the radiance, W/m^2/sr, that a ray from a point sees in a direction (towards the light, unit) where
 * it meets no surface, and the density with which light_sample_from_point picks that direction, 1/sr. */
rgb light_escaped_radiance(const light *l, vec3 point, vec3 direction);
float light_escaped_pdf(const light *l, vec3 point, vec3 direction);

/* Returns whether light_sample_from_point picks the same direction by u from all points, so that a guide may learn
 * which u are of use; such is a sky that does not come in by a portal. light_direction_numbers, for such lights alone,
 * finds the u, up to rounding, by which a direction is picked; it returns false where it is never picked. */
bool light_has_direction_numbers(const light *l);
bool light_direction_numbers(const light *l, vec3 direction, vec2 *out_u);

/* Returns the radiance that an area light emits at a point on it in a direction (away from it, unit), W/m^2/sr. */
rgb light_emitted_radiance(const struct scene *s, const light *l, const struct surface_hit *hit, vec3 direction);

/* Returns the intensity of a point light in a direction (away from it, unit), W/sr. */
rgb light_intensity(const light *l, vec3 direction);

/* Finds the cone under which a ball is seen from a point outside it, and returns true; out_one_minus_cos: of its half
 * angle. Returns false where the point is inside, or too close for a precise cone. */
bool light_ball_cone(vec3 center, float radius, vec3 point, float *out_one_minus_cos);

/* The start of a photon path. */
typedef struct light_emission {
    vec3 origin;     /* offset from the lamp's surface */
    vec3 direction;  /* unit */
    rgb flux;        /* W, of a photon that represents the whole light */
    uint32_t medium; /* medium at the start, SCENE_NO_MEDIUM: none; for light from infinitely far away, its absorption
                        so far is included */
} light_emission;

/* A ball: rays whose first hit lies outside of it are of no use. */
typedef struct light_target {
    vec3 center;
    float radius; /* > 0 */
} light_target;

/* The random numbers, in [0, 1), that decide where a photon starts. Neighbouring numbers give neighbouring starts, so
 * that a guide can select useful parts of a light by them. */
typedef struct emission_numbers {
    vec2 direction;
    vec2 position;             /* on an area light or a portal; for distant lights across the direction */
    float part;                /* picks the side of an area light, or one of the nested balls around small targets */
    const light_target *focus; /* borrowed; light from afar is densest around it; NULL: around the scene's detail */
} emission_numbers;

/* Samples a photon's start. target NULL: the whole light. Else only a part of the light that contains all rays which
 * meet the ball is sampled, as far as it is known, with its share of the flux (Jensen 1996: projection maps). Returns
 * false where the sample carries no flux. */
bool light_emit(const struct scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                light_emission *out_emission);

/* Finds the numbers, up to rounding, by which light_emit without a target emits a photon along the line that
 * light_sample_from_point has sampled from the point with u. in_out_numbers->part comes in as any number in [0, 1), for
 * what the line does not decide. Returns false where they are not known. */
bool light_emission_numbers(const struct scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                            emission_numbers *in_out_numbers);

/* light_emit by numbers drawn from the stream. */
bool light_sample_emission(const struct scene *s, const light *l, const light_target *target, struct rng *random,
                           light_emission *out_emission);
emission_numbers emission_numbers_draw(struct rng *random);

#endif

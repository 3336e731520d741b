/* light.h: where light comes from: sampling it from a lit point, and sampling rays that leave it.
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

/* Every kind, with the light_type that says what it is (light_type.h). */
#define LIGHT_KIND_LIST(X)                                                                                             \
    X(LIGHT_POINT, point_light)                                                                                        \
    X(LIGHT_SPOT, spot_light)                                                                                          \
    X(LIGHT_GONIOMETRIC, goniometric_light) /* a point whose intensity is a picture over all directions */             \
    X(LIGHT_PROJECTION, projection_light)   /* a point that throws a picture */                                        \
    X(LIGHT_DISTANT, distant_light)                                                                                    \
    X(LIGHT_AREA, area_light)                                                                                          \
    X(LIGHT_INFINITE, infinite_light)

typedef enum light_kind {
#define LIGHT_KIND_ENUM(kind, type) kind,
    LIGHT_KIND_LIST(LIGHT_KIND_ENUM)
#undef LIGHT_KIND_ENUM
        LIGHT_KIND_COUNT
} light_kind;

/* Light by direction: the same for all, or as a picture of the sphere of directions says. */
typedef struct light_directions {
    rgb value;                   /* for all directions, or what the picture is multiplied by */
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
    vec3 direction;                   /* of its axis, the way the light goes, unit */
    rgb intensity;                    /* along the axis, W/sr */
    float falloff_start, falloff_end; /* 1 - cos of the angles inside of which it is full and outside of which there is
                                       * nothing; smoothstep in the cosine between */
    bool dims_by_cosine;              /* its intensity is multiplied by the cosine to its axis, too */
} spot_source;

typedef struct goniometric_source {
    vec3 position;
    light_directions intensity; /* W/sr, by the directions that leave it */
} goniometric_source;

typedef struct projection_source {
    vec3 position;
    frame world_from_light;     /* a rotation or reflection; light goes along z */
    rgb intensity;              /* what the picture is multiplied by, W/sr */
    struct projection *picture; /* owned */
} projection_source;

typedef struct distant_source {
    vec3 direction;           /* the way the light goes, unit */
    rgb irradiance;           /* on a surface facing its middle, W/m^2 */
    float disc_one_minus_cos; /* 1 - cos of half the angle under which it is seen; 0: it has no extent */
} distant_source;

typedef struct area_source {
    uint32_t shape_index; /* of the shape that shines */
    bool two_sided;
    rgb radiance;              /* W/m^2/sr */
    uint32_t radiance_texture; /* multiplies radiance over the surface; SCENE_NO_TEXTURE: nowhere */
    struct radiance_map *map;  /* owned, or NULL; set by scene_commit where it varies */
} area_source;

typedef struct infinite_source {
    light_directions radiance; /* W/m^2/sr, by the directions that it comes from */
    struct portal *portal;     /* through which alone its light comes; owned, or NULL: from everywhere */
} infinite_source;

typedef struct light {
    light_kind kind;
    uint32_t group;  /* of the scene's light groups; 0: the one of those that name none */
    float photons;   /* multiplies its share of the photons; 0: it sends none */
    uint32_t medium; /* all but area lights: that their light starts in; SCENE_NO_MEDIUM: none */
    union {
        point_source point; /* its position is that of every kind that is a point */
        spot_source spot;
        goniometric_source goniometric;
        projection_source projection;
        distant_source distant;
        area_source area;
        infinite_source infinite;
    } as;
    rgb power; /* W; set by scene_commit. Distant, infinite: through the disc of the scene's bounding sphere; through a
                * portal: what enters there */
} light;

/* A light of that kind, of no power, with everything that has one at its default. */
light light_make(light_kind kind);
/* A spot's cone: full inside the first angle from its axis, dark outside the second, radians in [0, pi]. */
void light_set_cone(light *l, double full_angle, double dark_angle);
/* A distant light's disc, which shines alike all over: the angle across it, radians in [0, pi]. Shadows alone show
 * it. */
void light_set_disc(light *l, double angle);
/* Frees the pictures and tables. */
void light_reset(light *l);

/* Whether scattered rays find it: area and infinite lights. The others shadow rays alone find. */
bool light_can_be_met(const light *l);

/* Light arriving at a point. */
typedef struct light_sample {
    vec3 direction;        /* towards the light, unit */
    float distance;        /* INFINITY for distant and infinite lights */
    vec3 shadow_target;    /* where a shadow ray ends (just before the lamp's surface); unused for those */
    rgb radiance;          /* area, infinite: W/m^2/sr; delta lights: irradiance perpendicular to direction, W/m^2 */
    float pdf_solid_angle; /* 1 for delta lights */
    bool is_delta;         /* cannot be hit by a scattered ray: no MIS */
} light_sample;

/* Sets the members that scene_commit is said to set, once areas and bounds are there. Errors: AG_ERROR_MEMORY. */
ag_status light_commit(const struct scene *s, light *l);

/* u in [0,1)^2. Returns false when no light can come from there. */
bool light_sample_from_point(const struct scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample);

/* The density with which light_sample_from_point picks the direction from point to a hit on the light's
 * shape. For lights of kind LIGHT_INFINITE see environment_pdf. */
float light_pdf_from_point(const struct scene *s, const light *l, vec3 point, const struct surface_hit *hit);

/* Radiance that an area light sends from a point on it into direction (away from it, unit). */
rgb light_emitted_radiance(const struct scene *s, const light *l, const struct surface_hit *hit, vec3 direction);

/* The texture's part in that, not negative; 1 where there is none. */
rgb light_texture_value(const struct scene *s, const light *l, const struct surface_hit *hit);

/* Whether an area light is not alike all over, by its texture or its shape's alpha. */
bool light_varies(const struct scene *s, const light *l);
/* The share of its radiance that a point sampled on an area light sends: the texture's value, times the share of the
 * shape that is there unless it is invisible (alpha.h); rays that meet the lamp have taken account of that. at: read
 * only if the light varies. */
rgb light_sampled_value(const struct scene *s, const light *l, const struct surface_sample *at);

/* Intensity of a light that is a point, W/sr into direction (away from it, unit). */
rgb light_intensity(const light *l, vec3 direction);

/* The cone under which a ball is seen from a point outside it: true, and 1 - cos of its half angle; false when the
 * point is inside or too close for the cone to be precise. */
bool light_ball_cone(vec3 center, float radius, vec3 point, float *out_one_minus_cos);

/* A photon's start. */
typedef struct light_emission {
    vec3 origin;     /* off the lamp's own surface */
    vec3 direction;  /* unit */
    rgb flux;        /* W, carried by a single photon that stands for the whole light */
    uint32_t medium; /* that it starts in, SCENE_NO_MEDIUM: none; what it took before, from infinitely far, is off */
} light_emission;

/* A ball outside of which a ray's first hit is of no use. */
typedef struct light_target {
    vec3 center;
    float radius; /* > 0 */
} light_target;

/* The random numbers, in [0, 1), that decide where a photon starts: neighbouring ones give neighbouring starts, so that
 * whoever knows which parts of a light are of use can pick them by these numbers. */
typedef struct emission_numbers {
    vec2 direction;
    vec2 position; /* on an area light or a portal; of lights that are far away: across the direction */
    float part;    /* side of an area light; which of the balls that are nested around small things */
} emission_numbers;

/* target NULL: all of the light. Else only that part of it is sampled, as far as is known beforehand, whose rays meet
 * the ball: every ray that does is, with the right share of the whole (Jensen 1996: projection maps). What the numbers
 * leave open is decided by the path's own stream (math/rng.h). Returns false when the sample carries nothing. */
bool light_emit(const struct scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                struct rng *random, light_emission *out_emission);

/* The numbers, up to rounding, by which light_emit without a target sends a photon along the way that
 * light_sample_from_point has found from the point with u. in_out_numbers->part comes in as any number in [0, 1), for
 * what the way leaves open. false: they are not known. */
bool light_emission_numbers(const struct scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                            emission_numbers *in_out_numbers);

/* light_emit by numbers that are drawn from the stream. */
bool light_sample_emission(const struct scene *s, const light *l, const light_target *target, struct rng *random,
                           light_emission *out_emission);
emission_numbers emission_numbers_draw(struct rng *random);

#endif

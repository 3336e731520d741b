/* light_type.h: what a kind of light is: one file and one row of LIGHT_KIND_LIST each.
 * Flow: light.c, light_emission.c, light_bounds.c, light_pick.c and scene_hash.c ask the row of a light's kind.
 * Threads: read-only tables. */
#ifndef AFTERGLOW_LIGHT_TYPE_H
#define AFTERGLOW_LIGHT_TYPE_H

#include "light/light.h"
#include "light/light_tree.h"
#include "math/hash128.h"

/* Slack for rounding: a light this little behind a surface still counts. */
#define LIGHT_REACH_SLACK 1e-3f

/* Each function is there, but for those that may be NULL. */
typedef struct light_type {
    bool can_be_met;    /* scattered rays find it: samples towards it are weighed against them */
    bool is_everywhere; /* infinitely far away: it has no bounds, and may shine at any point */
    /* Sets the defaults of what the kind has; NULL: all are zero. */
    void (*init)(light *l);
    /* Frees what the kind owns; NULL: nothing. */
    void (*reset)(light *l);
    /* Adds what the kind has to a fingerprint, but for what commit sets (scene_hash.h). */
    void (*add_hash)(const light *l, hash128 *h);
    /* Makes what needs the scene; NULL: nothing. Errors: AG_ERROR_MEMORY. */
    ag_status (*commit)(const scene *s, light *l);
    rgb (*power)(const scene *s, const light *l); /* W, as light.power has it */
    /* W/sr into a unit direction away from it; of points, else NULL. */
    rgb (*intensity)(const light *l, vec3 direction);
    /* light_sample_from_point. */
    bool (*sample_from_point)(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample);
    /* light_pdf_from_point; NULL: 0. */
    float (*pdf_from_point)(const scene *s, const light *l, vec3 point, const struct surface_hit *hit);
    /* light_emitted_radiance; NULL: black. */
    rgb (*emitted_radiance)(const scene *s, const light *l, const struct surface_hit *hit, vec3 direction);
    /* light_emit. *out_emission has the light's own medium. */
    bool (*emit)(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 struct rng *random, light_emission *out_emission);
    /* light_emission_numbers; NULL: they are not known. */
    bool (*emission_numbers_of)(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out_numbers);
    /* Puts light_find_bounds of what shines into all directions around the light, and narrows them; NULL: it
     * is_everywhere. */
    void (*narrow_bounds)(const scene *s, const light *l, light_bounds *in_out_bounds);
    /* Whether one that is_everywhere may bring light to a point from the side of a normal, which may be 0 0 0 (all
     * sides); NULL: always. */
    bool (*reaches)(const light *l, vec3 point, vec3 normal);
} light_type;

/* Each is in the file of its name. */
#define LIGHT_TYPE_DECLARATION(kind, type) extern const light_type type;
LIGHT_KIND_LIST(LIGHT_TYPE_DECLARATION)
#undef LIGHT_TYPE_DECLARATION

extern const light_type *const light_types[LIGHT_KIND_COUNT];

static inline const light_type *light_type_of(light_kind kind) { return light_types[kind]; }

/* --- what several kinds share --- */

/* A point that shines into all directions. */
void light_narrow_to_point(const scene *s, const light *l, light_bounds *in_out_bounds);

/* Towards a light that is a point, by its type's intensity. */
bool light_sample_of_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample);

/* A direction from a position uniformly in the cone to the target; false where the light's own way, which fills a cone
 * of own_cone (1 - cos of its half angle), is as good. */
bool light_aim_at(const light_target *target, vec3 origin, float own_cone, vec2 u, vec3 *out_direction, float *out_pdf);

/* Emission of a point: sets the origin, and where light_aim_at finds a cone, direction and flux too (true). */
bool light_aim_point(const light *l, const light_target *target, float own_cone, const emission_numbers *numbers,
                     light_emission *out_emission);

/* Light from infinitely far away in that direction: of so much radiance (or irradiance) over its density, from a disc
 * outside all there is, with what media take from it. target as light_emit has it. */
bool light_emit_from_afar(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                          vec3 direction, rgb radiance, float pdf, light_emission *out_emission);

/* emission_numbers_of a kind whose light_sample_from_point and light_emit pick a direction by the numbers alike, and
 * whose light comes by light_emit_from_afar. */
bool light_numbers_from_afar(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                             emission_numbers *in_out_numbers);

#endif

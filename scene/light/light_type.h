/* light_type.h: the functions of a kind of light, in one file and one row of LIGHT_KIND_LIST each.
 * Flow: light.c, light_emission.c, light_bounds.c, light_pick.c and scene_hash.c ask the row of a light's kind.
 * Threads: read-only tables. */
#ifndef AFTERGLOW_LIGHT_TYPE_H
#define AFTERGLOW_LIGHT_TYPE_H

#include "light/light.h"
#include "light/light_tree.h"
#include "math/hash128.h"

/* Slack for rounding: a light this little behind a surface still counts. */
#define LIGHT_REACH_SLACK 1e-3f

/* Functions that may be NULL say so. */
typedef struct light_type {
    bool can_be_met;    /* scattered rays can meet it, so that samples towards it are weighted by MIS */
    bool is_everywhere; /* infinitely far away: it has no bounds and may light any point */
    /* Sets the defaults of the kind's members; NULL: all are zero. */
    void (*init)(light *l);
    /* Frees what the kind owns; NULL: nothing. */
    void (*reset)(light *l);
    /* Adds the kind's members to a fingerprint, without those that commit sets (scene_hash.h). */
    void (*add_hash)(const light *l, hash128 *h);
    /* Prepares what depends on the scene; NULL: nothing. Errors: AG_ERROR_MEMORY. */
    ag_status (*commit)(const scene *s, light *l);
    rgb (*power)(const scene *s, const light *l); /* W, as light.power */
    /* W/sr in a unit direction away from it; point lights, else NULL. */
    rgb (*intensity)(const light *l, vec3 direction);
    /* light_sample_from_point. */
    bool (*sample_from_point)(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample);
    /* light_pdf_from_point; NULL: 0. */
    float (*pdf_from_point)(const scene *s, const light *l, vec3 point, const struct surface_hit *hit);
    /* light_emitted_radiance; NULL: black. */
    rgb (*emitted_radiance)(const scene *s, const light *l, const struct surface_hit *hit, vec3 direction);
    /* light_escaped_radiance and light_escaped_pdf of a sky; NULL, both: the light is none. */
    rgb (*escaped_radiance)(const light *l, vec3 point, vec3 direction);
    float (*escaped_pdf)(const light *l, vec3 point, vec3 direction);
    /* light_has_direction_numbers and light_direction_numbers; NULL, both: it has none. */
    bool (*has_direction_numbers)(const light *l);
    bool (*direction_numbers)(const light *l, vec3 direction, vec2 *out_u);
    /* light_picture_of; NULL: it holds none. */
    struct environment *(*picture)(const light *l);
    /* light_emit. *out_emission has the light's own medium. */
    bool (*emit)(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out_emission);
    /* light_emission_numbers; NULL: they are not known. */
    bool (*emission_numbers_of)(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out_numbers);
    /* Narrows bounds that were set for emission in all directions around the light; NULL: it is_everywhere. */
    void (*narrow_bounds)(const scene *s, const light *l, light_bounds *in_out_bounds);
    /* Returns whether a light that is_everywhere may reach a point from the side of a normal, which may be 0 0 0 (all
     * sides); NULL: always. */
    bool (*reaches)(const light *l, vec3 point, vec3 normal);
} light_type;

/* Each is defined in the file of its name. */
#define LIGHT_TYPE_DECLARATION(kind, type) extern const light_type type;
LIGHT_KIND_LIST(LIGHT_TYPE_DECLARATION)
#undef LIGHT_TYPE_DECLARATION

extern const light_type *const light_types[LIGHT_KIND_COUNT];

static inline const light_type *light_type_of(light_kind kind) { return light_types[kind]; }

/* --- what several kinds share --- */

/* Bounds of a point that emits in all directions. */
void light_narrow_to_point(const scene *s, const light *l, light_bounds *in_out_bounds);

/* Samples a point light, by its type's intensity. */
bool light_sample_of_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample);

/* Samples a direction from a position uniformly in the cone to the target; returns false where the light's own
 * sampling, which fills a cone of own_cone (1 - cos of its half angle), is as good. */
bool light_aim_at(const light_target *target, vec3 origin, float own_cone, vec2 u, vec3 *out_direction, float *out_pdf);

/* Begins the emission of a point light: sets the origin, and where light_aim_at finds a cone, direction and flux too,
 * and returns true. */
bool light_aim_point(const light *l, const light_target *target, float own_cone, const emission_numbers *numbers,
                     light_emission *out_emission);

/* Emits light from infinitely far away in a direction, with radiance (or irradiance) divided by its density, from a
 * disc outside the scene, less what media absorb. target as in light_emit. */
bool light_emit_from_afar(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                          vec3 direction, rgb radiance, float pdf, light_emission *out_emission);

/* emission_numbers_of a kind whose light_sample_from_point and light_emit pick a direction by the numbers alike, and
 * whose light comes by light_emit_from_afar. */
bool light_numbers_from_afar(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                             emission_numbers *in_out_numbers);

#endif

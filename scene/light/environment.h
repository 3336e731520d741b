/* environment.h: light from infinitely far away on all sides: the same from everywhere, or as a picture of the sphere
 * of directions says.
 * Rests on: Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", Journal of Graphics Tools 13(3), 2008
 * (square pictures); Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.5 (infinite lights).
 * Flow: pbrt_environments reads pictures; light.c samples; the renderer asks for what rays see that meet nothing.
 * Threads: read-only once created. */
#ifndef AFTERGLOW_ENVIRONMENT_H
#define AFTERGLOW_ENVIRONMENT_H

#include "light/light.h"
#include "math/distribution_2d.h"
#include "math/hash128.h"

/* How a picture covers the sphere; z is up in the light's own space. x of the picture goes right, y down.
 * Octahedral: +z in the middle, -z in the corners, +x towards the right edge, +y towards the bottom one.
 * Latitude-longitude: +z along the top edge; from the left edge, which is +x, on to +y. */
typedef enum environment_mapping { ENVIRONMENT_OCTAHEDRAL, ENVIRONMENT_LATITUDE_LONGITUDE } environment_mapping;

/* A picture of radiance, constant over each pixel. */
typedef struct environment {
    environment_mapping mapping;
    uint32_t width, height;
    rgb *pixels;           /* [height][width], top row first; owned */
    distribution_2d picks; /* pixels in proportion to the light they bring */
    rgb integral;          /* of radiance over the sphere, W/m^2 */
    bool is_gray;          /* its colours were averaged */
    char *name;            /* of the picture, owned; NULL: it is not found again by that */
    uint64_t version;      /* of the picture of that name, see light_picture_note */
    unsigned holder_count; /* of lights of scenes that follow one another */
} environment;

enum { ENVIRONMENT_MAX_SIZE = 65535 }; /* pixels along a side */

/* pixels: finite and not negative, from malloc; taken over, on failure too. Errors: AG_ERROR_MEMORY. */
ag_status environment_create(environment_mapping mapping, uint32_t width, uint32_t height, rgb *pixels,
                             environment **out_environment);
void environment_destroy(environment *e); /* NULL is fine */
/* Another light holds it too, and destroys it as well. */
environment *environment_hold(environment *e);

/* Light by direction, even and upright, and black yet. */
light_directions light_directions_make(void);
void light_directions_add_hash(const light_directions *d, hash128 *h);

/* The direction of a point of [0,1]^2 on a picture that is octahedral. */
vec3 environment_octahedral_direction(double x, double y);
/* The solid angle of each pixel of a row, sr. */
double environment_pixel_solid_angle(const environment *e, uint32_t y);
/* The pixel that a unit direction of the light's space falls into, and where in it, as environment_direction has it. */
void environment_pixel_at(const environment *e, vec3 direction, uint32_t *out_x, uint32_t *out_y);
void environment_uv_at(const environment *e, vec3 direction, uint32_t *out_x, uint32_t *out_y, vec2 *out_within);
/* A direction in the light's space, even in solid angle over each pixel for coordinates within it in [0,1]^2. */
vec3 environment_direction(const environment *e, uint32_t x, uint32_t y, vec2 within);

/* The rest asks a light of kind LIGHT_INFINITE, from a point of the scene: light that comes through a portal reaches
 * but what sees through that. Directions are in world space, unit, towards the light. */

/* W/m^2/sr. */
rgb environment_radiance(const light *l, vec3 point, vec3 direction);
/* The density with which environment_sample picks the direction, 1/sr. */
float environment_pdf(const light *l, vec3 point, vec3 direction);
/* u in [0,1)^2. false where no light comes from anywhere. */
bool environment_sample(const light *l, vec3 point, vec2 u, vec3 *out_direction, rgb *out_radiance,
                        float *out_pdf_solid_angle);

/* The functions below know of no portal. They serve LIGHT_GONIOMETRIC too: intensity, W/sr, by directions that leave
 * the light. */
rgb environment_whole_radiance(const light_directions *d, vec3 direction);
bool environment_sample_whole(const light_directions *d, vec2 u, vec3 *out_direction, rgb *out_radiance,
                              float *out_pdf_solid_angle);
/* The numbers for which environment_sample_whole picks the direction, up to rounding, in [0,1)^2. false where it never
 * does. */
bool environment_sample_whole_numbers(const light_directions *d, vec3 direction, vec2 *out_u);
/* Over the sphere of directions, W/m^2. */
rgb environment_integral(const light_directions *d);

#endif

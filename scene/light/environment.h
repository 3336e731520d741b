/* environment.h: light from infinitely far away in all directions: constant, or given by a picture of the sphere of
 * directions.
 * Rests on: Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", Journal of Graphics Tools 13(3),
 * 2008 (square pictures); Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.5 (infinite
 * lights).
 * Flow: pbrt_environments reads pictures; infinite_light, portal and goniometric_light look directions up.
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
    distribution_2d picks; /* picks pixels in proportion to the light that they bring */
    rgb integral;          /* of radiance over the sphere, W/m^2 */
    bool is_gray;          /* its colours were averaged to grey */
    char *name;            /* name by which the picture is found again, owned; NULL: it is not */
    uint64_t version;      /* of the picture of that name, see light_picture_note */
    unsigned holder_count; /* lights that hold it, also of successive scenes */
} environment;

enum { ENVIRONMENT_MAX_SIZE = 65535 }; /* pixels along a side */

/* Creates a picture from pixels, finite and not negative, from malloc, which it takes over, on failure too. Errors:
 * AG_ERROR_MEMORY. */
ag_status environment_create(environment_mapping mapping, uint32_t width, uint32_t height, rgb *pixels,
                             environment **out_environment);
void environment_destroy(environment *e); /* NULL is fine */
/* Adds a holder, which calls environment_destroy as well. */
environment *environment_hold(environment *e);

/* Returns black constant light in an unrotated frame. */
light_directions light_directions_make(void);
void light_directions_add_hash(const light_directions *d, hash128 *h);

/* Returns the direction of a point of [0,1]^2 on an octahedral picture. */
vec3 environment_octahedral_direction(double x, double y);
/* Returns the solid angle of a pixel in a row, sr. */
double environment_pixel_solid_angle(const environment *e, uint32_t y);
/* Finds the pixel of a unit direction of the light's space, and the position in it, as environment_direction takes
 * it. */
void environment_pixel_at(const environment *e, vec3 direction, uint32_t *out_x, uint32_t *out_y);
void environment_uv_at(const environment *e, vec3 direction, uint32_t *out_x, uint32_t *out_y, vec2 *out_within);
/* Returns a direction in the light's space; uniform coordinates in [0,1]^2 within a pixel are uniform in solid angle
 * over it. */
vec3 environment_direction(const environment *e, uint32_t x, uint32_t y, vec2 within);

/* The functions below ignore portals, which infinite_light.c looks at. They serve goniometric lights too: intensity,
 * W/sr, by directions that leave the light. Directions are in world space, unit, towards an infinite light. */

/* Returns radiance, W/m^2/sr. */
rgb environment_whole_radiance(const light_directions *d, vec3 direction);
/* Samples a direction by u in [0,1)^2. Returns false where there is no light from any direction. */
bool environment_sample_whole(const light_directions *d, vec2 u, vec3 *out_direction, rgb *out_radiance,
                              float *out_pdf_solid_angle);
/* Returns the density with which environment_sample_whole picks the direction, 1/sr. */
float environment_whole_pdf(const light_directions *d, vec3 direction);
/* Finds the numbers in [0,1)^2, up to rounding, for which environment_sample_whole picks a direction. Returns false
 * where it never picks it. */
bool environment_sample_whole_numbers(const light_directions *d, vec3 direction, vec2 *out_u);
/* Returns the integral over the sphere of directions, W/m^2. */
rgb environment_integral(const light_directions *d);

#endif

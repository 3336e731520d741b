/* environment.c: see environment.h.
 * Points on pictures are found in double precision: single would blur the pixels of large ones. */
#include "light/environment.h"

#include "math/angle.h"
#include "math/sampling.h"

#include <stdlib.h>

static const double TWO_PI = 6.283185307179586477;

/* --- the square: Clarberg's map, equal in area everywhere --- */

vec3 environment_octahedral_direction(double x, double y)
{
    double u = 2.0 * x - 1.0, v = 2.0 * y - 1.0;
    /* the upper half of the sphere is |u| + |v| < 1; the lower one is folded out over its edges */
    double above = 1.0 - fabs(u) - fabs(v), r = 1.0 - fabs(above);
    double quarter = r > 0.0 ? 0.5 * ((fabs(v) - fabs(u)) / r + 1.0) : 0.5; /* of the way round from x to y */
    float s, c;
    sincos_turns((float)(quarter * 0.25), &s, &c);
    double across = r * sqrt(2.0 - r * r);
    return vec3_make((float)copysign(across * c, u), (float)copysign(across * s, v),
                     (float)copysign(1.0 - r * r, above));
}

static void octahedral_coordinates(vec3 d, double *out_x, double *out_y)
{
    double x = d.x, y = d.y, z = d.z;
    double r = sqrt((x * x + y * y) / (1.0 + fabs(z))); /* sqrt(1 - |z|), without cancellation */
    double b = double_min(r, 1.0) * 4.0 * angle_turns(fabs(y), fabs(x)), a = double_min(r, 1.0) - b;
    double u = z < 0.0 ? 1.0 - b : a, v = z < 0.0 ? 1.0 - a : b;
    *out_x = 0.5 * (copysign(u, x) + 1.0);
    *out_y = 0.5 * (copysign(v, y) + 1.0);
}

/* --- latitude and longitude --- */

/* sin^2 of half the angle between the top edge of the row and +z. */
static double row_sine_squared(uint32_t row, uint32_t height)
{
    float s, c;
    sincos_turns((float)(0.25 * row / height), &s, &c);
    return (double)s * s;
}

static vec3 spherical_direction(const environment *e, uint32_t x, uint32_t y, vec2 within)
{
    /* rows of the lower half from the bottom up, so that both poles are sharp */
    bool is_low = 2 * y >= e->height;
    uint32_t row = is_low ? e->height - 1 - y : y;
    double f = is_low ? 1.0 - (double)within.y : (double)within.y;
    double h0 = row_sine_squared(row, e->height), h = h0 + f * (row_sine_squared(row + 1, e->height) - h0);
    double z = 1.0 - 2.0 * h, across = 2.0 * sqrt(double_max(h * (1.0 - h), 0.0));
    float s, c;
    sincos_turns((float)((x + (double)within.x) / e->width), &s, &c);
    return vec3_make((float)(across * c), (float)(across * s), (float)(is_low ? -z : z));
}

static void spherical_coordinates(vec3 d, double *out_x, double *out_y)
{
    double x = d.x, y = d.y;
    *out_x = angle_turns(y, x);
    *out_y = 2.0 * angle_turns(sqrt(x * x + y * y), (double)d.z);
}

/* --- both --- */

double environment_pixel_solid_angle(const environment *e, uint32_t y)
{
    if (e->mapping == ENVIRONMENT_OCTAHEDRAL)
        return 2.0 * TWO_PI / ((double)e->width * e->height);
    float middle, half, c;
    sincos_turns((float)(0.5 * (y + 0.5) / e->height), &middle, &c);
    sincos_turns((float)(0.25 / e->height), &half, &c);
    return 2.0 * (double)middle * half * TWO_PI / e->width; /* cos a - cos b as a product */
}

static uint32_t cell_of(double coordinate, uint32_t count)
{
    double cell = coordinate * count;
    return cell >= count ? count - 1 : cell > 0.0 ? (uint32_t)cell : 0;
}

static void find_pixel(const environment *e, vec3 direction, double *x, double *y, uint32_t *out_x, uint32_t *out_y)
{
    if (e->mapping == ENVIRONMENT_OCTAHEDRAL)
        octahedral_coordinates(direction, x, y);
    else
        spherical_coordinates(direction, x, y);
    *out_x = cell_of(*x, e->width);
    *out_y = cell_of(*y, e->height);
}

void environment_pixel_at(const environment *e, vec3 direction, uint32_t *out_x, uint32_t *out_y)
{
    double x, y;
    find_pixel(e, direction, &x, &y, out_x, out_y);
}

void environment_uv_at(const environment *e, vec3 direction, uint32_t *out_x, uint32_t *out_y, vec2 *out_within)
{
    double x, y;
    find_pixel(e, direction, &x, &y, out_x, out_y);
    double down = y * e->height - *out_y;
    if (e->mapping == ENVIRONMENT_LATITUDE_LONGITUDE) {
        /* rows of the lower half from the bottom up, as in spherical_direction */
        bool is_low = 2 * *out_y >= e->height;
        uint32_t row = is_low ? e->height - 1 - *out_y : *out_y;
        double h0 = row_sine_squared(row, e->height), h1 = row_sine_squared(row + 1, e->height);
        double cx = direction.x, cy = direction.y, cz = fabs((double)direction.z), across2 = cx * cx + cy * cy;
        bool is_near = (direction.z < 0.0f) == is_low;
        double h = is_near ? 0.5 * across2 / (1.0 + cz) : 0.5 * (1.0 + cz);
        down = (h - h0) / (h1 - h0);
        down = is_low ? 1.0 - down : down;
    }
    double right = x * e->width - *out_x;
    *out_within = (vec2){float_below_one(float_max((float)right, 0.0f)), float_below_one(float_max((float)down, 0.0f))};
}

vec3 environment_direction(const environment *e, uint32_t x, uint32_t y, vec2 within)
{
    if (e->mapping == ENVIRONMENT_OCTAHEDRAL)
        return environment_octahedral_direction((x + (double)within.x) / e->width, (y + (double)within.y) / e->height);
    return spherical_direction(e, x, y, within);
}

ag_status environment_create(environment_mapping mapping, uint32_t width, uint32_t height, rgb *pixels,
                             environment **out_environment)
{
    environment *e = calloc(1, sizeof *e);
    float *weights = malloc((size_t)width * height * sizeof *weights);
    ag_status status = AG_ERROR_MEMORY;
    *out_environment = NULL;
    if (e && weights) {
        *e = (environment){.holder_count = 1, .mapping = mapping, .width = width, .height = height, .pixels = pixels};
        double sum[3] = {0.0, 0.0, 0.0};
        for (uint32_t y = 0; y < height; y++) {
            double solid_angle = environment_pixel_solid_angle(e, y), row[3] = {0.0, 0.0, 0.0};
            for (uint32_t x = 0; x < width; x++) {
                rgb p = pixels[(size_t)y * width + x];
                row[0] += (double)p.r, row[1] += (double)p.g, row[2] += (double)p.b;
                /* by the mean of the channels, as lights are picked; as a share of the sphere: cannot overflow */
                double mean = ((double)p.r + p.g + p.b) / 3.0;
                weights[(size_t)y * width + x] = (float)(mean * solid_angle / (2.0 * TWO_PI));
            }
            for (int i = 0; i < 3; i++)
                sum[i] += row[i] * solid_angle;
        }
        e->integral = rgb_make((float)sum[0], (float)sum[1], (float)sum[2]);
        status = distribution_2d_create(width, height, weights, &e->picks);
        e->picks.values = pixels;
        e->picks.value_bytes = sizeof *pixels;
    }
    free(weights);
    if (status != AG_OK) {
        free(pixels);
        free(e);
        return status;
    }
    *out_environment = e;
    return AG_OK;
}

environment *environment_hold(environment *e)
{
    e->holder_count++;
    return e;
}

void environment_destroy(environment *e)
{
    if (!e || --e->holder_count > 0)
        return;
    free(e->name);
    distribution_2d_reset(&e->picks);
    free(e->pixels);
    free(e);
}

/* --- lights --- */

light_directions light_directions_make(void) { return (light_directions){.world_from_light = frame_identity()}; }

void light_directions_add_hash(const light_directions *d, hash128 *h)
{
    const environment *e = d->picture;
    const bool has_picture = e != NULL;
    HASH128_ADD(h, d->value);
    HASH128_ADD(h, d->world_from_light);
    HASH128_ADD(h, has_picture);
    if (!e)
        return;
    HASH128_ADD(h, e->mapping);
    HASH128_ADD(h, e->width);
    HASH128_ADD(h, e->height);
    hash128_add(h, e->pixels, (size_t)e->width * e->height * sizeof *e->pixels);
}

static float pixel_pdf(const environment *e, float probability, uint32_t y)
{
    return (float)((double)probability / environment_pixel_solid_angle(e, y));
}

rgb environment_whole_radiance(const light_directions *d, vec3 direction)
{
    const environment *e = d->picture;
    uint32_t x, y;
    if (!e)
        return d->value;
    environment_pixel_at(e, frame_to_local(&d->world_from_light, direction), &x, &y);
    return rgb_mul(d->value, e->pixels[(size_t)y * e->width + x]);
}

bool environment_sample_whole(const light_directions *d, vec2 u, vec3 *out_direction, rgb *out_radiance,
                              float *out_pdf_solid_angle)
{
    const environment *e = d->picture;
    if (!e) {
        *out_direction = sample_uniform_sphere(u);
        *out_radiance = d->value;
        *out_pdf_solid_angle = 0.25f * AG_INV_PI;
        return !rgb_is_black(d->value);
    }
    distribution_2d_sample pick;
    if (!distribution_2d_pick(&e->picks, u, &pick))
        return false;
    vec3 direction = environment_direction(e, pick.x, pick.y, pick.within);
    *out_direction = vec3_normalize(frame_to_world(&d->world_from_light, direction));
    *out_radiance = rgb_mul(d->value, e->pixels[(size_t)pick.y * e->width + pick.x]);
    *out_pdf_solid_angle = pixel_pdf(e, pick.probability, pick.y);
    return true;
}

float environment_whole_pdf(const light_directions *d, vec3 direction)
{
    const environment *e = d->picture;
    uint32_t x, y;
    if (!e)
        return 0.25f * AG_INV_PI;
    environment_pixel_at(e, frame_to_local(&d->world_from_light, direction), &x, &y);
    return pixel_pdf(e, distribution_2d_probability(&e->picks, x, y), y);
}

bool environment_sample_whole_numbers(const light_directions *d, vec3 direction, vec2 *out_u)
{
    const environment *e = d->picture;
    if (!e) {
        *out_u = sample_uniform_sphere_inverse(direction);
        return true;
    }
    uint32_t x, y;
    vec2 within;
    environment_uv_at(e, frame_to_local(&d->world_from_light, direction), &x, &y, &within);
    *out_u = distribution_2d_numbers(&e->picks, x, y, within);
    return distribution_2d_probability(&e->picks, x, y) > 0.0f;
}

rgb environment_integral(const light_directions *d)
{
    return d->picture ? rgb_mul(d->value, d->picture->integral) : rgb_scale(d->value, 4.0f * AG_PI);
}

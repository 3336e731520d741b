/* projection.c: see projection.h. */
#include "light/projection.h"

#include <stdlib.h>

static const double PI = 3.14159265358979323846;
/* Directions nearer to the plane at right angles than this carry nothing, as in pbrt-v4. */
static const float NEAR = 1e-3f;
enum { PARTS_ALONG_SIDE = 256 }; /* that solid angles are summed over, at least */

/* Solid angle of a pixel over the area of the picture at z = 1. */
static double pixel_stretch(const projection *p, uint32_t x, uint32_t y)
{
    uint32_t side = p->width < p->height ? p->width : p->height, parts = (PARTS_ALONG_SIDE + side - 1) / side;
    double sum = 0.0;
    for (uint32_t k = 0; k < parts * parts; k++) {
        double a = (2.0 * (x + (k % parts + 0.5) / parts) / p->width - 1.0) * (double)p->reach_x;
        double b = (2.0 * (y + (k / parts + 0.5) / parts) / p->height - 1.0) * (double)p->reach_y;
        double square = 1.0 + a * a + b * b;
        sum += 1.0 / (square * sqrt(square));
    }
    return sum / ((double)parts * parts);
}

static double pixel_area(const projection *p)
{
    return 4.0 * (double)p->reach_x * (double)p->reach_y / ((double)p->width * p->height);
}

ag_status projection_create(uint32_t width, uint32_t height, rgb *pixels, float fov_degrees,
                            projection **out_projection)
{
    projection *p = calloc(1, sizeof *p);
    float *weights = malloc((size_t)width * height * sizeof *weights);
    ag_status status = AG_ERROR_MEMORY;
    *out_projection = NULL;
    if (p && weights) {
        double reach = tan((double)fov_degrees * PI / 360.0), aspect = (double)width / height;
        *p = (projection){.width = width,
                          .height = height,
                          .pixels = pixels,
                          .reach_x = (float)(aspect > 1.0 ? reach * aspect : reach),
                          .reach_y = (float)(aspect > 1.0 ? reach : reach / aspect)};
        double sum[3] = {0.0, 0.0, 0.0}, area = pixel_area(p);
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) {
                rgb c = pixels[(size_t)y * width + x];
                double stretch = pixel_stretch(p, x, y);
                weights[(size_t)y * width + x] = (float)(((double)c.r + c.g + c.b) / 3.0 * stretch);
                sum[0] += (double)c.r * stretch * area;
                sum[1] += (double)c.g * stretch * area;
                sum[2] += (double)c.b * stretch * area;
            }
        p->integral = rgb_make((float)sum[0], (float)sum[1], (float)sum[2]);
        status = distribution_2d_create(width, height, weights, &p->picks);
    }
    free(weights);
    if (status != AG_OK) {
        free(pixels);
        free(p);
        return status;
    }
    *out_projection = p;
    return AG_OK;
}

void projection_destroy(projection *p)
{
    if (!p)
        return;
    distribution_2d_reset(&p->picks);
    free(p->pixels);
    free(p);
}

/* The pixel in a direction, and the place in it, from its top left corner. Returns false outside the pyramid. */
static bool find_pixel(const projection *p, vec3 direction, uint32_t *out_x, uint32_t *out_y, vec2 *out_within)
{
    if (!(direction.z >= NEAR))
        return false;
    float right = direction.x / direction.z / p->reach_x, up = direction.y / direction.z / p->reach_y;
    if (!(fabsf(right) <= 1.0f && fabsf(up) <= 1.0f))
        return false;
    float x = 0.5f * (1.0f + right) * (float)p->width, y = 0.5f * (1.0f - up) * (float)p->height;
    *out_x = (uint32_t)x < p->width ? (uint32_t)x : p->width - 1;
    *out_y = (uint32_t)y < p->height ? (uint32_t)y : p->height - 1;
    *out_within = (vec2){x - (float)*out_x, y - (float)*out_y};
    return true;
}

rgb projection_value(const projection *p, vec3 direction)
{
    uint32_t x, y;
    vec2 within;
    return find_pixel(p, direction, &x, &y, &within) ? p->pixels[(size_t)y * p->width + x] : rgb_gray(0.0f);
}

bool projection_sample_numbers(const projection *p, vec3 direction, vec2 *out_u)
{
    uint32_t x, y;
    vec2 within;
    if (!find_pixel(p, direction, &x, &y, &within))
        return false;
    *out_u = distribution_2d_numbers(&p->picks, x, y, within);
    return distribution_2d_probability(&p->picks, x, y) > 0.0f;
}

bool projection_sample(const projection *p, vec2 u, vec3 *out_direction, rgb *out_value, float *out_pdf_solid_angle)
{
    distribution_2d_sample pick;
    if (!distribution_2d_pick(&p->picks, u, &pick))
        return false;
    float x = (2.0f * ((float)pick.x + pick.within.x) / (float)p->width - 1.0f) * p->reach_x;
    float y = (1.0f - 2.0f * ((float)pick.y + pick.within.y) / (float)p->height) * p->reach_y;
    float square = 1.0f + x * x + y * y, inverse = 1.0f / sqrtf(square);
    *out_direction = vec3_make(x * inverse, y * inverse, inverse);
    *out_value = p->pixels[(size_t)pick.y * p->width + pick.x];
    *out_pdf_solid_angle = (float)((double)pick.probability / pixel_area(p)) * square / inverse;
    return out_direction->z >= NEAR;
}

float projection_corner_cosine(const projection *p)
{
    return 1.0f / sqrtf(1.0f + p->reach_x * p->reach_x + p->reach_y * p->reach_y);
}

/* portal.c: see portal.h. Sums and points on the map are in double precision: windows are differences of sums. */
#include "light/portal.h"

#include "light/environment.h"
#include "light/light_type.h"
#include "math/angle.h"
#include "math/sampling.h"

#include <stdlib.h>

static const double PI = 3.14159265358979323846;
/* The share of the mean of all cells that even a black one keeps, so that no light is missed between the points looked
 * at. */
static const double FLOOR = 0.01;
enum { MAP_SIZE_MIN = 64, MAP_SIZE_MAX = 1024 };

/* Part of the map, in cells. */
typedef struct window {
    double x0, x1, y0, y1;
} window;

/* --- the map: angles from z, towards x and towards y, from -90 degrees to 90 --- */

/* Where on [0, 1] the angle with this tangent is. */
static double coordinate_of(double tangent) { return 0.5 + copysign(2.0 * angle_turns(fabs(tangent), 1.0), tangent); }

static vec3 direction_at(double u, double v)
{
    float sx, cx, sy, cy;
    sincos_turns((float)(0.5 * (u - 0.5)), &sx, &cx);
    sincos_turns((float)(0.5 * (v - 0.5)), &sy, &cy);
    return vec3_normalize(vec3_make(sx * cy, sy * cx, float_max(cx * cy, 1e-12f)));
}

/* Solid angle per area of the map. */
static double stretch_at(vec3 w)
{
    double x = w.x, y = w.y, z = w.z;
    return PI * PI * (x * x + z * z) * (y * y + z * z) / z;
}

static vec3 to_local(const portal *p, vec3 point) { return frame_to_local(&p->axes, vec3_sub(point, p->corner)); }

/* The part of the sky that a point of the room (local, z < 0) sees through the portal. */
static window window_from(const portal *p, vec3 local)
{
    double inverse = 1.0 / -(double)local.z, n = p->size;
    return (window){
        n * coordinate_of(-(double)local.x * inverse), n * coordinate_of(((double)p->width - local.x) * inverse),
        n * coordinate_of(-(double)local.y * inverse), n * coordinate_of(((double)p->height - local.y) * inverse)};
}

/* --- sums --- */

/* The sum up to x cells from the left and y from the top, both within [0, size]. */
static double sum_to(const double *sums, uint32_t size, double x, double y)
{
    uint32_t i = x < size ? (uint32_t)x : size - 1, j = y < size ? (uint32_t)y : size - 1;
    const double *a = sums + (size_t)j * (size + 1) + i, *b = a + size + 1;
    double s = x - i, t = y - j;
    return (a[0] * (1.0 - s) + a[1] * s) * (1.0 - t) + (b[0] * (1.0 - s) + b[1] * s) * t;
}

static double sum_in(const double *sums, uint32_t size, window w)
{
    return sum_to(sums, size, w.x1, w.y1) - sum_to(sums, size, w.x0, w.y1) - sum_to(sums, size, w.x1, w.y0) +
           sum_to(sums, size, w.x0, w.y0);
}

/* Moves the right edge of *w (the lower one where is_y) to where the window holds `wanted`, and gives the cell. */
static uint32_t find_edge(const double *sums, uint32_t size, bool is_y, double wanted, window *w)
{
    double *edge = is_y ? &w->y1 : &w->x1, begin = is_y ? w->y0 : w->x0, end = *edge;
    uint32_t low = (uint32_t)begin, high = end < size ? (uint32_t)end : size - 1;
    while (low < high) { /* the first cell up to whose far side there is as much */
        uint32_t middle = low + (high - low) / 2;
        *edge = double_min(middle + 1.0, end);
        if (sum_in(sums, size, *w) > wanted)
            high = middle;
        else
            low = middle + 1;
    }
    double from = double_max(low, begin), to = double_min(low + 1.0, end);
    *edge = from;
    double before = from > begin ? sum_in(sums, size, *w) : 0.0;
    *edge = to;
    double share = sum_in(sums, size, *w) - before;
    *edge = share > 0.0 ? double_clamp(from + (to - from) * (wanted - before) / share, from, to) : from;
    return low;
}

static double cell_density(const double *sums, uint32_t size, uint32_t i, uint32_t j, double whole)
{
    const double *a = sums + (size_t)j * (size + 1) + i, *b = a + size + 1;
    return ((b[1] - b[0]) - (a[1] - a[0])) / whole * ((double)size * size);
}

/* A direction within the window, and its density. */
static bool sample_window(const double *sums, uint32_t size, window w, vec2 u, vec3 *out_local, float *out_pdf)
{
    double whole = sum_in(sums, size, w);
    if (!(whole > 0.0))
        return false;
    window column = w;
    uint32_t i = find_edge(sums, size, false, (double)u.x * whole, &column);
    double x = column.x1;
    column = (window){double_max(i, w.x0), double_min(i + 1.0, w.x1), w.y0, w.y1};
    uint32_t j = find_edge(sums, size, true, (double)u.y * sum_in(sums, size, column), &column);
    double density = cell_density(sums, size, i, j, whole);
    *out_local = direction_at(x / size, column.y1 / size);
    *out_pdf = (float)(density / stretch_at(*out_local));
    return density > 0.0 && *out_pdf > 0.0f;
}

/* --- making one --- */

bool portal_init(const vec3 corners[4], portal *out_portal)
{
    vec3 edges[4] = {vec3_sub(corners[3], corners[0]), vec3_sub(corners[2], corners[1]),
                     vec3_sub(corners[1], corners[0]), vec3_sub(corners[2], corners[3])};
    float lengths[4];
    for (int i = 0; i < 4; i++) {
        lengths[i] = vec3_length(edges[i]);
        if (!(lengths[i] > 0.0f && isfinite(lengths[i])))
            return false;
        edges[i] = vec3_scale(edges[i], 1.0f / lengths[i]);
    }
    const float tolerance = 1e-3f;
    if (fabsf(vec3_dot(edges[0], edges[1]) - 1.0f) > tolerance ||
        fabsf(vec3_dot(edges[2], edges[3]) - 1.0f) > tolerance || fabsf(vec3_dot(edges[0], edges[2])) > tolerance ||
        fabsf(lengths[0] - lengths[1]) > tolerance * lengths[0] ||
        fabsf(lengths[2] - lengths[3]) > tolerance * lengths[2])
        return false;
    vec3 z = vec3_normalize(vec3_cross(edges[0], edges[2]));
    *out_portal = (portal){.corner = corners[0],
                           .axes = {edges[0], vec3_cross(z, edges[0]), z},
                           .width = lengths[0],
                           .height = lengths[2]};
    return true;
}

static double mean(rgb c) { return ((double)c.r + c.g + c.b) / 3.0; }

/* Radiance at 2 x 2 points of each cell, by the mean of the channels, row by row; NULL when out of memory. */
static float *look_around(const portal *p, const light_directions *sky)
{
    uint32_t count = 2 * p->size;
    float *seen = malloc((size_t)count * count * sizeof *seen);
    for (uint32_t j = 0; seen && j < count; j++)
        for (uint32_t i = 0; i < count; i++) {
            vec3 w = direction_at((i + 0.5) / count, (j + 0.5) / count);
            seen[(size_t)j * count + i] = (float)mean(environment_whole_radiance(sky, frame_to_world(&p->axes, w)));
        }
    return seen;
}

/* A cell's radiance is the mean over its points and the ring around it, so that it knows of bright neighbours whose
 * edge it may share. */
static double cell_radiance(const float *seen, uint32_t size, uint32_t i, uint32_t j)
{
    uint32_t end = 2 * size, x0 = i > 0 ? 2 * i - 1 : 0, y0 = j > 0 ? 2 * j - 1 : 0;
    double sum = 0.0;
    int count = 0;
    for (uint32_t y = y0; y < 2 * j + 3 && y < end; y++)
        for (uint32_t x = x0; x < 2 * i + 3 && x < end; x++, count++)
            sum += (double)seen[(size_t)y * end + x];
    return sum / count;
}

static void add_up(portal *p, const float *seen)
{
    uint32_t n = p->size;
    double total = 0.0, sphere = 0.0;
    for (int pass = 0; pass < 2; pass++) /* first the mean radiance, then the sums */
        for (uint32_t j = 0; j < n; j++) {
            double row_light = 0.0, row_flux = 0.0;
            for (uint32_t i = 0; i < n; i++) {
                vec3 w = direction_at((i + 0.5) / n, (j + 0.5) / n);
                double solid_angle = stretch_at(w) / ((double)n * n), radiance = cell_radiance(seen, n, i, j);
                if (pass == 0) {
                    total += radiance * solid_angle;
                    sphere += solid_angle;
                    continue;
                }
                double weight = (radiance + FLOOR * total / sphere) * solid_angle;
                size_t above = (size_t)j * (n + 1) + i + 1, at = above + n + 1;
                row_light += weight;
                row_flux += weight * (double)w.z;
                p->light[at] = p->light[above] + row_light;
                p->flux[at] = p->flux[above] + row_flux;
            }
        }
}

/* The irradiance on the portal by the picture's own pixels, or by constant radiance pi L. */
static rgb irradiance_on(const portal *p, const light_directions *sky)
{
    const environment *e = sky->picture;
    if (!e)
        return rgb_scale(sky->value, AG_PI);
    uint32_t parts = 256 / e->height + 1;
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t y = 0; y < e->height; y++)
        for (uint32_t x = 0; x < e->width; x++) {
            double cosine = 0.0;
            for (uint32_t k = 0; k < parts * parts; k++) {
                vec2 within = {((float)(k % parts) + 0.5f) / (float)parts, ((float)(k / parts) + 0.5f) / (float)parts};
                vec3 w = frame_to_world(&sky->world_from_light, environment_direction(e, x, y, within));
                cosine += double_max((double)vec3_dot(w, p->axes.z), 0.0);
            }
            cosine *= environment_pixel_solid_angle(e, y) / ((double)parts * parts);
            rgb c = e->pixels[(size_t)y * e->width + x];
            sum[0] += cosine * (double)c.r, sum[1] += cosine * (double)c.g, sum[2] += cosine * (double)c.b;
        }
    return rgb_mul(sky->value, rgb_make((float)sum[0], (float)sum[1], (float)sum[2]));
}

ag_status portal_create(const portal *placed, const light_directions *sky, portal **out_portal)
{
    portal *p = malloc(sizeof *p);
    *out_portal = NULL;
    if (!p)
        return AG_ERROR_MEMORY;
    *p = *placed;
    p->size = sky->picture ? sky->picture->height : MAP_SIZE_MIN;
    p->size = p->size < MAP_SIZE_MIN ? MAP_SIZE_MIN : p->size > MAP_SIZE_MAX ? MAP_SIZE_MAX : p->size;
    size_t count = ((size_t)p->size + 1) * ((size_t)p->size + 1);
    p->light = calloc(count, sizeof *p->light);
    p->flux = calloc(count, sizeof *p->flux);
    float *seen = look_around(p, sky);
    if (!p->light || !p->flux || !seen) {
        free(seen);
        portal_destroy(p);
        return AG_ERROR_MEMORY;
    }
    add_up(p, seen);
    free(seen);
    p->irradiance = irradiance_on(p, sky);
    *out_portal = p;
    return AG_OK;
}

void portal_destroy(portal *p)
{
    if (!p)
        return;
    free(p->light);
    free(p->flux);
    free(p);
}

/* --- asking --- */

bool portal_is_before(const portal *p, vec3 point) { return vec3_dot(vec3_sub(p->corner, point), p->axes.z) > 0.0f; }

bool portal_reaches(const portal *p, vec3 point, vec3 normal)
{
    if (!portal_is_before(p, point))
        return false;
    bool is_in_front = vec3_is_zero(normal);
    for (int k = 0; k < 4 && !is_in_front; k++) {
        vec3 corner = vec3_add_scaled(p->corner, p->axes.x, k & 1 ? p->width : 0.0f);
        vec3 to_corner = vec3_sub(vec3_add_scaled(corner, p->axes.y, k & 2 ? p->height : 0.0f), point);
        is_in_front = vec3_dot(to_corner, normal) > -LIGHT_REACH_SLACK * vec3_length(to_corner);
    }
    return is_in_front;
}

bool portal_is_crossed(const portal *p, vec3 point, vec3 direction)
{
    vec3 from = to_local(p, point), d = frame_to_local(&p->axes, direction);
    if (!(from.z < 0.0f && d.z > 0.0f))
        return false;
    float t = -from.z / d.z, x = from.x + t * d.x, y = from.y + t * d.y;
    return x >= 0.0f && x <= p->width && y >= 0.0f && y <= p->height;
}

bool portal_sample(const portal *p, vec3 point, vec2 u, vec3 *out_direction, float *out_pdf_solid_angle)
{
    vec3 from = to_local(p, point), w;
    if (!(from.z < 0.0f) || !sample_window(p->light, p->size, window_from(p, from), u, &w, out_pdf_solid_angle))
        return false;
    *out_direction = vec3_normalize(frame_to_world(&p->axes, w));
    return true;
}

float portal_pdf(const portal *p, vec3 point, vec3 direction)
{
    if (!portal_is_crossed(p, point, direction))
        return 0.0f;
    vec3 w = frame_to_local(&p->axes, direction);
    uint32_t n = p->size;
    double whole = sum_in(p->light, n, window_from(p, to_local(p, point)));
    double x = n * coordinate_of((double)w.x / w.z), y = n * coordinate_of((double)w.y / w.z);
    uint32_t i = x < n ? (uint32_t)x : n - 1, j = y < n ? (uint32_t)y : n - 1;
    return whole > 0.0 ? (float)(cell_density(p->light, n, i, j, whole) / stretch_at(w)) : 0.0f;
}

/* The tangents from a ball to a portal from 0 to length, `near` and `far` from its plane: the least, then the
 * largest. */
static void tangents_from_ball(double center, double radius, double length, double near, double far, double out[2])
{
    double low = -(center + radius), high = length - (center - radius);
    out[0] = low / (low < 0.0 ? near : far);
    out[1] = high / (high > 0.0 ? near : far);
}

bool portal_sample_flux(const portal *p, const light_target *target, const emission_numbers *numbers,
                        vec3 *out_position, vec3 *out_direction, float *out_pdf)
{
    double n = p->size, along_x[2] = {0.0, 0.0}, along_y[2] = {0.0, 0.0};
    window w = {0.0, n, 0.0, n};
    vec3 center = {0.0f, 0.0f, 0.0f}, d;
    if (target) {
        center = to_local(p, target->center);
        double near = -(double)center.z - target->radius, far = -(double)center.z + target->radius;
        if (near > 0.0) {
            tangents_from_ball(center.x, target->radius, p->width, near, far, along_x);
            tangents_from_ball(center.y, target->radius, p->height, near, far, along_y);
            w = (window){n * coordinate_of(along_x[0]), n * coordinate_of(along_x[1]), n * coordinate_of(along_y[0]),
                         n * coordinate_of(along_y[1])};
        }
    }
    float pdf;
    if (!sample_window(p->flux, p->size, w, numbers->direction, &d, &pdf))
        return false;
    /* all of the portal, or what the ball's shadow covers of it along that direction */
    float x0 = 0.0f, x1 = p->width, y0 = 0.0f, y1 = p->height;
    if (target) {
        float slope_x = d.x / d.z, slope_y = d.y / d.z;
        float x = center.x - slope_x * center.z, reach_x = target->radius * sqrtf(1.0f + slope_x * slope_x);
        float y = center.y - slope_y * center.z, reach_y = target->radius * sqrtf(1.0f + slope_y * slope_y);
        x0 = float_max(x0, x - reach_x), x1 = float_min(x1, x + reach_x);
        y0 = float_max(y0, y - reach_y), y1 = float_min(y1, y + reach_y);
        if (!(x0 < x1 && y0 < y1))
            return false;
    }
    vec2 u = numbers->position;
    vec3 local = {x0 + u.x * (x1 - x0), y0 + u.y * (y1 - y0), 0.0f};
    *out_position = vec3_add(p->corner, frame_to_world(&p->axes, local));
    *out_direction = vec3_normalize(frame_to_world(&p->axes, d));
    *out_pdf = pdf / ((x1 - x0) * (y1 - y0));
    return *out_pdf > 0.0f && isfinite(*out_pdf);
}

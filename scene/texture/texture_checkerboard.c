/* texture_checkerboard.c: see texture_checkerboard.h. In double: positions are large beside the widths of boxes. */
#include "texture/texture_checkerboard.h"

enum { PROBES_IN_PLANE = 16, PROBES_IN_SPACE = 4 }; /* the latter along each axis */

/* Boxes along cells stand for parts that lie askew to them as long as those are no larger, in cells. Others would take
 * cells that go along with one another for independent ones: on a plane x = y all are even, in a box half of them. */
static const float ASKEW_MOST = 0.001f;

/* No conversion to an integer, which large numbers would overflow. */
static bool is_odd(float x)
{
    const float half = 0.5f * x;
    return half - floorf(half) >= 0.5f;
}

bool checkerboard_is_odd(vec3 p) { return is_odd(p.x) != (is_odd(p.y) != is_odd(p.z)); }

/* The integral from 0 to x of 1 in even cells and -1 in odd ones. */
static double wave_integral(double x)
{
    const double in_pair = x - 2.0 * floor(0.5 * x);
    return in_pair < 1.0 ? in_pair : 2.0 - in_pair;
}

/* The mean of 1 in even cells and -1 in odd ones around x. */
static double box_mean(float x, float width)
{
    if (width < 1e-6f)
        return is_odd(x) ? -1.0 : 1.0;
    const double half = 0.5 * (double)width;
    const double mean = (wave_integral((double)x + half) - wave_integral((double)x - half)) / (double)width;
    return double_min(double_max(mean, -1.0), 1.0);
}

static double cells_mean(vec3 p, vec3 widths)
{
    return box_mean(p.x, widths.x) * box_mean(p.y, widths.y) * box_mean(p.z, widths.z);
}

/* The second largest extent of a segment: 0 where it lies along the cells. */
static float askew(vec3 v)
{
    const float x = fabsf(v.x), y = fabsf(v.y), z = fabsf(v.z);
    return float_max(float_min(x, y), float_min(float_max(x, y), z));
}

static bool is_within_cell(float x, float width) { return floorf(x - 0.5f * width) == floorf(x + 0.5f * width); }

/* One axis of the footprint in equal parts. */
typedef struct parts {
    int count;
    vec3 step, width; /* width: of each part; zero where only its middle counts */
} parts;

/* As many as are asked for, up to `most`; of those that lie askew over more than `limit` only the middles count. */
static parts part_axis(vec3 axis, float wanted, int most, float limit)
{
    parts p = {.count = wanted >= (float)most ? most : wanted > 1.0f ? (int)ceilf(wanted) : 1};
    p.step = vec3_scale(axis, 1.0f / (float)p.count);
    p.width = askew(p.step) > limit ? vec3_make(0.0f, 0.0f, 0.0f) : p.step;
    return p;
}

/* A box whose variances are those of a part along each axis. */
static vec3 box_of(vec3 a, vec3 b)
{
    return vec3_make(sqrtf(a.x * a.x + b.x * b.x), sqrtf(a.y * a.y + b.y * b.y), sqrtf(a.z * a.z + b.z * b.z));
}

static double parts_mean(vec3 p, const parts *a, const parts *b)
{
    const vec3 widths = box_of(a->width, b->width);
    double sum = 0.0;
    for (int k = 0; k < a->count; k++)
        for (int l = 0; l < b->count; l++) {
            const float along_a = (float)k - 0.5f * (float)(a->count - 1),
                        along_b = (float)l - 0.5f * (float)(b->count - 1);
            sum += cells_mean(vec3_add_scaled(vec3_add_scaled(p, a->step, along_a), b->step, along_b), widths);
        }
    return sum / (double)(a->count * b->count);
}

/* The principal axes of what two conjugate diameters span, the longer one first. */
static void find_sides(const vec3 axes[2], vec3 out_sides[2])
{
    const float aa = vec3_length_squared(axes[0]), ab = vec3_dot(axes[0], axes[1]), bb = vec3_length_squared(axes[1]);
    const float difference = 0.5f * (aa - bb), root = sqrtf(difference * difference + ab * ab);
    float x = difference > 0.0f ? root + difference : ab, y = difference > 0.0f ? ab : root - difference;
    const float norm = sqrtf(x * x + y * y);
    x = norm > 0.0f ? x / norm : 1.0f;
    y = norm > 0.0f ? y / norm : 0.0f;
    out_sides[0] = vec3_add(vec3_scale(axes[0], x), vec3_scale(axes[1], y));
    out_sides[1] = vec3_sub(vec3_scale(axes[1], x), vec3_scale(axes[0], y));
}

float checkerboard_odd_share(vec3 p, const vec3 axes[2], bool is_solid)
{
    const float extent = vec3_max_abs(axes[0]) + vec3_max_abs(axes[1]);
    if (!(extent < 1e15f))
        return 0.5f;
    if (is_within_cell(p.x, fabsf(axes[0].x) + fabsf(axes[1].x)) &&
        is_within_cell(p.y, fabsf(axes[0].y) + fabsf(axes[1].y)) &&
        is_within_cell(p.z, fabsf(axes[0].z) + fabsf(axes[1].z)))
        return checkerboard_is_odd(p) ? 1.0f : 0.0f;
    vec3 sides[2];
    find_sides(axes, sides);
    parts a, b;
    if (is_solid) {
        a = part_axis(sides[0], askew(sides[0]) / ASKEW_MOST, PROBES_IN_SPACE, ASKEW_MOST);
        b = part_axis(sides[1], askew(sides[1]) / ASKEW_MOST, PROBES_IN_SPACE, ASKEW_MOST);
    } else {
        const float width = vec3_length(sides[1]);
        a = part_axis(sides[0], vec3_length(sides[0]) / float_max(width, 1e-6f), PROBES_IN_PLANE,
                      float_max(width, ASKEW_MOST));
        b = (parts){1, sides[1], sides[1]};
    }
    return (float)(0.5 - 0.5 * parts_mean(p, &a, &b));
}

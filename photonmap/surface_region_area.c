/* surface_region_area.c: the area of a region: each octant's part is a triangle, and beside it what the disc's rim cuts
 * off, and counts for more where the surface bends away from the plane. Threads: pure functions. */
#include "surface_region.h"

static const float SQRT_2 = 1.41421356f;

/* Of the normal's part in the plane, where normals are alike: 1 - PHOTON_ESTIMATE_MIN_COS^2. */
static const float SINE_SQUARED_MOST = 0.36f;

/* A point of an octant as a sum of its two bounds. */
static void split_by_bounds(int octant, const float at[2], float out_parts[2])
{
    float along = at[0] * SURFACE_REGION_BOUND[octant][0] + at[1] * SURFACE_REGION_BOUND[octant][1];
    float across = at[1] * SURFACE_REGION_BOUND[octant][0] - at[0] * SURFACE_REGION_BOUND[octant][1];
    out_parts[0] = along - across;
    out_parts[1] = across * SQRT_2;
}

/* The area of a piece of surface over that of its shadow in the plane, between the centre and a point of an octant: it
 * bends like an arc up to there, and the normal follows the point, as it does on balls and on rods. */
static double area_of_arc(const surface_region *region, int octant, const float at[2])
{
    float parts[2];
    split_by_bounds(octant, at, parts);
    const float *first = region->bend[octant], *second = region->bend[(octant + 1) % SURFACE_REGION_OCTANTS];
    float x = parts[0] * first[0] + parts[1] * second[0], y = parts[0] * first[1] + parts[1] * second[1];
    float cosine = sqrtf(1.0f - float_min(x * x + y * y, SINE_SQUARED_MOST));
    return 2.0 / (1.0 + (double)cosine);
}

/* The area of the disc between two points of its rim, no more than an octant apart. */
static double sector_area(const surface_region *region, int octant, const float from[2], const float to[2],
                          float radius)
{
    float x = (to[0] - from[0]) / radius, y = (to[1] - from[1]) / radius;
    const float middle[2] = {0.5f * (from[0] + to[0]), 0.5f * (from[1] + to[1])};
    double square = (double)x * (double)x + (double)y * (double)y, chord = sqrt(square);
    /* twice the arc sine of half the chord */
    double angle = chord * (1.0 + square * (1.0 / 24.0 + square * (3.0 / 640.0 + square * (5.0 / 7168.0))));
    return 0.5 * angle * (double)radius * (double)radius * area_of_arc(region, octant, middle);
}

/* The mean of area_of_arc over a stretch of an octant's chord: foot + t along, t from begin to end. */
static double mean_area_of_arcs(const surface_region *region, int octant, const float foot[2], const float along[2],
                                float begin, float end)
{
    enum { PARTS = 8 };
    bool is_bent = false;
    for (int i = octant; i < octant + 2; i++) {
        const float *bend = region->bend[i % SURFACE_REGION_OCTANTS];
        is_bent |= bend[0] != 0.0f || bend[1] != 0.0f;
    }
    if (!is_bent)
        return 1.0;
    double mean = 0.0;
    for (int i = 0; i < PARTS; i++) {
        float t = begin + (end - begin) * ((float)i + 0.5f) / (float)PARTS;
        const float at[2] = {foot[0] + along[0] * t, foot[1] + along[1] * t};
        mean += area_of_arc(region, octant, at) / PARTS;
    }
    return mean;
}

/* The area that an octant's chord bounds, within the disc. */
static double octant_area(const surface_region *region, int octant, float radius)
{
    const float *u = SURFACE_REGION_BOUND[octant], *v = SURFACE_REGION_BOUND[(octant + 1) % SURFACE_REGION_OCTANTS];
    float a = region->line[octant][0], b = region->line[octant][1], square = a * a + b * b;
    const double whole = (double)AG_PI / SURFACE_REGION_OCTANTS * (double)radius * (double)radius;
    if (!(square * radius * radius > 1.0f))
        return whole;
    /* along the chord, from its point nearest to the centre: where the bounds meet it, and where the rim does */
    float height = 1.0f / sqrtf(square), along[2] = {-b * height, a * height};
    float rim =
        sqrtf(float_max(radius * radius - height * height, 0.0f)); /* rounded, the height may be above the radius */
    float at_u = a * u[0] + b * u[1], at_v = a * v[0] + b * v[1];
    float begin = at_u > 0.0f ? (along[0] * u[0] + along[1] * u[1]) / at_u : -INFINITY;
    float end = at_v > 0.0f ? (along[0] * v[0] + along[1] * v[1]) / at_v : INFINITY;
    const bool is_cut_first = begin < -rim;
    const bool is_cut_last = rim < end;
    begin = float_max(begin, -rim);
    end = float_min(end, rim);
    if (!(begin < end))
        return whole;
    const float foot[2] = {a * height * height, b * height * height};
    double area =
        0.5 * (double)height * (double)(end - begin) * mean_area_of_arcs(region, octant, foot, along, begin, end);
    if (is_cut_first) {
        const float bound[2] = {u[0] * radius, u[1] * radius};
        const float at[2] = {foot[0] + along[0] * begin, foot[1] + along[1] * begin};
        area += sector_area(region, octant, bound, at, radius);
    }
    if (is_cut_last) {
        const float bound[2] = {v[0] * radius, v[1] * radius};
        const float at[2] = {foot[0] + along[0] * end, foot[1] + along[1] * end};
        area += sector_area(region, octant, at, bound, radius);
    }
    return area;
}

double surface_region_area(const surface_region *region, float radius)
{
    double sum = 0.0;
    for (int i = 0; i < SURFACE_REGION_OCTANTS; i++)
        sum += octant_area(region, i, radius);
    return (double)region->share * sum;
}

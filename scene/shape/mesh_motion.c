/* mesh_motion.c: see mesh_motion.h. Embree takes the same straight steps between the same vertices, so that what is
 * recomputed here lies where rays meet it, within the rounding that epsilon allows for. */
#include "shape/mesh_motion.h"

/* The two sets of vertices around a time, and how much of the way from the first to the second is done. */
typedef struct moment {
    size_t before, after; /* the index of each set's first value */
    float share;
} moment;

static moment moment_of(const mesh *m, float time)
{
    const float at = time * (float)m->motion_segments,
                step = float_max(float_min(floorf(at), (float)(m->motion_segments - 1)), 0.0f);
    const size_t before = (size_t)step * m->vertex_count;
    return (moment){before, before + m->vertex_count, at - step};
}

corner_values mesh_moving_values(const mesh *m, const vec3 *values, uint32_t triangle, float time)
{
    const moment now = moment_of(m, time);
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    corner_values c;
    for (int k = 0; k < 3; k++)
        c.at[k] = vec3_add_scaled(vec3_scale(values[now.before + index[k]], 1.0f - now.share),
                                  values[now.after + index[k]], now.share);
    return c;
}

corner_values mesh_moving_normals(const mesh *m, uint32_t triangle, float time)
{
    corner_values c = mesh_moving_values(m, m->normals, triangle, time);
    for (int k = 0; k < 3; k++) {
        const float square = vec3_length_squared(c.at[k]);
        c.at[k] = square > 0.0f ? vec3_scale(c.at[k], 1.0f / sqrtf(square)) : (vec3){0.0f, 0.0f, 0.0f};
    }
    return c;
}

float mesh_moving_reach(const mesh *m, uint32_t triangle, float time)
{
    const moment now = moment_of(m, time);
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    float reach = 0.0f;
    for (int k = 0; k < 3; k++)
        reach = float_max(reach, float_max(vec3_max_abs(m->positions[now.before + index[k]]),
                                           vec3_max_abs(m->positions[now.after + index[k]])));
    return reach;
}

/* Subtracts in double precision: in float a triangle that is a few thousand times as long as it is wide loses
 * its area. */
static void subtract(vec3 a, vec3 b, double out[3])
{
    out[0] = (double)a.x - b.x, out[1] = (double)a.y - b.y, out[2] = (double)a.z - b.z;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Computes twice the area as a vector along the triangle's normal. */
static void find_area(const corner_values *c, double out_area[3])
{
    double e1[3], e2[3];
    subtract(c->at[1], c->at[0], e1);
    subtract(c->at[2], c->at[0], e2);
    cross(e1, e2, out_area);
}

void find_barycentrics(const corner_values *positions, vec3 point, double *out_b1, double *out_b2)
{
    double e1[3], e2[3], from_p0[3], area[3], beside_e2[3], beside_e1[3];
    subtract(positions->at[1], positions->at[0], e1);
    subtract(positions->at[2], positions->at[0], e2);
    subtract(point, positions->at[0], from_p0);
    cross(e1, e2, area);
    cross(from_p0, e2, beside_e2);
    cross(e1, from_p0, beside_e1);
    const double square = dot(area, area);
    *out_b1 = square > 0.0 ? dot(beside_e2, area) / square : 0.0;
    *out_b2 = square > 0.0 ? dot(beside_e1, area) / square : 0.0;
}

void mesh_move_to_opening(const mesh *m, uint32_t triangle, float time, vec3 *in_out_point, double in_out_area[3])
{
    const corner_values now = mesh_moving_values(m, m->positions, triangle, time),
                        opening = mesh_moving_values(m, m->positions, triangle, 0.0f);
    double b1, b2, area_now[3], area_then[3];
    find_barycentrics(&now, *in_out_point, &b1, &b2);
    b1 = double_clamp(b1, 0.0, 1.0); /* rounded, it may lie beside the triangle */
    b2 = double_clamp(b2, 0.0, 1.0 - b1);
    *in_out_point =
        vec3_add_scaled(vec3_add_scaled(vec3_scale(opening.at[0], (float)(1.0 - b1 - b2)), opening.at[1], (float)b1),
                        opening.at[2], (float)b2);
    find_area(&now, area_now);
    find_area(&opening, area_then);
    const double square = dot(area_now, area_now);
    double scale = square > 0.0 ? sqrt(dot(in_out_area, in_out_area) / square) : 0.0;
    if (dot(in_out_area, area_now) < 0.0)
        scale = -scale;
    for (int i = 0; i < 3; i++)
        in_out_area[i] = scale * area_then[i];
}

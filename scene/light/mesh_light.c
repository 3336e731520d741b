/* mesh_light.c: see mesh_light.h. */
#include "light/mesh_light.h"

#include "math/sampling.h"
#include "math/spherical_triangle.h"

/* Meshes of more triangles are not looked at whole for each sample. */
enum { WHOLE_MAX = 16 };

/* Below the first, where formulas cost more than they bring, and above the second, where nearly half of all directions
 * meet the triangle and the formulas lose their precision, points of a triangle are uniform in area. */
static const double TURNS_LEAST = 1e-5, TURNS_MOST = 0.98;
static const double TWO_PI = 6.283185307179586477;

static void see_triangle(const mesh *m, uint32_t triangle, vec3 point, spherical_triangle *out)
{
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    spherical_triangle_see(point, m->positions[index[0]], m->positions[index[1]], m->positions[index[2]], out);
}

/* Returns the solid angle over 2 pi of what may shine towards the point. Where vertex normals decide which side
 * shines, both are taken for it. */
static double shining_turns(const shape *lamp, bool is_two_sided, const spherical_triangle *t)
{
    bool is_dark = !is_two_sided && !lamp->as.mesh.normals && t->is_from_back != lamp->flip_normal;
    return is_dark ? 0.0 : t->turns;
}

static mesh_light_density density_within(const spherical_triangle *t, double probability)
{
    if (t->turns >= TURNS_LEAST && t->turns <= TURNS_MOST)
        return (mesh_light_density){probability / (TWO_PI * t->turns), false};
    double area = spherical_triangle_area(t);
    return (mesh_light_density){area > 0.0 ? probability / area : 0.0, true};
}

bool mesh_light_sample(const shape *lamp, bool is_two_sided, vec3 point, vec2 u, surface_sample *out_sample,
                       mesh_light_density *out_density)
{
    const mesh *m = &lamp->as.mesh;
    uint32_t picked = 0;
    double probability;
    spherical_triangle t;
    if (m->triangle_count <= WHOLE_MAX) {
        spherical_triangle all[WHOLE_MAX];
        double turns[WHOLE_MAX], sum = 0.0;
        for (uint32_t i = 0; i < m->triangle_count; i++) {
            see_triangle(m, i, point, &all[i]);
            sum += turns[i] = shining_turns(lamp, is_two_sided, &all[i]);
        }
        if (!(sum > 0.0))
            return false;
        double left = (double)u.x * sum;
        for (uint32_t i = 0; i < m->triangle_count; i++) {
            if (!(turns[i] > 0.0))
                continue;
            picked = i;
            if (left < turns[i])
                break;
            left -= turns[i];
        }
        t = all[picked];
        u.x = float_below_one((float)double_min(left / turns[picked], 1.0));
        probability = turns[picked] / sum;
    } else {
        picked = shape_pick_triangle(lamp, &u.x);
        see_triangle(m, picked, point, &t);
        probability = (double)mesh_area_share(m, picked);
    }
    *out_density = density_within(&t, probability);
    if (!(out_density->value > 0.0))
        return false;
    *out_sample = shape_sample_triangle(
        lamp, picked, out_density->is_by_area ? sample_triangle(u) : spherical_triangle_sample(&t, u));
    return true;
}

mesh_light_density mesh_light_density_of(const shape *lamp, bool is_two_sided, vec3 point, uint32_t triangle)
{
    const mesh *m = &lamp->as.mesh;
    spherical_triangle t, other;
    see_triangle(m, triangle, point, &t);
    if (m->triangle_count > WHOLE_MAX)
        return density_within(&t, (double)mesh_area_share(m, triangle));
    double sum = 0.0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        see_triangle(m, i, point, &other);
        sum += shining_turns(lamp, is_two_sided, &other);
    }
    double turns = shining_turns(lamp, is_two_sided, &t);
    return turns > 0.0 ? density_within(&t, turns / sum) : (mesh_light_density){0.0, true};
}

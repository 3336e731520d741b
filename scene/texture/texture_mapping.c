/* texture_mapping.c: see texture_mapping.h. Threads: pure functions. */
#include "texture/texture_mapping.h"

#include "math/angle.h"

void texture_mapping_set_space(texture_mapping *m, const transform *world_from_texture)
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            m->texture_from_world[row][column] = (float)world_from_texture->inverse[row][column];
}

vec3 texture_mapping_point(const texture_mapping *m, vec3 p)
{
    float out[3];
    for (int row = 0; row < 3; row++) {
        const float *a = m->texture_from_world[row];
        out[row] = a[0] * p.x + a[1] * p.y + a[2] * p.z + a[3];
    }
    return vec3_make(out[0], out[1], out[2]);
}

vec3 texture_mapping_point_step(const texture_mapping *m, vec3 position_step)
{
    const vec3 from = texture_mapping_point(m, vec3_make(0.0f, 0.0f, 0.0f));
    return vec3_sub(texture_mapping_point(m, position_step), from);
}

vec2 texture_mapping_st(const texture_mapping *m, vec2 uv, vec3 position)
{
    if (m->kind == TEXTURE_MAPPING_UV)
        return (vec2){m->scale.x * uv.x + m->delta.x, m->scale.y * uv.y + m->delta.y};
    if (m->kind == TEXTURE_MAPPING_UV_AFFINE)
        return (vec2){m->axes[0].x * uv.x + m->axes[0].y * uv.y + m->delta.x,
                      m->axes[1].x * uv.x + m->axes[1].y * uv.y + m->delta.y};
    vec3 p = texture_mapping_point(m, position);
    if (m->kind == TEXTURE_MAPPING_PLANAR)
        return (vec2){vec3_dot(p, m->axes[0]) + m->delta.x, vec3_dot(p, m->axes[1]) + m->delta.y};
    double x = (double)p.x, y = (double)p.y, round_z = angle_turns(y, x);
    if (m->kind == TEXTURE_MAPPING_CYLINDRICAL)
        return (vec2){(float)(round_z <= 0.5 ? round_z + 0.5 : round_z - 0.5), p.z};
    return (vec2){(float)(2.0 * angle_turns(sqrt(x * x + y * y), (double)p.z)), (float)round_z};
}

/* Across the seam of what goes round once in 1. */
static float shorter_way(float turn) { return turn - floorf(turn + 0.5f); }

vec2 texture_mapping_step(const texture_mapping *m, vec2 uv, vec3 position, vec2 uv_step, vec3 position_step)
{
    if (m->kind == TEXTURE_MAPPING_UV)
        return (vec2){m->scale.x * uv_step.x, m->scale.y * uv_step.y};
    if (m->kind == TEXTURE_MAPPING_UV_AFFINE)
        return (vec2){m->axes[0].x * uv_step.x + m->axes[0].y * uv_step.y,
                      m->axes[1].x * uv_step.x + m->axes[1].y * uv_step.y};
    if (m->kind == TEXTURE_MAPPING_PLANAR) {
        vec3 step = texture_mapping_point_step(m, position_step);
        return (vec2){vec3_dot(step, m->axes[0]), vec3_dot(step, m->axes[1])};
    }
    vec2 here = texture_mapping_st(m, uv, position),
         there = texture_mapping_st(m, uv, vec3_add(position, position_step));
    vec2 step = {there.x - here.x, there.y - here.y};
    if (m->kind == TEXTURE_MAPPING_CYLINDRICAL)
        step.x = shorter_way(step.x);
    else
        step.y = shorter_way(step.y);
    return step;
}

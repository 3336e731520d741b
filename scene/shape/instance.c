/* instance.c: see instance.h. Plain IEEE steps; Embree takes the same straight steps between the same matrices, so that
 * what is recomputed here lies where rays meet it, within the rounding that epsilon allows for.
 * Threads: read-only. */
#include "shape/instance.h"

#include "scene.h"
#include "shape/mesh_motion.h"

/* The error of the traversal's transform into the object's space and back, relative to all that is summed there. */
#define FLAT_EPSILON_RELATIVE  0x1p-19f
#define ROUND_EPSILON_RELATIVE 0x1p-19f

affine instance_at(const scene *s, uint32_t instance_index, float time)
{
    const scene_instance *i = &s->instances[instance_index];
    const affine *steps = s->instance_steps + i->first_step;
    if (i->step_count == 1)
        return steps[0];
    float at = time * (float)(i->step_count - 1), step = float_min(floorf(at), (float)(i->step_count - 2));
    return affine_lerp(&steps[(uint32_t)step], &steps[(uint32_t)step + 1], at - step);
}

vec3 instance_point_in_object(const affine *world_from_object, const double world[3])
{
    double c[3][3], determinant = affine_determinant(world_from_object), from[3], p[3];
    affine_cofactors(world_from_object, c);
    for (int i = 0; i < 3; i++)
        from[i] = world[i] - (double)world_from_object->m[i][3];
    for (int i = 0; i < 3; i++)
        p[i] = (c[0][i] * from[0] + c[1][i] * from[1] + c[2][i] * from[2]) / determinant;
    return (vec3){(float)p[0], (float)p[1], (float)p[2]};
}

vec3 instance_direction_in_object(const affine *world_from_object, vec3 direction)
{
    double c[3][3], determinant = affine_determinant(world_from_object), d[3];
    affine_cofactors(world_from_object, c);
    for (int i = 0; i < 3; i++)
        d[i] = (c[0][i] * (double)direction.x + c[1][i] * (double)direction.y + c[2][i] * (double)direction.z) /
               determinant;
    return (vec3){(float)d[0], (float)d[1], (float)d[2]};
}

static vec3 normal_to_world(const double cofactors[3][3], double sign, vec3 n)
{
    double w[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        w[i] = cofactors[i][0] * (double)n.x + cofactors[i][1] * (double)n.y + cofactors[i][2] * (double)n.z;
        square += w[i] * w[i];
    }
    double inverse = sign / sqrt(square);
    return (vec3){(float)(w[0] * inverse), (float)(w[1] * inverse), (float)(w[2] * inverse)};
}

/* Two roundings add up: that of a ray's origin in the world's coordinates, and that of its transform into the object's
 * space, where the sums are as large as the translation. The map scales the second on the way back. */
static float epsilon_in_world(const affine *a, const double cofactors[3][3], double determinant, vec3 world,
                              float object_epsilon, float relative)
{
    double from[3] = {fabs((double)world.x) + fabs((double)a->m[0][3]),
                      fabs((double)world.y) + fabs((double)a->m[1][3]),
                      fabs((double)world.z) + fabs((double)a->m[2][3])};
    double lost[3], largest = 0.0;
    for (int i = 0; i < 3; i++)
        lost[i] = (double)object_epsilon + (double)relative *
                                               (fabs(cofactors[0][i]) * from[0] + fabs(cofactors[1][i]) * from[1] +
                                                fabs(cofactors[2][i]) * from[2]) /
                                               fabs(determinant);
    for (int i = 0; i < 3; i++)
        largest =
            double_max(largest, fabs((double)a->m[i][0]) * lost[0] + fabs((double)a->m[i][1]) * lost[1] +
                                    fabs((double)a->m[i][2]) * lost[2] + (double)relative * fabs((double)a->m[i][3]));
    return (float)largest;
}

void instance_transform_hit(const affine *world_from_object, surface_hit *in_out_hit)
{
    surface_hit *h = in_out_hit;
    double cofactors[3][3], determinant = affine_determinant(world_from_object);
    affine_cofactors(world_from_object, cofactors);
    const double(*c)[3] = (const double(*)[3])cofactors;
    double sign = determinant < 0.0 ? -1.0 : 1.0; /* a map that mirrors keeps outside and inside */
    h->is_mirrored = h->is_mirrored != (determinant < 0.0);
    h->position = affine_point(world_from_object, h->position);
    h->shading_normal = normal_to_world(c, sign, h->shading_normal);
    h->geometric_normal = vec3_face_forward(normal_to_world(c, sign, h->geometric_normal), h->shading_normal);
    h->epsilon = epsilon_in_world(world_from_object, c, determinant, h->position, h->epsilon,
                                  h->is_flat ? FLAT_EPSILON_RELATIVE : ROUND_EPSILON_RELATIVE);
}

/* A normal is transformed back by the transpose of the matrix. */
static vec3 normal_in_object(const affine *a, vec3 n)
{
    double o[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        o[i] = (double)a->m[0][i] * (double)n.x + (double)a->m[1][i] * (double)n.y + (double)a->m[2][i] * (double)n.z;
        square += o[i] * o[i];
    }
    double inverse = 1.0 / sqrt(square);
    return (vec3){(float)(o[0] * inverse), (float)(o[1] * inverse), (float)(o[2] * inverse)};
}

surface_hit instance_hit_in_object(const scene *s, const surface_hit *hit)
{
    surface_hit h = *hit;
    if (hit->instance_index == SCENE_NO_INSTANCE)
        return h;
    affine world_from_object = instance_at(s, hit->instance_index, hit->time);
    const double world[3] = {(double)hit->position.x, (double)hit->position.y, (double)hit->position.z};
    h.position = instance_point_in_object(&world_from_object, world);
    h.geometric_normal = normal_in_object(&world_from_object, hit->geometric_normal);
    h.shading_normal = normal_in_object(&world_from_object, hit->shading_normal);
    h.instance_index = SCENE_NO_INSTANCE;
    h.is_mirrored = hit->is_mirrored != (affine_determinant(&world_from_object) < 0.0);
    return h;
}

static const affine IDENTITY = {{{1.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f, 0.0f}}};

surface_rest surface_at_opening(const scene *s, const surface_hit *hit)
{
    surface_rest rest = {hit->position, hit->geometric_normal, 1.0f};
    if (!s->has_motion)
        return rest;
    const shape *at = &s->shapes[hit->shape_index];
    const bool is_placed = hit->instance_index != SCENE_NO_INSTANCE;
    const bool is_moving = is_placed && s->instances[hit->instance_index].step_count > 1;
    if (!is_moving && !shape_is_deforming(at))
        return rest;

    /* the normal, as an area of 1, goes back into the object as it came, there with the surface, and out again by the
     * cofactors */
    affine now = IDENTITY, opening = IDENTITY;
    if (is_placed) {
        now = instance_at(s, hit->instance_index, hit->time);
        opening = instance_at(s, hit->instance_index, 0.0f);
    }
    const double world[3] = {(double)hit->position.x, (double)hit->position.y, (double)hit->position.z};
    vec3 position = is_placed ? instance_point_in_object(&now, world) : hit->position;
    double c[3][3], determinant = affine_determinant(&now);
    vec3 n = hit->geometric_normal;
    const double normal[3] = {(double)n.x, (double)n.y, (double)n.z};
    double object[3], placed[3], before = 0.0, after = 0.0;
    for (int i = 0; i < 3; i++) {
        object[i] = 0.0;
        for (int j = 0; j < 3; j++)
            object[i] += (double)now.m[j][i] * normal[j] / determinant;
    }
    if (shape_is_deforming(at))
        mesh_move_to_opening(&at->as.mesh, hit->primitive_index, hit->time, &position, object);
    affine_cofactors(&opening, c);
    for (int i = 0; i < 3; i++) {
        placed[i] = c[i][0] * object[0] + c[i][1] * object[1] + c[i][2] * object[2];
        before += normal[i] * normal[i];
        after += placed[i] * placed[i];
    }
    rest.position = is_placed ? affine_point(&opening, position) : position;
    rest.area_ratio = (float)sqrt(after / before);
    if (!(after > 0.0))
        return rest; /* no area: any normal will do */
    double inverse = 1.0 / sqrt(after);
    rest.geometric_normal =
        (vec3){(float)(placed[0] * inverse), (float)(placed[1] * inverse), (float)(placed[2] * inverse)};
    return rest;
}

/* scene_hash.c: see scene_hash.h. Field by field, for what lies between the fields of a struct is anything. What
 * scene_commit works out of the rest is left out. tests/scene/test_scene_hash.c finds the field that was forgotten. */
#include "scene_hash.h"

#include "light/light_type.h"
#include "scene.h"
#include "shape/curves.h"
#include "shape/mesh_motion.h"

#include <string.h>

#define ADD(value) HASH128_ADD(h, value)

static void add_array(hash128 *h, const void *items, size_t count, size_t item_size)
{
    ADD(count);
    hash128_add(h, items, items ? count * item_size : 0);
}

/* --- materials --- */

static void add_image(hash128 *h, const texture_image *i)
{
    ADD(i->width);
    ADD(i->height);
    ADD(i->channel_count);
    const hash128 content = texture_image_content(i);
    ADD(content);
    hash128_add_text(h, i->colors.space);
    ADD(i->colors.has_matrix);
    if (i->colors.has_matrix)
        ADD(i->colors.matrix);
}

static void add_texture(hash128 *h, const texture *t)
{
    ADD(t->kind);
    ADD(t->is_spectrum);
    ADD(t->mapping);
    ADD(t->inputs);
    ADD(t->direction);
    ADD(t->image_index);
    ADD(t->channel);
    ADD(t->wraps);
    ADD(t->filter);
    ADD(t->is_data);
    ADD(t->invert);
    ADD(t->scale);
    ADD(t->octaves);
    ADD(t->roughness);
    ADD(t->variation);
    ADD(t->cost);
    ADD(t->step);
    ADD(t->has_pictures);
    ADD(t->is_linear_in_pictures);
    ADD(t->most);
}

/* Of what the file says, all that differs from the default, each with its name. */
static void add_material(hash128 *h, const material *m)
{
    material unsaid;
    const int form = MATERIAL_HASH_FORM;
    ADD(form);
    ADD(m->kind);
    ADD(m->mixed);
#define ADD_VALUE(type, name, otherwise)                                                                               \
    unsaid.name = (otherwise);                                                                                         \
    if (memcmp(&m->name, &unsaid.name, sizeof m->name) != 0) {                                                         \
        hash128_add_text(h, #name);                                                                                    \
        ADD(m->name);                                                                                                  \
    }
    MATERIAL_VALUE_LIST(ADD_VALUE)
#undef ADD_VALUE
#define ADD_TEXTURE(name)                                                                                              \
    if (m->name != SCENE_NO_TEXTURE) {                                                                                 \
        hash128_add_text(h, #name);                                                                                    \
        ADD(m->name);                                                                                                  \
    }
    MATERIAL_TEXTURE_LIST(ADD_TEXTURE)
#undef ADD_TEXTURE
}

/* --- shapes --- */

static void add_mesh(hash128 *h, const mesh *m)
{
    add_array(h, m->positions, mesh_value_count(m), sizeof *m->positions);
    add_array(h, m->normals, mesh_value_count(m), sizeof *m->normals);
    add_array(h, m->uvs, m->vertex_count, sizeof *m->uvs);
    add_array(h, m->tangents, mesh_value_count(m), sizeof *m->tangents);
    if (m->motion_segments > 0) /* maps of scenes without motion, that were kept before there was any, stay valid */
        ADD(m->motion_segments);
    add_array(h, m->indices, (size_t)m->triangle_count * 3, sizeof *m->indices);
}

static void add_quadric(hash128 *h, const quadric *q)
{
    ADD(q->world_from_object);
    ADD(q->radius);
    ADD(q->inner_radius);
    ADD(q->height);
    ADD(q->z_min);
    ADD(q->z_max);
    ADD(q->turn);
}

static void add_curves(hash128 *h, const curves *c)
{
    const size_t points = curves_points_of_each(c) * c->segment_count;
    ADD(c->type);
    add_array(h, c->points, points, sizeof *c->points);
    add_array(h, c->normals, points, sizeof *c->normals);
    if (c->motion_segments > 0) /* as of meshes */
        ADD(c->motion_segments);
    add_array(h, c->spans, c->segment_count, sizeof *c->spans);
}

static void add_shape(hash128 *h, const shape *s)
{
    ADD(s->kind);
    ADD(s->flip_normal);
    ADD(s->has_medium_interface);
    ADD(s->medium_inside);
    ADD(s->medium_outside);
    ADD(s->material_index);
    ADD(s->light_index);
    ADD(s->alpha);
    ADD(s->alpha_texture);
    ADD(s->alpha_cutoff);
    ADD(s->object_index);
    switch (s->kind) {
    case SHAPE_MESH: add_mesh(h, &s->as.mesh); break;
    case SHAPE_SPHERE:
    case SHAPE_CYLINDER:
    case SHAPE_DISK: add_quadric(h, &s->as.quadric); break;
    case SHAPE_CURVES: add_curves(h, &s->as.curves); break;
    }
}

static void add_instance(hash128 *h, const scene_instance *i)
{
    ADD(i->object_index);
    ADD(i->first_step);
    ADD(i->step_count);
}

/* --- light --- */

static void add_light(hash128 *h, const light *l)
{
    ADD(l->kind);
    ADD(l->photons);
    ADD(l->medium);
    light_type_of(l->kind)->add_hash(l, h);
}

hash128 scene_hash_of_light(const scene *s)
{
    hash128 begun = hash128_begin(), *h = &begun;
    ADD(s->space.primaries); /* of the working space, which all colours are of */
    ADD(s->space.white);
    ADD(s->textures.image_count);
    for (uint32_t i = 0; i < s->textures.image_count; i++)
        add_image(h, s->textures.images[i]);
    ADD(s->textures.count);
    for (uint32_t i = 0; i < s->textures.count; i++)
        add_texture(h, &s->textures.items[i]);
    ADD(s->material_count);
    for (uint32_t i = 0; i < s->material_count; i++)
        add_material(h, &s->materials[i]);
    ADD(s->medium_count);
    for (uint32_t i = 0; i < s->medium_count; i++)
        medium_add_hash(&s->media[i], h);
    ADD(s->shape_count);
    for (uint32_t i = 0; i < s->shape_count; i++)
        add_shape(h, &s->shapes[i]);
    ADD(s->object_count);
    ADD(s->instance_count);
    for (uint32_t i = 0; i < s->instance_count; i++)
        add_instance(h, &s->instances[i]);
    add_array(h, s->instance_steps, s->instance_step_count, sizeof *s->instance_steps);
    ADD(s->light_count);
    for (uint32_t i = 0; i < s->light_count; i++)
        add_light(h, &s->lights[i]);
    ADD(s->has_motion);          /* photons then have times, by a random number */
    if (s->has_scattering_media) /* also where only the eye is in one: photons then draw numbers for their flights */
        ADD(s->has_scattering_media);
    if (s->has_glued_faces) /* maps of before there was a rule for these do not fit */
        hash128_add_text(h, "glued");
    return begun;
}

/* --- forms --- */

hash128 scene_hash_of_form(const scene *s, uint32_t shape_index)
{
    hash128 begun = hash128_begin(), *h = &begun;
    shape item = s->shapes[shape_index];
    item.has_medium_interface = false;
    item.medium_inside = item.medium_outside = SCENE_NO_MEDIUM;
    item.object_index = SCENE_NO_OBJECT;
    /* rays pass interfaces, but no lamp */
    item.light_index = s->has_interfaces && item.light_index != SHAPE_NO_LIGHT ? 0 : SHAPE_NO_LIGHT;
    if (!s->has_interfaces)
        item.material_index = 0;
    add_shape(h, &item);
    if (s->has_glued_faces) { /* which of two faces is met follows from both */
        ADD(item.role);
        ADD(item.is_glued);
    }
    return begun;
}

hash128 scene_hash_of_passed_surfaces(const scene *s)
{
    hash128 begun = hash128_begin(), *h = &begun;
    bool has_alpha = false;
    for (uint32_t i = 0; i < s->shape_count; i++)
        has_alpha = has_alpha || s->shapes[i].alpha_texture != SCENE_NO_TEXTURE;
    ADD(s->has_interfaces);
    ADD(has_alpha);
    for (uint32_t i = 0; (has_alpha || s->has_interfaces) && i < s->textures.image_count; i++)
        add_image(h, s->textures.images[i]);
    for (uint32_t i = 0; (has_alpha || s->has_interfaces) && i < s->textures.count; i++)
        add_texture(h, &s->textures.items[i]);
    for (uint32_t i = 0; s->has_interfaces && i < s->material_count; i++)
        add_material(h, &s->materials[i]);
    if (s->has_glued_faces)
        hash128_add_text(h, "glued");
    return begun;
}

/* --- the eye --- */

static void add_camera(hash128 *h, const camera *c)
{
    ADD(c->kind);
    ADD(c->world_from_camera);
    ADD(c->is_moving);
    if (c->is_moving)
        ADD(c->motion);
    ADD(c->shutter_open);
    ADD(c->shutter_close);
    ADD(c->fov_degrees);
    ADD(c->frame_aspect_ratio);
    ADD(c->has_screen_window);
    if (c->has_screen_window)
        ADD(c->screen_window);
    ADD(c->screen_shift);
    ADD(c->lens_radius);
    ADD(c->focal_distance);
    ADD(c->exposure);
    ADD(c->medium);
}

hash128 scene_hash_of_view(const scene *s)
{
    hash128 begun = hash128_begin(), *h = &begun;
    ADD(s->has_camera);
    add_camera(h, &s->camera);
    ADD(s->hints.disable_pixel_jitter);
    ADD(s->light_group_count);
    for (uint32_t i = 0; i < s->light_group_count; i++)
        hash128_add_text(h, s->light_group_names[i]);
    for (uint32_t i = 0; i < s->light_count; i++)
        ADD(s->lights[i].group);
    const uint32_t counts[SCENE_NAMED_COUNT] = {
        [NAMED_MATERIAL] = s->material_count, [NAMED_SHAPE] = s->shape_count, [NAMED_OBJECT] = s->object_count};
    for (int kind = 0; kind < SCENE_NAMED_COUNT; kind++)
        for (uint32_t i = 0; i < counts[kind]; i++)
            hash128_add_text(h, scene_name(s, (scene_named)kind, i));
    return begun;
}

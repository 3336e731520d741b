/* pbrt_undo.c: see pbrt_private.h. A file ends with its first error; of calls others may follow one that failed, and
 * what that had added by then is taken back. Objects, materials and media that it named stay, empty and unused. Flow:
 * pbrt_builder -> [here] -> scene. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <stdlib.h>

static bool is_used(const pbrt_parser *parser, size_t named)
{
    return named != PBRT_NO_MEDIUM && parser->named_media[named].is_used;
}

pbrt_mark pbrt_set_mark(const pbrt_parser *parser)
{
    const scene *s = parser->scene;
    const pbrt_object *o = parser->open_object;
    const pbrt_state *state = &parser->state;
    return (pbrt_mark){
        .shape_count = s->shape_count,
        .light_count = s->light_count,
        .instance_count = s->instance_count,
        .instance_step_count = s->instance_step_count,
        .camera_medium = s->camera_medium,
        .camera = s->camera,
        .has_camera = s->has_camera,
        .film_distance = parser->film_distance,
        .lamp_copy_count = parser->lamp_copy_count,
        .lamp_copy_vertex_count = parser->lamp_copy_vertex_count,
        .lamp_count = o ? o->lamp_count : 0,
        .part_count = o ? o->part_count : 0,
        .media = {state->medium_inside, state->medium_outside},
        .are_media_used = {is_used(parser, state->medium_inside), is_used(parser, state->medium_outside)}};
}

void pbrt_go_back(pbrt_parser *parser, const pbrt_mark *mark)
{
    scene *s = parser->scene;
    pbrt_object *o = parser->open_object;
    while (s->shape_count > mark->shape_count)
        shape_reset(&s->shapes[--s->shape_count]);
    while (s->light_count > mark->light_count)
        light_reset(&s->lights[--s->light_count]);
    while (o && o->lamp_count > mark->lamp_count)
        shape_reset(&o->lamps[--o->lamp_count].shape);
    while (o && o->part_count > mark->part_count)
        free(o->parts[--o->part_count].object_from_part.segments);
    s->instance_count = mark->instance_count;
    s->instance_step_count = mark->instance_step_count;
    s->camera = mark->camera;
    s->camera_medium = mark->camera_medium;
    s->has_camera = mark->has_camera;
    parser->film_distance = mark->film_distance;
    parser->lamp_copy_count = mark->lamp_copy_count;
    parser->lamp_copy_vertex_count = mark->lamp_copy_vertex_count;
    parser->curves_object_index = SCENE_NO_OBJECT; /* it may have no instance */
    for (int i = 0; i < 2; i++)
        if (mark->media[i] != PBRT_NO_MEDIUM)
            parser->named_media[mark->media[i]].is_used = mark->are_media_used[i];
}

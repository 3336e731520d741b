/* scene_forms.c: see scene_forms.h. */
#include "scene_forms.h"

#include "scene_extent.h"
#include "scene_hash.h"

#include <stdlib.h>
#include <string.h>

static int compare_forms(const void *a, const void *b)
{
    const scene_form *x = a, *y = b;
    for (int i = 0; i < 2; i++)
        if (x->is.bits[i] != y->is.bits[i])
            return x->is.bits[i] < y->is.bits[i] ? -1 : 1;
    return 0;
}

static void include(scene_box *b, const scene_box *other)
{
    b->low = vec3_min(b->low, other->low);
    b->high = vec3_max(b->high, other->high);
}

/* The fingerprint of an object: of all its shapes. */
static hash128 hash_object(const scene *s, const scene_object *object, const hash128 *of_shapes)
{
    hash128 begun = hash128_begin();
    for (uint32_t i = 0; i < object->shape_count; i++)
        HASH128_ADD(&begun, of_shapes[s->object_shapes[object->first_shape + i]]);
    return begun;
}

/* Appends the shapes of the world, and writes the fingerprints of all shapes. */
static void add_shapes(const scene *s, scene_forms *f, hash128 *out_of_shapes)
{
    for (uint32_t i = 0; i < s->shape_count; i++) {
        const shape *item = &s->shapes[i];
        out_of_shapes[i] = scene_hash_of_form(s, i);
        f->has_curves = f->has_curves || item->kind == SHAPE_CURVES;
        if (item->object_index != SCENE_NO_OBJECT)
            continue;
        scene_form *form = &f->forms[f->count++];
        form->is = out_of_shapes[i];
        shape_bounds(item, &form->bounds.low, &form->bounds.high);
    }
}

/* Appends the instances of objects, which have those fingerprints and bounds. */
static void add_instances(const scene *s, const scene_form *objects, scene_forms *f)
{
    for (uint32_t i = 0; i < s->instance_count; i++) {
        const scene_instance *at = &s->instances[i];
        if (s->objects[at->object_index].shape_count == 0)
            continue;
        scene_form form = objects[at->object_index];
        HASH128_ADD(&form.is, at->step_count);
        hash128_add(&form.is, s->instance_steps + at->first_step, at->step_count * sizeof *s->instance_steps);
        scene_place_bounds(s, i, &form.bounds.low, &form.bounds.high);
        f->forms[f->count++] = form;
    }
}

ag_status scene_forms_create(const scene *s, scene_forms *out_forms)
{
    scene_forms f = {.passed_surfaces = scene_hash_of_passed_surfaces(s)};
    *out_forms = (scene_forms){0};
    hash128 *of_shapes = malloc(((size_t)s->shape_count + 1) * sizeof *of_shapes);
    scene_form *objects = malloc(((size_t)s->object_count + 1) * sizeof *objects);
    f.forms = malloc(((size_t)s->shape_count + s->instance_count + 1) * sizeof *f.forms);
    bool has_memory = of_shapes && objects && f.forms;
    if (has_memory) {
        add_shapes(s, &f, of_shapes);
        for (uint32_t i = 0; i < s->object_count; i++) {
            objects[i].is = hash_object(s, &s->objects[i], of_shapes);
            scene_find_object_bounds(s, i, &objects[i].bounds.low, &objects[i].bounds.high);
        }
        add_instances(s, objects, &f);
        qsort(f.forms, f.count, sizeof *f.forms, compare_forms);
        *out_forms = f;
    } else {
        free(f.forms);
    }
    free(of_shapes);
    free(objects);
    return has_memory ? AG_OK : AG_ERROR_MEMORY;
}

void scene_forms_reset(scene_forms *forms)
{
    free(forms->forms);
    *forms = (scene_forms){0};
}

/* --- differences --- */

static float middle_x(const scene_box *b) { return b->low.x + b->high.x; }
static float middle_y(const scene_box *b) { return b->low.y + b->high.y; }

static int compare_by_x(const void *a, const void *b)
{
    float x = middle_x(a), y = middle_x(b);
    return (x > y) - (x < y);
}

static int compare_by_y(const void *a, const void *b)
{
    float x = middle_y(a), y = middle_y(b);
    return (x > y) - (x < y);
}

/* Puts neighbours into one box each, where there are too many: in columns along x, and along y in each. */
static void gather_boxes(scene_box *boxes, size_t count, scene_difference *out)
{
    enum { SIDE = 16 };
    _Static_assert(SIDE * SIDE == SCENE_DIFFERENCE_BOXES, "a box for each part of each column");
    if (count <= SCENE_DIFFERENCE_BOXES) {
        if (count > 0)
            memcpy(out->boxes, boxes, count * sizeof *boxes);
        out->count = (uint32_t)count;
        return;
    }
    qsort(boxes, count, sizeof *boxes, compare_by_x);
    for (size_t i = 0; i < SIDE; i++) {
        size_t begin = i * count / SIDE, of_column = (i + 1) * count / SIDE - begin;
        qsort(boxes + begin, of_column, sizeof *boxes, compare_by_y);
        for (size_t k = 0; k < SIDE; k++) {
            size_t first = begin + k * of_column / SIDE, end = begin + (k + 1) * of_column / SIDE;
            scene_box all = boxes[first];
            for (size_t j = first; j < end; j++)
                include(&all, &boxes[j]);
            out->boxes[out->count++] = all;
        }
    }
}

ag_status scene_forms_compare(const scene_forms *a, const scene_forms *b, scene_difference *out_difference)
{
    *out_difference = (scene_difference){0};
    if (!hash128_is_equal(a->passed_surfaces, b->passed_surfaces))
        return AG_OK;
    scene_box *boxes = malloc(((size_t)a->count + b->count + 1) * sizeof *boxes);
    if (!boxes)
        return AG_ERROR_MEMORY;
    size_t count = 0;
    for (uint32_t i = 0, k = 0; i < a->count || k < b->count;) {
        int order = i == a->count ? 1 : k == b->count ? -1 : compare_forms(&a->forms[i], &b->forms[k]);
        if (order != 0)
            boxes[count++] = order < 0 ? a->forms[i].bounds : b->forms[k].bounds;
        i += order <= 0;
        k += order >= 0;
    }
    out_difference->is_known = count == 0 || !(a->has_curves || b->has_curves);
    if (out_difference->is_known)
        gather_boxes(boxes, count, out_difference);
    free(boxes);
    return AG_OK;
}

/* Of bounds that are rounded. */
static const float HAIR = 1e-5f;

bool scene_difference_is_near(const scene_difference *d, vec3 point, float distance_squared)
{
    for (uint32_t i = 0; i < d->count; i++) {
        const scene_box *b = &d->boxes[i];
        vec3 nearest = vec3_max(b->low, vec3_min(point, b->high));
        float hair = HAIR * float_max(vec3_max_abs(b->low), vec3_max_abs(b->high));
        float reach = sqrtf(distance_squared) + hair;
        if (!(vec3_distance_squared(nearest, point) > reach * reach))
            return true;
    }
    return false;
}

/* slab_faces.c: see slab_faces.h. Candidates are flat patches of meshes; one is kept where a ray into the glass finds
 * its counterpart, so that bottles and balls cost nothing later. Threads: read-only once found. */
#include "rays/slab_faces.h"

#include "material/slab.h"
#include "shape/flat_patches.h"
#include "shape/mesh_motion.h"

#include <stdlib.h>

/* Patches of less than this share of their mesh are none: they would be the facets of something round. */
static const double PATCH_SHARE_MIN = 1e-5;
/* Rays cast to find the counterparts of a shape's patches, in all its instances, at most. */
static const uint64_t TRIALS_MAX = 1u << 20;
/* Where on a patch's largest triangle they start. */
static const float TRIAL_BARYCENTRICS[][2] = {{0.34f, 0.33f}, {0.6f, 0.2f}, {0.2f, 0.6f}, {0.21f, 0.19f}};
enum { TRIAL_COUNT = 4 };

typedef struct shape_faces {
    uint32_t *patch_of_triangle; /* NULL: no part of the shape is a slab's */
    flat_patch *patches;
    bool *is_face; /* of each patch */
    uint32_t patch_count;
    float face_area; /* as flat_patch.area */
} shape_faces;

struct slab_faces {
    shape_faces *of_shape; /* [shape_count] */
    uint32_t shape_count;
};

static const flat_patch *patch_at(const slab_faces *f, const surface_hit *hit, uint32_t *out_index)
{
    const shape_faces *at = &f->of_shape[hit->shape_index];
    if (!at->patch_of_triangle)
        return NULL;
    *out_index = at->patch_of_triangle[hit->primitive_index];
    return *out_index == FLAT_NO_PATCH ? NULL : &at->patches[*out_index];
}

/* World units. */
static float thickness_max(const scene *s, const surface_hit *hit, const flat_patch *p)
{
    float area = p->area, square = vec3_length_squared(p->extent);
    if (hit->instance_index != SCENE_NO_INSTANCE) {
        affine a = instance_at(s, hit->instance_index, hit->time);
        double c[3][3], grown = 0.0, squares = 0.0;
        affine_cofactors(&a, c);
        for (int i = 0; i < 3; i++) {
            double n = c[i][0] * (double)p->normal.x + c[i][1] * (double)p->normal.y + c[i][2] * (double)p->normal.z;
            double reach = fabs((double)a.m[i][0]) * (double)p->extent.x +
                           fabs((double)a.m[i][1]) * (double)p->extent.y +
                           fabs((double)a.m[i][2]) * (double)p->extent.z;
            grown += n * n;
            squares += reach * reach;
        }
        area *= (float)sqrt(grown);
        square = (float)squares;
    }
    return square > 0.0f ? area / (sqrtf(square) * SLAB_WIDTH_OVER_THICKNESS_MIN) : 0.0f;
}

/* One slab has one material, and the same within and without on both sides. */
static bool is_counterpart(const scene *s, const surface_hit *in, const surface_hit *out)
{
    if (s->shapes[in->shape_index].material_index != s->shapes[out->shape_index].material_index ||
        in->instance_index != out->instance_index || in->has_medium_interface != out->has_medium_interface)
        return false;
    if (in->has_medium_interface &&
        (in->medium_inside != out->medium_inside || in->medium_outside != out->medium_outside))
        return false;
    return vec3_length_squared(vec3_add(in->geometric_normal, out->geometric_normal)) <=
           FLAT_ANGLE_MAX * FLAT_ANGLE_MAX;
}

/* Light that is scattered in the glass does not pass it straight. */
static bool scatters_within(const scene *s, const slab_way *way)
{
    return way->medium < s->medium_count && medium_scatters(&s->media[way->medium]);
}

/* Follows a ray that has met a patch straight into the glass. Returns false where it does not leave by the patch's
 * counterpart, or where the part between them is no slab. */
static bool find_exit(const scene *s, const slab_faces *f, const scene_ray *ray, const surface_hit *in,
                      const flat_patch *entered, slab_way *out_way, surface_hit *out_hit, uint32_t *out_patch)
{
    float cosine = -vec3_dot(in->geometric_normal, ray->direction);
    if (!(cosine > 0.0f))
        return false; /* from within */
    float most = thickness_max(s, in, entered);
    scene_ray within = *ray;
    within.origin = surface_point_behind(in->position, in->geometric_normal, in->epsilon, ray->direction);
    within.alpha_rule = RAY_MEETS_ALPHA;
    within.skips_uv = true;
    if (!scene_intersect(s, within, 1.01f * most / cosine, out_hit) || !is_counterpart(s, in, out_hit))
        return false;
    const flat_patch *left = patch_at(f, out_hit, out_patch);
    float thickness = vec3_dot(vec3_sub(in->position, out_hit->position), in->geometric_normal);
    if (!left || !(thickness > 0.0f && thickness <= most && thickness <= thickness_max(s, out_hit, left)))
        return false;
    *out_way = (slab_way){.exit = out_hit->position,
                          .epsilon = out_hit->epsilon,
                          .thickness = thickness,
                          .medium = in->has_medium_interface ? in->medium_inside : ray->medium};
    return !scatters_within(s, out_way);
}

void slab_faces_meet(const scene *s, const scene_ray *ray, surface_hit *in_out_hit)
{
    uint32_t entered, left;
    const flat_patch *p = patch_at(s->slab_faces, in_out_hit, &entered);
    surface_hit out;
    slab_way way;
    if (p && s->slab_faces->of_shape[in_out_hit->shape_index].is_face[entered] &&
        find_exit(s, s->slab_faces, ray, in_out_hit, p, &way, &out, &left) &&
        s->slab_faces->of_shape[out.shape_index].is_face[left])
        in_out_hit->slab = way;
}

double slab_faces_share(const scene *s, uint32_t material_index)
{
    double all = 0.0, faces = 0.0;
    for (uint32_t i = 0; s->slab_faces && i < s->shape_count; i++) {
        if (s->shapes[i].material_index != material_index)
            continue;
        all += (double)s->shapes[i].area;
        faces += (double)s->slab_faces->of_shape[i].face_area;
    }
    return all > 0.0 ? faces / all : 0.0;
}

/* --- finding them --- */

static bool may_be_slab(const scene *s, const shape *item)
{
    return item->kind == SHAPE_MESH && item->as.mesh.triangle_count > 0 && !shape_is_deforming(item) &&
           item->light_index == SHAPE_NO_LIGHT && item->alpha == 1.0f && item->alpha_texture == SCENE_NO_TEXTURE &&
           slab_may_be_of(s, item->material_index);
}

/* The hit of a trial on a patch, in one of its object's instances, or in the world itself. */
static void find_trial_hit(const scene *s, uint32_t shape_index, uint32_t instance_index, const flat_patch *p,
                           int trial, surface_hit *out_hit)
{
    static const vec3 NOWHERE = {0.0f, 0.0f, 0.0f};
    shape_surface_at(&s->shapes[shape_index], p->largest_triangle, TRIAL_BARYCENTRICS[trial][0],
                     TRIAL_BARYCENTRICS[trial][1], NOWHERE, NOWHERE, 0.0f, out_hit);
    out_hit->distance = out_hit->time = 0.0f;
    out_hit->shape_index = shape_index;
    out_hit->primitive_index = p->largest_triangle;
    out_hit->instance_index = instance_index;
    if (instance_index != SCENE_NO_INSTANCE) {
        affine world_from_object = instance_at(s, instance_index, 0.0f);
        instance_transform_hit(&world_from_object, out_hit);
    }
}

/* Looks for the counterparts of a shape's patches; those that are found are faces, as their counterparts are. */
static void try_patches(const scene *s, slab_faces *f, uint32_t shape_index, uint32_t instance_index,
                        uint64_t *in_out_trials)
{
    shape_faces *own = &f->of_shape[shape_index];
    for (uint32_t i = 0; i < own->patch_count; i++)
        for (int trial = 0; trial < TRIAL_COUNT && !own->is_face[i] && *in_out_trials < TRIALS_MAX; trial++) {
            surface_hit in, out;
            slab_way way;
            uint32_t left;
            find_trial_hit(s, shape_index, instance_index, &own->patches[i], trial, &in);
            scene_ray ray = scene_ray_make(in.position, vec3_negate(in.geometric_normal));
            (*in_out_trials)++;
            if (find_exit(s, f, &ray, &in, &own->patches[i], &way, &out, &left))
                own->is_face[i] = f->of_shape[out.shape_index].is_face[left] = true;
        }
}

static ag_status find_candidates(const scene *s, run_context *run, slab_faces *f)
{
    for (uint32_t i = 0; i < s->shape_count; i++) {
        shape_faces *own = &f->of_shape[i];
        if (run_is_cancelled(run))
            return AG_CANCELLED;
        if (!may_be_slab(s, &s->shapes[i]))
            continue;
        ag_status status = flat_patches_find(&s->shapes[i].as.mesh, PATCH_SHARE_MIN, &own->patch_of_triangle,
                                             &own->patches, &own->patch_count);
        own->is_face = calloc((size_t)own->patch_count + 1, sizeof *own->is_face);
        if (status != AG_OK || !own->is_face)
            return AG_ERROR_MEMORY;
    }
    return AG_OK;
}

static ag_status find_faces(const scene *s, run_context *run, slab_faces *f)
{
    for (uint32_t i = 0; i < s->shape_count; i++) {
        uint64_t trials = 0;
        uint32_t object = s->shapes[i].object_index;
        if (run_is_cancelled(run))
            return AG_CANCELLED;
        if (f->of_shape[i].patch_count == 0)
            continue;
        if (object == SCENE_NO_OBJECT)
            try_patches(s, f, i, SCENE_NO_INSTANCE, &trials);
        for (uint32_t k = 0; object != SCENE_NO_OBJECT && k < s->instance_count && trials < TRIALS_MAX; k++)
            if (s->instances[k].object_index == object)
                try_patches(s, f, i, k, &trials);
    }
    return AG_OK;
}

static void reset(shape_faces *own)
{
    free(own->patch_of_triangle);
    free(own->patches);
    free(own->is_face);
    *own = (shape_faces){0};
}

/* Forgets the shapes without faces. false: no shape has any. */
static bool keep_faces(slab_faces *f)
{
    bool has_any = false;
    for (uint32_t i = 0; i < f->shape_count; i++) {
        shape_faces *own = &f->of_shape[i];
        for (uint32_t k = 0; k < own->patch_count; k++)
            own->face_area += own->is_face[k] ? own->patches[k].area : 0.0f;
        has_any = has_any || own->face_area > 0.0f;
        if (own->face_area == 0.0f)
            reset(own);
    }
    return has_any;
}

ag_status slab_faces_find(const scene *s, run_context *run, slab_faces **out_faces)
{
    *out_faces = NULL;
    bool may_have_any = false;
    for (uint32_t i = 0; i < s->shape_count && !may_have_any; i++)
        may_have_any = may_be_slab(s, &s->shapes[i]);
    if (!may_have_any)
        return AG_OK;
    slab_faces *f = calloc(1, sizeof *f);
    if (!f)
        return AG_ERROR_MEMORY;
    f->shape_count = s->shape_count;
    f->of_shape = calloc(s->shape_count, sizeof *f->of_shape);
    ag_status status = f->of_shape ? find_candidates(s, run, f) : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = find_faces(s, run, f);
    if (status == AG_OK && keep_faces(f))
        *out_faces = f;
    else
        slab_faces_destroy(f);
    return status;
}

void slab_faces_destroy(slab_faces *f)
{
    if (!f)
        return;
    for (uint32_t i = 0; f->of_shape && i < f->shape_count; i++)
        reset(&f->of_shape[i]);
    free(f->of_shape);
    free(f);
}

/* fuzz_scene.c: see fuzz_scene.h. Threads: one. */
#include "fuzz_scene.h"

#include "rays/rays.h"
#include "scene.h"
#include "shape/curves.h"

#include <math.h>
#include <stdlib.h>

void fuzz_enter_folder_with_files(void)
{
    static const char SCENE[] = "Shape \"disk\" \"float height\" 2\n";
    static const char PLY[] =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 2\n1 0 2\n0 1 2\n3 0 1 2\n";
    static const char PICTURE[] = "PF\n2 1\n-1.0\n"
                                  "\0\0\200\077\0\0\0\077\0\0\200\076\0\0\0\077\0\0\200\076\0\0\0\100";
    static const char SPECTRUM[] = "400 1 700 2\n", LENS[] = "50 5 1.5 30\n-50 5 1 30\n";
    static bool is_there;
    if (is_there)
        return;
    is_there = true;
    fuzz_enter_folder();
    fuzz_write("a.pbrt", SCENE, sizeof SCENE - 1);
    fuzz_write("a.ply", PLY, sizeof PLY - 1);
    fuzz_write("a.pfm", PICTURE, sizeof PICTURE - 1);
    fuzz_write("a.spd", SPECTRUM, sizeof SPECTRUM - 1);
    fuzz_write("a.dat", LENS, sizeof LENS - 1);
}

static void check_mesh(const mesh *m)
{
    FUZZ_CHECK(m->vertex_count > 0 && m->triangle_count > 0 && m->positions && m->indices);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        FUZZ_CHECK(vec3_is_finite(m->positions[i]));
        FUZZ_CHECK(!m->normals || vec3_is_finite(m->normals[i]));
    }
    for (size_t i = 0; i < 3 * (size_t)m->triangle_count; i++)
        FUZZ_CHECK(m->indices[i] < m->vertex_count);
}

static void check_curves(const curves *c)
{
    FUZZ_CHECK(c->segment_count > 0 && c->segment_count <= c->capacity);
    FUZZ_CHECK((c->type == CURVES_RIBBON) == (c->normals != NULL));
    for (size_t i = 0; i < curves_points_of_each(c) * c->segment_count; i++)
        FUZZ_CHECK(vec3_is_finite(c->points[i].at) && c->points[i].radius >= 0.0f && isfinite(c->points[i].radius));
}

static void check_indices(const scene *s)
{
    for (uint32_t i = 0; i < s->shape_count; i++) {
        const shape *item = &s->shapes[i];
        FUZZ_CHECK(item->material_index < s->material_count);
        FUZZ_CHECK(item->light_index == SHAPE_NO_LIGHT || item->light_index < s->light_count);
        if (item->kind == SHAPE_MESH)
            check_mesh(&item->as.mesh);
        if (item->kind == SHAPE_CURVES)
            check_curves(&item->as.curves);
    }
    for (uint32_t i = 0; i < s->light_count; i++)
        FUZZ_CHECK(s->lights[i].kind != LIGHT_AREA || s->lights[i].as.area.shape_index < s->shape_count);
    for (uint32_t i = 0; i < s->textures.count; i++) {
        for (int k = 0; k < 4; k++) {
            uint32_t index = s->textures.items[i].inputs[k].texture_index;
            FUZZ_CHECK(index == SCENE_NO_TEXTURE || index < i);
        }
        FUZZ_CHECK(s->textures.items[i].kind != TEXTURE_IMAGE ||
                   s->textures.items[i].image_index < s->textures.image_count);
    }
}

static bool is_unit(vec3 v) { return fabsf(vec3_length(v) - 1.0f) < 1e-3f; }

static void cast_rays(const scene *s)
{
    static const vec3 DIRECTIONS[] = {
        {0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, -1.0f}, {0.6f, 0.64f, 0.48f}, {-0.8f, 0.6f, 0.0f}};
    for (int d = 0; d < 4; d++)
        for (int o = 0; o < 2; o++) {
            scene_ray ray = {.origin = o ? s->bounding_center : s->bounds_min, .direction = DIRECTIONS[d]};
            if (o == 0 && s->has_camera)
                ray = camera_generate_ray(&s->camera, 0.25f * (float)(1 + d), 0.5f, 1.0f, (vec2){0.3f, 0.6f}, 0.0f);
            surface_hit hit;
            if (!scene_intersect(s, ray, INFINITY, &hit))
                continue;
            FUZZ_CHECK(hit.shape_index < s->shape_count);
            FUZZ_CHECK(vec3_is_finite(hit.position) && hit.epsilon >= 0.0f);
            FUZZ_CHECK(is_unit(hit.geometric_normal) && is_unit(hit.shading_normal));
            const shape *met = &s->shapes[hit.shape_index];
            FUZZ_CHECK(met->kind != SHAPE_CURVES || hit.primitive_index < met->as.curves.segment_count);
            FUZZ_CHECK(met->kind != SHAPE_MESH || hit.primitive_index < met->as.mesh.triangle_count);
            for (uint32_t i = 0; i < s->textures.count && i < 16; i++)
                texture_evaluate_rgb(&s->textures, i, &hit);
        }
}

void fuzz_look_at_scene(scene *s, fuzz_run *run)
{
    static thread_pool *pool; /* for as long as the process lives: a thread a run would cost more than the run */
    check_indices(s);
    if (!pool)
        FUZZ_CHECK(thread_pool_create(1, &pool) == AG_OK);
    run->context.pool = pool;
    ag_status status = scene_commit(s, &run->context, NULL);
    fuzz_check_said(run, status);
    if (status != AG_OK)
        return;
    for (uint32_t i = 0; i < s->light_count; i++)
        FUZZ_CHECK(s->photon_probability[i] >= 0.0f && s->photon_probability[i] <= 1.0f);
    FUZZ_CHECK(isfinite(s->surface_area) && isfinite(s->bounding_radius));
    cast_rays(s);
}

void fuzz_read_scene(fuzz_reader *read, const char *path)
{
    fuzz_run run;
    fuzz_run_init(&run);
    scene *s = scene_create();
    FUZZ_CHECK(s);
    ag_status status = read(&run.context, path, s);
    fuzz_check_said(&run, status);
    if (status == AG_OK)
        fuzz_look_at_scene(s, &run);
    scene_destroy(s);
    fuzz_run_reset(&run);
}

/* model_fixture.h: models in other formats than pbrt's, written by the tests and read by scene_file_load, with all that
 * was said meanwhile. Threads: one at a time. */
#ifndef AFTERGLOW_TESTS_MODEL_FIXTURE_H
#define AFTERGLOW_TESTS_MODEL_FIXTURE_H

#include "pbrt_fixture.h"
#include "scene_file.h"
#include "temporary_folder.h"

static inline const char *model_write(const char *name, const void *bytes, size_t size)
{
    const char *path = in_folder(name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}

static inline const char *model_write_text(const char *name, const char *text)
{
    return model_write(name, text, strlen(text));
}

static inline reading model_read(const char *path)
{
    reading r;
    run_context run;
    reading_begin(&r, &run);
    r.status = scene_file_load(&run, path, r.scene);
    reading_end(&run);
    return r;
}

/* A file of that name with that text. */
static inline reading model_of(const char *name, const char *text) { return model_read(model_write_text(name, text)); }

/* The same, which is right and says nothing louder than info. */
static inline reading model_quietly(const char *name, const char *text)
{
    reading r = model_of(name, text);
    if (r.status != AG_OK || r.count[AG_LOG_WARNING] > 0)
        fail_msg("%s: %s%s", ag_status_text(r.status), r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "",
                 r.said[AG_LOG_WARNING] ? r.said[AG_LOG_WARNING] : "");
    return r;
}

/* The file's path and then this text is said at that level. */
static inline void model_said(const reading *r, ag_log_level level, const char *name, const char *text)
{
    char whole[1024];
    snprintf(whole, sizeof whole, "%s%s", in_folder(name), text);
    if (!r->said[level] || !strstr(r->said[level], whole))
        fail_msg("%s was not said, but: %s", whole, r->said[level] ? r->said[level] : "nothing");
}

static inline void model_refused(const char *name, const char *text, ag_status status, const char *expected)
{
    reading r = model_of(name, text);
    assert_int_equal(r.status, status);
    model_said(&r, AG_LOG_ERROR, name, expected);
    reading_destroy(&r);
}

static inline const mesh *model_mesh(const reading *r, uint32_t index)
{
    assert_true(index < r->scene->shape_count);
    assert_int_equal(r->scene->shapes[index].kind, SHAPE_MESH);
    return &r->scene->shapes[index].as.mesh;
}

static inline const material *model_material(const reading *r, uint32_t shape_index)
{
    assert_true(shape_index < r->scene->shape_count);
    return &r->scene->materials[r->scene->shapes[shape_index].material_index];
}

/* Nothing in the scene refers to what is not there. */
static inline void model_is_sound(const reading *r)
{
    for (uint32_t k = 0; k < r->scene->shape_count; k++) {
        const mesh *m = model_mesh(r, k);
        for (size_t i = 0; i < 3 * (size_t)m->triangle_count; i++)
            assert_true(m->indices[i] < m->vertex_count);
        for (uint32_t i = 0; i < m->vertex_count; i++)
            assert_true(vec3_is_finite(m->positions[i]));
        assert_true(r->scene->shapes[k].material_index < r->scene->material_count);
    }
}

#endif

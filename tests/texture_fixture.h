/* texture_fixture.h: textures of scenes, looked up at hits made for it.
 * Flow: pbrt_fixture.h -> [here] -> tests/test_texture*.c, test_pbrt_textures.c. Threads: one. */
#ifndef AFTERGLOW_TESTS_TEXTURE_FIXTURE_H
#define AFTERGLOW_TESTS_TEXTURE_FIXTURE_H

#include "bvh.h"
#include "image_file.h"
#include "pbrt_fixture.h"
#include "temporary_folder.h"

static inline surface_hit hit_at(float u, float v, float x, float y, float z)
{
    surface_hit hit;
    memset(&hit, 0, sizeof hit);
    hit.uv = (vec2){u, v};
    hit.position = vec3_make(x, y, z);
    hit.geometric_normal = vec3_make(0.0f, 0.6f, 0.8f);
    hit.shading_normal = vec3_make(1.0f, 0.0f, 0.0f);
    return hit;
}

/* What stands after WorldBegin, in a file of the temporary folder, so that pictures are found beside it. */
static inline reading read_world(const char *world)
{
    FILE *file = fopen(in_folder("scene.pbrt"), "w");
    assert_non_null(file);
    assert_true(fprintf(file, "WorldBegin %s", world) > 0);
    assert_int_equal(fclose(file), 0);
    return reading_create(in_folder("scene.pbrt"), NULL, 0);
}

static inline reading good_world(const char *world)
{
    reading r = read_world(world);
    for (int level = AG_LOG_ERROR; level <= AG_LOG_WARNING; level++)
        if (r.said[level])
            print_error("%s", r.said[level]);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 0);
    return r;
}

static inline rgb last_rgb(const reading *r, surface_hit hit)
{
    return texture_evaluate_rgb(r->scene, r->scene->texture_count - 1, &hit);
}

static inline float last_float(const reading *r, surface_hit hit)
{
    return texture_evaluate_float(r->scene, r->scene->texture_count - 1, &hit);
}

/* The last texture of the world at one hit. */
static inline float float_of(const char *world, surface_hit hit)
{
    reading r = good_world(world);
    float value = last_float(&r, hit);
    reading_destroy(&r);
    return value;
}

static inline rgb rgb_of(const char *world, surface_hit hit)
{
    reading r = good_world(world);
    rgb value = last_rgb(&r, hit);
    reading_destroy(&r);
    return value;
}

static inline void write_image(const char *name, int width, int height, int channel_count, image_sample_type type,
                               const float *pixels)
{
    static const char *const names[4] = {"R", "G", "B", "A"};
    static const char *const grey_names[1] = {"Y"};
    const image_description description = {.width = width,
                                           .height = height,
                                           .full_width = width,
                                           .full_height = height,
                                           .channel_count = channel_count,
                                           .channel_names = channel_count == 1 ? grey_names : names,
                                           .type = type};
    if (image_file_write(in_folder(name), &description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
}

#endif

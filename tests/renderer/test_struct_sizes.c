/* test_struct_sizes.c: every public call that takes settings or a description refuses a struct of another size than the
 * library's, and one of zeros, with a message and without an effect. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/scene_desk.h"

#include <stdint.h>

/* A scene of the desk, complete, and its film. */
typedef struct bench {
    desk d;
    ag_scene *complete;
    ag_film *film;
    ag_rendering *rendering; /* begin_rendering's */
} bench;

static void begin_bench(bench *b)
{
    square s;
    ag_render_settings settings;
    begin(&b->d);
    assert_int_equal(ag_scene_create(b->d.context, NULL, &b->complete), AG_OK);
    ag_scene *open = b->d.made;
    b->d.made = b->complete;
    make_square(&s);
    light_and_look(&b->d);
    assert_int_equal(ag_scene_add_shape(b->complete, &s.shape, NULL), AG_OK);
    assert_int_equal(ag_scene_commit(b->complete), AG_OK);
    b->d.made = open;
    assert_int_equal(ag_render_settings_from_scene(b->d.context, b->complete, &settings), AG_OK);
    settings.width = settings.height = 4;
    settings.samples_per_pixel = 1;
    settings.photon_count = 100;
    assert_int_equal(ag_render(b->d.context, b->complete, &settings, &b->film), AG_OK);
}

/* Two samples of a rendering of the complete scene, whose photon map is kept as a.map. */
static void begin_rendering(bench *b)
{
    ag_render_settings settings;
    assert_int_equal(ag_render_settings_from_scene(b->d.context, b->complete, &settings), AG_OK);
    settings.width = settings.height = 4;
    settings.samples_per_pixel = 2;
    settings.photon_count = 100;
    settings.photon_map_file = in_folder("a.map");
    assert_int_equal(ag_rendering_create(b->d.context, b->complete, &settings, &b->rendering), AG_OK);
    assert_int_equal(ag_rendering_continue(b->rendering, 2), AG_OK);
}

static void end_bench(bench *b)
{
    ag_film_destroy(b->film);
    ag_scene_destroy(b->complete);
    end(&b->d);
}

/* A public call with a struct that is filled but for its size; size 0: with one of zeros. */
typedef ag_status sized_call(bench *b, size_t size);

#define SIZED(type, name, filled)                                                                                      \
    type name = filled;                                                                                                \
    name.struct_size = size;                                                                                           \
    if (size == 0)                                                                                                     \
    memset(&name, 0, sizeof name)

static ag_status load(bench *b, size_t size)
{
    ag_scene *scene = NULL;
    SIZED(ag_scene_settings, s, ag_default_scene_settings());
    ag_status status = ag_scene_load_as(b->d.context, "none.pbrt", &s, &scene);
    assert_null(scene);
    return status;
}

static ag_status load_text(bench *b, size_t size)
{
    ag_scene *scene = NULL;
    SIZED(ag_scene_settings, s, ag_default_scene_settings());
    ag_status status = ag_scene_load_text(b->d.context, "t", "WorldBegin", 10, &s, &scene);
    assert_null(scene);
    return status;
}

static ag_status create(bench *b, size_t size)
{
    ag_scene *scene = NULL;
    SIZED(ag_scene_settings, s, ag_default_scene_settings());
    ag_status status = ag_scene_create(b->d.context, &s, &scene);
    assert_null(scene);
    return status;
}

static ag_status render_film(bench *b, size_t size)
{
    ag_film *film = NULL;
    SIZED(ag_render_settings, s, ag_default_render_settings());
    ag_status status = ag_render(b->d.context, b->complete, &s, &film);
    assert_null(film);
    return status;
}

static ag_status create_rendering(bench *b, size_t size)
{
    ag_rendering *rendering = NULL;
    SIZED(ag_render_settings, s, ag_default_render_settings());
    ag_status status = ag_rendering_create(b->d.context, b->complete, &s, &rendering);
    assert_null(rendering);
    return status;
}

static ag_status predict_memory(bench *b, size_t size)
{
    ag_prediction prediction;
    SIZED(ag_render_settings, s, ag_default_render_settings());
    return ag_predict_memory(b->d.context, b->complete, &s, &prediction);
}

static ag_status predict(bench *b, size_t size)
{
    ag_prediction prediction;
    SIZED(ag_render_settings, s, ag_default_render_settings());
    return ag_predict(b->d.context, b->complete, &s, &prediction);
}

static ag_status check_output(bench *b, size_t size)
{
    SIZED(ag_output_settings, s, ag_default_output_settings());
    return ag_output_check(b->d.context, &s, in_folder("a.exr"));
}

static ag_status write_film(bench *b, size_t size)
{
    SIZED(ag_output_settings, s, ag_default_output_settings());
    return ag_film_write(b->d.context, b->film, &s, in_folder("a.exr"));
}

static ag_status add_shape(bench *b, size_t size)
{
    square made;
    make_square(&made);
    SIZED(ag_shape, s, made.shape);
    return ag_scene_add_shape(b->d.made, &s, NULL);
}

static ag_status add_light(bench *b, size_t size)
{
    SIZED(ag_light, s, ag_default_light());
    return ag_scene_add_light(b->d.made, &s, NULL);
}

static ag_status add_instance(bench *b, size_t size)
{
    SIZED(ag_instance, s, ag_default_instance());
    return ag_scene_add_instance(b->d.made, &s, NULL);
}

static ag_status add_image(bench *b, size_t size)
{
    SIZED(ag_image, s, ag_default_image());
    return ag_scene_add_image(b->d.made, "a.png", &s);
}

static ag_status add_texture(bench *b, size_t size)
{
    SIZED(ag_texture, s, ag_default_texture());
    return ag_scene_add_texture(b->d.made, &s);
}

static ag_status set_camera(bench *b, size_t size)
{
    SIZED(ag_camera, s, ag_default_camera());
    return ag_scene_set_camera(b->d.made, &s);
}

static ag_status change_camera(bench *b, size_t size)
{
    SIZED(ag_camera, s, ag_default_camera());
    return ag_scene_set_camera(b->complete, &s);
}

static void other_sizes_are_refused(void **state)
{
    (void)state;
    static const struct {
        sized_call *call;
        size_t size;
        const char *said;
    } CALLS[] = {
        {load, sizeof(ag_scene_settings), "ag_scene_settings: struct_size is "},
        {load_text, sizeof(ag_scene_settings), "ag_scene_settings: struct_size is "},
        {create, sizeof(ag_scene_settings), "ag_scene_settings: struct_size is "},
        {render_film, sizeof(ag_render_settings), "ag_render_settings: struct_size is "},
        {create_rendering, sizeof(ag_render_settings), "ag_render_settings: struct_size is "},
        {predict_memory, sizeof(ag_render_settings), "ag_render_settings: struct_size is "},
        {predict, sizeof(ag_render_settings), "ag_render_settings: struct_size is "},
        {check_output, sizeof(ag_output_settings), "ag_output_settings: struct_size is "},
        {write_film, sizeof(ag_output_settings), "ag_output_settings: struct_size is "},
        {add_shape, sizeof(ag_shape), "ag_scene_add_shape:"},
        {add_light, sizeof(ag_light), "ag_scene_add_light:"},
        {add_instance, sizeof(ag_instance), "ag_scene_add_instance:"},
        {add_image, sizeof(ag_image), "ag_scene_add_image:"},
        {add_texture, sizeof(ag_texture), "ag_scene_add_texture:"},
        {set_camera, sizeof(ag_camera), "ag_scene_set_camera:"},
        {change_camera, sizeof(ag_camera), "ag_scene_set_camera:"},
    };
    bench b;
    begin_bench(&b);
    for (size_t i = 0; i < sizeof CALLS / sizeof *CALLS; i++) {
        const size_t sizes[] = {0, sizeof(size_t), CALLS[i].size - 1, CALLS[i].size + 8, SIZE_MAX};
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
            b.d.said[0] = '\0';
            assert_int_equal(CALLS[i].call(&b, sizes[k]), AG_ERROR_ARGUMENT);
            if (!strstr(b.d.said, CALLS[i].said) || !strstr(b.d.said, "struct_size is "))
                fail_msg("call %zu, size %zu: %s", i, sizes[k], b.d.said);
        }
    }
    assert_int_equal(entry_count(), 0);
    end_bench(&b);
}

/* These calls cannot log a message: a context's log is a member of the struct itself, and settings by name have no
 * context. */
static void other_sizes_are_refused_in_silence(void **state)
{
    (void)state;
    const size_t sizes[] = {0, sizeof(ag_context_settings) - 1, sizeof(ag_context_settings) + 8};
    ag_context *context = NULL;
    ag_render_settings zeros = {0};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        ag_context_settings s = ag_default_context_settings();
        s.struct_size = sizes[i];
        assert_int_equal(ag_context_create(&s, &context), AG_ERROR_ARGUMENT);
        assert_null(context);
    }
    assert_int_equal(ag_render_settings_set(&zeros, "spp", "4"), AG_ERROR_ARGUMENT);
    assert_int_equal(zeros.samples_per_pixel, 0);
}

static void descriptions_are_needed(void **state)
{
    (void)state;
    desk d;
    begin(&d);
    assert_int_equal(ag_scene_add_shape(d.made, NULL, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "there is no description");
    end(&d);
}

/* A program's struct of any size: what lies behind it stays as it was, and the library's size alone is filled. */
static void no_more_is_written_than_the_program_has(void **state)
{
    (void)state;
    enum { ROOM = 4096 };
    for (int which = AG_STRUCT_CONTEXT_SETTINGS; which <= AG_STRUCT_CAMERA; which++) {
        const size_t known = ag_struct_size((ag_struct)which);
        assert_in_range(known, sizeof(size_t), ROOM / 2);
        for (size_t size = sizeof(size_t); size <= known + 64; size += 8) {
            union {
                size_t struct_size;
                unsigned char bytes[ROOM];
            } given;
            memset(&given, 0xa5, sizeof given);
            ag_struct_fill((ag_struct)which, &given, size);
            assert_int_equal(given.struct_size, size);
            for (size_t k = sizeof(size_t); k < ROOM; k++) {
                if (k >= size)
                    assert_int_equal(given.bytes[k], 0xa5);
                else if (size != known)
                    assert_int_equal(given.bytes[k], 0);
            }
        }
    }
    assert_int_equal(ag_struct_size((ag_struct)(AG_STRUCT_CAMERA + 1)), 0);
    const ag_camera camera = ag_default_camera();
    assert_int_equal(camera.struct_size, ag_struct_size(AG_STRUCT_CAMERA));
    assert_string_equal(camera.type, "perspective");
}

/* An older and a newer program's settings, which the library fills within their size and then refuses. */
static void settings_of_another_release_are_refused(void **state)
{
    (void)state;
    bench b;
    begin_bench(&b);
    const size_t sizes[] = {sizeof(ag_render_settings) - 8, sizeof(ag_render_settings) + 8};
    for (int i = 0; i < 2; i++) {
        union {
            ag_render_settings settings;
            unsigned char bytes[sizeof(ag_render_settings) + 64];
        } given;
        memset(&given, 0xa5, sizeof given);
        assert_int_equal(ag_render_settings_fill(b.d.context, b.complete, &given, sizes[i]), AG_OK);
        for (size_t k = sizes[i]; k < sizeof given; k++)
            assert_int_equal(given.bytes[k], 0xa5);
        b.d.said[0] = '\0';
        ag_film *film = NULL;
        assert_int_equal(ag_render(b.d.context, b.complete, &given.settings, &film), AG_ERROR_ARGUMENT);
        assert_null(film);
        assert_non_null(strstr(b.d.said, "compiled with the headers of this release"));
    }
    end_bench(&b);
}

/* The library fills structs of any size. That of an older program, which lacks the last members, gets those that it
 * has; that of a newer program gets zeros in the members that the library does not know. Nothing is written behind
 * either. */
typedef void fill_call(const bench *b, void *out, size_t size);

static void fill_statistics(const bench *b, void *out, size_t size)
{
    ag_context_statistics_fill(b->d.context, out, size);
}

static void fill_prediction(const bench *b, void *out, size_t size)
{
    ag_context_prediction_fill(b->d.context, out, size);
}

static void predict_into(const bench *b, void *out, size_t size)
{
    const ag_render_settings s = ag_default_render_settings();
    assert_int_equal(ag_predict_memory_fill(b->d.context, b->complete, &s, out, size), AG_OK);
}

static void fill_growth(const bench *b, void *out, size_t size) { ag_rendering_growth_fill(b->rendering, out, size); }

static void fill_noise(const bench *b, void *out, size_t size) { ag_rendering_noise_fill(b->rendering, out, size); }

static void fill_map_info(const bench *b, void *out, size_t size)
{
    assert_int_equal(ag_photon_map_read_info_fill(b->d.context, in_folder("a.map"), out, size), AG_OK);
}

static void fill_merged_info(const bench *b, void *out, size_t size)
{
    const char *const maps[] = {in_folder("a.map")};
    assert_int_equal(ag_photon_map_merge_fill(b->d.context, in_folder("merged.map"), maps, 1, out, size), AG_OK);
}

static void what_is_given_back_fits_any_release(void **state)
{
    (void)state;
    enum { ROOM = 4096 };
    static const struct {
        fill_call *fill;
        size_t size, constant; /* so many of its first bytes, after the size, are the same in each call */
    } STRUCTS[] = {{fill_statistics, sizeof(ag_statistics), offsetof(ag_statistics, time_total_s)},
                   {fill_prediction, sizeof(ag_prediction), sizeof(ag_prediction)},
                   {predict_into, sizeof(ag_prediction), sizeof(size_t)},
                   {fill_growth, sizeof(ag_growth), sizeof(ag_growth)},
                   {fill_noise, sizeof(ag_noise), sizeof(ag_noise)},
                   {fill_map_info, sizeof(ag_photon_map_info), sizeof(ag_photon_map_info)},
                   {fill_merged_info, sizeof(ag_photon_map_info), sizeof(ag_photon_map_info)}};
    bench b;
    begin_bench(&b);
    begin_rendering(&b);
    predict_into(&b, &(ag_prediction){0}, sizeof(ag_prediction));
    assert_true(ag_context_statistics(b.d.context).rays_camera > 0);
    assert_true(ag_context_prediction(b.d.context).memory_peak_bytes > 0);
    assert_true(ag_rendering_growth(b.rendering).irradiance_photons > 0);
    assert_true(ag_rendering_noise(b.rendering).level > 0.0);
    ag_photon_map_info info;
    assert_int_equal(ag_photon_map_read_info(b.d.context, in_folder("a.map"), &info), AG_OK);
    assert_true(info.photons_global > 0);
    for (size_t i = 0; i < sizeof STRUCTS / sizeof *STRUCTS; i++) {
        unsigned char whole[ROOM];
        STRUCTS[i].fill(&b, whole, STRUCTS[i].size);
        for (size_t size = sizeof(size_t); size <= STRUCTS[i].size + 64; size += 8) {
            union {
                size_t struct_size;
                unsigned char bytes[ROOM];
            } given;
            memset(&given, 0xa5, sizeof given);
            STRUCTS[i].fill(&b, &given, size);
            assert_int_equal(given.struct_size, size);
            for (size_t k = sizeof(size_t); k < ROOM; k++) {
                if (k >= size)
                    assert_int_equal(given.bytes[k], 0xa5);
                else if (k >= STRUCTS[i].size)
                    assert_int_equal(given.bytes[k], 0);
                else if (k < STRUCTS[i].constant)
                    assert_int_equal(given.bytes[k], whole[k]);
            }
        }
    }
    ag_rendering_finish(b.rendering, NULL);
    end_bench(&b);
}

/* A program that was compiled before ag_prediction had its times gets the members that it knows. */
static void an_older_prediction_is_filled(void **state)
{
    (void)state;
    struct {
        size_t struct_size;
        uint64_t memory_peak_bytes, memory_needed_bytes, memory_scene_bytes;
        uint64_t behind;
    } older = {.behind = 77};
    const size_t size = offsetof(ag_prediction, memory_photon_bytes);
    bench b;
    begin_bench(&b);
    const ag_render_settings s = ag_default_render_settings();
    assert_int_equal(ag_predict_memory_fill(b.d.context, b.complete, &s, &older, size), AG_OK);
    const ag_prediction now = ag_context_prediction(b.d.context);
    assert_int_equal(older.struct_size, size);
    assert_int_equal(older.memory_peak_bytes, now.memory_peak_bytes);
    assert_int_equal(older.memory_needed_bytes, now.memory_needed_bytes);
    assert_int_equal(older.memory_scene_bytes, now.memory_scene_bytes);
    assert_int_equal(older.behind, 77);
    end_bench(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(other_sizes_are_refused),
                                       cmocka_unit_test(other_sizes_are_refused_in_silence),
                                       cmocka_unit_test(descriptions_are_needed),
                                       cmocka_unit_test(no_more_is_written_than_the_program_has),
                                       TEST_IN_FOLDER(settings_of_another_release_are_refused),
                                       TEST_IN_FOLDER(what_is_given_back_fits_any_release),
                                       TEST_IN_FOLDER(an_older_prediction_is_filled)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_scene_text.c: scenes from pbrt text in memory: the bits of the file's, files found in the folder of the text's
 * name or by the caller, messages with the text's name. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"

enum { SIZE = 24 };

typedef struct desk {
    ag_context *context;
    ag_scene_settings settings;
    char said[2048];  /* errors and warnings */
    char asked[1024]; /* names that a file was asked for by */
    const char *folder_of_files;
} desk;

static void hear(void *user, ag_log_level level, const char *text)
{
    desk *d = user;
    size_t length = strlen(d->said);
    if (level <= AG_LOG_WARNING)
        snprintf(d->said + length, sizeof d->said - length, "%s\n", text);
}

/* Knows the files of one folder, under names of its own: "mine:NAME". */
static bool find_file(void *user, const char *name, char *out_path, size_t path_size)
{
    desk *d = user;
    size_t length = strlen(d->asked);
    snprintf(d->asked + length, sizeof d->asked - length, "%s;", name);
    if (strncmp(name, "mine:", 5) != 0)
        return false;
    snprintf(out_path, path_size, "%s%s", d->folder_of_files, name + 5);
    return true;
}

static void begin(desk *d, bool is_confined)
{
    *d = (desk){.settings = ag_default_scene_settings(), .folder_of_files = LAYERS_SCENES};
    ag_context_settings made = ag_default_context_settings();
    made.thread_count = 2;
    made.log = hear;
    made.user = d;
    made.is_confined = is_confined;
    d->settings.find_file = find_file;
    d->settings.find_file_user = d;
    assert_int_equal(ag_context_create(&made, &d->context), AG_OK);
}

static void render_and_destroy(desk *d, ag_scene *scene, float *out_pixels)
{
    ag_render_settings settings;
    ag_film *film;
    int width, height;
    assert_int_equal(ag_render_settings_from_scene(d->context, scene, &settings), AG_OK);
    settings.width = settings.height = SIZE;
    settings.samples_per_pixel = 2;
    settings.photon_count = settings.caustic_photon_count = 2000;
    settings.gather_samples = 4;
    assert_int_equal(ag_render(d->context, scene, &settings, &film), AG_OK);
    memcpy(out_pixels, ag_film_pixels(film, &width, &height), 3 * SIZE * SIZE * sizeof *out_pixels);
    ag_film_destroy(film);
    ag_scene_destroy(scene);
}

static char *read_scene(const char *name, size_t *out_size)
{
    char path[512];
    snprintf(path, sizeof path, LAYERS_SCENES "%s", name);
    return (char *)read_bytes(path, out_size);
}

/* box_with_blocks includes another file, which is looked for beside where the text says that it is from. */
static void text_has_the_bits_of_the_file(void **state)
{
    (void)state;
    desk d;
    ag_scene *scene;
    size_t size;
    float of_file[3 * SIZE * SIZE], of_text[3 * SIZE * SIZE];
    begin(&d, false);
    assert_int_equal(ag_scene_load(d.context, LAYERS_SCENES "box_with_blocks.pbrt", &scene), AG_OK);
    render_and_destroy(&d, scene, of_file);
    char *text = read_scene("box_with_blocks.pbrt", &size);
    assert_int_equal(ag_scene_load_text(d.context, LAYERS_SCENES "anything", text, size, NULL, &scene), AG_OK);
    assert_true(ag_scene_was_read_from(scene, LAYERS_SCENES "block.pbrt"));
    assert_false(ag_scene_was_read_from(scene, LAYERS_SCENES "box_with_blocks.pbrt"));
    free(text);
    render_and_destroy(&d, scene, of_text);
    assert_memory_equal(of_text, of_file, sizeof of_file);
    ag_context_destroy(d.context);
}

static void the_caller_may_find_files(void **state)
{
    (void)state;
    static const char TEXT[] = "Camera \"perspective\" WorldBegin\n"
                               "Include \"mine:block.pbrt\"\n"
                               "Shape \"plymesh\" \"string filename\" \"nobodys.ply\"\n";
    static const char WHOLE[] = "Camera \"perspective\" WorldBegin\n"
                                "Include \"mine:block.pbrt\"\n"
                                "LightSource \"point\"\n";
    desk d;
    ag_scene *scene = NULL;
    float pixels[3 * SIZE * SIZE];
    begin(&d, false);
    assert_int_equal(ag_scene_load_text(d.context, "told", TEXT, sizeof TEXT - 1, &d.settings, &scene), AG_ERROR_INPUT);
    assert_null(scene);
    assert_string_equal(d.asked, "mine:block.pbrt;nobodys.ply;");
    assert_non_null(strstr(d.said, "told:3:1: error: Shape \"plymesh\":"));
    d.said[0] = '\0';
    assert_int_equal(ag_scene_load_text(d.context, "told", WHOLE, sizeof WHOLE - 1, &d.settings, &scene), AG_OK);
    assert_string_equal(d.said, "");
    render_and_destroy(&d, scene, pixels);
    ag_context_destroy(d.context);
}

static bool find_nothing(void *user, const char *name, char *out_path, size_t path_size)
{
    (void)user;
    (void)name;
    assert_string_equal(out_path, "");
    assert_true(path_size > 0);
    return true;
}

static void an_empty_path_is_an_error(void **state)
{
    (void)state;
    static const char *const TEXTS[] = {
        "WorldBegin Include \"block.pbrt\"", "WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\"",
        "WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"",
        "WorldBegin LightSource \"infinite\" \"string filename\" \"a.exr\""};
    desk d;
    ag_scene *scene = NULL;
    begin(&d, false);
    d.settings.find_file = find_nothing;
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        d.said[0] = '\0';
        assert_int_equal(ag_scene_load_text(d.context, "told", TEXTS[i], strlen(TEXTS[i]), &d.settings, &scene),
                         AG_ERROR_INPUT);
        assert_non_null(strstr(d.said, "find_file knows \""));
        assert_non_null(strstr(d.said, "told:1:"));
    }
    ag_context_destroy(d.context);
}

/* The caller finds them; a scene that is not trusted may read them where it may read at all. */
static void confined_scenes_stay_confined(void **state)
{
    (void)state;
    static const char TEXT[] = "Camera \"perspective\" WorldBegin\nInclude \"mine:block.pbrt\"\n";
    desk d;
    ag_scene *scene = NULL;
    begin(&d, true);
    assert_int_equal(ag_scene_load_text(d.context, in_folder("text"), TEXT, sizeof TEXT - 1, &d.settings, &scene),
                     AG_ERROR_INPUT);
    assert_non_null(strstr(d.said, "confined"));
    assert_int_equal(ag_scene_load_text(d.context, LAYERS_SCENES "text", TEXT, sizeof TEXT - 1, &d.settings, &scene),
                     AG_OK);
    ag_scene_destroy(scene);
    ag_context_destroy(d.context);
}

static void misuse_is_an_error(void **state)
{
    (void)state;
    desk d;
    ag_scene *scene = NULL;
    begin(&d, false);
    assert_int_equal(ag_scene_load_text(NULL, "t", "WorldBegin", 10, NULL, &scene), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_load_text(d.context, NULL, "WorldBegin", 10, NULL, &scene), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_load_text(d.context, "t", NULL, 10, NULL, &scene), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_load_text(d.context, "t", "WorldBegin", 10, NULL, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_load_text(d.context, "t", "", 0, NULL, &scene), AG_ERROR_SCENE);
    assert_non_null(strstr(d.said, "t:1:1: error: the file ends without WorldBegin"));
    assert_int_equal(ag_scene_load_text(d.context, "t", "WorldBegin garbage", 10, NULL, &scene),
                     AG_OK); /* size counts */
    ag_scene_destroy(scene);
    ag_context_destroy(d.context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_has_the_bits_of_the_file),
        cmocka_unit_test(the_caller_may_find_files),
        cmocka_unit_test(an_empty_path_is_an_error),
        TEST_IN_FOLDER(confined_scenes_stay_confined),
        cmocka_unit_test(misuse_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_scene_changes.c: scenes that are changed after their commit: whatever was changed, the picture has the bits of
 * the same scene made afresh; what did not change is kept; what cannot be done leaves the scene as it was. Threads:
 * one. */
#define _GNU_SOURCE
#include "fixtures/changing_scene.h"
#include "fixtures/sanitizer.h"

static void expect_as_afresh(desk *d, const saying *all, bool is_by_paths)
{
    enum { COUNT = 3 * SIZE * SIZE };
    float changed[COUNT], afresh[COUNT];
    ag_scene *fresh, *const both[] = {d->made, NULL};
    float *const pixels[] = {changed, afresh};
    assert_int_equal(ag_scene_create(d->context, NULL, &fresh), AG_OK);
    say_all(fresh, all, NULL);
    assert_int_equal(ag_scene_commit(fresh), AG_OK);
    for (int i = 0; i < 2; i++) {
        ag_scene *s = both[i] ? both[i] : fresh;
        ag_render_settings settings;
        ag_film *film;
        int width, height;
        assert_int_equal(ag_render_settings_from_scene(d->context, s, &settings), AG_OK);
        settings.width = settings.height = SIZE;
        settings.samples_per_pixel = 2;
        settings.photon_count = settings.caustic_photon_count = 500;
        settings.gather_samples = 2;
        settings.noise_level = 0.0f;
        if (is_by_paths)
            settings.integrator = AG_INTEGRATOR_PATH;
        assert_int_equal(ag_render(d->context, s, &settings, &film), AG_OK);
        memcpy(pixels[i], ag_film_pixels(film, &width, &height), sizeof changed);
        ag_film_destroy(film);
    }
    ag_scene_destroy(fresh);
    d->said[0] = '\0';
    assert_memory_equal(changed, afresh, sizeof changed);
}

/* A changed scene has the picture of one made afresh, whatever was changed in whatever order, and whatever commits
 * failed. */
static void a_changed_scene_is_as_one_made_afresh(void **state)
{
    (void)state;
    enum { SEEDS = IS_THREAD_SANITIZED ? 1 : 3, COMMITS = 25, EDITS_MAX = 5 };
    static const char *const GONE[] = {"gone"};
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        desk d;
        changing c = {.now = {.count = 0}};
        chance random = {seed};
        begin_editable(&d);
        begin_saying(&c.now);
        say_all(d.made, &c.now, c.handles);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        expect_as_afresh(&d, &c.now, false);
        for (int i = 0; i < COMMITS; i++) {
            const changing before = c;
            for (int k = pick(&random, EDITS_MAX); k >= 0; k--)
                change_anything(&d, &c, &random);
            if (i % 5 == 4) {
                const ag_parameter p = {"reflectance", AG_PARAMETER_TEXTURE, 1, .strings = GONE};
                assert_int_equal(ag_scene_change_material(d.made, "plain", "diffuse", &p, 1), AG_OK);
                assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
                expect_said(&d, "no spectrum texture is named \"gone\"");
                c = before;
            } else {
                assert_int_equal(ag_scene_commit(d.made), AG_OK);
            }
            expect_as_afresh(&d, &c.now, i % 2 == 1);
        }
        end(&d);
    }
}

/* Commits the scene, and returns what was built since the last call. */
static ag_commit_counts commit_counted(desk *d, ag_commit_counts *in_out_before)
{
    assert_int_equal(ag_scene_commit(d->made), AG_OK);
    const ag_commit_counts before = *in_out_before, after = ag_scene_commit_counts(d->made);
    *in_out_before = after;
    return (ag_commit_counts){after.commits - before.commits,
                              after.meshes_made - before.meshes_made,
                              after.trees_built - before.trees_built,
                              after.trees_kept - before.trees_kept,
                              after.pictures_read - before.pictures_read,
                              after.pictures_kept - before.pictures_kept};
}

/* Counters tell. Of objects there are two with instances, so that there are three trees; of pictures one of a texture,
 * and one of a sky. */
static void what_did_not_change_is_kept(void **state)
{
    (void)state;
    desk d;
    changing c;
    ag_camera eye = ag_default_camera();
    begin_changing(&d, &c);
    ag_commit_counts counts = ag_scene_commit_counts(d.made), before = counts;
    assert_int_equal(counts.commits, 1);
    assert_int_equal(counts.trees_built, 3);

    /* nothing, or the camera */
    eye.world_from_camera = ASIDE;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    counts = commit_counted(&d, &before);
    assert_int_equal(counts.commits, 0);

    /* exposure, lights, materials, textures */
    assert_int_equal(say_exposure(d.made, 2), AG_OK);
    c.now.thing[16] = 2;
    assert_int_equal(say_thing(d.made, &c.now, 16, c.handles[16], NULL), AG_OK);
    assert_int_equal(say_material(d.made, 0, 1, true), AG_OK);
    assert_int_equal(say_texture(d.made, 0, 1, true), AG_OK);
    assert_int_equal(ag_scene_assign_material(d.made, c.handles[8], "shiny"), AG_OK);
    counts = commit_counted(&d, &before);
    assert_int_equal(counts.commits, 1);
    assert_int_equal(counts.meshes_made + counts.trees_built + counts.pictures_read, 0);
    assert_int_equal(counts.trees_kept, 3);
    assert_int_equal(counts.pictures_kept, 2);

    /* a picture, and nothing of the geometry */
    assert_int_equal(say_picture(d.made, 3, true), AG_OK);
    counts = commit_counted(&d, &before);
    assert_int_equal(counts.trees_built, 0);
    assert_int_equal(counts.pictures_read, 2);

    /* an instance moves: the world's tree, and no object's */
    assert_int_equal(ag_scene_move(d.made, c.handles[13], ASIDE, NULL), AG_OK);
    counts = commit_counted(&d, &before);
    assert_int_equal(counts.meshes_made, 0);
    assert_int_equal(counts.trees_built, 1);
    assert_int_equal(counts.trees_kept, 2);

    /* one mesh of an object: that object's tree, and the world's that shows it */
    c.now.thing[8] = 1;
    assert_int_equal(say_thing(d.made, &c.now, 8, c.handles[8], NULL), AG_OK);
    counts = commit_counted(&d, &before);
    assert_int_equal(counts.meshes_made, 1);
    assert_int_equal(counts.trees_built, 2);
    assert_int_equal(counts.trees_kept, 1);
    end(&d);
}

/* A change that is refused leaves no trace: the picture is the one before. */
static void mistakes_leave_the_scene_as_it_was(void **state)
{
    (void)state;
    desk d, other;
    changing c, others;
    shape_words w;
    ag_rendering *rendering;
    ag_render_settings settings;
    ag_light lamp = ag_default_light();
    float odd = NAN;
    const ag_parameter unknown = {"colour", AG_PARAMETER_RGB, 3, .floats = w.emitted},
                       wrong = {"radius", AG_PARAMETER_FLOAT, 1, .floats = &odd};
    begin_changing(&d, &c);
    begin_changing(&other, &others);

    assert_int_equal(ag_scene_remove(d.made, others.handles[0]), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_remove:1:0: error: the handle is another scene's");
    assert_int_equal(ag_scene_move(d.made, 0, NULL, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_move:1:0: error: the handle is 0, which nothing has");
    lamp.type = "point";
    assert_int_equal(ag_scene_change_light(d.made, c.handles[0], &lamp), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_change_light:1:0: error: the handle is a shape's");
    assert_int_equal(ag_scene_assign_material(d.made, c.handles[16], "plain"), AG_ERROR_ARGUMENT);
    expect_said(&d, "the handle is no shape's");
    assert_int_equal(ag_scene_move(d.made, c.handles[0], AWAY, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "a mesh is moved by an instance of its object");
    assert_int_equal(ag_scene_change_material(d.made, "gold", "diffuse", NULL, 0), AG_ERROR_ARGUMENT);
    expect_said(&d, "there is no material \"gold\"");
    assert_int_equal(ag_scene_add_material(d.made, "plain", "diffuse", NULL, 0), AG_ERROR_SCENE);
    expect_said(&d, "there is a material \"plain\" already");
    assert_int_equal(ag_scene_remove_named(d.made, (ag_named)9, "plain"), AG_ERROR_ARGUMENT);
    expect_said(&d, "there is no such kind of named thing");
    describe_shape(0, 1, 0, &w);
    w.indices[4] = 99;
    assert_int_equal(ag_scene_change_shape(d.made, c.handles[0], &w.shape), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_change_shape:1:2: error: index 99");
    w.shape.struct_size = 3;
    assert_int_equal(ag_scene_change_shape(d.made, c.handles[0], &w.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, "struct_size");
    describe_shape(5, 1, 0, &w);
    w.shape.parameters = &wrong;
    w.shape.parameter_count = 1;
    assert_int_equal(ag_scene_change_shape(d.made, c.handles[5], &w.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, "value 1 is not finite");
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    expect_as_afresh(&d, &c.now, false);

    /* a parameter that is not known is told, once, and ignored as in a file */
    const float grey[3] = {0.5f, 0.5f, 0.5f};
    memcpy(w.emitted, grey, sizeof grey);
    assert_int_equal(ag_scene_change_material(d.made, "plain", "diffuse", &unknown, 1), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    expect_said(&d, "\"rgb colour\" is not known");

    /* commits that cannot be: the last of an object's shapes, a material that is used */
    assert_int_equal(ag_scene_remove_named(d.made, AG_NAMED_MATERIAL, "plain"), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
    expect_said(&d, "no material is named \"plain\"");
    assert_int_equal(ag_render_settings_from_scene(d.context, d.made, &settings), AG_OK);
    assert_int_equal(ag_scene_remove(d.made, c.handles[8]), AG_OK);
    settings.width = settings.height = 4;
    settings.photon_count = settings.caustic_photon_count = 100;
    assert_int_equal(ag_rendering_create(d.context, d.made, &settings, &rendering), AG_ERROR_ARGUMENT);
    expect_said(&d, "the scene was changed: ag_scene_commit comes first");
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
    expect_said(&d, "no object is named \"a\"");
    ag_context_cancel(d.context);
    assert_int_equal(say_exposure(d.made, 3), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_CANCELLED);
    ag_context_clear_cancel(d.context);

    /* under a rendering */
    assert_int_equal(ag_rendering_create(d.context, d.made, &settings, &rendering), AG_OK);
    assert_int_equal(ag_scene_remove(d.made, c.handles[0]), AG_ERROR_ARGUMENT);
    expect_said(&d, "a rendering of it is not finished yet");
    assert_int_equal(say_picture(d.made, 1, true), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
    ag_rendering_finish(rendering, NULL);
    assert_int_equal(say_material(d.made, 0, c.now.material[0], true), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    expect_as_afresh(&d, &c.now, true);
    end(&other);
    end(&d);
}

/* A camera that was set after an edit goes with it; one that was set before stays. Another shutter tells as well. */
static void a_camera_is_dropped_with_the_edits(void **state)
{
    (void)state;
    enum { COUNT = 3 * SIZE * SIZE };
    static const char *const GONE[] = {"gone"};
    const float open = 0.5f, wide = 70.0f;
    const ag_parameter missing = {"reflectance", AG_PARAMETER_TEXTURE, 1, .strings = GONE},
                       other[] = {{"shutteropen", AG_PARAMETER_FLOAT, 1, .floats = &open},
                                  {"fov", AG_PARAMETER_FLOAT, 1, .floats = &wide}};
    float before[COUNT], after[COUNT];
    ag_instance moving = ag_default_instance();
    square item;
    for (int is_set_before = 0; is_set_before < 2; is_set_before++) {
        desk d;
        ag_camera eye = ag_default_camera();
        begin_lit_editable(&d);
        make_square(&item);
        item.shape.object = moving.object = "o";
        assert_int_equal(ag_scene_add_shape(d.made, &item.shape, NULL), AG_OK);
        assert_int_equal(ag_scene_add_instance(d.made, &moving, NULL), AG_OK);
        assert_int_equal(ag_scene_add_material(d.made, "m", "diffuse", NULL, 0), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        eye.world_from_camera = ASIDE;
        if (is_set_before)
            assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
        render(d.context, d.made, before);
        assert_int_equal(ag_scene_change_material(d.made, "m", "diffuse", &missing, 1), AG_OK);
        eye.world_from_camera = AWAY;
        eye.parameters = other;
        for (int i = 1; i <= 2; i++) {
            eye.parameter_count = (size_t)i;
            assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
        }
        assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
        expect_said(&d, "the edits since the last commit are dropped");
        render(d.context, d.made, after);
        assert_memory_equal(before, after, sizeof before);
        /* what moves is made for the shutter that is left */
        moving.world_from_object_end = ASIDE;
        assert_int_equal(ag_scene_add_instance(d.made, &moving, NULL), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        moving.world_from_object_end = NULL;
        render(d.context, d.made, before);
        assert_int_equal(ag_scene_change_material(d.made, "m", "diffuse", NULL, 0), AG_OK);
        eye.parameters = &other[1];
        eye.parameter_count = 1;
        assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        render(d.context, d.made, after);
        assert_memory_not_equal(before, after, sizeof before);
        end(&d);
    }
}

/* Scenes that were not made for it, and those that are not committed. */
static void other_scenes_do_not_change(void **state)
{
    (void)state;
    desk d;
    ag_handle lamp;
    ag_light l = ag_default_light();
    l.type = "point";
    begin(&d);
    assert_int_equal(ag_scene_add_light(d.made, &l, &lamp), AG_OK);
    assert_true(lamp != 0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_scene_remove(d.made, lamp), AG_ERROR_ARGUMENT);
        expect_said(&d, "ag_scene_remove: the scene cannot be changed: is_editable of its settings is false");
        assert_int_equal(ag_scene_commit(d.made), i == 0 ? AG_OK : AG_ERROR_ARGUMENT);
    }
    assert_int_equal(ag_scene_commit_counts(d.made).commits, 0);
    assert_int_equal(ag_scene_commit_counts(NULL).commits, 0);
    end(&d);
    begin_editable(&d);
    assert_int_equal(ag_scene_add_light(d.made, &l, &lamp), AG_OK);
    assert_int_equal(ag_scene_remove(d.made, lamp), AG_ERROR_ARGUMENT);
    expect_said(&d, "is not committed yet");
    assert_int_equal(ag_scene_remove(NULL, lamp), AG_ERROR_ARGUMENT);
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_changed_scene_is_as_one_made_afresh, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_did_not_change_is_kept, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(mistakes_leave_the_scene_as_it_was, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_camera_is_dropped_with_the_edits, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(other_scenes_do_not_change, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

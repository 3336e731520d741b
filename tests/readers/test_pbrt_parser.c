/* test_pbrt_parser.c: blocks, attributes and transforms of pbrt's text, what it tells the renderer, progress; damaged
 * scenes. Threads: one. */
/* ctest: serial */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/pbrt_fixture.h"
#include "fixtures/shared_folder.h"

#include "color/spectra.h"
#include "pbrt/pbrt_private.h"

/* A hint that is given has that value. */
static void check_integer(integer_hint hint, int64_t value)
{
    assert_true(hint.is_given);
    assert_int_equal(hint.value, value);
}

static void hints_for_the_renderer(void **state)
{
    (void)state;
    reading r =
        reading_of("Integrator \"photonmap\" \"integer nused\" [ 300 ] \"float maxdist\" 3 \"bool finalgather\" true\n"
                   "\"integer causticphotons\" 0 \"integer maxdepth\" 7 \"integer finalgathersamples\" 9\n"
                   "Sampler \"stratified\" Sampler \"sobol\" \"integer pixelsamples\" 16 \"integer seed\" -3\n"
                   "Option \"seed\" 5 Film \"gbuffer\" \"string filename\" \"a.exr\" \"bool savefp16\" false\n"
                   "\"integer xresolution\" 40 \"integer yresolution\" 20 \"integer pixelbounds\" [ 10 20 5 99 ]\n"
                   "\"float iso\" 200 \"float whitebalance\" 5000 \"float maxcomponentvalue\" 10\n"
                   "PixelFilter \"box\" \"float xradius\" 2 Accelerator \"bvh\"\n"
                   "\"integer maxnodeprims\" 4 ColorSpace \"srgb\" WorldBegin");
    const scene_hints *hints = &r.scene->hints;
    assert_int_equal(r.count[AG_LOG_WARNING], 0);
    assert_true(hints->is_for_photon_map && hints->has_sampler && !hints->disable_pixel_jitter);
    check_integer(hints->nearest, 300);
    check_integer(hints->caustic_photon_count, 0);
    check_integer(hints->max_depth, 7);
    check_integer(hints->gather_samples, 9);
    check_integer(hints->samples_per_pixel, 16);
    check_integer(hints->seed, -3);
    check_integer(hints->width, 40);
    check_integer(hints->height, 20);
    assert_false(hints->photon_count.is_given);
    assert_true(hints->radius.is_given && hints->radius.value == 3.0f);
    assert_string_equal(hints->file_name, "a.exr");
    assert_true(hints->has_float_samples && hints->surface_layers == SURFACE_LAYERS_CAMERA);
    assert_true(hints->iso == 200.0f && hints->max_component == 10.0f);
    assert_true(hints->white_balance.is_given && hints->white_balance.value == 5000.0f);
    assert_true(hints->has_crop_window);
    for (int i = 0; i < 4; i++)
        assert_near(hints->crop_window[i], (double[]){0.25, 0.5, 0.25, 1.0}[i], 1e-15);
    assert_int_equal(hints->filter.kind, FILTER_BOX);
    assert_true(hints->filter.radius[0] == 2.0f && hints->filter.radius[1] == 0.5f);
    assert_int_equal(hints->filter.where.line, 7);
    assert_int_equal(hints->filter.where.column, 1);
    assert_false(r.scene->has_camera);
    reading_destroy(&r);
    r = reading_of("WorldBegin"); /* nothing said, nothing given */
    hints = &r.scene->hints;
    assert_false(hints->is_for_photon_map || hints->has_sampler || hints->has_crop_window || hints->has_float_samples);
    assert_false(hints->width.is_given || hints->height.is_given || hints->samples_per_pixel.is_given);
    assert_false(hints->seed.is_given || hints->white_balance.is_given || hints->radius.is_given);
    assert_null(hints->file_name);
    assert_true(hints->iso == 100.0f && hints->max_component == 0.0f && hints->filter.radius[0] == 1.5f);
    reading_destroy(&r);
    r = reading_of("Sampler \"stratified\" WorldBegin"); /* pbrt's defaults */
    check_integer(r.scene->hints.samples_per_pixel, 16);
    reading_destroy(&r);
    r = reading_of("Sampler \"independent\" WorldBegin");
    check_integer(r.scene->hints.samples_per_pixel, 4);
    reading_destroy(&r);
}

/* WorldBegin settles them: an error names the parameter's location, and shows it. */
static void wrong_hints(void **state)
{
    (void)state;
    static const struct {
        const char *text, *error;
    } WRONG[] = {
        {"Film \"rgb\" \"integer xresolution\" 0",
         "t:1:12: error: Film: \"xresolution\" is 0, it must be from 1 to 65536\n"},
        {"Film \"rgb\"\n\"float cropwindow\" [ 0 1 0 ]", "t:2:1: error: Film: \"cropwindow\" takes four numbers\n"},
        {"Film \"rgb\" \"float cropwindow\" [ 0 1 2 3 ]",
         "t:1:12: error: Film: \"cropwindow\" leaves no part of the picture\n"},
        {"Film \"rgb\" \"string iso\" \"x\"", "t:1:12: error: "},
        {"Sampler \"sobol\" \"integer pixelsamples\" 0",
         "t:1:17: error: Sampler: \"pixelsamples\" is 0, it must be from 1 to 1048576\n"},
        {"Integrator \"photonmap\" \"integer nused\" 0",
         "t:1:24: error: Integrator: \"nused\" is 0, it must be from 1 to 65536\n"},
        {"Integrator \"photonmap\" \"float maxdist\" -1",
         "t:1:24: error: Integrator: \"maxdist\" must be finite and not negative\n"},
    };
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++) {
        char text[256];
        snprintf(text, sizeof text, "%s WorldBegin", WRONG[i].text);
        reading r = reading_create(NULL, text, strlen(text));
        assert_int_equal(r.status, AG_ERROR_SCENE);
        if (!r.said[AG_LOG_ERROR] || strncmp(r.said[AG_LOG_ERROR], WRONG[i].error, strlen(WRONG[i].error)) != 0)
            fail_msg("%s: %s", WRONG[i].text, r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "nothing said");
        reading_destroy(&r);
    }
}

/* Fails unless the origin of the only sphere comes to lie there. */
static void check_origin(const char *text, double x, double y, double z)
{
    reading r = reading_of(text);
    assert_int_equal(r.scene->shape_count, 1);
    assert_vec3(transform_point(&r.scene->shapes[0].as.quadric.world_from_object, vec3_make(0, 0, 0)), x, y, z, 1e-6);
    reading_destroy(&r);
}

/* Exporters write singular transforms around what is not there: nothing is made below them, and the rest is read. */
static void singular_transforms_leave_out_what_they_hold(void **state)
{
    (void)state;
    const char *text = "WorldBegin AttributeBegin\n"
                       "ConcatTransform [ -0 -0 0 0 0 1 0 0 -1e-16 0 -1 0 5 6 7 1 ] Translate 1 2 3\n"
                       "Shape \"sphere\" Shape \"disk\" LightSource \"point\" ObjectInstance \"o\"\n"
                       "AttributeBegin Identity Shape \"sphere\" AttributeEnd Shape \"sphere\"\n"
                       "AttributeEnd Shape \"sphere\" ObjectBegin \"o\" ObjectEnd Scale 1 0 1 Shape \"sphere\"\n"
                       "CoordSysTransform \"world\" Translate 1 0 0 Shape \"sphere\"";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_string_equal(
        r.said[AG_LOG_WARNING],
        "t:2:1: warning: the singular matrix of ConcatTransform cannot be undone: what stands below it is left out\n"
        "t:3:1: warning: Shape: its transform cannot be undone: it is left out, as are any others of the kind\n"
        "t:3:29: warning: LightSource: its transform cannot be undone: it is left out, as are any others of the kind\n"
        "t:3:49: warning: ObjectInstance: its transform cannot be undone: it is left out, as are any others of the "
        "kind\n");
    assert_int_equal(r.scene->shape_count, 3);
    assert_int_equal(r.scene->light_count, 0);
    assert_int_equal(r.scene->instance_count, 0);
    assert_near(r.scene->shapes[1].as.quadric.world_from_object.m[0][3], 0, 0);
    assert_near(r.scene->shapes[2].as.quadric.world_from_object.m[0][3], 1, 0);
    reading_destroy(&r);
}

static void transforms_compose_as_in_pbrt(void **state)
{
    (void)state;
    check_origin("WorldBegin Translate 1 2 3 Scale 2 2 2 Translate 1 0 0 Shape \"sphere\"", 3, 2, 3);
    check_origin("WorldBegin Rotate 90 0 0 2 Translate 1 0 0 Shape \"sphere\"", 0, 1, 0);
    check_origin("WorldBegin Translate 9 9 9 Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  4 5 6 1 ] Shape \"sphere\"", 4, 5,
                 6);
    check_origin("WorldBegin Translate 1 0 0 ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1 ] Shape \"sphere\"", 5,
                 5, 6);
    check_origin("WorldBegin Translate 1 0 0 Identity Shape \"sphere\"", 0, 0, 0);
    check_origin("Translate 5 0 0 WorldBegin Shape \"sphere\"", 0, 0, 0);
    check_origin("WorldBegin Translate 1 0 0 AttributeBegin Translate 1 0 0 AttributeEnd Shape \"sphere\"", 1, 0, 0);
    check_origin("WorldBegin Translate 1 0 0 CoordinateSystem \"a\" Translate 1 0 0 CoordinateSystem \"b\"\n"
                 "CoordSysTransform \"a\" Translate 0 1 0 Shape \"sphere\"",
                 1, 1, 0);
    check_origin("WorldBegin Translate 1 0 0 CoordSysTransform \"world\" Shape \"sphere\"", 0, 0, 0);
    /* what is placed in "camera" moves with it: one unit before an eye at 0 0 5 that looks down */
    check_origin("LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\"\n"
                 "Translate 0 0 1 Shape \"sphere\"",
                 0, 0, 4);
    check_origin(
        "Scale -1 1 1 LookAt 1 2 3 4 2 3 0 0 1 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\"\n"
        "Translate 0 0 1 Shape \"sphere\"",
        2, 2, 3);
}

static void attributes_are_brought_back(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin Material \"diffuse\" \"rgb reflectance\" [ .1 .1 .1 ]\n"
                           "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [ .2 .2 .2 ] ReverseOrientation\n"
                           "AreaLightSource \"diffuse\" Shape \"sphere\" Shape \"disk\" AttributeEnd Shape \"sphere\"");
    const scene *s = r.scene;
    assert_int_equal(s->shape_count, 3);
    assert_int_equal(s->light_count, 2);
    assert_rgb(s->materials[s->shapes[0].material_index].reflectance, .2, .2, .2, 1e-7);
    assert_rgb(s->materials[s->shapes[2].material_index].reflectance, .1, .1, .1, 1e-7);
    assert_true(s->shapes[0].flip_normal && s->shapes[1].flip_normal && !s->shapes[2].flip_normal);
    assert_int_equal(s->shapes[0].light_index, 0);
    assert_int_equal(s->shapes[1].light_index, 1);
    assert_int_equal(s->lights[1].as.area.shape_index, 1);
    assert_int_equal(s->shapes[2].light_index, SHAPE_NO_LIGHT);
    reading_destroy(&r);
}

/* Of many lines one of each name is in force, and the end of a block brings back what was in force before it. The work
 * of a directive is that of the names: a list of all lines would take 10^10 steps for this file. */
static void attributes_of_one_name_replace_each_other(void **state)
{
    (void)state;
    enum { LINES = 200000, BLOCKS = 1000 };
    char *text = malloc((size_t)LINES * 64 + (size_t)BLOCKS * 80);
    assert_non_null(text);
    char *end = text + sprintf(text, "WorldBegin\n");
    for (int i = 0; i < LINES; i++)
        end += sprintf(end, "Attribute \"shape\" \"float radius\" %d%s\n", i + 1, i % 2 ? " Shape \"sphere\"" : "");
    for (int i = 0; i < BLOCKS; i++)
        end += sprintf(end, "AttributeBegin Attribute \"shape\" \"float radius\" .5 \"float zmax\" .25\n");
    end += sprintf(end, "Shape \"sphere\"\n");
    for (int i = 0; i < BLOCKS; i++)
        end += sprintf(end, "AttributeEnd ");
    end += sprintf(end, "Shape \"sphere\" Attribute \"shape\" \"float radius\" 7 Shape \"sphere\"");
    reading r = reading_create(NULL, text, (size_t)(end - text));
    assert_int_equal(r.status, AG_OK);
    const shape *shapes = r.scene->shapes;
    assert_int_equal(r.scene->shape_count, LINES / 2 + 3);
    for (int i = 0; i < LINES / 2; i++)
        assert_near(shapes[i].as.quadric.radius, 2 * i + 2, 0);
    assert_near(shapes[LINES / 2].as.quadric.radius, 0.5, 0);
    assert_near(shapes[LINES / 2].as.quadric.z_max, 0.25, 0);
    assert_near(shapes[LINES / 2 + 1].as.quadric.radius, LINES, 0);
    assert_near(shapes[LINES / 2 + 1].as.quadric.z_max, LINES, 0);
    assert_near(shapes[LINES / 2 + 2].as.quadric.radius, 7, 0);
    reading_destroy(&r);
    free(text);
}

static void attributes_of_many_names_are_an_error(void **state)
{
    (void)state;
    enum { MOST = 1000 };
    char *text = malloc((size_t)MOST * 64);
    assert_non_null(text);
    for (int count = MOST; count <= MOST + 1; count++) {
        char *end = text + sprintf(text, "WorldBegin Attribute \"light\" \"float a\" 1\n");
        for (int i = 1; i < count; i++)
            end += sprintf(end, "Attribute \"shape\" \"float n%d\" 1\n", i);
        end += sprintf(end, "Attribute \"shape\" \"float last\" 1 Shape \"sphere\"");
        reading r = reading_create(NULL, text, (size_t)(end - text));
        assert_int_equal(r.status, count == MOST ? AG_OK : AG_ERROR_SCENE);
        if (count > MOST)
            assert_non_null(strstr(r.said[AG_LOG_ERROR], "t:1002:19: error: more than 1000 attributes of different "
                                                         "names for \"shape\""));
        reading_destroy(&r);
    }
    free(text);
}

/* Of an array that an Attribute gives there is one for all directives, however many they are, and the names in it are
 * one as well. */
static void attributes_share_their_arrays(void **state)
{
    (void)state;
    enum { LISTS = 50, POINTS = 10000 };
    char *text = malloc((size_t)POINTS * 6 + (size_t)LISTS * 20 + 200);
    assert_non_null(text);
    char *end = text + sprintf(text, "\"shape\" \"string s\" [ \"a\" \"b\" ] \"bool b\" true \"point3 P\" [ ");
    for (int i = 0; i < POINTS; i++)
        end += sprintf(end, "1 2 3 ");
    end += sprintf(end, "]\n");
    for (int i = 0; i < LISTS; i++)
        end += sprintf(end, "Shape \"sphere\"\n");
    const file_location start = {"t", 1, 1};
    reading r;
    run_context run;
    reading_begin(&r, &run);
    pbrt_parser *parser = pbrt_parser_create(&run, r.scene);
    assert_non_null(parser);
    assert_int_equal(pbrt_push_text(parser, "t", text, (size_t)(end - text)), AG_OK);
    assert_int_equal(pbrt_attribute_directive(parser, start), AG_OK);
    parameter_list lists[LISTS];
    int copies = 0;
    for (int i = 0; i < LISTS; i++) {
        pbrt_token word;
        assert_int_equal(pbrt_next(parser, &word), AG_OK);
        assert_int_equal(pbrt_read_named_parameters(parser, "Shape", "a type", start, &lists[i]), AG_OK);
        const parameter *p = parameter_list_find(&lists[i], "P"), *s = parameter_list_find(&lists[i], "s"),
                        *b = parameter_list_find(&lists[i], "b"), *first = parameter_list_find(&lists[0], "P");
        assert_true(p && s && b && p->count == 3 * POINTS && p->numbers[3 * POINTS - 1] == 3.0);
        assert_true(strcmp(s->strings[1], "b") == 0 && b->bools[0]);
        copies += i > 0 && p->numbers != first->numbers;
        copies += i > 0 && s->strings != parameter_list_find(&lists[0], "s")->strings;
        copies += i > 0 && b->bools != parameter_list_find(&lists[0], "b")->bools;
    }
    assert_int_equal(copies, 0);
    for (int i = 0; i < LISTS; i++)
        parameter_list_reset(&lists[i]);
    pbrt_parser_destroy(parser);
    reading_end(&run);
    reading_destroy(&r);
    free(text);
}

/* The reader rewrites pbrt-v3's parameters as those of pbrt-v4 in one directive's list. The values of the Attribute,
 * which the list borrows, stay as they are for the next directive. */
static void attributes_outlive_changes_of_their_values(void **state)
{
    (void)state;
    static const char TEXT[] =
        "WorldBegin Attribute \"light\" \"rgb I\" [ 1 2 3 ] \"rgb scale\" [ 2 3 4 ]\n"
        "LightSource \"point\" LightSource \"point\" LightSource \"point\"\n"
        "Attribute \"light\" \"float scale\" 2 \"blackbody I\" [ 5000 .5 ]\n"
        "LightSource \"point\" LightSource \"point\"\n"
        "Attribute \"medium\" \"string type\" \"heterogeneous\" \"float density\" [ 1 1 ] \"integer nx\" 2\n"
        "MakeNamedMedium \"m\" MakeNamedMedium \"n\"\n"
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" \"conductor\"\n"
        "Attribute \"material\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\"\n"
        "\"rgb amount\" [ .1 .2 .3 ]\n"
        "Material \"mix\" Shape \"sphere\" Material \"mix\" Shape \"sphere\"";
    reading r = reading_create(NULL, TEXT, strlen(TEXT));
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.scene->light_count, 5);
    for (int i = 0; i < 3; i++) {
        const rgb color = r.scene->lights[i].as.point.intensity;
        assert_near(color.g / color.r, 3, 1e-5);
        assert_near(color.b / color.r, 6, 1e-5);
        assert_memory_equal(&color, &r.scene->lights[0].as.point.intensity, sizeof color);
    }
    const rgb hot[2] = {r.scene->lights[3].as.point.intensity, r.scene->lights[4].as.point.intensity};
    assert_true(hot[0].r > 0.0f);
    assert_memory_equal(&hot[0], &hot[1], sizeof hot[0]);
    assert_non_null(strstr(r.said[AG_LOG_WARNING], "\"uniformgrid\""));
    for (size_t i = 0; i < 2; i++) {
        const material *mix = &r.scene->materials[r.scene->shapes[i].material_index];
        assert_int_equal(mix->kind, MATERIAL_MIX);
        assert_near(mix->mix_amount, 0.2, 1e-6);
        assert_int_equal(r.scene->materials[mix->mixed[0]].kind, MATERIAL_CONDUCTOR);
        assert_int_equal(r.scene->materials[mix->mixed[1]].kind, MATERIAL_DIFFUSE);
    }
    reading_destroy(&r);
}

static void attributes_speak_to_what_follows(void **state)
{
    (void)state;
    const char *text =
        "WorldBegin Attribute \"shape\" \"float radius\" 2 \"float nobody\" 1\n"
        "Attribute \"light\" \"float scale\" 3 \"rgb L\" [ 1 2 3 ] \"string meant\" \"for others\"\n"
        "AttributeBegin Attribute \"shape\" \"float radius\" 4 Shape \"sphere\" Shape \"sphere\" \"float radius\" 5\n"
        "AttributeEnd Shape \"disk\" ColorSpace \"aces2065-1\" Attribute \"material\" \"rgb reflectance\" [ .5 .5 .5 "
        "]\n"
        "ColorSpace \"srgb\" Material \"diffuse\" AreaLightSource \"diffuse\" Shape \"sphere\"\n"
        "Attribute \"texture\" \"float value\" .25 Texture \"t\" \"float\" \"constant\"";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_string_equal(r.said[AG_LOG_WARNING],
                        "t:2:53: warning: Attribute \"light\": \"string meant\" is used by nothing that follows\n"
                        "t:1:47: warning: Attribute \"shape\": \"float nobody\" is used by nothing that follows\n");
    static const double RADIUS[] = {4, 5, 2, 2};
    for (int i = 0; i < 4; i++)
        assert_near(r.scene->shapes[i].as.quadric.radius, RADIUS[i], 0);
    assert_rgb(r.scene->materials[r.scene->shapes[3].material_index].reflectance, .5, .5, .5, 1e-6);
    assert_int_equal(r.scene->light_count, 1);
    assert_rgb(r.scene->lights[0].as.area.radiance, 3, 6, 9, 1e-6);
    assert_near(r.scene->textures.items[0].inputs[0].value.r, .25, 0);
    reading_destroy(&r);
}

static void colour_spaces_are_part_of_the_state(void **state)
{
    (void)state;
    reading r = reading_of("ColorSpace \"ACES2065-1\" WorldBegin AttributeBegin ColorSpace \"srgb\"\n"
                           "Material \"diffuse\" \"rgb reflectance\" [ .2 .4 .6 ] Shape \"sphere\" AttributeEnd\n"
                           "Material \"diffuse\" \"rgb reflectance\" [ .5 .4 .3 ] Shape \"sphere\"\n"
                           "LightSource \"point\" \"rgb I\" [ 1 1 1 ]\n"
                           "Material \"conductor\" \"rgb eta\" [ 2 2 2 ] \"rgb k\" [ 3 3 3 ] Shape \"sphere\"");
    const scene *s = r.scene;
    assert_rgb(s->materials[s->shapes[0].material_index].reflectance, .2, .4, .6, 1e-7);
    assert_rgb(s->materials[s->shapes[1].material_index].reflectance, 2.52169 * .5 - 1.13413 * .4 - .38756 * .3,
               -.27648 * .5 + 1.37272 * .4 - .09624 * .3, -.01538 * .5 - .15298 * .4 + 1.16835 * .3, 1e-5);
    assert_rgb(s->materials[s->shapes[2].material_index].eta, 2, 2, 2, 1e-5);
    const char *film = "ColorSpace \"rec2020\" Film \"rgb\" WorldBegin";
    reading pictured = reading_create(NULL, film, strlen(film));
    assert_int_equal(pictured.status, AG_OK);
    assert_string_equal(pictured.said[AG_LOG_WARNING],
                        "t:1:22: warning: the ColorSpace is not that of the picture: it is "
                        "written in linear Rec. 709\n");
    reading_destroy(&pictured);
    rgb white;
    assert_true(spectra_find_named("illum-acesD60", NULL, &white));
    assert_rgb(s->lights[0].as.point.intensity, white.r, white.g, white.b, 1e-6);
    reading_destroy(&r);
}

typedef struct progress_log {
    run_context *run;
    int calls;
    double last;
    bool cancel;
} progress_log;

static void hear_progress(void *user, ag_phase phase, double fraction)
{
    progress_log *p = user;
    assert_int_equal(phase, AG_PHASE_LOAD);
    assert_true(fraction >= p->last && fraction <= 1.0);
    p->last = fraction;
    p->calls++;
    if (p->cancel)
        run_cancel(p->run);
}

static void progress_is_told_and_cancelling_heeded(void **state)
{
    (void)state;
    for (int cancel = 0; cancel < 2; cancel++) {
        run_context run;
        progress_log p = {.run = &run, .cancel = cancel};
        run_context_init(&run, NULL, NULL, hear_progress, &p);
        scene *s = scene_create();
        const char *text = "WorldBegin Shape \"sphere\"";
        assert_int_equal(pbrt_parse_text(&run, "t", text, strlen(text), s), cancel ? AG_CANCELLED : AG_OK);
        assert_true(p.calls > 0);
        assert_near(p.last, cancel ? 0.0 : 1.0, 0.0);
        scene_destroy(s);
        run_context_reset(&run);
    }
}

/* Every beginning of a scene that has a bit of everything, and the scene with each byte changed: anything may be said,
 * nothing may crash or leak. */
static void damaged_scenes_are_survived(void **state)
{
    (void)state;
    static const char TEXT[] =
        "LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" [ 40 ] Film \"rgb\" \"string filename\" [ \"a\" "
        "]\n"
        "WorldBegin MakeNamedMaterial \"m\" \"string type\" \"conductor\" \"rgb k\" [ 1 2 3 ] # comment\n"
        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] \"bool twosided\" true NamedMaterial \"m\"\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] \"integer indices\" [ 0 1 2 3 ] AttributeEnd\n"
        "Texture \"t\" \"float\" \"scale\" \"float v\" 2 ObjectBegin \"o\" Shape \"disk\" ObjectEnd\n"
        "ActiveTransform EndTime Rotate 9 1 0 0 ObjectInstance \"o\" ColorSpace \"rec2020\"\n"
        "Attribute \"shape\" \"float radius\" 1 Material \"diffuse\" \"spectrum reflectance\" [ 400 1 ] Import "
        "\"/none\"";
    static const unsigned char BYTES[] = {0, '"', '[', ']', '#', '\\', '\n', '-', '9', 'e', 'x', 0xff};
    size_t size = sizeof TEXT - 1;
    char *copy = malloc(size);
    assert_non_null(copy);
    for (size_t length = 0; length <= size; length++) {
        memcpy(copy, TEXT, size);
        reading r = reading_create(NULL, copy, length);
        assert_int_equal(r.status != AG_OK, r.count[AG_LOG_ERROR] == 1);
        reading_destroy(&r);
    }
    for (size_t i = 0; i < size; i++) {
        memcpy(copy, TEXT, size);
        for (size_t b = 0; b < sizeof BYTES; b++) {
            copy[i] = (char)BYTES[b];
            reading r = reading_create(NULL, copy, size);
            assert_int_equal(r.status != AG_OK, r.count[AG_LOG_ERROR] == 1);
            reading_destroy(&r);
        }
    }
    free(copy);
}

static void cornell_box_is_read(void **state)
{
    (void)state;
    if (!shared_folder()) {
        print_message("SKIPPED: cornell-box is in the folder shared, which is not beside the source folder\n");
        skip();
    }
    char path[1024];
    snprintf(path, sizeof path, "%s/scenes/cornell-box/scene.pbrt", shared_folder());
    reading r = reading_create(path, NULL, 0);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    assert_non_null(strstr(r.said[AG_LOG_WARNING], "Integrator \"path\" is another renderer's"));
    assert_int_equal(r.scene->shape_count, 8);
    assert_int_equal(r.scene->light_count, 1);
    assert_true(r.scene->has_camera);
    assert_false(r.scene->hints.is_for_photon_map); /* it is for pbrt's "path" */
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hints_for_the_renderer),
        cmocka_unit_test(wrong_hints),
        cmocka_unit_test(transforms_compose_as_in_pbrt),
        cmocka_unit_test(singular_transforms_leave_out_what_they_hold),
        cmocka_unit_test(attributes_are_brought_back),
        cmocka_unit_test(attributes_share_their_arrays),
        cmocka_unit_test(attributes_outlive_changes_of_their_values),
        cmocka_unit_test(attributes_speak_to_what_follows),
        cmocka_unit_test(attributes_of_one_name_replace_each_other),
        cmocka_unit_test(attributes_of_many_names_are_an_error),
        cmocka_unit_test(colour_spaces_are_part_of_the_state),
        cmocka_unit_test(progress_is_told_and_cancelling_heeded),
        cmocka_unit_test(damaged_scenes_are_survived),
        cmocka_unit_test(cornell_box_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

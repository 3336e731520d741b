/* test_program_layers.c: layers and metadata in the program's files: parts that add up bit for bit, camera matrices
 * that lead from points to pixels, crops, tiles, halves, and files that are equal where pictures are. Threads: the
 * program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define SMALL                                                                                                          \
    "-q", "--size", "20x16", "--spp", "2", "--photons", "2000", "--caustic-photons", "2000", "--gather-samples", "4"

static image read_layers(const char *name, int channel_count)
{
    image read;
    if (image_read(in_folder(name), &read, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
    assert_int_equal(read.channel_count, channel_count);
    return read;
}

static void run_well(const char *const *arguments)
{
    program_run run = program_execute(NULL, arguments);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
}

/* R, G, B, P.X, P.Y, P.Z, then caustic, direct, emission, indirect, specular. */
static void test_parts_in_files(void **state)
{
    (void)state;
    run_well(
        ARGUMENTS(SMALL, "--type", "float", "--aov", "light,P", "-o", "p.exr", PROGRAM_SCENES "glass_and_metal.pbrt"));
    image p = read_layers("p.exr", 21);
    static const int order[] = {12, 9, 15, 6, 18};
    for (int i = 0; i < p.width * p.height; i++)
        for (int c = 0; c < 3; c++) {
            const float *pixel = p.pixels + 21 * i + c;
            float sum = pixel[order[0]];
            for (int k = 1; k < 5; k++)
                sum += pixel[order[k]];
            assert_memory_equal(&sum, pixel, sizeof sum);
        }

    /* where a pixel's position is shown, worldToNDC puts it: within the pixel but for the mean over edges */
    float ndc[16];
    unsigned char *value = attribute_of("p.exr", "worldToNDC", "m44f");
    assert_non_null(value);
    memcpy(ndc, value, sizeof ndc);
    free(value);
    int near = 0;
    for (int y = 0; y < p.height; y++)
        for (int x = 0; x < p.width; x++) {
            const float *position = p.pixels + 21 * (y * p.width + x) + 3;
            double projected[4];
            for (int k = 0; k < 4; k++)
                projected[k] = (double)position[0] * (double)ndc[k] + (double)position[1] * (double)ndc[4 + k] +
                               (double)position[2] * (double)ndc[8 + k] + (double)ndc[12 + k];
            near += fabs(projected[0] / projected[3] * p.width - (x + 0.5)) < 0.6 &&
                    fabs(projected[1] / projected[3] * p.height - (y + 0.5)) < 0.6;
        }
    assert_true(near > 9 * p.width * p.height / 10);
    free(p.pixels);

    value = attribute_of("p.exr", "worldToCamera", "m44f");
    assert_non_null(value);
    float to_camera[16];
    memcpy(to_camera, value, sizeof to_camera);
    free(value);
    /* LookAt 0 1.1 3.4  0 0.75 0: the eye is the origin */
    for (int k = 0; k < 3; k++)
        assert_true(fabsf(1.1f * to_camera[4 + k] + 3.4f * to_camera[8 + k] + to_camera[12 + k]) < 1e-5f);
}

static void test_metadata(void **state)
{
    (void)state;
    run_well(ARGUMENTS(SMALL, "--seed", "77", "-o", "p.exr", PROGRAM_SCENES "mirror_wall.pbrt"));
    static const struct {
        const char *name, *part;
    } texts[] = {{"afterglow/seed", "77"},
                 {"afterglow/samplesPerPixel", "2"},
                 {"afterglow/photonsGlobal", "2000"},
                 {"afterglow/integrator", "photonmap"},
                 {"afterglow/commandLine", "--seed 77 -o p.exr"},
                 {"afterglow/version", "."},
                 {"afterglow/threads", ""},
                 {"afterglow/cpu", ""},
                 {"afterglow/irradianceComputed", ""}};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        unsigned char *value = attribute_of("p.exr", texts[i].name, "string");
        if (!value || !strstr((const char *)value, texts[i].part))
            fail_msg("%s is %s", texts[i].name, value ? (const char *)value : "not there");
        free(value);
    }
    float white[8];
    unsigned char *value = attribute_of("p.exr", "chromaticities", "chromaticities");
    assert_non_null(value);
    memcpy(white, value, sizeof white);
    free(value);
    assert_true(fabsf(white[6] - 0.3127f) < 1e-6f && fabsf(white[7] - 0.329f) < 1e-6f);
    value = attribute_of("p.exr", "renderTimeSeconds", "float");
    assert_non_null(value);
    free(value);
}

static void test_reproducible(void **state)
{
    (void)state;
    run_well(ARGUMENTS(SMALL, "--aov", "all", "--reproducible", "-t", "1", "-o", "a.exr",
                       PROGRAM_SCENES "glass_and_metal.pbrt"));
    run_well(ARGUMENTS(SMALL, "--aov", "all", "--reproducible", "-t", "3", "-o", "b.exr",
                       PROGRAM_SCENES "glass_and_metal.pbrt"));
    expect_same_files("a.exr", "b.exr");
    assert_null(attribute_of("a.exr", "afterglow/commandLine", "string"));
    assert_null(attribute_of("a.exr", "renderTimeSeconds", "float"));
}

/* A crop's layers are those of the whole; its windows say where it is. Tiles hold the same. */
static void test_crop_and_tiles(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES "mirror_wall.pbrt";
    run_well(ARGUMENTS(SMALL, "--aov", "Z,N,light,id", "-o", "whole.exr", scene));
    run_well(ARGUMENTS(SMALL, "--aov", "Z,N,light,id", "--cropwindow", "0.25,0.75,0.5,1", "-o", "crop.exr", scene));
    run_well(ARGUMENTS(SMALL, "--aov", "Z,N,light,id", "--tiled", "-o", "tiled.exr", scene));
    image whole = read_layers("whole.exr", 24), crop = read_layers("crop.exr", 24),
          tiled = read_layers("tiled.exr", 24);
    assert_int_equal(crop.width, 10);
    assert_int_equal(crop.height, 8);
    for (int y = 0; y < 8; y++)
        assert_memory_equal(crop.pixels + 24 * 10 * y, whole.pixels + 24 * (20 * (y + 8) + 5), 24 * 10 * sizeof(float));
    assert_memory_equal(whole.pixels, tiled.pixels, 24 * 20 * 16 * sizeof(float));
    int32_t window[4];
    unsigned char *value = attribute_of("crop.exr", "dataWindow", "box2i");
    assert_non_null(value);
    memcpy(window, value, sizeof window);
    assert_true(window[0] == 5 && window[1] == 8 && window[2] == 14 && window[3] == 15);
    free(value);
    value = attribute_of("crop.exr", "displayWindow", "box2i");
    memcpy(window, value, sizeof window);
    assert_true(window[0] == 0 && window[1] == 0 && window[2] == 19 && window[3] == 15);
    free(value);
    value = attribute_of("tiled.exr", "tiles", "tiledesc");
    assert_non_null(value);
    free(value);
    value = attribute_of("whole.exr", "compression", "compression");
    assert_int_equal(value[0], 3); /* ZIP, which loses nothing */
    free(value);
    free(whole.pixels);
    free(crop.pixels);
    free(tiled.pixels);
}

/* Values that halves cannot hold are clamped and counted; floats can hold them. */
static void test_half(void **state)
{
    (void)state;
    const char *scene =
        write_text("bright.pbrt", "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 "
                                  "Camera \"perspective\" WorldBegin LightSource \"infinite\" \"rgb L\" [1e6 2 3]");
    program_run run = RUN("--progress", "none", "--spp", "1", "--integrator", "path", "-o", "p.exr", scene);
    expect_exit(&run, 0);
    expect_said(&run, "16 pixels have values above 65504");
    program_run_reset(&run);
    image p = read_layers("p.exr", 3);
    assert_true(p.pixels[0] == 65504.0f && p.pixels[1] == 2.0f);
    free(p.pixels);
    run_well(ARGUMENTS("-q", "--spp", "1", "--type", "float", "--integrator", "path", "-o", "p.exr", scene));
    p = read_layers("p.exr", 3);
    assert_true(p.pixels[0] > 999990.0f);
    free(p.pixels);
}

static void test_what_is_said(void **state)
{
    (void)state;
    static const struct {
        const char *option, *said;
    } wrong[] = {{"--aov=albedos", "--aov: 'albedos' is not valid"},
                 {"--aov=", "--aov: '' is not valid"},
                 {"--clamp-direct=-1", "--clamp-direct: '-1' is not valid"},
                 {"--clamp-indirect=nan", "--clamp-indirect: 'nan' is not valid"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        program_run run = RUN(wrong[i].option, "-o", "p.exr", PROGRAM_SCENES "floor.pbrt");
        expect_exit(&run, 2);
        expect_said(&run, wrong[i].said);
        program_run_reset(&run);
    }
    program_run idle = RUN("--aov=Z", "-o", "p.png", PROGRAM_SCENES "floor.pbrt");
    expect_exit(&idle, 2);
    expect_said(&idle, "--aov is for .exr files, and there is none");
    program_run_reset(&idle);
    const char *scene = write_text("group.pbrt", "Camera \"perspective\" WorldBegin\n"
                                                 "LightSource \"point\" \"string lightgroup\" \"a b\"");
    program_run run = RUN("-o", "p.exr", scene);
    expect_exit(&run, 1);
    expect_said(&run, "group.pbrt:2:");
    expect_said(&run, "\"lightgroup\" should be a name");
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_parts_in_files), TEST_IN_FOLDER(test_metadata), TEST_IN_FOLDER(test_reproducible),
        TEST_IN_FOLDER(test_crop_and_tiles), TEST_IN_FOLDER(test_half),     TEST_IN_FOLDER(test_what_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_program_texture_filter.c: textures filtered over ray cones: a plane to the horizon has less error at 4 samples
 * than unfiltered at 16, and the same mean; so have a room with pictures on its walls, by photon map and path tracing,
 * and the plane in a mirror; whatever the number of threads and the memory for textures, in parts and as a whole the
 * bits are the same; checkerboards are filtered, too.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"
#include "fixtures/program_textures.h"
#include "math/rng.h"

/* Writes a picture of random colours. */
static void write_noise(const char *name, int side)
{
    float *pixels = malloc((size_t)side * (size_t)side * 3 * sizeof *pixels);
    assert_non_null(pixels);
    for (int i = 0; i < 3 * side * side; i++) {
        rng random = rng_make(1, 2, (uint64_t)i);
        pixels[i] = rng_float(&random);
    }
    write_square(name, side, 3, IMAGE_UINT8, pixels);
    free(pixels);
}

#define PICTURE                                                                                                          \
    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"noise.png\" \"float uscale\" %d \"float vscale\" %d " \
    "Material \"diffuse\" \"texture reflectance\" \"t\" "

/* A plane of that material fills the picture; nothing else is noisy. */
static const char *plane_of(const char *material)
{
    char text[2048];
    snprintf(text, sizeof text,
             "LookAt 0 0.5 0  0 0 2  0 1 0 Camera \"perspective\" \"float fov\" 26 "
             "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64 WorldBegin "
             "LightSource \"distant\" \"point3 from\" [0 10 0] \"point3 to\" [0 0 0] \"rgb L\" [3 3 3] %s "
             "Shape \"trianglemesh\" \"point3 P\" [-99 0 -99  99 0 -99  99 0 99 -99 0 99] \"point2 uv\" "
             "[0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3]",
             material);
    return write_scene(text);
}

static const char *horizon(void)
{
    char material[512];
    write_noise("noise.png", 128);
    snprintf(material, sizeof material, PICTURE, 1000, 1000);
    return plane_of(material);
}

/* Relative mean squared error, where dark pixels count less. */
static double error_of(const picture *p, const picture *reference)
{
    double sum = 0.0;
    for (int i = 0; i < 3 * p->width * p->height; i++) {
        double wanted = (double)reference->pixels[i], off = (double)p->pixels[i] - wanted;
        sum += off * off / (wanted * wanted + 1e-3);
    }
    return sum / (3 * p->width * p->height);
}

#define PLANE "--integrator=path", "--max-depth=1", "--noise=0"

static picture render_path(const char *scene, const char *filter, const char *samples)
{
    return RENDER(scene, PLANE, filter, samples);
}

static void test_horizon(void **state)
{
    (void)state;
    const char *scene = horizon();
    picture reference = render_path(scene, "--texture-filter=off", "--spp=1024"),
            before = render_path(scene, "--texture-filter=off", "--spp=16"),
            now = render_path(scene, "--texture-filter=on", "--spp=4");
    double error_before = error_of(&before, &reference), error_now = error_of(&now, &reference);
    print_message("error %.5f at 16 samples unfiltered, %.5f at 4 filtered\n", error_before, error_now);
    assert_true(error_now < error_before);
    const agreement_means filtered = agreement_render(scene, ARGUMENTS(PLANE, "--texture-filter=on", "--spp=4")),
                          unfiltered = agreement_render(scene, ARGUMENTS(PLANE, "--texture-filter=off", "--spp=256"));
    expect_agreement("the plane", &filtered, &unfiltered, (agreement_bounds){AGREEMENT_BLUR, 0.002, 0.02});
    picture_reset(&reference);
    picture_reset(&before);
    picture_reset(&now);
}

/* Cells from many pixels to far less than one, on the plane and in space, along the axes and askew: at most half of the
 * error at 4 samples, and the mean of unfiltered ones. */
static void test_checkerboards(void **state)
{
    (void)state;
    static const char *const MAPPINGS[] = {
        "\"float uscale\" 3000 \"float vscale\" 3000", "\"float uscale\" 400 \"float vscale\" 400",
        "\"string mapping\" \"planar\" \"vector3 v1\" [4 0 4] \"vector3 v2\" [-4 0 4]", "\"integer dimension\" 3"};
    for (size_t k = 0; k < sizeof MAPPINGS / sizeof *MAPPINGS; k++) {
        char material[512];
        snprintf(material, sizeof material,
                 "AttributeBegin Rotate 45 1 0 0 Scale 0.2 0.2 0.2 Texture \"t\" \"spectrum\" \"checkerboard\" %s "
                 "\"rgb tex1\" [0.9 0.8 0.7] \"rgb tex2\" [0.05 0.1 0.2] AttributeEnd "
                 "Material \"diffuse\" \"texture reflectance\" \"t\"",
                 MAPPINGS[k]);
        const char *scene = plane_of(material);
        picture reference = render_path(scene, "--texture-filter=off", "--spp=1024"),
                before = render_path(scene, "--texture-filter=off", "--spp=4"),
                now = render_path(scene, "--texture-filter=on", "--spp=4"),
                many = render_path(scene, "--texture-filter=on", "--spp=256");
        const double error_before = error_of(&before, &reference), error_now = error_of(&now, &reference),
                     error_many = error_of(&many, &reference);
        print_message("error %.5f unfiltered, %.5f filtered, %.6f of many\n", error_before, error_now, error_many);
        assert_true(error_now < 0.5 * error_before);
        assert_true(error_many < 5e-4);
        for (int c = 0; c < 3; c++)
            expect_near("the cells", picture_mean(&many, c), picture_mean(&reference, c), 0.001);
        picture_reset(&reference);
        picture_reset(&before);
        picture_reset(&now);
        picture_reset(&many);
    }
}

/* A picture far away, as one of these materials: whether it is filtered at all. */
static bool is_filtered(const char *material)
{
    char text[4096];
    snprintf(text, sizeof text,
             "LookAt 0 0 -40  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 2 "
             "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16 WorldBegin "
             "LightSource \"distant\" \"point3 from\" [0 0 -9] \"point3 to\" [0 0 0] "
             "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"noise.png\" "
             "Texture \"t2\" \"spectrum\" \"imagemap\" \"string filename\" \"noise.png\" \"float scale\" 2 "
             "Texture \"half\" \"spectrum\" \"scale\" \"texture tex\" \"t\" \"float scale\" 0.5 "
             "Texture \"c\" \"float\" \"checkerboard\" \"float uscale\" 64 \"float vscale\" 64 "
             "Texture \"cells\" \"spectrum\" \"scale\" \"texture tex\" \"t\" \"texture scale\" \"c\" "
             "Texture \"picked\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"t\" \"texture tex2\" \"half\" "
             "Texture \"plain\" \"spectrum\" \"checkerboard\" \"float uscale\" 64 \"float vscale\" 64 "
             "\"rgb tex1\" [0.5 0.5 0.5] "
             "Texture \"mixed\" \"spectrum\" \"mix\" \"texture amount\" \"c\" \"rgb tex1\" [0.1 0.1 0.1] "
             "Texture \"twice\" \"spectrum\" \"scale\" \"texture tex\" \"plain\" \"texture scale\" \"c\" "
             "Texture \"bright\" \"spectrum\" \"scale\" \"texture tex\" \"plain\" \"float scale\" 3 "
             "Material %s "
             "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0 -1 1 0] \"point2 uv\" "
             "[0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3]",
             material);
    const char *scene = write_scene(text);
    picture off = render_path(scene, "--texture-filter=off", "--spp=4"),
            on = render_path(scene, "--texture-filter=on", "--spp=4");
    const size_t size = 3 * (size_t)on.width * (size_t)on.height * sizeof *on.pixels;
    const bool is_alike = memcmp(on.pixels, off.pixels, size) == 0;
    assert_true(picture_mean(&off, 1) > 0.01);
    picture_reset(&off);
    picture_reset(&on);
    return !is_alike;
}

/* Textures that cut values, or pick among them, at each point give another mean than that of their filtered values, so
 * they stay unfiltered. */
static void test_not_linear(void **state)
{
    (void)state;
    write_noise("noise.png", 512);
    assert_true(is_filtered("\"diffuse\" \"texture reflectance\" \"t\""));
    assert_true(is_filtered("\"diffuse\" \"texture reflectance\" \"half\""));
    assert_true(
        is_filtered("\"diffusetransmission\" \"texture reflectance\" \"half\" \"texture transmittance\" \"half\""));
    assert_true(is_filtered("\"diffuse\" \"texture reflectance\" \"plain\""));
    assert_true(is_filtered("\"diffuse\" \"texture reflectance\" \"mixed\""));
    assert_false(is_filtered("\"diffuse\" \"texture reflectance\" \"twice\""));
    assert_false(is_filtered("\"diffuse\" \"texture reflectance\" \"bright\""));
    assert_false(is_filtered("\"diffuse\" \"texture reflectance\" \"t2\""));
    assert_false(is_filtered("\"diffuse\" \"texture reflectance\" \"cells\""));
    assert_false(is_filtered("\"diffuse\" \"texture reflectance\" \"picked\""));
    assert_false(is_filtered("\"diffusetransmission\" \"texture reflectance\" \"t\" \"texture transmittance\" \"t\""));
}

/* A closed room of pictures with a lamp: light that goes from wall to wall, by coarse look-ups of photons, gather rays
 * and paths, is that of unfiltered path tracing. */
static const char *room(void)
{
    char text[4096];
    write_noise("noise.png", 512);
    snprintf(
        text, sizeof text,
        "LookAt 0.2 0.1 -0.9  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 80 "
        "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24 WorldBegin "
        "AttributeBegin Translate 0 0.6 0 AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Material \"diffuse\" "
        "\"rgb reflectance\" [0 0 0] Shape \"sphere\" \"float radius\" 0.2 AttributeEnd " PICTURE
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 4 5 0 5 1 3 2 6 3 6 7 0 3 7 0 7 4 1 "
        "5 6 1 6 2] \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1] \"point2 "
        "uv\" [0 0 1 0 1 1 0 1 0.1 0.9 0.9 1.2 1.7 2.1 1.2 2]",
        1, 1);
    return write_scene(text);
}

static void test_room(void **state)
{
    (void)state;
    const char *scene = room();
    const agreement_means reference = agreement_render(
                              scene, ARGUMENTS("--integrator=path", "--noise=0", "--spp=64", "--texture-filter=off")),
                          path = agreement_render(
                              scene, ARGUMENTS("--integrator=path", "--noise=0", "--spp=64", "--texture-filter=on")),
                          map = agreement_render(
                              scene, ARGUMENTS(AGREEMENT_MAP, "--noise=0", "--spp=8", "--texture-filter=on"));
    expect_agreement("paths", &path, &reference, (agreement_bounds){AGREEMENT_BLUR, 0.003, 0.02});
    expect_agreement("photon map", &map, &reference, (agreement_bounds){AGREEMENT_BLUR, 0.006, 0.02});
}

static void test_same_bits(void **state)
{
    (void)state;
    const char *scene = room();
    picture whole = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--nthreads=1");
    picture threads = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--nthreads=5", "--cache=precompute");
    picture part = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--cropwindow=0.5,1,0,0.5");
    picture off = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-filter=off");
    const size_t size = 3 * 24 * 24 * sizeof *whole.pixels;
    assert_memory_equal(whole.pixels, threads.pixels, size);
    assert_true(memcmp(whole.pixels, off.pixels, size) != 0);
    assert_int_equal(part.width, 12);
    for (int y = 0; y < 12; y++)
        assert_memory_equal(part.pixels + 3 * 12 * y, whole.pixels + 3 * (24 * y + 12), 3 * 12 * sizeof *part.pixels);
    picture_reset(&whole);
    picture_reset(&threads);
    picture_reset(&part);
    picture_reset(&off);
}

/* A map that was traced with filtering is not taken for one without. */
static void test_photon_map_file(void **state)
{
    (void)state;
    const char *scene = room();
    picture first = RENDER(scene, "--spp=1", "--noise=0", "--photons=1e4", "--photon-map=room.map"),
            again = RENDER(scene, "--spp=1", "--noise=0", "--photons=1e4", "--photon-map=room.map");
    assert_memory_equal(first.pixels, again.pixels, 3 * 24 * 24 * sizeof *first.pixels);
    program_run run = RUN(scene, "--spp=1", "--noise=0", "--photons=1e4", "--photon-map=room.map",
                          "--texture-filter=off", "-o", "other.exr");
    assert_true(run.exit_code != 0);
    assert_non_null(strstr(run.err, "texture"));
    program_run_reset(&run);
    picture_reset(&first);
    picture_reset(&again);
}

/* Two pictures that do not fit, of bytes with alpha and of floats: the same bits as in memory, by whatever threads;
 * tiles are read, and keep to the bound. */
static const char *large_room(void)
{
    enum { SIDE = 1500 };
    float *pixels = malloc((size_t)SIDE * SIDE * 4 * sizeof *pixels);
    assert_non_null(pixels);
    for (int i = 0; i < 4 * SIDE * SIDE; i++) {
        rng random = rng_make(1, 3, (uint64_t)i);
        pixels[i] = rng_float(&random);
    }
    write_square("bytes.png", SIDE, 4, IMAGE_UINT8, pixels);
    write_square("floats.exr", SIDE, 3, IMAGE_FLOAT, pixels);
    free(pixels);
    return write_room_of("bytes.png", "floats.exr");
}

static void test_memory(void **state)
{
    (void)state;
    const char *scene = large_room();
    picture whole = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-memory=0"),
            tiled = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-memory=16M", "--nthreads=1"),
            again = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-memory=64M", "--nthreads=7",
                           "--stats=more.json"),
            least = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-memory=16M", "--nthreads=7",
                           "--stats=least.json", "--photon-map=a.map"),
            from_map = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--photon-map=a.map");
    const size_t size = 3 * 24 * 24 * sizeof *whole.pixels;
    assert_memory_equal(tiled.pixels, whole.pixels, size);
    assert_memory_equal(again.pixels, whole.pixels, size);
    assert_memory_equal(from_map.pixels, least.pixels, size); /* the map's fingerprint of the scene is the same, too */
    json_t *stats = stats_read(in_folder("least.json"));
    const long long held = stats_integer(stats, "texture.whole_bytes"),
                    most = stats_integer(stats, "texture.tile_bytes");
    assert_int_equal(held, 0);
    assert_true(most > 1 << 20 && most <= 16 << 20);
    assert_true(stats_integer(stats, "texture.tiles_read") * 12 * 64 * 64 > most);
    assert_true(stats_integer(stats, "texture.file_bytes") > 1500LL * 1500 * (3 + 1 + 12));
    json_decref(stats);
    stats = stats_read(in_folder("more.json"));
    assert_true(stats_integer(stats, "texture.whole_bytes") > 1500LL * 1500 * 4);
    json_decref(stats);
    picture_reset(&whole);
    picture_reset(&tiled);
    picture_reset(&again);
    picture_reset(&least);
    picture_reset(&from_map);
}

/* Sizes that are none; and a file system that is full while textures are put there. */
static void test_memory_errors(void **state)
{
    (void)state;
    static const char *const WRONG[] = {"--texture-memory=15M", "--texture-memory=-1",
                                        "--texture-memory=1P",  "--texture-memory=16MB",
                                        "--texture-memory=",    "--texture-memory=99999999999G"};
    for (size_t k = 0; k < sizeof WRONG / sizeof *WRONG; k++) {
        program_run run = RUN(WRONG[k], "-o", "no.exr", PROGRAM_SCENES "box_with_blocks.pbrt");
        expect_exit(&run, 2);
        program_run_reset(&run);
    }
    const char *scene = large_room();
    const program_setting setting = {.file_size_limit = 1 << 20};
    program_run run = program_execute(&setting, ARGUMENTS("--texture-memory=16M", "-o", "no.exr", scene));
    assert_true(run.exit_code > 0);
    assert_non_null(strstr(run.err, "temporary file"));
    assert_true(access(in_folder("no.exr"), F_OK) != 0);
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_horizon), TEST_IN_FOLDER(test_checkerboards), TEST_IN_FOLDER(test_not_linear),
        TEST_IN_FOLDER(test_room),    TEST_IN_FOLDER(test_same_bits),     TEST_IN_FOLDER(test_photon_map_file),
        TEST_IN_FOLDER(test_memory),  TEST_IN_FOLDER(test_memory_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

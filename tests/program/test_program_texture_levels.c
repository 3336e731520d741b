/* test_program_texture_levels.c: files that hold tiles and coarser levels: their own levels are what is seen from afar;
 * the same bits in memory and tile by tile, by whatever threads, and in a photon map's fingerprint; broken ones are
 * told. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_textures.h"
#include "fixtures/tiled_tiff.h"

/* Each level of a colour of its own: the finest is red, the next one green, others blue. */
static unsigned char colored(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    (void)x, (void)y;
    return channel == (level < 2 ? level : 2) ? 255 : 0;
}

static unsigned char noise(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    const uint32_t key = ((level * 4096 + y) * 4096 + x) * 4 + channel;
    return (unsigned char)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 56);
}

/* A square of 256 x 256 pixels of the picture, seen straight on over so many of ours, lit by pi W/m^2. */
static picture look(const char *size)
{
    write_scene("LookAt 0 0 -5  0 0 0  0 1 0 Camera \"orthographic\" WorldBegin "
                "LightSource \"distant\" \"point3 from\" [0 0 -9] \"point3 to\" [0 0 0] "
                "\"rgb L\" [3.14159265 3.14159265 3.14159265] "
                "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tx\" \"string encoding\" \"linear\" "
                "Material \"diffuse\" \"texture reflectance\" \"t\" "
                "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0 -1 1 0] \"point2 uv\" "
                "[0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3]");
    return RENDER("scene.pbrt", "--integrator=path", "--max-depth=1", "--noise=0", "--spp=1", "--size", size);
}

static void test_own_levels(void **state)
{
    (void)state;
    tiff_write_levels("a.tx", 256, 3, colored);
    picture close = look("256x256"), far = look("16x16");
    assert_true(picture_mean(&close, 0) > 0.99); /* pixel by pixel */
    assert_true(picture_mean(&far, 2) > 0.9 && picture_mean(&far, 0) < 0.01);
    picture_reset(&close);
    picture_reset(&far);
}

/* Pixels of 0 and 255 whose next level is 128, as a mean of encoded values; 188 is the encoded mean of light. */
static unsigned char dark_mean(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    (void)channel;
    return level > 0 ? 128 : (x + y) % 2 ? 255 : 0;
}

static unsigned char light_mean(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    return level > 0 ? 188 : dark_mean(level, x, y, channel);
}

/* Levels that end before a single pixel would leave what is far away unfiltered: the file's own are not used. */
static void test_levels_that_end_early(void **state)
{
    (void)state;
    tiff_least_side = 128;
    tiff_write_levels("a.tx", 256, 3, colored);
    tiff_least_side = 1;
    picture far = look("16x16");
    assert_true(picture_mean(&far, 0) > 0.9 && picture_mean(&far, 1) < 0.01);
    picture_reset(&far);
}

/* Levels that have less light than the picture are told. */
static void test_dark_levels(void **state)
{
    (void)state;
    write_scene(
        "Camera \"perspective\" WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tx\" "
        "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"");
    for (int k = 0; k < 4; k++) {
        tiff_write_levels("a.tx", k < 2 ? 256 : 2048, 3, k % 2 ? light_mean : dark_mean);
        program_run run =
            RUN("--integrator=path", "--size=4x4", "--spp=1", "--texture-memory=16M", "-o", "x.exr", "scene.pbrt");
        expect_exit(&run, 0);
        const char *told = strstr(run.err, "'a.tx': from afar it is too dark: its second level has 43 % of the light");
        assert_true(k % 2 ? !strstr(run.err, "too dark") : told != NULL);
        program_run_reset(&run);
    }
}

static unsigned char half_clear(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    (void)level, (void)x, (void)y;
    return channel == 3 ? 128 : 100;
}

/* Colours that are multiplied by alpha are darker than those of the picture that they were made of. */
static void test_multiplied_colors(void **state)
{
    (void)state;
    write_scene(
        "Camera \"perspective\" WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tx\" "
        "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"");
    for (int k = 0; k < 4; k++) {
        tiff_is_multiplied = k % 2;
        tiff_write_levels("a.tx", k < 2 ? 256 : 2048, 4, half_clear);
        tiff_is_multiplied = false;
        program_run run =
            RUN("--integrator=path", "--size=4x4", "--spp=1", "--texture-memory=16M", "-o", "x.exr", "scene.pbrt");
        expect_exit(&run, 0);
        assert_true((k % 2 == 1) == (strstr(run.err, "'a.tx': its colours are multiplied by its alpha") != NULL));
        program_run_reset(&run);
    }
}

static const char *room(void)
{
    tiff_write_levels("bytes.tx", 2048, 4, noise);
    tiff_write_levels("gray.tif", 1024, 1, noise);
    return write_room_of("bytes.tx", "gray.tif");
}

static void test_memory(void **state)
{
    (void)state;
    const char *scene = room();
    picture whole = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-memory=0"),
            tiled = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-memory=16M", "--nthreads=1"),
            least = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--texture-memory=16M", "--nthreads=7",
                           "--stats=least.json", "--photon-map=a.map"),
            from_map = RENDER(scene, "--noise=0", "--spp=4", "--photons=2e4", "--photon-map=a.map");
    const size_t size = 3 * 24 * 24 * sizeof *whole.pixels;
    assert_memory_equal(tiled.pixels, whole.pixels, size);
    assert_memory_equal(from_map.pixels, least.pixels, size); /* the map is of this scene */
    json_t *stats = stats_read(in_folder("least.json"));
    assert_int_equal(stats_integer(stats, "texture.file_bytes"), 0); /* no temporary file */
    assert_true(stats_integer(stats, "texture.tiles_read") > 100);
    assert_true(stats_integer(stats, "texture.tile_bytes") <= 16 << 20);
    json_decref(stats);
    picture_reset(&whole);
    picture_reset(&tiled);
    picture_reset(&least);
    picture_reset(&from_map);
}

/* Cut short, or with tiles that cannot be read: told while the scene is read, or where a tile is missing later on.
 * Tiles that cannot be read say nothing of the levels' light. */
static void test_broken(void **state)
{
    (void)state;
    for (int cut = 0; cut < 2; cut++) {
        const char *scene = room();
        tiff_broken_from = cut ? UINT32_MAX : 1;
        tiff_write_levels("bytes.tx", 2048, 4, noise);
        tiff_broken_from = UINT32_MAX;
        struct stat file;
        assert_int_equal(stat(in_folder("bytes.tx"), &file), 0);
        if (cut)
            assert_int_equal(truncate(in_folder("bytes.tx"), file.st_size / 4), 0);
        for (int tiled = 0; tiled < 2; tiled++) {
            program_run run = RUN("--noise=0", "--spp=1", "--photons=1e3", "-o", "no.exr",
                                  tiled ? "--texture-memory=16M" : "--texture-memory=0", scene);
            assert_true(run.exit_code > 0);
            assert_non_null(strstr(run.err, "bytes.tx"));
            assert_null(strstr(run.err, "too dark"));
            assert_true(access(in_folder("no.exr"), F_OK) != 0);
            program_run_reset(&run);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_own_levels),  TEST_IN_FOLDER(test_levels_that_end_early),
        TEST_IN_FOLDER(test_dark_levels), TEST_IN_FOLDER(test_multiplied_colors),
        TEST_IN_FOLDER(test_memory),      TEST_IN_FOLDER(test_broken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

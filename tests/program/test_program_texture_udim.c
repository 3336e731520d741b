/* test_program_texture_udim.c: pictures in tiles: each shows where it is to, by both names, with edges and filters;
 * what is missing is black and told once; names of which there is no file, or a wrong one, are errors. Flow: tests of
 * the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_textures.h"

/* Linear values in 1/255 of red, green and blue, the same all over the picture. */
static void write_tile(const char *name, int side, const unsigned char *color)
{
    const size_t count = (size_t)side * (size_t)side;
    float *pixels = malloc(3 * count * sizeof *pixels);
    assert_non_null(pixels);
    for (size_t i = 0; i < 3 * count; i++)
        pixels[i] = (float)color[i % 3] / 255.0f;
    write_square(name, side, 3, strstr(name, ".exr") ? IMAGE_FLOAT : IMAGE_UINT8, pixels);
    free(pixels);
}

static const unsigned char COLORS[4][3] = {{51, 102, 204}, {255, 51, 0}, {0, 102, 255}, {102, 204, 153}};

/* u from 0 to 3, v from 0 to 2, four pixels to a tile; light of pi W/m^2 straight on it: radiance is reflectance. */
static const char *plane(const char *file_name, const char *more)
{
    char text[2048];
    snprintf(text, sizeof text,
             "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-1.5 1.5 -1 1] "
             "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8 PixelFilter \"box\" WorldBegin "
             "LightSource \"distant\" \"point3 from\" [0 0 -9] \"point3 to\" [0 0 0] "
             "\"rgb L\" [3.14159265 3.14159265 3.14159265] "
             "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" \"string encoding\" \"linear\" %s "
             "Material \"diffuse\" \"texture reflectance\" \"t\" "
             "Shape \"trianglemesh\" \"point3 P\" [-1.5 -1 0  1.5 -1 0  1.5 1 0 -1.5 1 0] \"point2 uv\" "
             "[0 0 3 0 3 2 0 2] \"integer indices\" [0 1 2 0 2 3]",
             file_name, more);
    return write_scene(text);
}

/* The pixel of that column and row of the plane, counted from below. */
static const float *pixel_at(const picture *p, int column, int row)
{
    return p->pixels + 3 * ((p->height - 1 - row) * p->width + column);
}

/* Tiles 1001, 1002, 1003 and 1012 have the four colours; others of the six are black. */
static void expect_tiles(const picture *p)
{
    static const int TILE[2][3] = {{0, 1, 2}, {-1, 3, -1}};
    for (int row = 0; row < 8; row++)
        for (int column = 0; column < 12; column++)
            for (int c = 0; c < 3; c++) {
                const int tile = TILE[row / 4][column / 4];
                const double wanted = tile < 0 ? 0.0 : COLORS[tile][c] / 255.0;
                if (fabs((double)pixel_at(p, column, row)[c] - wanted) > 1e-3)
                    fail_msg("pixel %d, %d: %g, not %g", column, row, (double)pixel_at(p, column, row)[c], wanted);
            }
}

static program_run run_path(const char *scene)
{
    return RUN("--integrator=path", "--max-depth=1", "--noise=0", "--spp=4", "--type=float", "-o", "picture.exr",
               scene);
}

static void expect_warned_picture(const char *scene, const char *warning)
{
    program_run run = run_path(scene);
    expect_exit(&run, 0);
    const char *at = strstr(run.err, warning);
    if (!at || strstr(at + 1, warning))
        fail_msg("not told once: %s", run.err);
    program_run_reset(&run);
    picture p = picture_read(in_folder("picture.exr"));
    expect_tiles(&p);
    picture_reset(&p);
}

static void test_names(void **state)
{
    (void)state;
    static const char *const NAMES[2][4] = {{"a.1001.png", "a.1002.png", "a.1003.png", "a.1012.png"},
                                            {"b_u1_v1.png", "b_u2_v1.png", "b_u3_v1.png", "b_u2_v2.png"}};
    for (int k = 0; k < 8; k++)
        write_tile(NAMES[k / 4][k % 4], k % 2 ? 16 : 700, COLORS[k % 4]);
    write_tile("a.1000.png", 4, COLORS[0]); /* these are no tiles */
    write_tile("a.10011.png", 4, COLORS[0]);
    write_tile("a.01011.png", 4, COLORS[0]);
    expect_warned_picture(plane("a.<UDIM>.png", ""),
                          "a.<UDIM>.png': texture coordinates lie on tiles of which there is no file (1011, 1013), "
                          "where it is black");
    expect_warned_picture(plane("b_<uvtile>.png", "\"string filter\" \"point\""), "no file (1011, 1013)");
    expect_warned_picture(plane("a.<udim>.png", "\"string wrap\" \"black\""), "no file (1011, 1013)");
}

/* Tiles of different kinds, some of them outside of memory, in the photon map, too: the same bits. */
static void test_memory(void **state)
{
    (void)state;
    static const char *const NAMES[4] = {"a.1001.png", "a.1002.exr", "a.1003.png", "a.1012.exr"};
    for (int k = 0; k < 4; k++)
        write_tile(NAMES[k], k % 2 ? 4 : 2048, COLORS[k]);
    assert_int_equal(rename(in_folder("a.1002.exr"), in_folder("a.1002.png")), 0);
    assert_int_equal(rename(in_folder("a.1012.exr"), in_folder("a.1012.png")), 0);
    const char *scene = plane("a.<UDIM>.png", "");
    picture whole[2];
    for (int k = 0; k < 2; k++) {
        program_run run = RUN(k ? "--texture-memory=16M" : "--texture-memory=0", k ? "--nthreads=1" : "--nthreads=3",
                              "--noise=0", "--spp=4", "--photons=1e4", "-o", "picture.exr", "--type=float", scene);
        expect_exit(&run, 0);
        assert_non_null(strstr(run.err, "no file (1011, 1013)"));
        program_run_reset(&run);
        whole[k] = picture_read(in_folder("picture.exr"));
        expect_tiles(&whole[k]);
    }
    assert_memory_equal(whole[0].pixels, whole[1].pixels, 3 * 12 * 8 * sizeof *whole[0].pixels);
    picture_reset(&whole[0]);
    picture_reset(&whole[1]);
}

/* A mesh of u and v from 0 to 1 needs no tile but the first, for all that its corners lie on others. */
static void test_edges(void **state)
{
    (void)state;
    write_tile("a.1001.png", 4, COLORS[0]);
    const char *scene = plane("a.<UDIM>.png", "\"float uscale\" 0.33333334 \"float vscale\" 0.5");
    picture p = RENDER(scene, "--integrator=path", "--max-depth=1", "--noise=0", "--spp=64"); /* says nothing */
    for (int i = 0; i < 12 * 8; i++)
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)p.pixels[3 * i + c] - COLORS[0][c] / 255.0) < 1e-3);
    picture_reset(&p);
    program_run run = run_path(plane("a.<UDIM>.png", "\"float udelta\" -2.5 \"float vdelta\" -1"));
    assert_non_null(strstr(run.err, "texture coordinates lie outside of all tiles, where it is black"));
    program_run_reset(&run);
    run = run_path(plane("a.<UDIM>.png", "\"float uscale\" 10"));
    assert_non_null(strstr(run.err, ", ...) and outside of all tiles, where"));
    program_run_reset(&run);
}

static void test_errors(void **state)
{
    (void)state;
    program_run run = run_path(plane("none.<UDIM>.png", ""));
    assert_true(run.exit_code > 0);
    assert_non_null(strstr(run.err, "there is no file of any tile, such as '"));
    assert_non_null(strstr(run.err, "none.1001.png'"));
    program_run_reset(&run);
    FILE *file = fopen(in_folder("a.1002.png"), "w");
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
    write_tile("a.1001.png", 4, COLORS[0]);
    run = run_path(plane("a.<UDIM>.png", ""));
    assert_true(run.exit_code > 0);
    assert_non_null(strstr(run.err, "a.1002.png"));
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_names),
        TEST_IN_FOLDER(test_memory),
        TEST_IN_FOLDER(test_edges),
        TEST_IN_FOLDER(test_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_program_texture_memory.c: many large pictures take no more memory than few, while their tiles and levels are
 * made and when they are found in a folder: one is decoded at a time. A pbrt file that names them tells meanwhile how
 * far it has been read. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_textures.h"
#include "math/rng.h"

#include <afterglow/scene.h>

enum { SIDE = 1300, MOST = 12 };

/* By the default limit 64 pictures of 8192 x 8192, 8-bit RGB, stay within 2 GiB: what is held, or half of it while one
 * of them is decoded and its levels are made, and the rest of the process. */
#define LIMIT  AG_DEFAULT_TEXTURE_MEMORY_BYTES
#define OTHERS ((uint64_t)256 << 20)
#define VALUES ((uint64_t)8192 * 8192 * 3)
_Static_assert(LIMIT + OTHERS <= (uint64_t)2 << 30, "what is held fits");
_Static_assert(LIMIT / 2 + VALUES + 2 * VALUES / 3 + OTHERS <= (uint64_t)2 << 30, "what is made fits");

static void write_pictures(void)
{
    char name[16];
    float *pixels = malloc((size_t)SIDE * SIDE * 3 * sizeof *pixels);
    assert_non_null(pixels);
    for (int k = 0; k < MOST; k++) {
        for (int i = 0; i < 3 * SIDE * SIDE; i++) {
            rng random = rng_make(1, (uint64_t)k, (uint64_t)(i / 16));
            pixels[i] = rng_float(&random);
        }
        snprintf(name, sizeof name, "%d.png", k);
        write_square(name, SIDE, 3, IMAGE_UINT8, pixels);
    }
    free(pixels);
}

/* Columns of so many pictures. */
static const char *write_columns(int count)
{
    char text[8192];
    int length = snprintf(text, sizeof text,
                          "LookAt 0 0 -20  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40 Film \"rgb\" \"integer "
                          "xresolution\" 48 \"integer yresolution\" 48 WorldBegin LightSource \"infinite\" ");
    for (int k = 0; k < count; k++)
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "Texture \"t%d\" \"spectrum\" \"imagemap\" \"string filename\" \"%d.png\" "
                           "Material \"diffuse\" \"texture reflectance\" \"t%d\" AttributeBegin Translate %d 0 0 "
                           "Shape \"trianglemesh\" \"point3 P\" [0 -6 0 1 -6 0 1 6 0 0 6 0] \"point2 uv\" [0 0 1 0 1 1 "
                           "0 1] \"integer indices\" [0 1 2 0 2 3] AttributeEnd ",
                           k, k, k, k - count / 2);
    assert_in_range(length, 1, sizeof text - 1);
    return write_scene(text);
}

static long long peak_of(int count, const char *cache)
{
    program_run run =
        RUN("--integrator=path", "--max-depth=1", "--noise=0", "--spp=1", "--nthreads=2", "--texture-memory=18M", cache,
            "--stats=stats.json", "-o", "picture.exr", write_columns(count));
    expect_exit(&run, 0);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("stats.json"));
    const long long peak = stats_integer(stats, "memory.peak_bytes");
    assert_true(stats_integer(stats, "texture.whole_bytes") <= 9 << 20);
    json_decref(stats);
    return peak;
}

static void test_many(void **state)
{
    (void)state;
    const long long whole_bytes = (long long)SIDE * SIDE * 3 * 5 / 3; /* of one, with its levels */
    write_pictures();
    const long long few = peak_of(2, "--texture-cache=few"), first = peak_of(MOST, "--texture-cache=many"),
                    second = peak_of(MOST, "--texture-cache=many"), made = peak_of(MOST, "--verbose");
    const long long bound = few + 3 * whole_bytes + (18 << 20);
    assert_true(first < bound && second < bound && made < bound);
    assert_true(second < first); /* nothing is decoded */
    assert_true(bound < few + (MOST - 2) * whole_bytes);
}

/* While pictures are read, a scene of little text tells how far it is, but not how long the rest of the work takes. */
static void test_progress(void **state)
{
    (void)state;
    int told = 0;
    write_pictures();
    program_run run = RUN("--integrator=path", "--max-depth=1", "--noise=0", "--spp=1", "--texture-memory=18M",
                          "--progress=json", "-o", "picture.exr", write_columns(MOST));
    expect_exit(&run, 0);
    for (const char *at = run.err; (at = strstr(at, "\"load\", \"fraction\": ")) != NULL;) {
        at += strlen("\"load\", \"fraction\": ");
        const double fraction = strtod(at, NULL);
        told += fraction > 0.0 && fraction < 1.0;
        const char *left = strstr(at, "seconds_left"), *end = strchr(at, '\n');
        assert_true(end && (!left || left > end));
    }
    assert_true(told > 0);
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(test_many), TEST_IN_FOLDER(test_progress)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

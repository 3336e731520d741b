/* test_pbrt_textures.c: what the reader says of textures that are wrong, doubtful, or too many.
 * Flow: tests of scene/readers/pbrt/pbrt_textures.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/texture_fixture.h"
#include "image/image_levels.h"
#include "image/image_reader.h"
#include "texture/texture_noise.h"

#include <math.h>
#include <unistd.h>

static void wrong_textures_say_why(void **state)
{
    (void)state;
    static float pixels[3 * 64 * 64];
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++)
        pixels[i] = texture_noise(vec3_make((float)i * 0.37f, 0.2f, 0.1f)); /* no less when packed */
    write_image("cut.exr", 64, 64, 3, IMAGE_FLOAT, pixels);
    assert_int_equal(truncate(in_folder("cut.exr"), 3000), 0);
    static const struct {
        const char *world, *at, *text; /* at: what the last of such marks */
        ag_status status;
    } cases[] = {
        {"Texture \"a\" \"float\" \"scale\" \"texture tex\" \"b\"", "\"texture tex", "no float texture is named \"b\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"scale\" \"texture tex\" \"a\"", "\"texture tex", "no float texture is named \"a\"",
         AG_ERROR_SCENE},
        {"Texture \"b\" \"spectrum\" \"constant\" Texture \"a\" \"float\" \"scale\" \"texture tex\" \"b\"",
         "\"texture tex", "\"b\" is a spectrum texture, but \"tex\" takes a float texture", AG_ERROR_SCENE},
        {"Texture \"b\" \"float\" \"fbm\" Texture \"a\" \"spectrum\" \"scale\" \"texture tex\" \"b\"", "\"texture tex",
         "\"b\" is a float texture, but \"tex\" takes a spectrum texture", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"scale\" \"texture tex\" [ \"b\" \"c\" ]", "\"texture tex",
         "\"texture tex\" should have 1 value, but has 2", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"scale\" \"rgb tex\" [ 1 1 1 ]", "\"rgb tex", "\"rgb tex\" should be \"float tex\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"colour\" \"scale\"", "\"colour",
         "texture \"a\" should be of type \"float\" or \"spectrum\", not \"colour\"", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"marble\"", "Texture", "there are no float textures of class \"marble\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"spectrum\" \"brick\"", "Texture", "there are no spectrum textures of class \"brick\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"windy\" Texture \"a\" \"float\" \"windy\"", "Texture",
         "float texture \"a\" is made twice", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"checkerboard\" \"integer dimension\" 4", "\"integer",
         "\"dimension\" should be 2 or 3, not 4", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"dots\" \"string mapping\" \"cube\"", "\"string",
         "unknown mapping \"cube\"; known are uv, spherical, cylindrical, planar", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"directionmix\" \"vector3 dir\" [ 0 0 0 ]", "\"vector3",
         "\"dir\" should have a length above 0", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"fbm\" \"integer octaves\" -1", "\"integer", "\"octaves\" should not be negative",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\"", "Texture", "Texture \"imagemap\" has no \"string filename\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\" \"string wrap\" \"mirror\"", "\"string wrap",
         "unknown wrap \"mirror\"; known are repeat, black, clamp, octahedralsphere", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\" \"string encoding\" \"gamma -1\"", "\"string enc",
         "unknown encoding \"gamma -1\"; known are sRGB, linear and, with a number, gamma", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"none.png\"", "\"string file",
         "/none.png': No such file", AG_ERROR_INPUT},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \".\"", "\"string file", "Is a directory",
         AG_ERROR_INPUT},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"scene.pbrt\"", "\"string file",
         "OpenImageIO cannot open it: ", AG_ERROR_INPUT},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"cut.exr\"", "\"string file",
         "/cut.exr': OpenImageIO cannot", AG_ERROR_INPUT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        reading r = read_world(cases[i].world);
        const char *at = cases[i].world;
        for (const char *next = at; (next = strstr(next, cases[i].at)); next++)
            at = next;
        char location[64];
        snprintf(location, sizeof location, "scene.pbrt:1:%d: error: ", (int)(at - cases[i].world) + 12);
        if (r.status != cases[i].status || r.count[AG_LOG_ERROR] != 1 || !strstr(r.said[AG_LOG_ERROR], location) ||
            !strstr(r.said[AG_LOG_ERROR], cases[i].text))
            fail_msg("%s: %s, not at %s: %s", cases[i].world, r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "(nothing)",
                     location, cases[i].text);
        reading_destroy(&r);
    }
}

/* Infinities in a picture are told and are 0. */
static void bad_values_are_told(void **state)
{
    (void)state;
    static const float pixels[4] = {INFINITY, 0.5f, NAN, 0.25f};
    write_image("bad.exr", 4, 1, 1, IMAGE_FLOAT, pixels);
    reading r = read_world("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"bad.exr\" "
                           "Texture \"b\" \"float\" \"imagemap\" \"string filename\" \"bad.exr\"");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    assert_non_null(
        strstr(r.said[AG_LOG_WARNING], "\"bad.exr\": 2 values are infinite or not a number, and count as 0"));
    assert_near(last_float(&r, hit_at(0.25f, 0.5f, 0, 0, 0)), 0.25, 1e-6);
    reading_destroy(&r);
}

static void write_parts(const char *name, const image_description *description, const float *pixels)
{
    if (image_file_write(NULL, in_folder(name), description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
}

/* A data window lies where it is in the display window, which a texture covers: outside is black, what is beyond the
 * display window is not seen. */
static void windows_of_pictures_are_heeded(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"R", "G", "B"};
    float pixels[3 * 16];
    for (int i = 0; i < 48; i++)
        pixels[i] = (float)(i / 3 + 1);
    image_description d = {.width = 2,
                           .height = 2,
                           .x = 1,
                           .y = 2,
                           .full_width = 4,
                           .full_height = 4,
                           .channel_count = 3,
                           .channel_names = NAMES,
                           .type = IMAGE_FLOAT};
    write_parts("part.exr", &d, pixels);
    d = (image_description){.width = 4,
                            .height = 4,
                            .x = -1,
                            .y = -1,
                            .full_width = 2,
                            .full_height = 2,
                            .channel_count = 3,
                            .channel_names = NAMES,
                            .type = IMAGE_FLOAT};
    write_parts("more.exr", &d, pixels);
#define PICTURE(name)                                                                                                  \
    "Texture \"a\" \"spectrum\" \"imagemap\" \"string filter\" \"point\" \"string filename\" \"" name "\""
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++) {
            const surface_hit at = hit_at(((float)x + 0.5f) / 4.0f, 1.0f - ((float)y + 0.5f) / 4.0f, 0, 0, 0);
            const bool is_inside = x >= 1 && x < 3 && y >= 2;
            assert_near(rgb_of(PICTURE("part.exr"), at).g, is_inside ? (y - 2) * 2 + x - 1 + 1 : 0, 0.0);
        }
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 2; x++)
            assert_near(
                rgb_of(PICTURE("more.exr"), hit_at(((float)x + 0.5f) / 2.0f, 1.0f - ((float)y + 0.5f) / 2.0f, 0, 0, 0))
                    .g,
                (y + 1) * 4 + x + 1 + 1, 0.0);
}

/* A data window wholly outside of the display window shows nothing; a display window that is too large to be filled up
 * is told of. */
static void far_windows_are_black_or_told(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"R", "G", "B"};
    static const float WHITE[3] = {1, 1, 1};
    static const int AT[][2] = {{4, 0}, {0, 4}, {-1, 0}, {0, -1}, {INT32_MAX / 2 - 9, 0}};
    image_description d = {.width = 1,
                           .height = 1,
                           .full_width = 4,
                           .full_height = 4,
                           .channel_count = 3,
                           .channel_names = NAMES,
                           .type = IMAGE_FLOAT};
    for (size_t k = 0; k < sizeof AT / sizeof *AT; k++) {
        d.x = AT[k][0];
        d.y = AT[k][1];
        write_parts("far.exr", &d, WHITE);
        assert_near(rgb_of(PICTURE("far.exr"), hit_at(0.9f, 0.9f, 0, 0, 0)).g, 0.0, 0.0);
    }
    d.x = 3;
    d.y = 5;
    d.full_width = d.full_height = 30000;
    write_parts("vast.exr", &d, WHITE);
    static const char *const WORLDS[] = {PICTURE("vast.exr"),
                                         "LightSource \"infinite\" \"string filename\" \"vast.exr\" Shape \"sphere\""};
    for (int k = 0; k < 2; k++) {
        reading r = read_world(WORLDS[k]);
        assert_int_equal(r.status, AG_ERROR_INPUT);
        assert_non_null(strstr(r.said[AG_LOG_ERROR], "vast.exr': its data window of 1 x 1 pixels from (3, 5) on is "
                                                     "not its display window of 30000 x 30000"));
        reading_destroy(&r);
    }
}

/* Alpha is the channel of that name in the layer of the colours, and no other that stands behind blue. */
static void alpha_is_found_by_its_name(void **state)
{
    (void)state;
    static const struct {
        int channel_count;
        bool has_alpha;
        const char *names[6];
    } CASES[] = {{6, false, {"diffuse.R", "diffuse.G", "diffuse.B", "specular.R", "specular.G", "specular.B"}},
                 {4, false, {"R", "G", "B", "Z"}},
                 {4, false, {"x.R", "x.G", "x.B", "y.A"}},
                 {5, true, {"R", "G", "B", "A", "Z"}},
                 {4, true, {"x.R", "x.G", "x.B", "x.A"}},
                 {4, true, {"x.red", "x.green", "x.blue", "x.alpha"}},
                 {2, true, {"Y", "A"}}};
    static const float PIXEL[6] = {0.25f, 0.5f, 0.75f, 0.5f, 0.5f, 0.5f};
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        const image_description d = {.width = 1,
                                     .height = 1,
                                     .full_width = 1,
                                     .full_height = 1,
                                     .channel_count = CASES[k].channel_count,
                                     .channel_names = CASES[k].names,
                                     .type = IMAGE_FLOAT};
        write_parts("alpha.exr", &d, PIXEL);
        image read;
        assert_int_equal(image_read_colors(NULL, in_folder("alpha.exr"), &read, message, sizeof message), AG_OK);
        assert_int_equal(read.channel_count, CASES[k].channel_count == 2 ? 2 : CASES[k].has_alpha ? 4 : 3);
        image_reset(&read);
        reading r = read_world(PICTURE("alpha.exr"));
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(texture_image_has_alpha(r.scene->textures.images[0]), CASES[k].has_alpha);
        reading_destroy(&r);
    }
}

/* A file's own levels are used where its tiles are not too small; its alpha is that of its name. */
static void levels_of_small_tiles_are_not_used(void **state)
{
    (void)state;
    static const struct {
        const char *names;
        int tile_side, channel_count; /* 0: the file's levels are not used */
    } CASES[] = {{"R,G,B,A", 4, 0}, {"R,G,B,A", 8, 4}, {"R,G,B,Z", 8, 3}};
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        char command[512];
        image_levels *levels;
        snprintf(command, sizeof command,
                 "oiiotool --pattern noise 64x64 4 --chnames %s --tile %d %d -otex '%s' >/dev/null", CASES[k].names,
                 CASES[k].tile_side, CASES[k].tile_side, in_folder("levels.exr"));
        assert_int_equal(system(command), 0);
        assert_int_equal(image_levels_open(NULL, in_folder("levels.exr"), &levels), AG_OK);
        assert_int_equal(levels ? image_levels_describe(levels)->picture.channel_count : 0, CASES[k].channel_count);
        float tile[8 * 8 * 3];
        if (levels)
            assert_int_equal(image_levels_read(levels, 1, 8, 16, 0, 3, false, tile), AG_OK);
        image_levels_close(levels);
    }
}

/* A picture with layers shows the one that has red, green and blue, wherever it stands among the others. */
static void colors_are_found_by_their_names(void **state)
{
    (void)state;
    static const char *const NAMES[][6] = {{"N.X", "N.Y", "N.Z", "beauty.R", "beauty.G", "beauty.B"},
                                           {"A.X", "B.X", "C.X", "R", "G", "B"},
                                           {"Depth.Z", "N.X", "N.Y", "x.red", "x.green", "x.blue"}};
    static const float PIXEL[6] = {7, 8, 9, 0.25f, 0.5f, 0.75f};
    for (int k = 0; k < 3; k++) {
        const image_description d = {.width = 1,
                                     .height = 1,
                                     .full_width = 1,
                                     .full_height = 1,
                                     .channel_count = 6,
                                     .channel_names = NAMES[k],
                                     .type = IMAGE_FLOAT};
        write_parts("layers.exr", &d, PIXEL);
        const rgb c = rgb_of(PICTURE("layers.exr"), hit_at(0.5f, 0.5f, 0, 0, 0));
        if (c.r != 0.25f || c.g != 0.5f || c.b != 0.75f)
            fail_msg("layers %d: %g %g %g", k, (double)c.r, (double)c.g, (double)c.b);
    }
}

/* A JPEG file that is cut short is an error, wherever it is cut behind its header; one with something behind it is
 * none. */
static void cut_jpeg_files_are_told(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"R", "G", "B"};
    static float pixels[3 * 160 * 160]; /* more bytes than are read at once */
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++)
        pixels[i] = 0.5f + 0.5f * texture_noise(vec3_make((float)i * 0.37f, 0.2f, 0.1f));
    const image_description d = {.width = 160,
                                 .height = 160,
                                 .full_width = 160,
                                 .full_height = 160,
                                 .channel_count = 3,
                                 .channel_names = NAMES,
                                 .type = IMAGE_UINT8};
    write_parts("cut.jpg", &d, pixels);
    FILE *file = fopen(in_folder("cut.jpg"), "ab");
    assert_non_null(file);
    fputs("more", file);
    const long size = ftell(file) - 4;
    assert_int_equal(fclose(file), 0);
    rgb_of(PICTURE("cut.jpg"), hit_at(0.5f, 0.5f, 0, 0, 0));
    for (int k = 0; k < 3; k++) {
        assert_int_equal(truncate(in_folder("cut.jpg"), k == 0 ? size - 1 : size * (4 - k) / 4), 0);
        reading r = read_world(PICTURE("cut.jpg"));
        assert_int_equal(r.status, AG_ERROR_INPUT);
        assert_non_null(strstr(r.said[AG_LOG_ERROR], "cut.jpg': the JPEG file is cut short"));
        reading_destroy(&r);
    }
}

/* A PNG file of some hundred bytes with a chunk that promises 2 GiB is an error before memory is taken for it. */
static void png_chunks_fit_into_the_file(void **state)
{
    (void)state;
    static const unsigned char CHUNK[] = "\x7f\xff\xff\xf0tEXtname";
    static const char *const NAMES[] = {"Y"};
    const float pixel = 0.5f;
    const image_description d = {.width = 1,
                                 .height = 1,
                                 .full_width = 1,
                                 .full_height = 1,
                                 .channel_count = 1,
                                 .channel_names = NAMES,
                                 .type = IMAGE_UINT8};
    write_parts("long.png", &d, &pixel);
    rgb_of(PICTURE("long.png"), hit_at(0.5f, 0.5f, 0, 0, 0));
    FILE *file = fopen(in_folder("long.png"), "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, 33, SEEK_SET), 0); /* behind the signature and the header */
    assert_int_equal(fwrite(CHUNK, 1, sizeof CHUNK - 1, file), sizeof CHUNK - 1);
    assert_int_equal(fclose(file), 0);
    reading r = read_world(PICTURE("long.png"));
    assert_int_equal(r.status, AG_ERROR_INPUT);
    assert_non_null(
        strstr(r.said[AG_LOG_ERROR], "long.png': the PNG file is cut short, or damaged: one of its chunks"));
    reading_destroy(&r);
}

/* Doubtful textures that can be read all the same are warned of. */
static void doubtful_textures_are_warned_of(void **state)
{
    (void)state;
    static const struct {
        const char *world, *text;
        double value;
    } cases[] = {
        {"Texture \"a\" \"color\" \"constant\" \"rgb value\" [ 2 2 2 ]",
         "the texture type \"color\" is called \"spectrum\" in pbrt-v4 and is read as that", 2.0},
        {"Texture \"a\" \"spectrum\" \"ptex\" \"string filename\" \"a.ptx\"",
         "Texture \"ptex\" is not supported: a constant of 0.5 stands in", 0.5},
        {"Texture \"a\" \"float\" \"fbm\" \"integer octaves\" 33 \"float roughness\" 0",
         "\"octaves\" is above 32: 32 is used, what is finer cannot be seen", 0.0},
        {"Texture \"a\" \"float\" \"windy\" \"float uscale\" 2",
         "Texture \"windy\": \"float uscale\" is not known, or not supported yet, and is ignored", 0.0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        reading r = read_world(cases[i].world);
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], 1);
        if (!strstr(r.said[AG_LOG_WARNING], cases[i].text))
            fail_msg("%s: %s", cases[i].world, r.said[AG_LOG_WARNING]);
        assert_near(last_rgb(&r, hit_at(0, 0, 0, 0, 0)).g, cases[i].value, 0.0);
        reading_destroy(&r);
    }
}

/* A texture that doubles in cost with every line would take for ever to look up. */
static void exploding_graphs_are_refused(void **state)
{
    (void)state;
    char world[4096] = "Texture \"t0\" \"float\" \"fbm\" \"integer octaves\" 1 ";
    for (int i = 1; i <= 30; i++) {
        const size_t used = strlen(world);
        snprintf(world + used, sizeof world - used,
                 "Texture \"t%d\" \"float\" \"scale\" \"texture tex\" \"t%d\" \"texture scale\" \"t%d\"\n", i, i - 1,
                 i - 1);
    }
    reading r = read_world(world);
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(strstr(r.said[AG_LOG_ERROR], "texture \"t12\" is made of more than 4096 others"));
    assert_int_equal(r.scene->textures.count, 12);
    const surface_hit hit = hit_at(0, 0, 0.3f, 0.4f, 0.6f);
    assert_true(isfinite(last_float(&r, hit)));
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(wrong_textures_say_why),
        TEST_IN_FOLDER(bad_values_are_told),
        TEST_IN_FOLDER(windows_of_pictures_are_heeded),
        TEST_IN_FOLDER(far_windows_are_black_or_told),
        TEST_IN_FOLDER(alpha_is_found_by_its_name),
        TEST_IN_FOLDER(colors_are_found_by_their_names),
        TEST_IN_FOLDER(png_chunks_fit_into_the_file),
        TEST_IN_FOLDER(cut_jpeg_files_are_told),
        TEST_IN_FOLDER(doubtful_textures_are_warned_of),
        TEST_IN_FOLDER(exploding_graphs_are_refused),
        TEST_IN_FOLDER(levels_of_small_tiles_are_not_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

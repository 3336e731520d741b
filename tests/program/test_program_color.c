/* test_program_color.c: managed colour through the whole program: what is carried in ACEScg is what is carried in
 * Rec. 709, converted, for colours, spectra, metals and pictures of every kind; displays as OpenColorIO's tools show
 * them. Threads: the program's. */
#define _GNU_SOURCE
#include "color/color.h"
#include "fixtures/environment_picture.h"
#include "fixtures/program_picture.h"

#define ACES AG_SOURCE_DIR "/tests/color/aces.ocio"
#define HEAD                                                                                                           \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\n"                                               \
    "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"orthographic\" WorldBegin\n"
/* A square that faces the eye, beyond what it sees. */
#define SQUARE                                                                                                         \
    " Shape \"bilinearmesh\" \"point3 P\" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ] \"point2 uv\" [ 0 0 1 0 0 1 1 1 ]\n"
#define WHITE_SUN "LightSource \"distant\" \"point3 from\" [ 0 0 -1 ] \"rgb L\" [ 3 3 3 ]\n"
#define WHITE_SKY "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"

static const char *scene_of(const char *world)
{
    char text[4096];
    snprintf(text, sizeof text, HEAD "%s", world);
    return write_text("scene.pbrt", text);
}

#define DIRECT "--integrator=path", "--spp=1", "--max-depth=1", "--ocio", ACES

/* The matrix from Rec. 709 to ACEScg. */
static void acescg_matrix(double m[9])
{
    color_config *config;
    assert_int_equal(color_config_create(ACES, NULL, NULL, message, sizeof message, &config), AG_OK);
    assert_true(color_config_from_rec709(config, m));
    color_config_destroy(config);
    assert_true(fabs(m[0] - 0.613097) < 2e-6 && fabs(m[4] - 0.916354) < 2e-6 && fabs(m[8] - 0.869815) < 2e-6);
}

/* Carried in ACEScg, every pixel is what it is in Rec. 709, converted; and some pixel has a colour. */
static void check_converted(const char *what, const char *scene, double tolerance)
{
    double m[9], largest = 0.0, tint = 0.0;
    acescg_matrix(m);
    picture rec709 = RENDER(scene, DIRECT, "--working-space=Rec709"), acescg = RENDER(scene, DIRECT);
    assert_int_equal(acescg.width * acescg.height, rec709.width * rec709.height);
    for (int i = 0; i < 3 * rec709.width * rec709.height; i++)
        largest = fmax(largest, (double)rec709.pixels[i]);
    assert_true(largest > 0.0);
    for (int i = 0; i < rec709.width * rec709.height; i++) {
        const float *in = rec709.pixels + 3 * i, *out = acescg.pixels + 3 * i;
        tint = fmax(tint, fabs((double)(in[0] - in[2])));
        for (int c = 0; c < 3; c++) {
            double expected = m[3 * c] * (double)in[0] + m[3 * c + 1] * (double)in[1] + m[3 * c + 2] * (double)in[2];
            if (!(fabs((double)out[c] - expected) <= tolerance * largest))
                fail_msg("%s: pixel %d, channel %d: %g is not %g", what, i, c, (double)out[c], expected);
        }
    }
    assert_true(tint > 0.02 * largest);
    picture_reset(&rec709);
    picture_reset(&acescg);
}

static void colors_of_the_scene(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        WHITE_SUN "Material \"diffuse\" \"rgb reflectance\" [ 0.9 0.04 0.02 ]" SQUARE,
        WHITE_SUN "ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.4 0.3 ]" SQUARE,
        WHITE_SUN "Material \"diffuse\" \"spectrum reflectance\" [ 400 0.1 500 0.2 600 0.7 700 0.8 ]" SQUARE,
        WHITE_SUN
        "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 0.9 0.1 0.1 ] \"rgb tex2\" [ 0.1 0.1 0.8 ]"
        "\"float uscale\" 8 \"float vscale\" 8 Material \"diffuse\" \"texture reflectance\" \"t\"" SQUARE,
        WHITE_SUN "Texture \"t\" \"spectrum\" \"marble\" Material \"diffuse\" \"texture reflectance\" \"t\"" SQUARE,
        "LightSource \"distant\" \"point3 from\" [ 0 0 -1 ] \"blackbody L\" 3000\n" SQUARE,
        "LightSource \"distant\" \"point3 from\" [ 0 0 -1 ] \"spectrum L\" \"stdillum-A\" \"float illuminance\" "
        "7\n" SQUARE,
        "LightSource \"point\" \"point3 from\" [ 0 0 -3 ] \"rgb I\" [ 9 2 1 ] \"float power\" 30\n" SQUARE,
        "AreaLightSource \"diffuse\" \"rgb L\" [ 0.2 0.9 0.1 ] \"float power\" 100 \"bool twosided\" true\n" SQUARE,
        "LightSource \"infinite\" \"rgb L\" [ 0.2 0.3 0.9 ]\n",
    };
    for (size_t i = 0; i < sizeof WORLDS / sizeof *WORLDS; i++)
        check_converted(WORLDS[i], scene_of(WORLDS[i]), 1e-4);
}

/* Head-on, a metal shows a white sky in the colour that it reflects. Dark blue lets a tenth of its red through. */
static void metals_and_media(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        WHITE_SKY "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"" SQUARE,
        WHITE_SKY "Material \"conductor\"" SQUARE,
        WHITE_SKY "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.5 0.2 ]" SQUARE,
    };
    for (size_t i = 0; i < sizeof WORLDS / sizeof *WORLDS; i++)
        check_converted(WORLDS[i], scene_of(WORLDS[i]), 1e-4);

    /* absorption is converted: through a thickness of 0.01, what is left of white is 1 - sigma 0.01 */
    double m[9];
    acescg_matrix(m);
    const char *scene =
        scene_of(WHITE_SKY "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 5 9 ]"
                           "\"rgb sigma_s\" [ 0 0 0 ] MediumInterface \"m\" \"\" Material \"interface\""
                           "Scale 4 4 0.005 Translate 0 0 -1 Shape \"bilinearmesh\" \"point3 P\""
                           "[ -1 1 0  1 1 0  -1 -1 0  1 -1 0 ] Translate 0 0 2 Shape \"bilinearmesh\" \"point3 P\""
                           "[ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]");
    picture p = RENDER(scene, DIRECT);
    for (int c = 0; c < 3; c++) {
        double sigma = m[3 * c] * 1.0 + m[3 * c + 1] * 5.0 + m[3 * c + 2] * 9.0;
        expect_near("absorption", picture_mean(&p, c), exp(-0.01 * sigma), 1e-4);
    }
    picture_reset(&p);
}

/* Grey has the same numbers in all spaces, down to the last bit: the mean is a furnace's 1 / (1 - 0.5). */
static void grey_furnace(void **state)
{
    (void)state;
    const char *scene = write_text(
        "furnace.pbrt",
        "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12 Camera \"perspective\" WorldBegin\n"
        "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ] AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]"
        "ReverseOrientation Shape \"sphere\" \"float radius\" 2\n");
#define FURNACE "--spp=4", "--photons=20000", "--ocio", ACES
    picture acescg = RENDER(scene, FURNACE), rec709 = RENDER(scene, FURNACE, "--working-space=Rec709");
    assert_memory_equal(acescg.pixels, rec709.pixels, sizeof(float) * 3 * 16 * 12);
    for (int c = 0; c < 3; c++)
        expect_near("furnace", picture_mean(&acescg, c), 2.0, 0.03);
    picture_reset(&acescg);
    picture_reset(&rec709);
}

static void write_picture(const char *name, image_sample_type type, const float *chromaticities, const float rgb[3])
{
    enum { SIDE = 4 };
    static const char *const CHANNELS[] = {"R", "G", "B"};
    float pixels[SIDE * SIDE * 3];
    for (int i = 0; i < SIDE * SIDE * 3; i++)
        pixels[i] = rgb[i % 3];
    const image_attribute attribute = {.name = "chromaticities", .numbers = chromaticities, .number_count = 8};
    const image_description description = {.width = SIDE,
                                           .height = SIDE,
                                           .full_width = SIDE,
                                           .full_height = SIDE,
                                           .channel_count = 3,
                                           .channel_names = CHANNELS,
                                           .type = type,
                                           .attributes = &attribute,
                                           .attribute_count = chromaticities ? 1 : 0};
    if (image_file_write(NULL, in_folder(name), &description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
}

/* A picture that shines, in ACEScg. */
static void expect_shown(const char *file, const char *encoding, double r, double g, double b)
{
    char world[1024], all[256] = "";
    if (encoding)
        snprintf(all, sizeof all, "\"string encoding\" \"%s\"", encoding);
    /* lit so that its reflectance is what is seen */
    snprintf(world, sizeof world,
             "LightSource \"distant\" \"point3 from\" [ 0 0 -1 ] \"rgb L\" [ 1 1 1 ] \"float scale\" 3.14159265\n"
             "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" %s\n"
             "Material \"diffuse\" \"texture reflectance\" \"t\"" SQUARE,
             file, all);
    picture p = RENDER(scene_of(world), DIRECT);
    const double expected[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        if (!(fabs(picture_mean(&p, c) - expected[c]) <= 4e-5))
            fail_msg("%s: channel %d: %g is not %g", file, c, picture_mean(&p, c), expected[c]);
    picture_reset(&p);
}

static void pictures_by_their_color_space(void **state)
{
    (void)state;
    static const float AP1[8] = {.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33767f};
    static const float RGB[3] = {0.8f, 0.2f, 0.4f}, BYTES[3] = {204.0f / 255.0f, 51.0f / 255.0f, 102.0f / 255.0f};
    double m[9], converted[3], linear[3], decoded[3];
    acescg_matrix(m);
    for (int c = 0; c < 3; c++)
        linear[c] = pow(((double)BYTES[c] + 0.055) / 1.055, 2.4);
    for (int c = 0; c < 3; c++) {
        converted[c] = decoded[c] = 0.0;
        for (int k = 0; k < 3; k++) {
            converted[c] += m[3 * c + k] * (double)RGB[k];
            decoded[c] += m[3 * c + k] * linear[k];
        }
    }
    write_picture("a.png", IMAGE_UINT8, NULL, BYTES);
    write_picture("a.exr", IMAGE_FLOAT, NULL, RGB);
    write_picture("own.exr", IMAGE_FLOAT, AP1, RGB);
    write_picture("a_lin709.png", IMAGE_UINT8, NULL, BYTES);
    write_picture("a_data.png", IMAGE_UINT8, NULL, BYTES);
    write_picture("a_log.exr", IMAGE_FLOAT, NULL, RGB);
    write_picture("a_log.png", IMAGE_UINT8, NULL, BYTES);
    write_picture("own_log.exr", IMAGE_FLOAT, AP1, RGB);
    expect_shown("a.png", NULL, decoded[0], decoded[1], decoded[2]);
    expect_shown("a.png", "linear", converted[0], converted[1], converted[2]);
    expect_shown("a.png", "working", (double)BYTES[0], (double)BYTES[1], (double)BYTES[2]);
    expect_shown("a.exr", NULL, converted[0], converted[1], converted[2]);
    expect_shown("own.exr", NULL, (double)RGB[0], (double)RGB[1], (double)RGB[2]);
    expect_shown("a_lin709.png", NULL, converted[0], converted[1], converted[2]);
    expect_shown("a_lin709.png", "sRGB", decoded[0], decoded[1], decoded[2]);
    expect_shown("a_data.png", NULL, (double)BYTES[0], (double)BYTES[1], (double)BYTES[2]);
    /* ACEScct, 2^(17.52 v - 9.72), but below 1: values beyond white do not fit a reflectance */
    static const float DARK[3] = {0.5f, 0.2f, 0.4f};
    double log_decoded[3];
    write_picture("b_log.exr", IMAGE_FLOAT, NULL, DARK);
    for (int c = 0; c < 3; c++)
        log_decoded[c] = exp2(17.52 * (double)DARK[c] - 9.72);
    expect_shown("b_log.exr", NULL, log_decoded[0], log_decoded[1], log_decoded[2]);
    write_picture("c.png", IMAGE_UINT8, NULL, BYTES);
    expect_shown("own_log.exr", NULL, (double)RGB[0], (double)RGB[1], (double)RGB[2]); /* its own word is stronger */
    expect_shown("b_log.exr", "working", (double)DARK[0], (double)DARK[1], (double)DARK[2]);

    program_run run = RUN(
        "-q", "--ocio", ACES, "-o", "x.exr",
        scene_of("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" \"string encoding\" \"sRBG\""));
    expect_exit(&run, 1);
    expect_said(&run, "unknown encoding \"sRBG\"");
    expect_said(&run, "'AP1'");
    program_run_reset(&run);
}

/* Lights of pictures, normal maps and other formats. */
static void pictures_of_lights_and_other_formats(void **state)
{
    (void)state;
    static const float RGB[3] = {0.8f, 0.2f, 0.4f}, UP[3] = {0.5f, 0.5f, 1.0f}, TILTED[3] = {0.8f, 0.5f, 0.9f};
    write_picture("a.exr", IMAGE_FLOAT, NULL, RGB);
    write_picture("up.png", IMAGE_UINT8, NULL, UP);
    write_picture("tilted.exr", IMAGE_FLOAT, NULL, TILTED);
    static const char *const WORLDS[] = {
        "LightSource \"infinite\" \"string filename\" \"a.exr\" \"float illuminance\" 5\n",
        "LightSource \"infinite\" \"string filename\" \"a.exr\"\n" SQUARE,
        "Translate 0 0 -4 LightSource \"projection\" \"string filename\" \"a.exr\" \"float power\" 9\n"
        "Translate 0 0 4" SQUARE,
        "AreaLightSource \"diffuse\" \"string filename\" \"a.exr\" \"float power\" 50 \"bool twosided\" true\n" SQUARE,
        WHITE_SUN "Material \"diffuse\" \"string normalmap\" \"tilted.exr\" \"rgb reflectance\" [ .1 .2 .7 ]" SQUARE,
    };
    for (size_t i = 0; i < sizeof WORLDS / sizeof *WORLDS; i++)
        check_converted(WORLDS[i], scene_of(WORLDS[i]), 3e-5);

    static const char GLTF[] =
        "{ \"asset\": { \"version\": \"2.0\" }, \"scene\": 0, \"scenes\": [ { \"nodes\": [ 0, 1 ] } ],"
        "\"nodes\": [ { \"mesh\": 0 }, { \"camera\": 0, \"translation\": [ 0, 0, 3 ] } ],"
        "\"cameras\": [ { \"type\": \"orthographic\", \"orthographic\": { \"xmag\": 1, \"ymag\": 1, \"znear\": 0,"
        "\"zfar\": 9 } } ], \"meshes\": [ { \"primitives\": [ { \"attributes\": { \"POSITION\": 0 }, \"material\": 0 }"
        "] } ], \"materials\": [ { \"emissiveFactor\": [ 0.9, 0.1, 0.3 ], \"pbrMetallicRoughness\": {"
        "\"baseColorFactor\": [ 0, 0, 0, 1 ] } } ],"
        "\"accessors\": [ { \"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", \"min\":"
        "[ -10, -10, 0 ], \"max\": [ 10, 20, 0 ] } ], \"bufferViews\": [ { \"buffer\": 0, \"byteLength\": 36 } ],"
        "\"buffers\": [ { \"byteLength\": 36, \"uri\": \"data:application/octet-stream;base64,"
        "AAAgwQAAIMEAAAAAAAAgQQAAIMEAAAAAAAAAAAAAoEEAAAAA\" } ] }";
    check_converted("glTF", write_text("emits.gltf", GLTF), 2e-5);
    write_text("emits.mtl", "newmtl m\nKd 0 0 0\nKe 0.2 0.9 0.4\n");
    check_converted(
        "OBJ", write_text("emits.obj", "mtllib emits.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"), 2e-5);
}

/* The EXR says what it is, and its other spaces are conversions of it. */
static void spaces_of_exr_files(void **state)
{
    (void)state;
    static const float AP1[8] = {.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33767f};
    static const float AP0[8] = {.7347f, .2653f, 0.0f, 1.0f, .0001f, -.077f, .32168f, .33767f};
    static const float REC709[8] = {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f};
    static const struct {
        const char *argument;
        const float *chromaticities;
    } CASES[] = {{"--output-space=AP1", AP1},
                 {"--output-space=AP0", AP0},
                 {"--output-space=Rec709", REC709},
                 {"--working-space=Rec709", REC709},
                 {"--output-space=Log", NULL}};
    double m[9];
    acescg_matrix(m);
    char scene[160];
    snprintf(scene, sizeof scene, "%s", scene_of("LightSource \"infinite\" \"rgb L\" [ 0.2 0.3 0.9 ]\n"));
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        image read;
        picture p = RENDER(scene, DIRECT, CASES[i].argument);
        assert_int_equal(image_read(in_folder("picture.exr"), &read, message, sizeof message), AG_OK);
        assert_int_equal(read.has_chromaticities, CASES[i].chromaticities != NULL);
        for (int k = 0; k < 8 && CASES[i].chromaticities; k++)
            assert_true(fabsf(read.chromaticities[k] - CASES[i].chromaticities[k]) < 1e-6f);
        if (CASES[i].chromaticities == REC709) {
            expect_near("red", picture_mean(&p, 0), 0.2, 1e-5);
            expect_near("blue", picture_mean(&p, 2), 0.9, 1e-5);
        }
        if (CASES[i].chromaticities == AP1)
            expect_near("red", picture_mean(&p, 0), m[0] * 0.2 + m[1] * 0.3 + m[2] * 0.9, 1e-5);
        if (!CASES[i].chromaticities) {
            double red = m[0] * 0.2 + m[1] * 0.3 + m[2] * 0.9;
            expect_near("red", picture_mean(&p, 0), (log2(red) + 9.72) / 17.52, 1e-5);
        }
        image_reset(&read);
        picture_reset(&p);
    }
    /* layers go where the picture goes: what is seen here is emission alone */
    image read;
    program_run run = RUN("-q", DIRECT, "--type=float", "--aov=emission", "--output-space=AP0", "-o", "a.exr", scene);
    expect_exit(&run, 0);
    program_run_reset(&run);
    assert_int_equal(image_read(in_folder("a.exr"), &read, message, sizeof message), AG_OK);
    assert_int_equal(read.channel_count, 6);
    for (int c = 0; c < 3; c++)
        assert_true(read.pixels[c] > 0.0f && fabsf(read.pixels[c] - read.pixels[3 + c]) <= 1e-6f);
    image_reset(&read);
}

/* One run's EXR through oiiotool is that run's picture of 16 bits, with view, look and exposure. */
static void displays_as_the_tools(void **state)
{
    (void)state;
    if (system("command -v oiiotool >/dev/null 2>&1") != 0) {
        print_message("SKIPPED: oiiotool (Debian: openimageio-tools) is not installed\n");
        skip();
    }
    const char *scene =
        scene_of("LightSource \"infinite\" \"rgb L\" [ 0.2 0.1 0.3 ] LightSource \"point\" \"point3 from\" [ 1 1 -1 ]"
                 "\"rgb I\" [ 4 2 1 ] Material \"diffuse\" \"rgb reflectance\" [ 0.8 0.3 0.1 ]" SQUARE);
    program_run run = RUN("-q", "--spp=1", "--integrator=path", "--ocio", ACES, "-o", "a.exr", "--type=float", scene);
    expect_exit(&run, 0);
    program_run_reset(&run);
    static const char *const TYPES[2][2] = {{"a.png", "uint16"}, {"a.tif", "uint8"}};
    for (int i = 0; i < 2; i++) {
        char command[1024];
        run = RUN("-q", "--spp=1", "--integrator=path", "--ocio", ACES, "-o", TYPES[i][0], "--type", TYPES[i][1],
                  "--display=Cinema", "--view=Film", "--look=Warm", "--exposure=-1.5", scene);
        expect_exit(&run, 0);
        assert_string_equal(run.err, "");
        program_run_reset(&run);
        snprintf(command, sizeof command,
                 "cd '%s' && oiiotool --colorconfig '" ACES "' a.exr --mulc 0.35355339 --ociolook:from=AP1:to=AP1 Warm "
                 "--ociodisplay:from=AP1 Cinema Film -d %s -o theirs%s",
                 folder, TYPES[i][1], TYPES[i][0] + 1);
        assert_int_equal(system(command), 0);
        picture ours = picture_read(in_folder(TYPES[i][0]));
        picture theirs = picture_read(in_folder(i == 0 ? "theirs.png" : "theirs.tif"));
        double worst = 0.0;
        for (int k = 0; k < 8 * 6 * 3; k++)
            worst = fmax(worst, fabs((double)ours.pixels[k] - (double)theirs.pixels[k]));
        assert_true(worst <= 1.01 / (i == 0 ? 65535.0 : 255.0)); /* a value between two steps */
        picture_reset(&ours);
        picture_reset(&theirs);
    }
}

/* Light that is carried in two spaces is shown alike. */
static void views_of_both_spaces(void **state)
{
    (void)state;
    const char *scene = scene_of("LightSource \"infinite\" \"rgb L\" [ 0.7 0.1 0.3 ]\n");
    static const char *const SPACES[2] = {"--working-space=AP1", "--working-space=Rec709"};
    picture p[2];
    for (int i = 0; i < 2; i++) {
        program_run run =
            RUN("-q", "--spp=1", "--ocio", ACES, "-o", "a.png", "--type=uint16", "--view=Graded", SPACES[i], scene);
        expect_exit(&run, 0);
        program_run_reset(&run);
        p[i] = picture_read(in_folder("a.png"));
    }
    for (int k = 0; k < 8 * 6 * 3; k++)
        assert_true(fabsf(p[0].pixels[k] - p[1].pixels[k]) <= 4.0f / 65535.0f);
    picture_reset(&p[0]);
    picture_reset(&p[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(colors_of_the_scene),
        TEST_IN_FOLDER(metals_and_media),
        TEST_IN_FOLDER(grey_furnace),
        TEST_IN_FOLDER(pictures_by_their_color_space),
        TEST_IN_FOLDER(pictures_of_lights_and_other_formats),
        TEST_IN_FOLDER(spaces_of_exr_files),
        TEST_IN_FOLDER(displays_as_the_tools),
        TEST_IN_FOLDER(views_of_both_spaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

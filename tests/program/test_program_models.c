/* test_program_models.c: models of other formats through the whole program: they are seen and lit, as bright as their
 * files say; what was made up is said; errors end with 1.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/collada_fixture.h"
#include "fixtures/program_picture.h"
#include "scene_file.h"

#define QUICK "--photons=2000", "--caustic-photons=0", "--spp=4", "--gather-samples=16", "--size=32x18"

static const double PI_D = 3.14159265358979323846;

#define BOX                                                                                                            \
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"                                         \
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"

/* Seen, not black, in its colour; what was made up and what is missing is said. */
static void a_box_is_seen(void **state)
{
    (void)state;
    write_text("box.mtl", "newmtl red\nKd .8 .1 .1\nmap_Kd none.png\n");
    write_text("box.obj", "mtllib box.mtl\nmtllib none.mtl\nusemtl red\n" BOX);
    program_run run = RUN("-v", QUICK, "--type=float", "-o", "x.exr", "box.obj");
    expect_exit(&run, 0);
    expect_said(&run, "the file has no camera: one is set at (");
    expect_said(&run, "the file has no light: an even sky and a sun light it");
    expect_said(&run, "box.obj: warning: the picture \"none.png\" is not used: there is no such file");
    expect_said(&run,
                "box.obj:2:8: warning: the material library \"none.mtl\" cannot be read: No such file or directory");
    program_run_reset(&run);
    picture p = picture_read(in_folder("x.exr"));
    assert_int_equal(p.width, 32);
    double red = picture_block(&p, 14, 7, 4, 0), green = picture_block(&p, 14, 7, 4, 1);
    assert_true(red > 0.2 && green < 0.35 * red);
    expect_near("sky in the corner", picture_block(&p, 0, 0, 2, 1), 0.5, 1e-6);
    picture_reset(&p);
}

/* The light that is made: a floor of grey 1/2 reflects sky and sun alike, 1/2 (L + E cos / pi). */
static void the_light_that_is_made_is_as_bright_as_it_says(void **state)
{
    (void)state;
    const char *path =
        write_text("floor.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                "property float z\nelement face 1\nproperty list uchar int vertex_index\n"
                                "end_header\n-1 0 1\n1 0 1\n1 0 -1\n-1 0 -1\n4 0 1 2 3\n");
    run_context run;
    scene *s = scene_create();
    run_context_init(&run, NULL, NULL, NULL, NULL);
    assert_int_equal(scene_file_load(&run, path, s), AG_OK);
    double expected =
        0.5 * ((double)s->lights[0].as.infinite.radiance.value.g -
               (double)s->lights[1].as.distant.irradiance.g * (double)s->lights[1].as.distant.direction.y / PI_D);
    run_context_reset(&run);
    scene_destroy(s);
    picture p = RENDER("floor.ply", "--integrator=path", "--spp=1024", "--size=32x18");
    expect_near("floor", picture_block(&p, 15, 8, 2, 1), expected, 0.01);
    picture_reset(&p);
    p = RENDER("floor.ply", "--photons=2000", "--caustic-photons=0", "--spp=1024", "--gather-samples=1",
               "--size=32x18");
    expect_near("floor by the photon map", picture_block(&p, 15, 8, 2, 1), expected, 0.01);
    picture_reset(&p);
}

/* Ke is radiance, on both sides: the picture shows it as it is. */
static void lamps_shine_as_ke_says(void **state)
{
    (void)state;
    write_text("lamp.mtl", "newmtl lamp\nKd 0 0 0\nKe 4 2 1\n");
    static const char *const FACES[] = {"f 1 2 3 4\n", "f 4 3 2 1\n"};
    for (int k = 0; k < 2; k++) {
        char text[256];
        snprintf(text, sizeof text, "mtllib lamp.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl lamp\n%s",
                 FACES[k]);
        write_text("lamp.obj", text);
        picture p = RENDER("lamp.obj", QUICK);
        for (int c = 0; c < 3; c++)
            expect_near("lamp", picture_block(&p, 15, 8, 2, c), 4.0 / (1 << c), 1e-6);
        expect_near("nothing", picture_block(&p, 0, 0, 2, 0), 0.0, 0.0);
        picture_reset(&p);
    }
}

/* A point light whose file says that white shines with color / (q d^2) below it: the floor shines with Kd of that. */
static void lights_of_a_model_are_as_bright_as_it_says(void **state)
{
    (void)state;
    write_text(
        "lit.dae",
        COLLADA(
            "<up_axis>Y_UP</up_axis>",
            "<light id=\"lam\" name=\"lam\"><technique_common><point><color>1 0.5 0.25</color><constant_attenuation>0"
            "</constant_attenuation><quadratic_attenuation>0.125</quadratic_attenuation></point></technique_common>"
            "</light>",
            COLLADA_FLOOR "<node id=\"lamn\" name=\"lamn\"><translate>0 4 0</translate><instance_light url=\"#lam\"/>"
                          "</node><node id=\"camn\" name=\"camn\"><translate>0 5 0</translate>"
                          "<rotate>1 0 0 -90</rotate><instance_camera url=\"#cam\"/></node>"));
    static const double KD[3] = {0.5, 0.25, 0.75};
    picture p = RENDER("lit.dae", "--photons=2000", "--caustic-photons=0", "--spp=4", "--size=64x36",
                       "--cropwindow=.48,.52,.46,.54");
    for (int c = 0; c < 3; c++)
        expect_near("floor", picture_mean(&p, c), KD[c] * (1.0 / (1 << c)) / (0.125 * 16.0), 0.01);
    picture_reset(&p);
}

static void errors_end_with_1(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text, *said;
    } FILES[] = {
        {"bad.obj", "v 0 0 0\nf 1 2 3\n",
         "bad.obj:2:5: error: the corner refers to vertex 2, but there are 1\n    f 1 2 3\n        ^\n"},
        {"bad.dae", "<COLLADA>", "bad.dae: error: "},
        {"bad.stl", "solid", "bad.stl: error: "},
        {"bad.ply", "ply\n", "bad.ply:"},
    };
    for (size_t k = 0; k < sizeof FILES / sizeof *FILES; k++) {
        write_text(FILES[k].name, FILES[k].text);
        program_run run = RUN("-q", QUICK, "-o", "x.exr", FILES[k].name);
        expect_exit(&run, 1);
        expect_said(&run, FILES[k].said);
        program_run_reset(&run);
        assert_int_not_equal(access(in_folder("x.exr"), F_OK), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_box_is_seen),          TEST_IN_FOLDER(the_light_that_is_made_is_as_bright_as_it_says),
        TEST_IN_FOLDER(lamps_shine_as_ke_says), TEST_IN_FOLDER(lights_of_a_model_are_as_bright_as_it_says),
        TEST_IN_FOLDER(errors_end_with_1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_program_seams.c: what models have where their parts meet: thin walls, gaps of 1 mm, coplanar and overlapping
 * faces, flipped normals, panes within panes, lamps inside of fixtures, steep reliefs. In a room of 4 m x 3 m x 4 m the
 * photon map has the path tracer's light. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

#include "math/vec3.h"

#define MATTE "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"
#define THIN  "Material \"thindielectric\"\n"

/* --- scenes --- */

static char text[1 << 14];

static void add(const char *more)
{
    assert_true(strlen(text) + strlen(more) < sizeof text);
    strcat(text, more);
}

/* A rectangle from a corner along two edges. */
static void add_face(vec3 corner, vec3 u, vec3 v)
{
    char face[512];
    vec3 c[4] = {corner, vec3_add(corner, u), vec3_add(vec3_add(corner, u), v), vec3_add(corner, v)};
    int length = snprintf(face, sizeof face, "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [");
    for (int i = 0; i < 4; i++)
        length += snprintf(face + length, sizeof face - (size_t)length, "%g %g %g  ", (double)c[i].x, (double)c[i].y,
                           (double)c[i].z);
    snprintf(face + length, sizeof face - (size_t)length, "]\n");
    add(face);
}

enum { NO_FLOOR = 1, FLIPPED = 2 };

static void add_box(vec3 low, vec3 high, int how)
{
    vec3 d = vec3_sub(high, low), x = {d.x, 0.0f, 0.0f}, y = {0.0f, d.y, 0.0f}, z = {0.0f, 0.0f, d.z};
    const vec3 edges[3][2] = {{x, y}, {y, z}, {z, x}}, along[3] = {z, x, y};
    for (int i = 0; i < 3; i++)
        for (int far = 0; far < 2; far++) {
            bool is_turned = (far == 1) == ((how & FLIPPED) != 0);
            vec3 corner = far ? vec3_add(low, along[i]) : low;
            if (!(i == 2 && !far && (how & NO_FLOOR)))
                add_face(corner, edges[i][is_turned], edges[i][!is_turned]);
        }
}

static vec3 at(float x, float y, float z) { return (vec3){x, y, z}; }

/* The room, its faces' normals inwards or outwards, seen from its front wall. */
static void begin_room(int how)
{
    text[0] = '\0';
    add("LookAt 0 1.5 -1.9 0 1.2 0 0 1 0 Camera \"perspective\" \"float fov\" 75\nWorldBegin\n" MATTE);
    add_box(at(-2, 0, -2), at(2, 3, 2), how);
}

static void add_ceiling_lamp(float x)
{
    add("AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] \"bool twosided\" true\n");
    add("Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n");
    add_face(at(x - 0.6f, 2.4f, -0.6f), at(1.2f, 0, 0), at(0, 0, 1.2f));
    add("AttributeEnd\n");
}

static void add_ball_lamp(const char *where, const char *radius, const char *radiance)
{
    char lamp[512];
    snprintf(lamp, sizeof lamp,
             "AttributeBegin Translate %s AreaLightSource \"diffuse\" \"rgb L\" [%s %s %s] Material \"diffuse\" "
             "\"rgb reflectance\" [0 0 0] Shape \"sphere\" \"float radius\" %s AttributeEnd\n",
             where, radiance, radiance, radiance, radius);
    add(lamp);
}

/* --- comparisons --- */

/* How many photons and samples a comparison takes. */
typedef struct effort {
    const char *photons, *samples, *gather_samples, *path_samples;
} effort;

/* Gather rays are few, since samples that begin at the eye tell more; what is seen by way of glass, and light that
 * leaves a fixture by one opening, is noisier. */
static const effort PLAIN = {"--photons=1e5", "--spp=32", "--gather-samples=2", "--spp=96"},
                    OF_PANES = {"--photons=1e5", "--spp=128", "--gather-samples=1", "--spp=384"},
                    OF_FIXTURES = {"--photons=2e5", "--spp=64", "--gather-samples=2", "--spp=512"};

/* AGREEMENT_BLUR and AGREEMENT_ERRORS of these make a hundredth: more or less light than that is found out. */
static const double MOST_ERROR = 0.0014;

/* The photon map has the path tracer's light. most_error, most_of_blocks: bounds of the relative standard errors. */
static void expect_same_light_by(const char *what, const effort *e, double most_error, double most_of_blocks)
{
    char scene[256];
    snprintf(scene, sizeof scene, "%s", write_text("scene.pbrt", text));
    compare_integrators_by(what, scene, ARGUMENTS(AGREEMENT_MAP, e->photons, e->samples, e->gather_samples),
                           ARGUMENTS("--integrator=path", e->path_samples),
                           (agreement_bounds){AGREEMENT_BLUR, most_error, most_of_blocks});
}

static void expect_same_light(const char *what, double most_error, double most_of_blocks)
{
    expect_same_light_by(what, &PLAIN, most_error, most_of_blocks);
}

/* A wall without thickness, and two 1 mm apart, part a lit half from a dark one; a box floats 1 mm above the floor. */
static void test_thin_walls_and_gaps(void **state)
{
    (void)state;
    begin_room(0);
    add_ceiling_lamp(-1.0f);
    add(MATTE);
    add_face(at(0, 0, -1.2f), at(0, 2.2f, 0), at(0, 0, 3.2f));
    expect_same_light("a thin wall", MOST_ERROR, 0.006);
    add_face(at(0.001f, 0, -1.2f), at(0, 2.2f, 0), at(0, 0, 3.2f));
    add_box(at(-1.5f, 0.001f, 0.2f), at(-0.5f, 0.6f, 1.2f), 0);
    expect_same_light("gaps of 1 mm", MOST_ERROR, 0.006);
}

/* Boxes stand on the floor and against the walls, face on face, one within another; a sheet lies on the floor. */
static void test_coplanar_and_overlapping(void **state)
{
    (void)state;
    begin_room(0);
    add_ceiling_lamp(0.0f);
    add(MATTE);
    add_box(at(-2, 0, 1), at(-1, 0.7f, 2), 0);
    add_box(at(-1.4f, 0, 0.6f), at(-0.4f, 0.7f, 1.6f), 0);
    add_face(at(0.2f, 0, 0), at(1, 0, 0), at(0, 0, 1));
    expect_same_light("coplanar and overlapping faces", MOST_ERROR, 0.006);
}

static void test_flipped(void **state)
{
    (void)state;
    begin_room(FLIPPED);
    add_ceiling_lamp(0.0f);
    add(MATTE);
    add_box(at(-1.2f, 0, 0.5f), at(-0.3f, 0.8f, 1.4f), FLIPPED);
    add_box(at(0.3f, 0, 0.5f), at(1.2f, 0.8f, 1.4f), 0);
    expect_same_light("flipped normals", MOST_ERROR, 0.006);
}

/* A lamp in a box of thin glass in another. */
static void test_panes_within_panes(void **state)
{
    (void)state;
    begin_room(0);
    add(THIN);
    add_box(at(-0.8f, 0.3f, 0), at(0.8f, 1.9f, 1.6f), 0);
    add_box(at(-0.6f, 0.5f, 0.2f), at(0.6f, 1.7f, 1.4f), 0);
    add_ball_lamp("0 1.1 0.8", "0.4", "2");
    expect_same_light_by("panes within panes", &OF_PANES, MOST_ERROR, 0.008);
}

/* A lamp in a wide can below the ceiling: open, and behind thin glass. */
static void test_fixtures(void **state)
{
    (void)state;
    begin_room(0);
    add(MATTE);
    add_box(at(-0.6f, 2.2f, -0.6f), at(0.6f, 2.9f, 0.6f), NO_FLOOR);
    add_ball_lamp("0 2.55 0", "0.25", "6");
    expect_same_light_by("a lamp in a can", &OF_FIXTURES, 0.0018, 0.008);
    add(THIN);
    add_face(at(-0.6f, 2.2f, -0.6f), at(1.2f, 0, 0), at(0, 0, 1.2f));
    expect_same_light_by("a lamp in a can behind glass", &OF_FIXTURES, 0.0018, 0.008);
}

/* A plate of glass lies flush on the floor, smooth and rough, and a block of fog stands there: the floor counts, where
 * both are met at once. */
static void test_glued_glass(void **state)
{
    (void)state;
    begin_room(0);
    add_ceiling_lamp(0.0f);
    add("Material \"dielectric\"\n");
    add_box(at(-1, 0, -0.3f), at(1, 0.01f, 1.5f), 0);
    expect_same_light("a plate on the floor", MOST_ERROR, 0.01);
    begin_room(0);
    add_ceiling_lamp(0.0f);
    add("Material \"dielectric\" \"float roughness\" 0.3\n");
    add_box(at(-1, 0, -0.3f), at(1, 0.01f, 1.5f), 0);
    expect_same_light("a rough plate on the floor", MOST_ERROR, 0.01);
    begin_room(0);
    add_ceiling_lamp(0.0f);
    add("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [1 2 3]\n"
        "AttributeBegin MediumInterface \"a\" \"\" Material \"interface\"\n");
    add_box(at(-1, 0, -0.3f), at(1, 0.5f, 1.5f), 0);
    add("AttributeEnd\n");
    expect_same_light("a block of fog on the floor", MOST_ERROR, 0.006);
}

/* A thin pane that lies flush on the floor does nothing: the floor's light is that without it. */
static void test_glued_pane(void **state)
{
    (void)state;
    char scene[256];
    for (int k = 0; k < 2; k++) {
        const char *const *arguments =
            k == 0 ? ARGUMENTS("--integrator=path", PLAIN.path_samples)
                   : ARGUMENTS(AGREEMENT_MAP, PLAIN.photons, PLAIN.samples, PLAIN.gather_samples);
        begin_room(0);
        add_ceiling_lamp(0.0f);
        snprintf(scene, sizeof scene, "%s", write_text("bare.pbrt", text));
        agreement_means bare = agreement_render(scene, arguments);
        add(THIN);
        add_face(at(-1, 0, -0.3f), at(0, 0, 1.8f), at(2, 0, 0));
        snprintf(scene, sizeof scene, "%s", write_text("pane.pbrt", text));
        agreement_means covered = agreement_render(scene, arguments);
        expect_agreement("a thin pane on the floor", &covered, &bare,
                         (agreement_bounds){k * AGREEMENT_BLUR, MOST_ERROR, 0.006});
    }
}

/* The reflectance of a smooth face of glass of index 1.5 for unpolarised light. */
static double fresnel(double cosine)
{
    const double index = 1.5, within = sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double s = (cosine - index * within) / (cosine + index * within);
    const double p = (index * cosine - within) / (index * cosine + within);
    return 0.5 * (s * s + p * p);
}

/* A wide plate of glass is glued to a wide matte floor under an even sky of radiance 1. Of the sky's light a part Fe is
 * reflected by the glass (Fresnel, over the half space), and the rest goes to and fro between the floor, of reflectance
 * r, and the glass, which reflects Fi = 1 - (1 - Fe) / n^2 of diffuse light from within: the radiance at a cosine is
 * F + (1 - F) r (1 - Fe) / (n^2 (1 - r Fi)). Rests on: Saunderson, "Calculation of the Color of Pigmented Plastics",
 * 1942. With a gap between them the plate would be lighter: light that leaves the floor would be refracted into it, and
 * none be trapped. */
static void test_paint_under_glass(void **state)
{
    (void)state;
    enum { STEPS = 10000 };
    const double r[3] = {0.8, 0.5, 0.2}, index = 1.5;
    double external = 0.0, radiance[3];
    for (int i = 0; i < STEPS; i++) {
        double cosine = (i + 0.5) / STEPS;
        external += 2.0 * cosine * fresnel(cosine) / STEPS;
    }
    const double internal = 1.0 - (1.0 - external) / (index * index), cosine = 0.8;
    for (int c = 0; c < 3; c++)
        radiance[c] = fresnel(cosine) +
                      (1.0 - fresnel(cosine)) * r[c] * (1.0 - external) / (index * index * (1.0 - r[c] * internal));
    agreement_means truth = agreement_uniform(radiance[0], radiance[1], radiance[2]);
    text[0] = '\0';
    add("LookAt 0 0.8 -0.6 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 4\nWorldBegin\n"
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"diffuse\" \"rgb reflectance\" [0.8 0.5 0.2]\n");
    add_face(at(-0.2f, 0, -0.2f), at(0, 0, 0.4f), at(0.4f, 0, 0));
    add("Material \"dielectric\"\n");
    add_box(at(-0.2f, 0, -0.2f), at(0.2f, 0.002f, 0.2f), 0);
    char scene[256];
    snprintf(scene, sizeof scene, "%s", write_text("paint.pbrt", text));
    agreement_means path = agreement_render(scene, ARGUMENTS("--integrator=path", "--spp=64"));
    expect_agreement("paint under glass, path tracing", &path, &truth, (agreement_bounds){0.001, 0.01, 0.03});
    agreement_means map = agreement_render(scene, ARGUMENTS("--photons=5e4", "--caustic-photons=2e5", "--spp=8"));
    expect_agreement("paint under glass, photon map", &map, &truth, (agreement_bounds){AGREEMENT_BLUR, 0.02, 0.06});
}

/* Walls with a steep relief, plain, coated, and letting light through: photons leave as light comes to the eye. */
static void test_steep_reliefs(void **state)
{
    (void)state;
    const char *kinds[] = {"\"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]",
                           "\"coateddiffuse\" \"rgb reflectance\" [0.8 0.8 0.8]",
                           ("\"diffusetransmission\" \"rgb reflectance\" [0.5 0.5 0.5] "
                            "\"rgb transmittance\" [0.3 0.3 0.3]")};
    for (int k = 0; k < 3; k++) {
        char more[256];
        begin_room(0);
        add_ceiling_lamp(0.0f);
        add("Texture \"w\" \"float\" \"wrinkled\" \"integer octaves\" 2\n"
            "Texture \"steep\" \"float\" \"scale\" \"texture tex\" \"w\" \"float scale\" 0.3\n");
        snprintf(more, sizeof more, "Material %s \"texture displacement\" \"steep\"\n", kinds[k]);
        add(more);
        add_face(at(-1.99f, 0.01f, -2), at(3.98f, 0, 0), at(0, 0, 3.99f));
        add_face(at(-1.99f, 0.01f, -2), at(0, 2.98f, 0), at(0, 0, 3.99f));
        add_face(at(1.99f, 0.01f, -2), at(0, 2.98f, 0), at(0, 0, 3.99f));
        add_face(at(-1.99f, 0.01f, 1.99f), at(3.98f, 0, 0), at(0, 2.98f, 0));
        expect_same_light(kinds[k], 0.0018, 0.007);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_thin_walls_and_gaps),
        TEST_IN_FOLDER(test_coplanar_and_overlapping),
        TEST_IN_FOLDER(test_flipped),
        TEST_IN_FOLDER(test_panes_within_panes),
        TEST_IN_FOLDER(test_fixtures),
        TEST_IN_FOLDER(test_glued_glass),
        TEST_IN_FOLDER(test_glued_pane),
        TEST_IN_FOLDER(test_paint_under_glass),
        TEST_IN_FOLDER(test_steep_reliefs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

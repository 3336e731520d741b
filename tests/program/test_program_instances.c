/* test_program_instances.c: a room of instances is the room of the same shapes put there by hand: walls, mirrored and
 * stretched, glass that throws caustics, lamps; by photon map and by path tracing.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.007, 0.04}, UNBIASED = {0.0, 0.007, 0.04};

#define HEAD                                                                                                           \
    "LookAt 0 1 3.9 0 0.9 0 0 1 0 Camera \"perspective\" \"float fov\" 40\n"                                           \
    "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 48 PixelFilter \"box\" WorldBegin\n"

#define SQUARE "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]"
#define LAMP                                                                                                           \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [14 13 10] Material \"diffuse\" \"rgb reflectance\" [0 0 "   \
    "0]\n"                                                                                                             \
    "Scale .25 .25 1 " SQUARE " AttributeEnd\n"
#define BALL "Material \"dielectric\" Translate 0 .4 0 Shape \"sphere\" \"float radius\" .35"
#define METAL                                                                                                          \
    "Material \"conductor\" \"float roughness\" .1 Shape \"cylinder\" \"float radius\" .2 \"float zmin\" 0 "           \
    "Material \"diffuse\" \"rgb reflectance\" [.2 .3 .7] Translate 0 0 1 Shape \"disk\" \"float radius\" .2"

enum { PIECES = 4 };
static const char *const PIECE[PIECES] = {"Material \"diffuse\" \"rgb reflectance\" [.7 .6 .5] " SQUARE, LAMP, BALL,
                                          METAL};
static const struct {
    int piece;
    const char *placement;
} PLACEMENTS[] = {
    {0, "Translate 0 0 1.5 Rotate 90 1 0 0 Scale 1 2.5 1"},
    {0, "Translate 0 2 1.5 Rotate -90 1 0 0 Scale -1 2.5 1"},
    {0, "Translate 0 1 -1"},
    {0, "Translate 0 1 4 Scale 1 1 -3"},
    {0, "Translate -1 1 1.5 Rotate 90 0 1 0 Scale 2.5 1 1"},
    {0, "Translate 1 1 1.5 Rotate -90 0 1 0 Scale 2.5 1 1"},
    {1, "Translate -.4 1.99 0 Rotate 90 1 0 0"},
    {1, "Translate .5 1.99 .6 Rotate 90 1 0 0 Scale .8 -.5 1"},
    {2, "Translate -.5 0 .8"},
    {2, "Translate .45 0 1 Scale .8 .5 .8"},
    {3, "Translate -.4 0 -.4 Rotate -90 1 0 0"},
    {3, "Translate .5 0 -.3 Rotate -80 1 0 0 Scale 1 -1 1.4"},
};
enum { PLACEMENT_COUNT = sizeof PLACEMENTS / sizeof *PLACEMENTS };

static const char *write_room(const char *name, bool is_instanced)
{
    static char text[16384];
    size_t used = (size_t)snprintf(text, sizeof text, HEAD);
    for (int i = 0; is_instanced && i < PIECES; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "ObjectBegin \"%d\" %s ObjectEnd\n", i, PIECE[i]);
    for (int i = 0; i < PLACEMENT_COUNT; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "AttributeBegin %s ", PLACEMENTS[i].placement);
        if (is_instanced)
            used += (size_t)snprintf(text + used, sizeof text - used, "ObjectInstance \"%d\"", PLACEMENTS[i].piece);
        else
            used += (size_t)snprintf(text + used, sizeof text - used, "%s", PIECE[PLACEMENTS[i].piece]);
        used += (size_t)snprintf(text + used, sizeof text - used, " AttributeEnd\n");
    }
    assert_true(used < sizeof text);
    return write_text(name, text);
}

static void test_path_tracer(void **state)
{
    (void)state;
    agreement_means hand = agreement_render(write_room("hand.pbrt", false), ARGUMENTS("--integrator=path", "--spp=64"));
    agreement_means instances =
        agreement_render(write_room("instances.pbrt", true), ARGUMENTS("--integrator=path", "--spp=64"));
    expect_agreement("paths in instances", &instances, &hand, UNBIASED);
}

/* As many photons are stored as in the room that is put together by hand, since caustics are aimed at the glass and
 * metal of instances too, and its light is that of paths. */
static void test_photon_map(void **state)
{
    (void)state;
    long long caustic_emitted[2];
    const char *rooms[2] = {write_room("hand.pbrt", false), write_room("instances.pbrt", true)};
    for (int i = 0; i < 2; i++) {
        picture p = RENDER(rooms[i], "--spp=1", "--gather-samples=1", "--size=24x24", "--photons=200000",
                           "--caustic-photons=100000", "--stats=stats.json");
        json_t *stats = stats_read(in_folder("stats.json"));
        /* strong ones are divided into more */
        assert_in_range(stats_integer(stats, "photons.stored_caustic"), 100000, 105000);
        assert_int_equal(stats_integer(stats, "photons.stored_global"), 200000);
        caustic_emitted[i] = stats_integer(stats, "photons.emitted");
        json_decref(stats);
        picture_reset(&p);
    }
    expect_near("paths", (double)caustic_emitted[1], (double)caustic_emitted[0], 0.03);
    agreement_means path = agreement_render(rooms[0], ARGUMENTS("--integrator=path", "--spp=64"));
    agreement_means map = agreement_render(rooms[1], ARGUMENTS(AGREEMENT_MAP, "--spp=12"));
    expect_agreement("photons in instances", &map, &path, BOUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_path_tracer),
        TEST_IN_FOLDER(test_photon_map),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_aov.c: layers of pictures: the parts of light add up bit for bit and are alike in both integrators; what is met
 * first is where, what and which way it is; light groups; pbrt's gbuffer; clamps.
 * Threads: the renderer's. */
#define _GNU_SOURCE
#include "film/layer_table.h"
#include "fixtures/layers_fixture.h"

#define HEAD                                                                                                           \
    "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"                                             \
    "PixelFilter \"box\" Camera \"perspective\" \"float fov\" 90\n"

static void test_names(void **state)
{
    (void)state;
    uint32_t layers;
    assert_int_equal(ag_layers_parse("A,light,N", &layers), AG_OK);
    assert_int_equal(layers, AG_LAYER_ALPHA | AG_LAYER_NORMAL | AG_LAYERS_LIGHT);
    assert_int_equal(layers_of("all") | AG_LAYER_GBUFFER | AG_LAYER_TILE_TIME, layers_known());
    assert_int_equal(layers_of("all") & (AG_LAYER_GBUFFER | AG_LAYER_TILE_TIME), 0);
    static const char *const wrong[] = {"", ",", "A,", "a", "A;N", "Albedo", "A,,N"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(ag_layers_parse(wrong[i], &layers), AG_ERROR_ARGUMENT);
}

/* Every layer is a row, by a bit, a name and words of its own. */
static void test_table(void **state)
{
    (void)state;
    uint32_t seen = 0, all = 0, layers;
    const ag_layer_info *info;
    for (size_t i = 0; (info = ag_layer_at(i)) != NULL; i++) {
        uint32_t layer = (uint32_t)info->layer;
        assert_true(layer != 0 && (layer & (layer - 1)) == 0 && !(seen & layer));
        seen |= layer;
        all |= info->is_left_out_of_all ? 0 : layer;
        assert_true(strlen(info->about) > 5);
        assert_string_equal(layer_name(layer), info->name);
        assert_int_equal(ag_layers_parse(info->name, &layers), AG_OK);
        assert_int_equal(layers, layer);
        if (info->group) {
            assert_int_equal(ag_layers_parse(info->group, &layers), AG_OK);
            assert_true((layers & layer) && layers != layer);
        }
        for (size_t k = 0; k < i; k++) {
            assert_string_not_equal(info->name, ag_layer_at(k)->name);
            assert_string_not_equal(info->name, ag_layer_at(k)->group ? ag_layer_at(k)->group : "");
        }
    }
    assert_int_equal(seen, layers_known());
    assert_int_equal(all, layers_of("all"));
    assert_int_equal(ag_layers_parse("light", &layers), AG_OK);
    assert_int_equal(layers, AG_LAYERS_LIGHT);
}

static void expect_layout(uint32_t layers, aov_needs also, bool is_path, int group_count)
{
    static const char *names[LIGHT_GROUPS_MAX] = {"default"};
    static char spelt[LIGHT_GROUPS_MAX][16];
    aov_layout layout;
    for (int i = 1; i < group_count; i++) {
        snprintf(spelt[i], sizeof spelt[i], "g%d", i);
        names[i] = spelt[i];
    }
    assert_int_equal(aov_layout_create(layers, also, is_path, names, group_count, &layout), AG_OK);
    assert_string_equal(layout.channels[0].name, "R");
    assert_string_equal(layout.channels[2].name, "B");
    int width = 0;
    for (int i = 0; i < FILM_SUM_COUNT; i++)
        width = layout.offset[i] > width ? layout.offset[i] : width;
    assert_true(width < layout.sum_count);
    for (int i = 0; i < layout.channel_count; i++) {
        const film_channel *c = &layout.channels[i];
        for (int k = 0; k < i; k++)
            assert_string_not_equal(c->name, layout.channels[k].name);
        bool reads_sum = c->source <= CHANNEL_RELATIVE_VARIANCE;
        if (reads_sum && (layout.offset[c->sum] < 0 || c->offset + c->component >= layout.sum_count))
            fail_msg("%s is read from what is not summed", c->name);
        if (c->source == CHANNEL_VIEW)
            assert_true(layout.has_view[c->component]);
    }
    assert_true(!also.variance || (aov_has(&layout, SUM_SQUARES) && aov_has(&layout, SUM_DEVELOPED)));
    assert_true(!also.albedo_and_normal || (aov_has(&layout, SUM_ALBEDO) && aov_has(&layout, SUM_NORMAL)));
    aov_layout_reset(&layout);
}

/* For each layer alone, each pair and all of them, every channel has room, and the sum that it is read from is there.
 * ASan would find a channel too many. */
static void test_layouts(void **state)
{
    (void)state;
    for (int bits = 0; bits < 4; bits++) {
        aov_needs also = {.albedo_and_normal = bits & 1, .variance = bits & 2};
        expect_layout(0, also, false, 1);
        expect_layout(layers_known(), also, false, LIGHT_GROUPS_MAX);
        expect_layout(layers_known(), also, true, LIGHT_GROUPS_MAX);
        for (size_t i = 0; ag_layer_at(i); i++)
            for (size_t k = 0; k <= i; k++)
                expect_layout((uint32_t)ag_layer_at(i)->layer | (uint32_t)ag_layer_at(k)->layer, also, k % 2, 3);
    }
}

static void test_parts_add_up(void **state)
{
    (void)state;
    static const char *const parts[] = {"emission", "direct", "indirect", "caustic", "specular"};
    static const char *const filters[] = {"gaussian", "sinc"};
    for (int path = 0; path < 2; path++)
        for (int f = 0; f < 2; f++) {
            char text[512];
            snprintf(text, sizeof text, "PixelFilter \"%s\" Include \"" LAYERS_SCENES "glass_and_metal.pbrt\"",
                     filters[f]);
            studio *s = studio_open(text, 2);
            s->settings.integrator = path ? AG_INTEGRATOR_PATH : AG_INTEGRATOR_PHOTONMAP;
            s->settings.layers = AG_LAYERS_LIGHT;
            s->settings.white_balance = f ? 4500.0f : 0.0f;
            ag_film *film = studio_render(s);
            for (int c = 0; c < 3; c++) {
                const char name[] = {"RGB"[c], '\0'};
                float *beauty = film_channel_of(film, name), *sum = NULL;
                for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
                    char channel[64];
                    snprintf(channel, sizeof channel, "%s.%s", parts[i], name);
                    float *part = film_channel_of(film, channel);
                    for (int k = 0; sum && k < film_pixel_count(film); k++)
                        sum[k] += part[k];
                    if (sum)
                        free(part);
                    else
                        sum = part;
                }
                assert_memory_equal(beauty, sum, (size_t)film_pixel_count(film) * sizeof *sum);
                free(beauty);
                free(sum);
            }
            ag_film_destroy(film);
            studio_close(s);
        }
}

/* The means over a room with glass, metal and a mirror. Bounds: four times what two seeds differ by, measured. */
static void test_integrators_split_alike(void **state)
{
    (void)state;
    static const struct {
        const char *channel;
        double tolerance; /* relative */
    } expected[] = {{"emission.G", 0.02}, {"direct.G", 0.02},   {"indirect.G", 0.05},
                    {"caustic.G", 0.10},  {"specular.G", 0.05}, {"albedo.G", 0.02}};
    studio *s = studio_open(LAYERS_SCENES "glass_and_metal.pbrt", 2);
    s->settings.width = s->settings.height = 24;
    s->settings.samples_per_pixel = 16;
    s->settings.photon_count = 30000;
    s->settings.caustic_photon_count = 30000;
    s->settings.layers = AG_LAYERS_LIGHT | AG_LAYER_ALBEDO;
    ag_film *map = studio_render(s);
    s->settings.integrator = AG_INTEGRATOR_PATH;
    s->settings.samples_per_pixel = 128;
    ag_film *path = studio_render(s);
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        double a = film_mean(map, expected[i].channel), b = film_mean(path, expected[i].channel);
        assert_true(b > 0.0);
        expect_within(expected[i].channel, a / b, 1.0, expected[i].tolerance);
    }
    ag_film_destroy(map);
    ag_film_destroy(path);
    studio_close(s);
}

/* A wall at z = 2 that fills the left half of the view; it is met at x from -2 to 0. */
#define WALL                                                                                                           \
    "LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]\n"                                                               \
    "Material \"diffuse\" \"rgb reflectance\" [0.2 0.4 0.6]\n"                                                         \
    "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 2  0 -9 2  -9 9 2  0 9 2]\n"

static void test_first_hit(void **state)
{
    (void)state;
    studio *s = studio_open(HEAD "WorldBegin " WALL, 1);
    s->settings.integrator = AG_INTEGRATOR_PATH;
    s->settings.layers = layers_of("all");
    ag_film *film = studio_render(s);
    assert_false(film_has(film, "irradiance.R")); /* the photon map's alone */
    float *alpha = film_channel_of(film, "A"), *z = film_channel_of(film, "Z"), *n = film_channel_of(film, "N.Z"),
          *x = film_channel_of(film, "P.X"), *y = film_channel_of(film, "P.Y"),
          *albedo = film_channel_of(film, "albedo.B"), *object = film_channel_of(film, "id.object.V"),
          *emission = film_channel_of(film, "emission.G");
    for (int i = 0; i < 256; i++) {
        bool is_wall = i % 16 < 8;
        expect_within("A", (double)alpha[i], is_wall, 0.0);
        expect_within("Z", (double)z[i], is_wall ? 2.0 : (double)1e10f, 1e-5);
        expect_within("N", (double)n[i], is_wall ? -1.0 : 0.0, 1e-6);
        expect_within("albedo", (double)albedo[i], is_wall ? 0.6 : 0.0, 1e-6);
        expect_within("emission", (double)emission[i], is_wall ? 0.0 : 0.5, 1e-6);
        expect_within("object", (double)object[i], is_wall, 0.0);
        if (is_wall) { /* within the pixel's square, 0.25 wide */
            expect_within("x", (double)x[i], 0.25 * (i % 16 - 8 + 0.5), 0.125);
            expect_within("y", (double)y[i], 0.25 * (8 - i / 16 - 0.5), 0.125);
        }
    }
    free(alpha);
    free(z);
    free(n);
    free(x);
    free(y);
    free(albedo);
    free(object);
    free(emission);
    ag_film_destroy(film);
    studio_close(s);
}

/* Glass and mirrors reflect all that they do not let through. */
static void test_albedo(void **state)
{
    (void)state;
    static const struct {
        const char *material;
        double albedo, tolerance;
    } cases[] = {
        {"\"dielectric\"", 1.0, 1e-5},
        {"\"thindielectric\"", 1.0, 1e-5},
        {"\"conductor\" \"rgb reflectance\" [0.7 0.7 0.7]", 0.7, 0.01},
        {"\"diffusetransmission\" \"rgb reflectance\" [0.3 0.3 0.3] \"rgb transmittance\" [0.2 0.2 0.2]", 0.5, 1e-5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "Film \"rgb\" PixelFilter \"box\" Camera \"perspective\" \"float fov\" 20 WorldBegin "
                 "LightSource \"infinite\" Material %s Shape \"bilinearmesh\" \"point3 P\" "
                 "[-9 -9 2  9 -9 2  -9 9 2  9 9 2]",
                 cases[i].material);
        studio *s = studio_open(text, 1);
        s->settings.layers = AG_LAYER_ALBEDO;
        s->settings.integrator = AG_INTEGRATOR_PATH;
        ag_film *film = studio_render(s);
        expect_within(cases[i].material, film_mean(film, "albedo.G"), cases[i].albedo, cases[i].tolerance);
        ag_film_destroy(film);
        studio_close(s);
    }
}

/* A floor under the sky: its irradiance is pi L but for what its edges lose, in every space. */
static void test_irradiance(void **state)
{
    (void)state;
    studio *s = studio_open("Film \"rgb\" Camera \"perspective\" \"float fov\" 20 WorldBegin LightSource \"infinite\" "
                            "Shape \"disk\" \"float height\" 2 \"float radius\" 2",
                            1);
    s->settings.photon_count = 50000;
    s->settings.layers = AG_LAYER_IRRADIANCE;
    ag_film *film = studio_render(s);
    expect_within("irradiance", film_mean(film, "irradiance.G"), 3.14159265, 0.15);
    ag_film_destroy(film);
    studio_close(s);
}

/* Two lamps in groups of their own, and a sky in none: the groups are what each brings alone. */
static void test_light_groups(void **state)
{
    (void)state;
#define ROOM(a, b, c)                                                                                                  \
    HEAD "WorldBegin LightSource \"point\" \"point3 from\" [1 0 1] \"rgb I\" [" a "] \"string lightgroup\" \"key\"\n"  \
         "LightSource \"infinite\" \"rgb L\" [" c "]\n"                                                                \
         "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" b "] \"string lightgroup\" \"fill\" "                \
         "Translate -1 0 0.5 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n"                                     \
         "Translate 0 0 2 Material \"coateddiffuse\" Shape \"sphere\" \"float radius\" 1.2"
    static const char *const only[] = {ROOM("3 3 3", "0 0 0", "0 0 0"), ROOM("0 0 0", "2 2 2", "0 0 0"),
                                       ROOM("0 0 0", "0 0 0", "1 1 1")};
    static const char *const names[] = {"light_key.G", "light_fill.G", "light_default.G"};
    studio *all = studio_open(ROOM("3 3 3", "2 2 2", "1 1 1"), 2);
    all->settings.layers = AG_LAYERS_LIGHT | AG_LAYER_LIGHT_GROUPS;
    all->settings.samples_per_pixel = 128;
    all->settings.integrator = AG_INTEGRATOR_PATH;
    ag_film *together = studio_render(all);
    double sum = film_mean(together, "light_photons.G");
    expect_within("light_photons", sum, 0.0, 0.0);
    for (int i = 0; i < 3; i++) {
        studio *one = studio_open(only[i], 2);
        one->settings = all->settings;
        ag_film *alone = studio_render(one);
        double expected = film_mean(alone, "G");
        assert_true(expected > 0.0);
        expect_within(names[i], film_mean(together, names[i]) / expected, 1.0, 0.03);
        sum += film_mean(together, names[i]);
        ag_film_destroy(alone);
        studio_close(one);
    }
    expect_within("all groups", sum, film_mean(together, "G"), 1e-5);
    ag_film_destroy(together);

    all->settings.integrator = AG_INTEGRATOR_PHOTONMAP;
    all->settings.samples_per_pixel = 4;
    together = studio_render(all);
    sum = film_mean(together, "light_photons.G");
    /* more than that, for the coat reflects light of photons too */
    assert_true(sum > film_mean(together, "indirect.G") + film_mean(together, "caustic.G"));
    for (int i = 0; i < 3; i++)
        sum += film_mean(together, names[i]);
    expect_within("all groups of the map", sum, film_mean(together, "G"), 1e-5);
    ag_film_destroy(together);
    studio_close(all);
}

static void test_gbuffer(void **state)
{
    (void)state;
#define GBUFFER(space)                                                                                                 \
    "Film \"gbuffer\" \"string filename\" \"p.exr\" \"integer xresolution\" 16 \"integer yresolution\" 16 " space "\n" \
    "PixelFilter \"box\" Translate 0 0 3 Camera \"perspective\" \"float fov\" 90 WorldBegin Translate 0 0 -3\n" WALL
    static const char *const names[] = {
        "R",    "G",   "B",    "Albedo.R", "Albedo.G", "Albedo.B",   "P.X",
        "P.Y",  "P.Z", "dzdx", "dzdy",     "N.X",      "N.Y",        "N.Z",
        "Ns.X", "u",   "v",    "Ns.Z",     "Ns.Y",     "Variance.R", "RelativeVariance.B"};
    static const char *const scenes[] = {GBUFFER(""), GBUFFER("\"string coordinatesystem\" \"world\"")};
    for (int i = 0; i < 2; i++) {
        studio *s = studio_open(scenes[i], 1);
        s->settings.integrator = AG_INTEGRATOR_PATH;
        ag_film *film = studio_render(s);
        assert_int_equal(ag_film_channel_count(film), 25);
        for (size_t k = 0; k < sizeof names / sizeof *names; k++)
            assert_true(film_has(film, names[k]));
        /* "Translate 0 0 3" before Camera: the eye is at z = -3 of the world, and the wall at -1 */
        float *z = film_channel_of(film, "P.Z"), *n = film_channel_of(film, "N.Z"), *u = film_channel_of(film, "u"),
              *slope = film_channel_of(film, "dzdx");
        expect_within("P.Z", (double)z[0], i == 0 ? 2.0 : -1.0, 1e-5);
        expect_within("N.Z", (double)n[0], -1.0, 1e-6);
        expect_within("dzdx", (double)slope[0], 0.0, 1e-5);
        expect_within("empty", (double)z[15], 0.0, 0.0);
        assert_true(u[0] > 0.0f && u[0] < 1.0f);
        free(z);
        free(n);
        free(u);
        free(slope);
        ag_film_destroy(film);
        studio_close(s);
    }
}

/* A plane tilted by 45 degrees, z = 3 + x: seen under tan = x / z, z = 3 / (1 - tan), dz/dpixel = z^2 / 3 / 8. */
static void test_slopes(void **state)
{
    (void)state;
    studio *s = studio_open("Film \"gbuffer\" \"string filename\" \"p.exr\" PixelFilter \"box\" "
                            "Option \"disablepixeljitter\" true Camera \"perspective\" "
                            "\"float fov\" 90 WorldBegin LightSource \"infinite\" Shape \"bilinearmesh\" "
                            "\"point3 P\" [-30 -90 -27  30 -90 33  -30 90 -27  30 90 33]",
                            1);
    s->settings.integrator = AG_INTEGRATOR_PATH;
    ag_film *film = studio_render(s);
    float *dx = film_channel_of(film, "dzdx"), *dy = film_channel_of(film, "dzdy");
    for (int x = 0; x < 14; x++) {
        double tangent = (x + 0.5) / 8.0 - 1.0, z = 3.0 / (1.0 - tangent), next = 3.0 / (1.0 - tangent - 0.125);
        expect_within("dzdx", (double)dx[x], next - z, 1e-4 * next);
        expect_within("dzdy", (double)dy[x], 0.0, 1e-4);
    }
    free(dx);
    free(dy);
    ag_film_destroy(film);
    studio_close(s);
}

/* A ball of glass and one of rough copper in front of a mirror, on a floor under a lamp and a dim sky: all that layers
 * show is in the picture, and differs from place to place. */
#define ALL_SORTS(camera)                                                                                              \
    "Film \"rgb\" LookAt 0 1.6 4  0 .6 0  0 1 0 Camera " camera " WorldBegin\n"                                        \
    "LightSource \"infinite\" \"rgb L\" [.1 .2 .3]\n"                                                                  \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] \"string lightgroup\" \"key\" Translate 0 1.8 0\n"   \
    "Rotate 90 1 0 0 Shape \"disk\" \"float radius\" .7 AttributeEnd\n"                                                \
    "Material \"diffuse\" \"rgb reflectance\" [.7 .5 .3] Shape \"bilinearmesh\" \"point3 P\" [-1.6 0 -1 1.6 0 -1 "     \
    "-1.6 0 3 1.6 0 3]\n"                                                                                              \
    "Material \"conductor\" Shape \"bilinearmesh\" \"point3 P\" [-.8 0 -1 .8 .1 -1 -.8 1.4 -1.2 .8 1.4 -1]\n"          \
    "AttributeBegin Material \"conductor\" \"float roughness\" .2 Translate .7 .4 .2 Shape \"sphere\" "                \
    "\"float radius\" .4 AttributeEnd\n"                                                                               \
    "AttributeBegin Material \"dielectric\" Translate -.6 .5 .4 Shape \"sphere\" \"float radius\" .45 AttributeEnd\n"

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static int count_different(const ag_film *film, const char *channel)
{
    float *values = film_channel_of(film, channel);
    int count = film_pixel_count(film), different = 1;
    for (int i = 0; i < count; i++)
        assert_true(isfinite(values[i]));
    qsort(values, (size_t)count, sizeof *values, compare_floats);
    for (int i = 1; i < count; i++)
        different += values[i] != values[i - 1];
    free(values);
    return different;
}

/* Where nothing fills a value, a channel has one value everywhere, or a second where the ray meets nothing. Of a layer
 * that has channels for more than this scene has (ranks of Cryptomatte) the first is looked at. */
static void test_every_layer_is_filled(void **state)
{
    (void)state;
    studio *s = studio_open(ALL_SORTS("\"perspective\" \"float fov\" 50"), 2);
    const ag_layer_info *info;
    s->settings.width = s->settings.height = 48; /* more than one tile */
    s->settings.samples_per_pixel = 32;
    s->settings.noise_min_samples = 4;
    s->settings.noise_level = 0.03f; /* numbers of samples differ */
    for (size_t i = 0; (info = ag_layer_at(i)) != NULL; i++) {
        s->settings.layers = (uint32_t)info->layer;
        ag_film *film = studio_render(s);
        assert_true(ag_film_channel_count(film) > 3);
        bool has_ranks = info->group && strcmp(info->group, "crypto") == 0;
        for (int c = 0; c < (has_ranks ? 4 : ag_film_channel_count(film)); c++) {
            const char *name = ag_film_channel_name(film, c);
            if (count_different(film, name) < 3)
                fail_msg("layer %s: nothing fills channel %s", info->name, name);
        }
        ag_film_destroy(film);
    }
    studio_close(s);

    s = studio_open(ALL_SORTS("\"spherical\""), 2); /* its depth is the distance, which is filled elsewhere */
    s->settings.layers = AG_LAYER_DEPTH;
    ag_film *film = studio_render(s);
    assert_true(count_different(film, "Z") >= 3);
    ag_film_destroy(film);
    studio_close(s);
}

/* Clamping takes light away, each from its own part. */
static void test_clamps(void **state)
{
    (void)state;
    for (int path = 0; path < 2; path++) {
        studio *s = studio_open(LAYERS_SCENES "glass_and_metal.pbrt", 2);
        s->settings.integrator = path ? AG_INTEGRATOR_PATH : AG_INTEGRATOR_PHOTONMAP;
        s->settings.layers = AG_LAYERS_LIGHT;
        ag_film *free_film = studio_render(s);
        s->settings.clamp_indirect = 0.05f;
        ag_film *indirect = studio_render(s);
        expect_within("direct", film_mean(indirect, "direct.G"), film_mean(free_film, "direct.G"), 0.0);
        expect_within("emission", film_mean(indirect, "emission.G"), film_mean(free_film, "emission.G"), 0.0);
        assert_true(film_mean(indirect, "indirect.G") < 0.9 * film_mean(free_film, "indirect.G"));
        s->settings.clamp_indirect = 0.0f;
        s->settings.clamp_direct = 0.05f;
        ag_film *direct = studio_render(s);
        expect_within("indirect", film_mean(direct, "indirect.G"), film_mean(free_film, "indirect.G"), 0.0);
        assert_true(film_mean(direct, "direct.G") < 0.9 * film_mean(free_film, "direct.G"));
        float *seen = film_channel_of(direct, "emission.R");
        for (int i = 0; i < film_pixel_count(direct); i++)
            assert_true(seen[i] <= 0.05f);
        free(seen);
        ag_film_destroy(free_film);
        ag_film_destroy(direct);
        ag_film_destroy(indirect);
        studio_close(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_layouts),
        TEST_IN_FOLDER(test_parts_add_up),
        TEST_IN_FOLDER(test_integrators_split_alike),
        TEST_IN_FOLDER(test_first_hit),
        TEST_IN_FOLDER(test_albedo),
        TEST_IN_FOLDER(test_irradiance),
        TEST_IN_FOLDER(test_light_groups),
        TEST_IN_FOLDER(test_gbuffer),
        TEST_IN_FOLDER(test_slopes),
        TEST_IN_FOLDER(test_every_layer_is_filled),
        TEST_IN_FOLDER(test_clamps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

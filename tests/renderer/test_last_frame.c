/* test_last_frame.c: frames of an animation whose photon paths are fixed: whatever moves, changes, comes or goes, each
 * frame has the bits of one that is rendered alone, in the picture and in the slot of every photon; and where little
 * moves most irradiances are kept.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/temporary_folder.h"
#include "last_frame.h"
#include "rendering.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIZE = 24, PLATES = 4, TEXT_MAX = 8192 };

/* The values that differ from frame to frame. */
typedef struct props {
    double ball[3], ball_radius, camera, lamp, red, shutter;
    double plate[PLATES][3]; /* where plates stand on the floor; the first `plates` of them do, and how high */
    int plates;
    bool has_net, has_fur, has_mist; /* an alpha texture; curves; an interface */
    bool is_plain;                   /* nothing is an instance */
} props;

static uint64_t drawn = 1;

static double draw(double from, double to)
{
    drawn = drawn * 6364136223846793005u + 1442695040888963407u;
    return from + (to - from) * (double)(drawn >> 40) * 0x1p-24;
}

static void add_wall(char *text, const char *corners)
{
    size_t length = strlen(text);
    snprintf(text + length, TEXT_MAX - length,
             "Shape \"trianglemesh\" \"point3 P\" [%s] \"integer indices\" [0 1 2 0 2 3]\n", corners);
}

#define ADD(...) (length = strlen(text), snprintf(text + length, TEXT_MAX - length, __VA_ARGS__))

static void describe(const props *s, char text[TEXT_MAX])
{
    size_t length;
    text[0] = '\0';
    ADD("LookAt %.9g 0 -1.5  0 0 2  0 1 0\nCamera \"perspective\" \"float fov\" 70 \"float shutterclose\" 1\nWorldBegin\n",
        s->camera);
    ADD("AttributeBegin Translate 0 1.99 0 AreaLightSource \"diffuse\" \"rgb L\" [%.9g 10 9]\n", s->lamp);
    add_wall(text, "-.5 0 -.5 .5 0 -.5 .5 0 .5 -.5 0 .5");
    ADD("AttributeEnd\nMaterial \"diffuse\" \"rgb reflectance\" [.7 .7 .7]\n");
    add_wall(text, "-2 -2 -2 -2 -2 2 2 -2 2 2 -2 -2");
    add_wall(text, "-2 2 -2 2 2 -2 2 2 2 -2 2 2");
    add_wall(text, "-2 -2 2 -2 2 2 2 2 2 2 -2 2");
    add_wall(text, "-2 -2 -2 2 -2 -2 2 2 -2 -2 2 -2");
    ADD("Material \"diffuse\" \"rgb reflectance\" [%.9g .2 .2]\n", s->red);
    add_wall(text, "-2 -2 -2 -2 2 -2 -2 2 2 -2 -2 2");
    ADD("Material \"diffuse\" \"rgb reflectance\" [.2 .7 .2]\n");
    add_wall(text, "2 -2 -2 2 -2 2 2 2 2 2 2 -2");
    if (!s->is_plain)
        ADD("ObjectBegin \"block\"\nShape \"sphere\" \"float radius\" .3\nObjectEnd\n");
    if (!s->is_plain)
        ADD("AttributeBegin ActiveTransform EndTime Translate %.9g 0 0 ActiveTransform All Translate 1.2 -1.6 1\n"
            "ObjectInstance \"block\" AttributeEnd\n",
            s->shutter);
    ADD("AttributeBegin Translate %.9g %.9g %.9g Shape \"sphere\" \"float radius\" %.9g AttributeEnd\n", s->ball[0],
        s->ball[1], s->ball[2], s->ball_radius);
    for (int i = 0; i < s->plates; i++) { /* seen edge on from the lamp: hardly any photon meets one */
        const double *at = s->plate[i];
        char corners[320];
        snprintf(corners, sizeof corners, "%.9g -2 %.9g %.9g -2 %.9g %.9g %.9g %.9g %.9g %.9g %.9g", at[0], at[1],
                 at[0] + .1, at[1], at[0] + .1, -2 + at[2], at[1], at[0], -2 + at[2], at[1]);
        add_wall(text, corners);
    }
    if (s->has_net) {
        ADD("Texture \"net\" \"float\" \"checkerboard\" \"float tex1\" 1 \"float tex2\" 0 \"float uscale\" 8 \"float vscale\" 8\n"
            "Shape \"disk\" \"float radius\" .4 \"float height\" 1.5 \"texture alpha\" \"net\"\n");
    }
    if (s->has_fur)
        ADD("Shape \"curve\" \"point3 P\" [-1 -2 0 -1 -1.9 0 -1 -1.8 .1 -1 -1.7 .2] \"float width\" .02\n");
    if (s->has_mist)
        ADD("MakeNamedMedium \"mist\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .1 .1] \"rgb sigma_s\" [0 0 0]\n"
            "MediumInterface \"mist\" \"\" Material \"interface\" Shape \"sphere\" \"float radius\" .5\n");
}

/* Something small, or nothing, that comes between two frames. Returns whether most irradiances must outlast it. */
static bool change(props *s)
{
    switch ((int)draw(0, 10)) {
    case 0: return true;
    case 1: s->camera += draw(-.1, .1); return true;
    case 2: s->lamp = draw(8, 12); return false;
    case 3: s->red = draw(.5, .8); return false;
    case 4:
    case 5:
        for (int i = 0; s->plates < PLATES && i < 2; i++)
            s->plate[s->plates][i] = draw(-1.5, 1.5);
        if (s->plates < PLATES)
            s->plate[s->plates++][2] = draw(.02, .2);
        return true;
    case 6: s->plates -= s->plates > 0; return true;
    case 7: s->shutter = draw(0, .2); return false;
    case 8: s->ball_radius = draw(.03, .06); return true;
    default:
        for (int i = 0; i < 3; i++)
            s->ball[i] = draw(-1, 1);
        return true;
    }
}

typedef struct studio {
    ag_context *context;
    char said[2048];
} studio;

static void hear(void *user, ag_log_level level, const char *text)
{
    studio *s = user;
    size_t length = strlen(s->said);
    if (level <= AG_LOG_WARNING)
        snprintf(s->said + length, sizeof s->said - length, "%s\n", text);
}

static void open_shot(studio *s, unsigned threads)
{
    ag_context_settings settings = ag_default_context_settings();
    *s = (studio){0};
    settings.thread_count = threads;
    settings.log = hear;
    settings.user = s;
    assert_int_equal(ag_context_create(&settings, &s->context), AG_OK);
}

typedef struct estimating {
    ag_cache_mode cache;
    float irradiance_fraction, radius;
    int nearest;
    uint64_t photon_count;
} estimating;

typedef struct frame_bits {
    float pixels[3 * SIZE * SIZE];
    photon_block *irradiances; /* with their slots; owned */
    uint32_t count;
} frame_bits;

static frame_bits render_frame(studio *in, const props *what, const estimating *by)
{
    static char text[TEXT_MAX];
    ag_scene *made;
    ag_render_settings settings;
    ag_rendering *r;
    frame_bits out = {.irradiances = NULL};
    int width, height;
    describe(what, text);
    if (ag_scene_load_text(in->context, "frame", text, strlen(text), NULL, &made) != AG_OK)
        fail_msg("%s", in->said);
    assert_int_equal(ag_render_settings_from_scene(in->context, made, &settings), AG_OK);
    settings.width = settings.height = SIZE;
    settings.samples_per_pixel = 1;
    settings.noise_level = 0.0f;
    settings.gather_samples = 8;
    settings.photon_paths = 3000;
    settings.caustic_photon_count = 500;
    settings.photon_count = by->photon_count;
    settings.cache = by->cache;
    settings.nearest = by->nearest;
    settings.radius = by->radius;
    settings.irradiance_fraction = by->irradiance_fraction;
    if (ag_rendering_create(in->context, made, &settings, &r) != AG_OK || ag_rendering_continue(r, 1) != AG_OK)
        fail_msg("%s", in->said);
    memcpy(out.pixels, ag_film_pixels(ag_rendering_film(r), &width, &height), sizeof out.pixels);
    const photon_tree *tree = &r->maps->global.irradiance_photons;
    size_t bytes = (size_t)photon_block_count(tree->count) * sizeof(photon_block);
    out.count = tree->count;
    out.irradiances = malloc(bytes);
    assert_non_null(out.irradiances);
    memcpy(out.irradiances, tree->blocks, bytes);
    assert_int_equal(r->maps->global.spaces != NULL, what->is_plain);
    ag_rendering_finish(r, NULL);
    ag_scene_destroy(made);
    return out;
}

/* Fails unless all that is ready in both is the same, and the pictures are. */
static void expect_same(const frame_bits *one, const frame_bits *other, bool are_all_ready, int number)
{
    assert_int_equal(one->count, other->count);
    for (uint32_t i = 0; i < one->count; i++) {
        const uint32_t a = load_relaxed_u32(photon_block_slot(one->irradiances, i)),
                       b = load_relaxed_u32(photon_block_slot(other->irradiances, i));
        const bool are_ready = irradiance_word_is_ready(a) && irradiance_word_is_ready(b);
        if ((are_ready || are_all_ready) && a != b)
            fail_msg("frame %d: the slot of photon %u is %08x, and %08x in a frame that is rendered alone", number, i,
                     a, b);
    }
    assert_memory_equal(one->pixels, other->pixels, sizeof one->pixels);
}

static void free_bits(frame_bits *bits) { free(bits->irradiances); }

/* Renders a shot of random changes, each frame after the other and alone. */
static void run_shot(uint64_t seed, const estimating *by, unsigned threads, int frames)
{
    studio all;
    props now = {.ball = {0, -1, -1.8}, .ball_radius = .04, .lamp = 10, .red = .7, .shutter = 0};
    open_shot(&all, threads);
    drawn = seed;
    now.has_net = seed & 1;
    now.has_mist = seed == 3 || seed == 6;
    const bool is_whole = by->irradiance_fraction == 1.0f && by->cache == AG_CACHE_PRECOMPUTE;
    uint64_t kept_before = 0, should_keep = 0;
    for (int i = 0; i < frames; i++) {
        const bool keeps = i > 0 && change(&now);
        if (seed == 4 && i == frames / 2) /* beside a curve nothing is kept where any form changes */
            now.has_fur = true;
        frame_bits follows = render_frame(&all, &now, by);
        const ag_statistics s = ag_context_statistics(all.context);
        const uint64_t kept = s.irradiance_kept - kept_before;
        kept_before = s.irradiance_kept;
        assert_int_equal(s.irradiance_duplicated, 0);
        assert_int_equal(s.irradiance_computed, s.irradiance_distinct);
        should_keep += keeps && seed != 4 && kept > 0;
        if (keeps && seed != 4 && is_whole && kept < follows.count / 4)
            fail_msg("seed %u, frame %d: only %u of %u irradiances are kept", (unsigned)seed, i, (unsigned)kept,
                     follows.count);
        studio alone;
        open_shot(&alone, 3 - threads);
        frame_bits fresh = render_frame(&alone, &now, by);
        expect_same(&follows, &fresh, by->cache == AG_CACHE_PRECOMPUTE, i);
        assert_int_equal(ag_context_statistics(alone.context).irradiance_kept, 0);
        assert_string_equal(alone.said, all.said);
        all.said[0] = '\0';
        free_bits(&follows);
        free_bits(&fresh);
        ag_context_destroy(alone.context);
    }
    assert_true(should_keep > 0 || seed == 4);
    ag_context_destroy(all.context);
}

static void test_all_slots(void **state)
{
    (void)state;
    const estimating by = {AG_CACHE_PRECOMPUTE, 1.0f, 0.0f, 10, 1000000};
    for (uint64_t seed = 1; seed <= 4; seed++)
        run_shot(seed, &by, seed & 1 ? 1 : 2, 10);
}

static void test_on_demand(void **state)
{
    (void)state;
    const estimating by = {AG_CACHE_ON_DEMAND, 1.0f, 0.3f, 20, 1000000};
    for (uint64_t seed = 5; seed <= 6; seed++)
        run_shot(seed, &by, seed & 1 ? 1 : 2, 8);
}

/* Some photons alone bear irradiance, and which ones depends on all. */
static void test_fraction(void **state)
{
    (void)state;
    const estimating by = {AG_CACHE_PRECOMPUTE, 0.4f, 0.0f, 10, 1000000};
    run_shot(7, &by, 2, 8);
}

/* A map that is full before all paths have been emitted: other numbers of paths from frame to frame. */
static void test_full_map(void **state)
{
    (void)state;
    studio all, alone;
    props now = {.ball = {0, -1, -1.8}, .ball_radius = .04, .lamp = 10, .red = .7};
    const estimating by = {AG_CACHE_PRECOMPUTE, 1.0f, 0.0f, 10, 5000};
    open_shot(&all, 2);
    for (int i = 0; i < 2; i++) {
        now.ball[0] = .2 * i;
        open_shot(&alone, 1);
        frame_bits follows = render_frame(&all, &now, &by), fresh = render_frame(&alone, &now, &by);
        expect_same(&follows, &fresh, true, i);
        assert_non_null(strstr(alone.said, "the photon map was full"));
        free_bits(&follows);
        free_bits(&fresh);
        ag_context_destroy(alone.context);
    }
    assert_int_equal(ag_context_statistics(all.context).irradiance_kept, 0);
    ag_context_destroy(all.context);
}

/* A frame's photons go from one context to another, and are used once. */
static void test_taking_over(void **state)
{
    (void)state;
    studio one, two;
    props now = {.ball = {0, -1, -1.8}, .ball_radius = .04, .lamp = 10, .red = .7};
    const estimating by = {AG_CACHE_PRECOMPUTE, 1.0f, 0.0f, 10, 1000000};
    open_shot(&one, 2);
    open_shot(&two, 1);
    frame_bits first = render_frame(&one, &now, &by);
    ag_context_take_frame(two.context, one.context);
    frame_bits second = render_frame(&two, &now, &by), third = render_frame(&one, &now, &by);
    expect_same(&first, &second, true, 1);
    expect_same(&first, &third, true, 2);
    const ag_statistics s = ag_context_statistics(two.context);
    /* not kept are estimates of which two photons are equally far, and photons on a plane of the tree */
    assert_true(s.irradiance_kept > first.count - first.count / 100 && s.photons_came == s.photons_went);
    assert_int_equal(s.irradiance_kept + s.irradiance_computed, first.count);
    assert_int_equal(ag_context_statistics(one.context).irradiance_kept, 0);
    ag_context_take_frame(two.context, NULL);
    ag_context_take_frame(NULL, two.context);
    ag_context_take_frame(two.context, two.context);
    free_bits(&first);
    free_bits(&second);
    free_bits(&third);
    ag_context_destroy(one.context);
    ag_context_destroy(two.context);
}

/* What is known of the space around photons goes with the scene. */
static void test_spaces(void **state)
{
    (void)state;
    studio in;
    const props plain = {.ball = {0, -1, -1.8}, .ball_radius = .04, .lamp = 10, .red = .7, .is_plain = true};
    const estimating by = {AG_CACHE_ON_DEMAND, 1.0f, 0.0f, 10, 1000000};
    open_shot(&in, 1);
    frame_bits bits = render_frame(&in, &plain, &by);
    assert_non_null(in.context->last_frame);
    assert_null(in.context->last_frame->map.spaces);
    free_bits(&bits);
    ag_context_destroy(in.context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_slots),   cmocka_unit_test(test_on_demand),
                                       cmocka_unit_test(test_fraction),    cmocka_unit_test(test_full_map),
                                       cmocka_unit_test(test_taking_over), cmocka_unit_test(test_spaces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

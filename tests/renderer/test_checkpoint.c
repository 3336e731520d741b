/* test_checkpoint.c: a rendering that is paused anywhere, written down and taken up by another goes on to the bits of
 * one that was never cut; what is damaged, or of another render, is refused, and nothing is changed then.
 * Threads: the renderer's. */
#define _GNU_SOURCE
#include "checkpoint.h"
#include "estimate_fingerprint.h"
#include "fixtures/layers_fixture.h"

#include <pthread.h>
#include <zlib.h>

/* Asks for a pause again and again, at no moment that anybody could tell beforehand. */
typedef struct pauser {
    ag_context *context;
    unsigned first_microseconds; /* more with each part, so that slow machines come to an end */
    atomic_u32 has_ended;
} pauser;

static void *pause_at_times(void *user)
{
    pauser *p = user;
    for (unsigned microseconds = p->first_microseconds; !load_relaxed_u32(&p->has_ended); microseconds *= 2) {
        usleep(microseconds);
        ag_context_pause(p->context);
    }
    return NULL;
}

static void test_resumed_bits(void **state)
{
    (void)state;
    static const char *const filters[] = {"box", "mitchell"};
    for (int path = 0; path < 2; path++)
        for (int f = 0; f < 2; f++) {
            char text[512];
            snprintf(text, sizeof text, "PixelFilter \"%s\" Include \"%smirror_wall.pbrt\"", filters[f], LAYERS_SCENES);
            studio *whole = studio_open(text, 2);
            whole->settings.integrator = path ? AG_INTEGRATOR_PATH : AG_INTEGRATOR_PHOTONMAP;
            whole->settings.layers = layers_of("all") | AG_LAYER_GBUFFER;
            whole->settings.width = whole->settings.height = 34; /* some tiles */
            whole->settings.photon_count = whole->settings.caustic_photon_count = 2000;
            whole->settings.nearest = 30;
            ag_film *expected = studio_render(whole), *film;
            int wanted = whole->settings.samples_per_pixel;
            ag_status status = AG_PAUSED;
            for (int part = 0; part < wanted || status == AG_PAUSED; part++) {
                studio *s = studio_open(text, 1 + (unsigned)part % 3);
                s->settings = whole->settings;
                ag_rendering *r = studio_begin(s);
                if (part > 0 && ag_rendering_read_checkpoint(r, in_folder("c")) != AG_OK)
                    fail_msg("%s", s->said);
                ag_sample_counts counts = ag_rendering_sample_counts(r);
                pauser pausing = {.context = s->context, .first_microseconds = 500u << (part < 10 ? part : 10)};
                pthread_t thread;
                assert_int_equal(pthread_create(&thread, NULL, pause_at_times, &pausing), 0);
                status = ag_rendering_continue(r, part < wanted ? part + 1 : wanted);
                if (status == AG_PAUSED) /* it goes on in the same process */
                    status = ag_rendering_continue(r, part < wanted ? part + 1 : wanted);
                store_relaxed_u32(&pausing.has_ended, 1);
                assert_int_equal(pthread_join(thread, NULL), 0);
                assert_true(status == AG_OK || status == AG_PAUSED);
                assert_true(ag_rendering_sample_counts(r).mean >= counts.mean);
                assert_int_equal(ag_rendering_write_checkpoint(r, in_folder("c")), AG_OK);
                ag_rendering_finish(r, &film);
                if (status == AG_OK && part + 1 >= wanted)
                    expect_same_film(expected, film);
                ag_film_destroy(film);
                studio_close(s);
            }
            ag_film_destroy(expected);
            studio_close(whole);
        }
}

/* A pause that comes too early waits for the render, and is over then. */
static void test_pauses(void **state)
{
    (void)state;
    studio *s = studio_open(LAYERS_SCENES "mirror_wall.pbrt", 2);
    ag_context_pause(s->context);
    ag_rendering *r = studio_begin(s);
    assert_int_equal(ag_rendering_continue(r, 4), AG_PAUSED);
    assert_int_equal(ag_rendering_sample_counts(r).most, 0);
    assert_int_equal(ag_rendering_continue(r, 2), AG_OK);
    ag_sample_counts counts = ag_rendering_sample_counts(r);
    assert_true(counts.least == 2 && counts.most == 2 && counts.mean == 2.0);
    ag_context_pause(s->context);
    ag_context_cancel(s->context);
    assert_int_equal(ag_rendering_continue(r, 4), AG_CANCELLED);
    ag_rendering_finish(r, NULL);
    studio_close(s);
}

static void expect_refusal(studio *s, const char *why)
{
    ag_rendering *r = studio_begin(s);
    s->said[0] = '\0';
    assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_ERROR_INPUT);
    if (!strstr(s->said, why))
        fail_msg("'%s' is not in: %s", why, s->said);
    assert_int_equal(ag_rendering_sample_counts(r).most, 0);
    ag_rendering_finish(r, NULL);
}

static const char TEXT[] = "Include \"" LAYERS_SCENES "mirror_wall.pbrt\"";

static void write_checkpoint_of(studio *s)
{
    ag_rendering *r = studio_begin(s);
    assert_int_equal(ag_rendering_continue(r, 2), AG_OK);
    assert_int_equal(ag_rendering_write_checkpoint(r, in_folder("c")), AG_OK);
    ag_rendering_finish(r, NULL);
}

static void test_other_renders(void **state)
{
    (void)state;
    studio *s = studio_open(TEXT, 1);
    s->settings.gather_samples = 1;
    s->settings.photon_count = s->settings.caustic_photon_count = 500;
    const ag_render_settings ours = s->settings;
    write_checkpoint_of(s);
    s->settings.seed = 9;
    expect_refusal(s, "with another seed");
    s->settings = ours, s->settings.samples_per_pixel = 8;
    expect_refusal(s, "with another number of samples per pixel");
    s->settings = ours, s->settings.crop_window[1] = 0.5;
    expect_refusal(s, "with another crop window");
    s->settings = ours, s->settings.layers = AG_LAYER_ALPHA;
    expect_refusal(s, "with another set of layers");
    s->settings = ours, s->settings.integrator = AG_INTEGRATOR_PATH;
    expect_refusal(s, "with another integrator");
    studio_close(s);

    char text[1024];
    snprintf(text, sizeof text, "%s\nTranslate 0 0 9 Shape \"sphere\"", TEXT);
    s = studio_open(text, 1), s->settings = ours;
    expect_refusal(s, "with another scene");
    studio_close(s);
    snprintf(text, sizeof text, "Rotate 1 0 0 1 %s", TEXT);
    s = studio_open(text, 1), s->settings = ours;
    expect_refusal(s, "with another camera");
    studio_close(s);
    snprintf(text, sizeof text, "Include \"%smirror_wall.pbrt\" ", LAYERS_SCENES);
    s = studio_open(text, 1), s->settings = ours; /* another text of the same scene will do */
    ag_rendering *r = studio_begin(s);
    assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_OK);
    assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("none")), AG_ERROR_INPUT);
    ag_rendering_finish(r, NULL);
    studio_close(s);
}

static void overwrite(const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(in_folder("c"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* A header holds the fingerprint of the photon map's estimates and that of its photons, which other photons change and
 * computed irradiances do not; the path tracer's holds neither. */
static void test_header_has_estimates(void **state)
{
    (void)state;
    const hash128 none = {{0, 0}};
    for (int path = 0; path < 2; path++) {
        studio *s = studio_open(TEXT, 1);
        s->settings.integrator = path ? AG_INTEGRATOR_PATH : AG_INTEGRATOR_PHOTONMAP;
        s->settings.photon_count = s->settings.caustic_photon_count = 500;
        ag_rendering *r = studio_begin(s);
        checkpoint_header header;
        hash128 estimates;
        assert_int_equal(checkpoint_header_make(r, &header), AG_OK);
        assert_int_equal(estimate_fingerprint(&s->context->run, s->context->isa, photon_tracing_run,
                                              irradiance_estimate_find, &estimates),
                         AG_OK);
        assert_false(hash128_is_equal(estimates, none));
        assert_true(hash128_is_equal(header.estimates, path ? none : estimates));
        assert_true(hash128_is_equal(header.photons, none) == path);
        if (!path) {
            const hash128 photons = header.photons;
            assert_int_equal(ag_rendering_continue(r, 1), AG_OK);
            assert_int_equal(checkpoint_header_make(r, &header), AG_OK);
            assert_true(hash128_is_equal(header.photons, photons));
            r->maps->global.blocks[0].direction[3] ^= 1;
            r->maps->has_photons_hash = false;
            assert_int_equal(checkpoint_header_make(r, &header), AG_OK);
            assert_false(hash128_is_equal(header.photons, photons));
        }
        ag_rendering_finish(r, NULL);
        studio_close(s);
    }
}

static void flip_bit(unsigned char *bytes, size_t size, size_t at)
{
    bytes[at] ^= 1;
    uint32_t crc = (uint32_t)crc32_z(0, bytes, size - sizeof crc);
    memcpy(bytes + size - sizeof crc, &crc, sizeof crc);
    overwrite(bytes, size);
}

/* A build whose estimates or photons are others makes the same file but for their fingerprint and the checksum. */
static void test_other_builds(void **state)
{
    (void)state;
    const size_t differ[] = {offsetof(checkpoint_header, estimates), offsetof(checkpoint_header, photons)};
    studio *s = studio_open(TEXT, 1);
    s->settings.gather_samples = 1;
    s->settings.photon_count = s->settings.caustic_photon_count = 500;
    write_checkpoint_of(s);
    size_t size;
    unsigned char *bytes = read_bytes(in_folder("c"), &size);
    for (int i = 0; i < 2; i++) {
        flip_bit(bytes, size, differ[i]);
        expect_refusal(s, i == 0 ? "whose photon map has other light" : "with another photon map, of other photons");
        flip_bit(bytes, size, differ[i]);
    }
    ag_rendering *r = studio_begin(s);
    assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_OK);
    ag_rendering_finish(r, NULL);
    free(bytes);
    studio_close(s);
}

static void test_damage(void **state)
{
    (void)state;
    studio *s = studio_open(TEXT, 1);
    s->settings.integrator = AG_INTEGRATOR_PATH;
    s->settings.width = s->settings.height = 4;
    s->settings.layers = AG_LAYER_DEPTH;
    write_checkpoint_of(s);
    size_t size;
    unsigned char *bytes = read_bytes(in_folder("c"), &size);
    ag_rendering *r = studio_begin(s);
    for (size_t at = 0; at < size; at += at < 256 ? 1 : 7) { /* every byte counts */
        bytes[at] ^= 0x10;
        overwrite(bytes, size);
        bytes[at] ^= 0x10;
        s->said[0] = '\0';
        assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_ERROR_INPUT);
        assert_non_null(strstr(s->said, "cannot resume from"));
    }
    for (size_t length = 0; length < size; length += 1 + size / 200) {
        overwrite(bytes, length);
        assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_ERROR_INPUT);
    }
    assert_int_equal(ag_rendering_sample_counts(r).most, 0);
    overwrite(bytes, size);
    assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_OK);
    assert_int_equal(ag_rendering_sample_counts(r).least, 2);
    free(bytes);
    ag_rendering_finish(r, NULL);
    studio_close(s);
}

/* Each word of the settings makes a difference, but for the struct's size and the way files are stored. */
static void test_every_setting_counts(void **state)
{
    (void)state;
    studio *s = studio_open(TEXT, 1);
    ag_rendering *r = studio_begin(s);
    checkpoint_header before, after;
    assert_int_equal(checkpoint_header_make(r, &before), AG_OK);
    assert_null(checkpoint_header_difference(&before, &before));
    unsigned char *bytes = (unsigned char *)&r->settings;
    for (size_t at = sizeof r->settings.struct_size; at < sizeof r->settings; at += 4) {
        const size_t gap = offsetof(ag_render_settings, only) + sizeof r->settings.only;
        const bool is_map_name = at > offsetof(ag_render_settings, gather_samples); /* of the map's file */
        if (at == offsetof(ag_render_settings, float_samples) || at == gap || is_map_name)
            continue;
        bytes[at] ^= 1;
        assert_int_equal(checkpoint_header_make(r, &after), AG_OK);
        bytes[at] ^= 1;
        if (!checkpoint_header_difference(&before, &after) && at + 4 < sizeof r->settings)
            fail_msg("checkpoint.c does not know the setting at byte %zu", at);
    }
    ag_rendering_finish(r, NULL);
    studio_close(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_resumed_bits),
        TEST_IN_FOLDER(test_pauses),
        TEST_IN_FOLDER(test_other_renders),
        TEST_IN_FOLDER(test_every_setting_counts),
        TEST_IN_FOLDER(test_header_has_estimates),
        TEST_IN_FOLDER(test_other_builds),
        TEST_IN_FOLDER(test_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* layers_fixture.h: films rendered in this process, and their channels by name.
 * Flow: afterglow.h -> [here] -> tests of layers. Threads: one. */
#ifndef AFTERGLOW_TESTS_LAYERS_FIXTURE_H
#define AFTERGLOW_TESTS_LAYERS_FIXTURE_H

#include "afterglow/afterglow.h"
#include "temporary_folder.h"

#include <math.h>

#define LAYERS_SCENES AG_SOURCE_DIR "/tests/scenes/"

typedef struct studio {
    ag_context *context;
    ag_scene *scene;
    ag_render_settings settings;
    char said[4096]; /* warnings and errors, a line each */
} studio;

static inline void studio_hear(void *user, ag_log_level level, const char *text)
{
    studio *s = user;
    size_t length = strlen(s->said);
    if (level == AG_LOG_ERROR || level == AG_LOG_WARNING)
        snprintf(s->said + length, sizeof s->said - length, "%s\n", text);
}

/* A scene of that text or, where it begins with a slash, in that file; small and quick. */
static inline studio *studio_open(const char *what, unsigned threads)
{
    studio *s = calloc(1, sizeof *s);
    assert_non_null(s);
    ag_context_settings settings = ag_default_context_settings();
    settings.thread_count = threads;
    settings.log = studio_hear;
    settings.user = s;
    assert_int_equal(ag_context_create(&settings, &s->context), AG_OK);
    const char *path = what;
    if (what[0] != '/') {
        path = in_folder("scene.pbrt");
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        assert_true(fputs(what, file) >= 0);
        assert_int_equal(fclose(file), 0);
    }
    if (ag_scene_load(s->context, path, &s->scene) != AG_OK ||
        ag_render_settings_from_scene(s->context, s->scene, &s->settings) != AG_OK)
        fail_msg("%s", s->said);
    s->settings.width = s->settings.height = 16;
    s->settings.samples_per_pixel = 4;
    s->settings.photon_count = 2000;
    s->settings.caustic_photon_count = 2000;
    s->settings.gather_samples = 4;
    return s;
}

static inline void studio_close(studio *s)
{
    ag_scene_destroy(s->scene);
    ag_context_destroy(s->context);
    free(s);
}

/* A rendering that has no samples yet. */
static inline ag_rendering *studio_begin(studio *s)
{
    ag_rendering *rendering;
    if (ag_rendering_create(s->context, s->scene, &s->settings, &rendering) != AG_OK)
        fail_msg("%s", s->said);
    return rendering;
}

static inline ag_film *studio_render(studio *s)
{
    ag_film *film;
    if (ag_render(s->context, s->scene, &s->settings, &film) != AG_OK)
        fail_msg("%s", s->said);
    return film;
}

static inline int film_pixel_count(const ag_film *film)
{
    int width, height;
    ag_film_pixels(film, &width, &height);
    return width * height;
}

static inline bool film_has(const ag_film *film, const char *name)
{
    for (int i = 0; i < ag_film_channel_count(film); i++)
        if (strcmp(ag_film_channel_name(film, i), name) == 0)
            return true;
    return false;
}

/* The channel's values, to be freed. */
static inline float *film_channel_of(const ag_film *film, const char *name)
{
    for (int i = 0; i < ag_film_channel_count(film); i++)
        if (strcmp(ag_film_channel_name(film, i), name) == 0) {
            float *values = malloc((size_t)film_pixel_count(film) * sizeof *values);
            assert_non_null(values);
            assert_int_equal(ag_film_read_channel(film, i, values), AG_OK);
            return values;
        }
    fail_msg("there is no channel %s", name);
    return NULL;
}

static inline double film_mean(const ag_film *film, const char *name)
{
    float *values = film_channel_of(film, name);
    double sum = 0.0;
    for (int i = 0; i < film_pixel_count(film); i++)
        sum += (double)values[i];
    free(values);
    return sum / film_pixel_count(film);
}

/* Every channel of both, bit for bit. */
static inline void expect_same_film(const ag_film *a, const ag_film *b)
{
    assert_int_equal(ag_film_channel_count(a), ag_film_channel_count(b));
    for (int i = 0; i < ag_film_channel_count(a); i++) {
        const char *name = ag_film_channel_name(a, i);
        float *first = film_channel_of(a, name), *second = film_channel_of(b, name);
        if (memcmp(first, second, (size_t)film_pixel_count(a) * sizeof *first) != 0)
            fail_msg("channel %s differs", name);
        free(first);
        free(second);
    }
}

static inline void expect_within(const char *what, double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%s: %.9g is not %.9g within %g", what, value, expected, tolerance);
}

#endif

/* fuzz_render.c: whatever scene can be read can be rendered: both integrators, a handful of pixels, photons and rays,
 * and no pixel that is not a number. Flow: bytes -> a file -> [here] -> the public interface. Threads: one of the
 * program's. */
#include "afterglow/afterglow.h"
#include "fuzz_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void hear(void *user, ag_log_level level, const char *message)
{
    (void)user;
    if (getenv("FUZZ_VERBOSE"))
        fprintf(stderr, "%d %s\n", (int)level, message);
}

static void render(ag_context *context, const ag_scene *s, ag_integrator integrator)
{
    ag_render_settings settings;
    if (ag_render_settings_from_scene(context, s, &settings) != AG_OK)
        return;
    settings.integrator = integrator;
    settings.width = 3;
    settings.height = 2;
    settings.crop_window[0] = settings.crop_window[2] = 0.0;
    settings.crop_window[1] = settings.crop_window[3] = 1.0;
    settings.samples_per_pixel = 2;
    settings.photon_count = 60;
    settings.caustic_photon_count = 20;
    settings.nearest = 8;
    settings.gather_samples = 2;
    uint32_t all;
    FUZZ_CHECK(ag_layers_parse("all", &all) == AG_OK);
    settings.layers |= all;
    if (settings.max_depth > 8)
        settings.max_depth = 8;
    ag_film *film;
    ag_status status = ag_render(context, s, &settings, &film);
    if (status != AG_OK)
        return;
    int width, height;
    const float *pixels = ag_film_pixels(film, &width, &height);
    FUZZ_CHECK(width == 3 && height == 2);
    for (int i = 0; i < 3 * width * height; i++)
        FUZZ_CHECK(isfinite(pixels[i]));
    for (int c = 0; c < ag_film_channel_count(film); c++) {
        float values[6];
        FUZZ_CHECK(ag_film_read_channel(film, c, values) == AG_OK);
        for (int i = 0; i < 6; i++)
            FUZZ_CHECK(isfinite(values[i]));
    }
    ag_film_destroy(film);
    FUZZ_CHECK(ag_context_statistics(context).samples_not_finite == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_enter_folder_with_files();
    fuzz_write("t.pbrt", data, size);
    ag_context_settings settings = ag_default_context_settings();
    settings.thread_count = 1;
    settings.log = hear;
    ag_context *context;
    ag_scene *s;
    FUZZ_CHECK(ag_context_create(&settings, &context) == AG_OK);
    if (ag_scene_load(context, "t.pbrt", &s) == AG_OK) {
        render(context, s, AG_INTEGRATOR_PHOTONMAP);
        render(context, s, AG_INTEGRATOR_PATH);
        ag_scene_destroy(s);
    }
    ag_context_destroy(context);
    return 0;
}

/* render_scene.c: the library on one page: scene in, picture out, with messages, progress, and Ctrl-C.
 *
 *     cc -std=c17 render_scene.c -o render_scene $(pkg-config --cflags --libs afterglow)
 *     ./render_scene room.pbrt room.png [NAME=VALUE]
 *
 * It compiles as C17 and as C++17. */
#include <afterglow/afterglow.h>

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ag_context *context; /* for the signal handler */

static void on_interrupt(int number)
{
    (void)number;
    ag_context_cancel(context); /* what is under way soon returns AG_CANCELLED */
}

/* All that goes wrong is told here; calls return no more than a status. */
static void on_log(void *user, ag_log_level level, const char *message)
{
    (void)user;
    const char *kind = level == AG_LOG_ERROR ? "error: " : "warning: ";
    if (level <= AG_LOG_WARNING) /* messages about a location in a file have it already */
        fprintf(stderr, "\r%s%s\n", strstr(message, kind) ? "" : kind, message);
}

static void on_progress(void *user, ag_phase phase, double fraction)
{
    (void)user;
    fprintf(stderr, "\r%-10s %3.0f %%%s", ag_phase_name(phase), 100.0 * fraction, fraction == 1.0 ? "\n" : "");
}

/* Each call needs what the one before it made. */
static ag_status render(const char *scene_path, const char *picture_path, const ag_definition *definitions,
                        size_t definition_count)
{
    ag_scene *scene = NULL;
    ag_film *film = NULL;
    ag_render_settings settings;
    ag_output_settings output = ag_default_output_settings();
    output.exposure_stops = 0.5f;
    ag_status status = ag_output_check(context, &output, picture_path); /* before the work, not after it */
    if (status == AG_OK)
        status = ag_scene_load_with(context, scene_path, definitions, definition_count, &scene);
    if (status == AG_OK)
        status = ag_render_settings_from_scene(context, scene, &settings);
    if (status == AG_OK) {
        settings.samples_per_pixel = 4; /* what the scene says may be changed */
        settings.layers = AG_LAYER_DEPTH;
        status = ag_render(context, scene, &settings, &film);
    }
    if (status == AG_OK)
        status = ag_film_write(context, film, &output, picture_path);
    if (status == AG_OK) {
        int width, height; /* a film's pixels are also there to be used in memory */
        const float *rgb = ag_film_pixels(film, &width, &height);
        const float *middle = rgb + 3 * ((size_t)(height / 2) * (size_t)width + (size_t)(width / 2));
        printf("%s: %d x %d, %g %g %g in the middle, %llu irradiances\n", picture_path, width, height,
               (double)middle[0], (double)middle[1], (double)middle[2],
               (unsigned long long)ag_context_statistics(context).irradiance_computed);
    }
    ag_film_destroy(film);
    ag_scene_destroy(scene);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 3 && argc != 4) {
        fprintf(stderr, "usage: %s SCENE PICTURE [NAME=VALUE]\n", argv[0]);
        return EXIT_FAILURE;
    }
    char *equals = argc == 4 ? strchr(argv[3], '=') : NULL;
    if (equals)
        *equals = '\0';
    ag_definition definition = {argc == 4 ? argv[3] : "", equals ? equals + 1 : "", false};
    ag_context_settings settings = ag_default_context_settings();
    settings.log = on_log;
    settings.progress = on_progress;
    ag_status status = ag_context_create(&settings, &context);
    if (status == AG_OK) {
        signal(SIGINT, on_interrupt);
        status = render(argv[1], argv[2], &definition, argc == 4 ? 1 : 0);
        signal(SIGINT, SIG_DFL); /* before the context is gone */
    }
    ag_context_destroy(context);
    if (status != AG_OK)
        fprintf(stderr, "\r%-20s\n", ag_status_text(status));
    return status == AG_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* color_cost.c: the program afterglow-color-cost: what the colour transform of a picture of 1920 x 1080 costs beside
 * rendering it, for every display and view of the config. Both in one run, by elapsed time and by the CPU time of the
 * process, which other work on the machine disturbs less. Flow: a scene -> film -> output_color. Threads: the
 * context's. */
#include "clock.h"
#include "output/output_color.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 1920, HEIGHT = 1080, REPEATS = 5 };

typedef struct cost {
    double elapsed_s, cpu_s;
} cost;

static void tell(void *user, ag_log_level level, const char *text)
{
    (void)user;
    if (level <= AG_LOG_WARNING)
        fprintf(stderr, "afterglow-color-cost: %s\n", text);
}

static cost cost_now(void) { return (cost){clock_seconds(), clock_process_cpu_seconds()}; }

static cost cost_since(cost begin)
{
    cost now = cost_now();
    return (cost){now.elapsed_s - begin.elapsed_s, now.cpu_s - begin.cpu_s};
}

/* The least of some, of each apart. */
static ag_status measure_view(ag_context *context, const ag_output_settings *settings, const ag_film *film,
                              float *pixels, cost *out_least)
{
    const uint64_t count = (uint64_t)WIDTH * HEIGHT;
    ag_status status = AG_OK;
    for (int i = 0; i < REPEATS && status == AG_OK; i++) {
        memcpy(pixels, film->pixels, count * 3 * sizeof *pixels);
        cost begin = cost_now();
        status = output_color_apply(context, settings, false, pixels, count);
        cost c = cost_since(begin);
        if (i == 0 || c.elapsed_s < out_least->elapsed_s)
            out_least->elapsed_s = c.elapsed_s;
        if (i == 0 || c.cpu_s < out_least->cpu_s)
            out_least->cpu_s = c.cpu_s;
    }
    return status;
}

static void print_row(const char *what, const char *view, cost c, unsigned threads)
{
    printf("%-28s %-28s %8.3f s %8.3f s %8.1f %%\n", what, view, c.elapsed_s, c.cpu_s, 100.0 * c.cpu_s / threads);
}

/* Line by line through the summary: displays stand two deep, their views four. */
static ag_status measure_all(ag_context *context, const ag_film *film, float *pixels)
{
    const char *summary;
    char display[128] = "", view[128];
    ag_status status = ag_color_summary(context, &summary);
    if (status != AG_OK)
        return status;
    const char *line = strstr(summary, "displays and their views:\n");
    while (status == AG_OK && line && (line = strchr(line, '\n')) && strncmp(++line, "  ", 2) == 0) {
        bool is_view = strncmp(line, "    ", 4) == 0;
        char *name = is_view ? view : display;
        snprintf(name, sizeof view, "%.*s", (int)strcspn(line + (is_view ? 4 : 2), "\n"), line + (is_view ? 4 : 2));
        char *end = strstr(name, " (default)");
        end = end ? end : strstr(name, ", with the looks ");
        if (end)
            *end = '\0';
        if (!is_view)
            continue;
        cost c = {0};
        ag_output_settings settings = ag_default_output_settings();
        settings.display = display;
        settings.view = view;
        status = measure_view(context, &settings, film, pixels, &c);
        if (status == AG_OK)
            print_row(display, view, c, ag_context_thread_count(context));
    }
    return status;
}

static ag_status run(ag_context *context, const char *path, float *pixels)
{
    ag_scene *loaded = NULL;
    ag_film *film = NULL;
    ag_render_settings settings;
    cost begin;
    ag_status status = ag_scene_load(context, path, &loaded);
    if (status == AG_OK)
        status = ag_render_settings_from_scene(context, loaded, &settings);
    if (status == AG_OK) {
        settings.integrator = AG_INTEGRATOR_PATH;
        settings.width = WIDTH;
        settings.height = HEIGHT;
        settings.samples_per_pixel = 1;
        settings.max_depth = 1;
        begin = cost_now();
        status = ag_render(context, loaded, &settings, &film);
    }
    if (status == AG_OK) {
        printf("%-57s %10s %10s  of a second on %u threads\n", "", "elapsed", "CPU", ag_context_thread_count(context));
        print_row("render", "1 sample, direct light", cost_since(begin), ag_context_thread_count(context));
        status = measure_all(context, film, pixels);
    }
    ag_film_destroy(film);
    ag_scene_destroy(loaded);
    return status;
}

int main(int argc, char **argv)
{
    if (argc < 2 || argc > 3) {
        fprintf(stderr, "usage: afterglow-color-cost SCENE [THREADS]\nThe config is $OCIO's, else the one built in.\n");
        return 2;
    }
    ag_context_settings settings = ag_default_context_settings();
    settings.log = tell;
    settings.thread_count = argc == 3 ? (unsigned)strtoul(argv[2], NULL, 10) : 0;
    ag_context *context;
    ag_status status = ag_context_create(&settings, &context);
    float *pixels = malloc((size_t)WIDTH * HEIGHT * 3 * sizeof *pixels);
    if (status == AG_OK && pixels)
        status = run(context, argv[1], pixels);
    if (status == AG_OK && !pixels)
        status = AG_ERROR_MEMORY;
    free(pixels);
    if (status != AG_OK)
        fprintf(stderr, "afterglow-color-cost: error: %s\n", ag_status_text(status));
    else
        ag_context_destroy(context);
    return status == AG_OK ? 0 : 1;
}

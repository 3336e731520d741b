/* page_state.c: see page_state.h. */
#define _POSIX_C_SOURCE 200809L
#include "page_state.h"

#include "json_text.h"
#include "passes.h"
#include "thread_times.h"

#include <inttypes.h>
#include <stdlib.h>
#include <strings.h>

bool page_state_init(page_state *s, const progress *told)
{
    *s = (page_state){.told = told, .notes.noise = -1.0, .main_thread = thread_times_self()};
    return pthread_mutex_init(&s->lock, NULL) == 0;
}

void page_state_reset(page_state *s) { pthread_mutex_destroy(&s->lock); }

void page_state_note(page_state *s, const page_notes *notes)
{
    pthread_mutex_lock(&s->lock);
    s->notes = *notes;
    pthread_mutex_unlock(&s->lock);
}

bool page_state_has_place(page_state *s)
{
    pthread_mutex_lock(&s->lock);
    const bool has_place = s->notes.has_place;
    pthread_mutex_unlock(&s->lock);
    return has_place;
}

void page_state_set_mode(page_state *s, page_mode mode)
{
    pthread_mutex_lock(&s->lock);
    s->notes.mode = mode;
    pthread_mutex_unlock(&s->lock);
}

/* --- JSON --- */

static void write_progress(FILE *out, const progress_state *p)
{
    if (p->phase != AG_PHASE_COUNT)
        fprintf(out, ", \"phase\": \"%s\", \"fraction\": %.4f, \"percent\": %d", ag_phase_name(p->phase), p->fraction,
                p->percent);
    fprintf(out, ", \"seconds\": %.1f", p->seconds);
    if (p->seconds_left >= 0.0)
        fprintf(out, ", \"seconds_left\": %.1f", p->seconds_left);
    if (p->frame_count > 0)
        fprintf(out, ", \"frame\": %d, \"frame_index\": %d, \"frame_count\": %d", p->frame_number, p->frame + 1,
                p->frame_count);
}

static void write_triple(FILE *out, const char *name, const float values[3])
{
    fprintf(out, "\"%s\": [%.9g, %.9g, %.9g]", name, (double)values[0], (double)values[1], (double)values[2]);
}

static void write_camera(FILE *out, const page_notes *n)
{
    if (!n->has_place)
        return;
    fputs(", \"camera\": {", out);
    write_triple(out, "from", n->place.from);
    fputs(", ", out);
    write_triple(out, "to", n->place.to);
    fputs(", ", out);
    write_triple(out, "up", n->place.up);
    fputs(", ", out);
    write_triple(out, "right", n->right);
    fprintf(out, ", \"fov\": %.9g}", (double)n->fov_degrees);
}

/* growth: what there is by now, where that can be asked. */
static void write_counts(FILE *out, const ag_statistics *c, const ag_growth *growth)
{
    const struct {
        const char *name;
        uint64_t value;
    } counts[] = {
        {"photons in the map", c->photons_stored_global},
        {"caustic photons", c->photons_stored_caustic},
        {"bytes of photons", c->photon_bytes},
        {"irradiance asked for", growth ? growth->irradiance_requests : c->irradiance_requests},
        {"irradiance computed", growth ? growth->irradiance_computed : c->irradiance_computed},
        {"ready before", c->irradiance_ready},
        {"deferred", c->irradiance_deferred},
        {"waited", c->irradiance_waited},
        {"duplicated", c->irradiance_duplicated},
        {"estimates at hits", c->irradiance_uncached},
        {"refused", c->irradiance_refused},
        {"camera rays", c->rays_camera},
        {"shadow rays", c->rays_shadow},
        {"gather rays", c->rays_gather},
        {"path rays", c->rays_path},
        {"photon rays", c->rays_photon},
    };
    fputs(", \"counts\": {", out);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        fprintf(out, "%s\"%s\": %" PRIu64, i > 0 ? ", " : "", counts[i].name, counts[i].value);
    if (growth)
        fprintf(out, ", \"of so many photons\": %" PRIu64 ", \"photons per area\": %.6g", growth->irradiance_photons,
                growth->photon_density);
    fputs("}", out);
}

static void write_threads(FILE *out, int main_thread)
{
    thread_time times[THREAD_TIMES_MOST];
    const int count = thread_times_read(main_thread, times);
    fputs(", \"threads\": [", out);
    for (int i = 0; i < count; i++)
        fprintf(out, "%s[%d, %.2f]", i > 0 ? ", " : "", times[i].number, times[i].cpu_seconds);
    fprintf(out, "], \"clock\": %.3f", passes_seconds());
}

static char *finish(FILE *out, char **text, bool is_whole)
{
    if (fclose(out) == 0 && is_whole)
        return *text;
    free(*text);
    return NULL;
}

char *page_state_write(page_state *s, page_film *film, size_t *out_size)
{
    static const char *const modes[] = {"waiting", "rendering", "walking", "finished"};
    char *text = NULL;
    uint64_t turn = 0, version = 0;
    int width = 0, height = 0;
    ag_growth growth;
    bool has_growth = false;
    FILE *out = open_memstream(&text, out_size);
    if (!out)
        return NULL;
    pthread_mutex_lock(&s->lock);
    const page_notes n = s->notes;
    pthread_mutex_unlock(&s->lock);
    const progress_state p = progress_read(s->told);
    if (page_film_begin(film)) {
        (void)page_film_values(film, page_film_find(film, ""), &version);
        turn = film->turn;
        width = film->width;
        height = film->height;
        has_growth = film->rendering != NULL;
        if (has_growth)
            growth = ag_rendering_growth(film->rendering);
        page_film_end(film);
    }
    fprintf(out, "{\"mode\": \"%s\", \"turn\": %" PRIu64 ", \"version\": %" PRIu64 ", \"width\": %d, \"height\": %d",
            modes[n.mode], turn, version, width, height);
    write_progress(out, &p);
    fprintf(out, ", \"samples\": {\"least\": %d, \"most\": %d, \"mean\": %.6g, \"final\": %d}", n.samples.least,
            n.samples.most, n.samples.mean, n.samples_most);
    if (n.noise >= 0.0)
        fprintf(out, ", \"noise\": %.3g", n.noise);
    write_camera(out, &n);
    write_counts(out, &n.counts, has_growth ? &growth : NULL);
    write_threads(out, s->main_thread);
    fputs("}\n", out);
    return finish(out, &text, ferror(out) == 0);
}

static void write_layers(FILE *out, const page_film *film)
{
    static const char *const kinds[] = {"picture", "color", "vector", "number", "matte"};
    fputs("\"layers\": [", out);
    for (size_t i = 0; i < film->layer_count; i++) {
        fputs(i > 0 ? ", {\"name\": " : "{\"name\": ", out);
        json_text_put(out, film->layers[i].name);
        fprintf(out, ", \"kind\": \"%s\"}", kinds[film->layers[i].kind]);
    }
    fputs("]", out);
}

/* The pair that the command line has chosen, of those that the config has. */
static bool is_chosen(const ag_output_settings *output, size_t index, const char *display, const char *view,
                      const char *first_display)
{
    if (!output->display && !output->view)
        return index == 0;
    const char *wanted = output->display ? output->display : first_display;
    return strcasecmp(display, wanted) == 0 && (!output->view || strcasecmp(view, output->view) == 0);
}

static void write_views(FILE *out, const page_film *film)
{
    const char *display, *view, *first = NULL;
    bool has_chosen = false;
    fputs(", \"views\": [", out);
    for (size_t i = 0; ag_color_view_at(film->context, i, &display, &view) == AG_OK; i++) {
        first = first ? first : display;
        const bool is_now = !has_chosen && is_chosen(&film->output, i, display, view, first);
        has_chosen = has_chosen || is_now;
        fputs(i > 0 ? ", {\"display\": " : "{\"display\": ", out);
        json_text_put(out, display);
        fputs(", \"view\": ", out);
        json_text_put(out, view);
        fprintf(out, ", \"chosen\": %s}", is_now ? "true" : "false");
    }
    fprintf(out, "], \"exposure\": %.9g", (double)film->output.exposure_stops);
}

char *page_state_write_choices(page_film *film, size_t *out_size)
{
    char *text = NULL;
    if (!page_film_begin(film))
        return NULL;
    FILE *out = open_memstream(&text, out_size);
    if (out) {
        fputs("{", out);
        write_layers(out, film);
        write_views(out, film);
        fprintf(out, ", \"turn\": %" PRIu64 ", \"program\": \"afterglow %s\"}\n", film->turn, ag_version());
    }
    page_film_end(film);
    return out ? finish(out, &text, ferror(out) == 0) : NULL;
}

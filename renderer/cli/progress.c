/* progress.c: see progress.h. */
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include "json_text.h"
#include "passes.h"
#include "signals.h"
#include "status.h"
#include "terminal_picture.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { LINE_STEP = 5 };     /* percent, between two lines of a log */
enum { LINE_SECONDS = 10 }; /* between two such lines while a scene reads large files */

static pthread_mutex_t terminal = PTHREAD_MUTEX_INITIALIZER; /* one line at a time, from the log or from here */

static terminal_abilities abilities_of(picture_form form)
{
    enum { USUAL_WIDTH = 10, USUAL_HEIGHT = 20 }; /* of a VT340's characters */
    terminal_abilities told = {0};
    if (form == PICTURE_FORM_SIXELS)
        return (terminal_abilities){true, USUAL_WIDTH, USUAL_HEIGHT, TERMINAL_MOST_COLORS};
    if (form == PICTURE_FORM_AUTO)
        (void)terminal_query(STDERR_FILENO, &told); /* what it has learned of the terminal stays in `told` */
    return told;
}

void progress_init(progress *p, const options *o)
{
    *p = (progress){.style = o->progress,
                    .verbosity = o->verbosity,
                    .told_percent = -1,
                    .phase = AG_PHASE_COUNT,
                    .seconds_left = -1.0};
    const char *obstacle = p->style == PROGRESS_PICTURE ? terminal_picture_obstacle(STDERR_FILENO) : NULL;
    if (obstacle) {
        if (o->verbosity >= 0)
            fprintf(stderr, "afterglow: warning: --progress picture: %s: the picture is not shown\n", obstacle);
        p->style = PROGRESS_AUTO;
    }
    if (p->style == PROGRESS_PICTURE) {
        p->abilities = abilities_of(o->picture_form);
        signals_reset_terminal(p->abilities.has_sixels);
    }
    if (p->style == PROGRESS_AUTO)
        p->style = o->verbosity < 0 ? PROGRESS_NONE : isatty(STDERR_FILENO) ? PROGRESS_BAR : PROGRESS_PLAIN;
    p->has_precompute = o->render.cache == AG_CACHE_PRECOMPUTE;
    p->has_photons = ag_integrator_has_photons(o->render.integrator);
    p->begun = p->frame_begun = p->line_seconds = passes_seconds();
}

/* How much of the work of one picture each phase usually is. */
static void usual_shares(const progress *p, double out_shares[AG_PHASE_COUNT])
{
    for (int i = 0; i < AG_PHASE_COUNT; i++)
        out_shares[i] = 0.0;
    out_shares[AG_PHASE_LOAD] = out_shares[AG_PHASE_BVH] = out_shares[AG_PHASE_WRITE] = 2.0;
    out_shares[AG_PHASE_RENDER] = 94.0;
    if (p->has_photons) {
        out_shares[AG_PHASE_PHOTONS] = 10.0;
        out_shares[AG_PHASE_MAP] = 3.0;
        out_shares[AG_PHASE_PRECOMPUTE] = p->has_precompute ? 25.0 : 0.0;
        out_shares[AG_PHASE_RENDER] = 81.0 - out_shares[AG_PHASE_PRECOMPUTE];
    }
}

void progress_begin_frame(progress *p, int frame, int frame_count, int frame_number)
{
    pthread_mutex_lock(&terminal);                        /* progress_read may be asked from elsewhere */
    if (frame > p->frame && p->phase != AG_PHASE_COUNT) { /* a picture is over that was not skipped */
        for (int i = 0; i < AG_PHASE_COUNT; i++)
            p->learned_seconds[i] += p->phase_seconds[i];
        p->learned_count++;
    }
    for (int i = 0; i < AG_PHASE_COUNT; i++)
        p->phase_seconds[i] = 0.0;
    p->frame = frame;
    p->frame_count = frame_count;
    p->frame_number = frame_number;
    p->frame_begun = passes_seconds();
    p->phase = AG_PHASE_COUNT;
    pthread_mutex_unlock(&terminal);
}

static void enter_phase(progress *p, ag_phase phase, double fraction, double now)
{
    if (p->phase == phase)
        return;
    if (p->phase != AG_PHASE_COUNT)
        p->phase_seconds[p->phase] += now - p->phase_begun;
    p->phase = phase;
    p->phase_begun = now;
    p->phase_begun_at = fraction;
}

/* Returns the seconds until all pictures are written; -1: not known yet. A phase under way is taken to go on at its own
 * pace. One yet to come takes as long as in the pictures before, or in the first picture its usual share of the time
 * that is known, without the time to read the scene. */
static double seconds_left(const progress *p, double fraction, double now)
{
    const double least_seconds = 0.5, least_fraction = 0.02; /* to be known by */
    double shares[AG_PHASE_COUNT], known_seconds = 0.0, known_shares = 0.0;
    const double done = fraction - p->phase_begun_at, took = now - p->phase_begun;
    const bool has_pace = done >= least_fraction && took >= least_seconds;
    double left = has_pace ? took * (1.0 - fraction) / done : 0.0, of_one = 0.0;
    usual_shares(p, shares);
    /* the time to read a scene, with its large pictures or little text, tells nothing of what follows */
    for (int i = AG_PHASE_LOAD + 1; i < (int)p->phase; i++) {
        known_seconds += p->phase_seconds[i];
        known_shares += shares[i];
    }
    if (has_pace && p->phase != AG_PHASE_LOAD) {
        known_seconds += took + left;
        known_shares += shares[p->phase];
    }
    const bool is_learned = p->learned_count > 0;
    if (!is_learned && !(known_shares > 0.0 && known_seconds >= least_seconds))
        return -1.0;
    for (int i = (int)p->phase; i < AG_PHASE_COUNT; i++) {
        const double whole =
            is_learned ? p->learned_seconds[i] / p->learned_count : shares[i] * known_seconds / known_shares;
        if (i > (int)p->phase)
            left += whole;
        else if (!has_pace) /* a phase that has shown no pace yet takes at least as long again */
            left += fmax(whole * (1.0 - fraction), took * (1.0 - fraction) / fmax(done, least_fraction));
    }
    for (int i = 0; i < AG_PHASE_COUNT && is_learned; i++)
        of_one += p->learned_seconds[i] / p->learned_count;
    if (!is_learned)
        of_one = now - p->frame_begun + left;
    return left + of_one * (p->frame_count > 0 ? p->frame_count - p->frame - 1 : 0);
}

/* Returns how far the whole work is in percent: by time where that is known, else by usual shares. 100 only
 * at the end. */
static int overall_percent(const progress *p, double fraction, double left, double now)
{
    const bool is_last = p->frame_count == 0 || p->frame + 1 == p->frame_count;
    double shares[AG_PHASE_COUNT], done = 0.0;
    if (is_last && p->phase == AG_PHASE_WRITE && fraction >= 1.0)
        return 100;
    if (left >= 0.0) {
        done = 100.0 * (now - p->begun) / fmax(now - p->begun + left, 1e-9);
    } else {
        usual_shares(p, shares);
        for (int i = 0; i < (int)p->phase; i++)
            done += shares[i];
        done += shares[p->phase] * fraction;
        if (p->frame_count > 0)
            done = (100.0 * p->frame + done) / p->frame_count;
    }
    return done < 99.0 ? (int)done : 99;
}

/* Writes a time as "1:23", or with hours. */
static const char *time_text(double seconds, char *out, size_t size)
{
    const long whole = (long)(seconds + 0.5);
    if (whole >= 3600)
        snprintf(out, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    else
        snprintf(out, size, "%ld:%02ld", whole / 60, whole % 60);
    return out;
}

/* Writes ", 1:23 left", or nothing where that is not known. */
static const char *left_text(double seconds, char *out, size_t size)
{
    char time[32];
    out[0] = '\0';
    if (seconds >= 0.5)
        snprintf(out, size, ", %s left", time_text(seconds, time, sizeof time));
    return out;
}

/* From here to end_writing this thread alone writes, and Ctrl-Z waits. */
static void begin_writing(progress *p)
{
    pthread_mutex_lock(&terminal);
    signals_begin_drawing();
    if (signals_take_stopped()) { /* the process was stopped, and a shell has written below what is drawn */
        film_watch_leave(&p->watch);
        p->bar_is_shown = false;
    }
}

static void end_writing(void)
{
    signals_end_drawing();
    pthread_mutex_unlock(&terminal);
}

static void clear_bar(progress *p)
{
    if (p->bar_is_shown)
        fputs("\r\033[K", stderr);
    p->bar_is_shown = false;
}

/* Removes all that will be drawn anew, so that messages stand above it. */
static void clear_all(progress *p)
{
    if (p->watch.drawn_rows > 0)
        p->bar_is_shown = false; /* with it */
    film_watch_erase(&p->watch, stderr);
    clear_bar(p);
}

static void tell_frame_as_json(const progress *p)
{
    if (p->frame_count > 0)
        fprintf(stderr, ", \"frame\": %d, \"frame_index\": %d, \"frame_count\": %d", p->frame_number, p->frame + 1,
                p->frame_count);
}

/* Writes the phase's name and, while a scene is read, how much of it has been read: the percentage of the whole work
 * hardly moves then, however long it takes. Returns out. */
static const char *phase_text(const progress *p, double fraction, char *out, size_t size)
{
    if (p->phase == AG_PHASE_LOAD && fraction >= 0.01)
        snprintf(out, size, "load %d%%", (int)(100.0 * fraction));
    else
        snprintf(out, size, "%s", ag_phase_name(p->phase));
    return out;
}

static void tell_bar(progress *p, const char *frame, double fraction, double left)
{
    enum { WIDTH = 40 };
    terminal_size size;
    char bar[WIDTH + 1], left_for[48], phase[16], line[256];
    const int filled = p->told_percent * WIDTH / 100;
    memset(bar, '.', WIDTH);
    memset(bar, '#', (size_t)(filled < WIDTH ? filled : WIDTH));
    bar[WIDTH] = '\0';
    snprintf(line, sizeof line, "%s%-10s [%s] %3d%%%s", frame, phase_text(p, fraction, phase, sizeof phase), bar,
             p->told_percent, left_text(left, left_for, sizeof left_for));
    /* a line that wraps cannot be cleared, nor the picture above it */
    const bool is_narrow = p->style == PROGRESS_PICTURE && terminal_picture_room(STDERR_FILENO, &size);
    fprintf(stderr, "\r\033[K%.*s", is_narrow ? size.columns - 1 : (int)sizeof line, line);
    fflush(stderr);
    p->bar_is_shown = true;
}

void progress_tell(void *user, ag_phase phase, double fraction)
{
    progress *p = user;
    begin_writing(p);
    const double now = passes_seconds();
    enter_phase(p, phase, fraction, now);
    const double left = seconds_left(p, fraction, now);
    const int percent = overall_percent(p, fraction, left, now);
    p->fraction = fraction;
    p->seconds_left = left;
    p->percent = percent;
    char left_for[48], phase_for[16], frame[48] = "";
    const bool is_new = percent > p->told_percent, is_new_line = percent / LINE_STEP > p->told_percent / LINE_STEP;
    if (p->frame_count > 0)
        snprintf(frame, sizeof frame, "frame %d of %d, ", p->frame + 1, p->frame_count);
    if (is_new && (p->style != PROGRESS_PLAIN || is_new_line || p->told_percent < 0))
        p->told_percent = percent;
    const bool is_long_load = phase == AG_PHASE_LOAD && now - p->line_seconds >= LINE_SECONDS;
    switch (p->style) {
    case PROGRESS_PICTURE:
        film_watch_draw(&p->watch, stderr, now, false);
        tell_bar(p, frame, fraction, left);
        break;
    case PROGRESS_BAR: tell_bar(p, frame, fraction, left); break;
    case PROGRESS_PLAIN:
        if (!is_long_load && (!is_new || p->told_percent != percent))
            break;
        p->line_seconds = now;
        fprintf(stderr, "Progress: %d%% (%s%s%s)\n", percent, frame,
                phase_text(p, fraction, phase_for, sizeof phase_for), left_text(left, left_for, sizeof left_for));
        break;
    case PROGRESS_ALF: /* the form that render queues read from standard output */
        if (is_new) {
            printf("ALF_PROGRESS %d%%\n", percent);
            fflush(stdout);
        }
        break;
    case PROGRESS_JSON:
        fprintf(stderr, "{\"phase\": \"%s\", \"fraction\": %.4f, \"percent\": %d, \"seconds\": %.1f",
                ag_phase_name(phase), fraction, p->told_percent, now - p->begun);
        tell_frame_as_json(p);
        if (left >= 0.0)
            fprintf(stderr, ", \"seconds_left\": %.1f", left);
        fprintf(stderr, "}\n");
        break;
    case PROGRESS_AUTO:
    case PROGRESS_NONE: break;
    }
    end_writing();
}

progress_state progress_read(const progress *p)
{
    pthread_mutex_lock(&terminal);
    const double now = passes_seconds();
    const progress_state state = {.phase = p->phase,
                                  .fraction = p->fraction,
                                  .percent = p->percent,
                                  .seconds = now - p->begun,
                                  .seconds_left = p->seconds_left,
                                  .frame = p->frame,
                                  .frame_count = p->frame_count,
                                  .frame_number = p->frame_number};
    pthread_mutex_unlock(&terminal);
    return state;
}

void progress_log(void *user, ag_log_level level, const char *message)
{
    progress *p = user;
    if (level > AG_LOG_ERROR && (int)level > p->verbosity + 1)
        return;
    static const char *const prefixes[] = {"error: ", "warning: ", "", ""};
    static const char *const located[] = {": error: ", ": warning: "};
    /* messages about a location in a file begin with it and with their level */
    bool has_location = level <= AG_LOG_WARNING && strstr(message, located[level]) != NULL;
    begin_writing(p);
    clear_all(p);
    fprintf(stderr, "%s%s%s\n", has_location ? "" : "afterglow: ", has_location ? "" : prefixes[level], message);
    end_writing();
}

void progress_tell_written(progress *p, const char *const *files, const bool *is_written, int file_count)
{
    const char *separator = "";
    int written_count = 0;
    const bool is_json = p->style == PROGRESS_JSON;
    const double now = passes_seconds();
    char time[32];
    const bool is_for_people = p->style == PROGRESS_BAR || p->style == PROGRESS_PICTURE || p->style == PROGRESS_PLAIN;
    for (int i = 0; i < file_count; i++)
        written_count += is_written[i];
    if (written_count == 0 || (!is_json && !is_for_people))
        return;
    begin_writing(p);
    clear_bar(p);
    fprintf(stderr, "%s", is_json ? "{\"written\": [" : "afterglow: wrote ");
    for (int i = 0; i < file_count; i++) {
        if (!is_written[i])
            continue;
        fputs(separator, stderr);
        separator = ", ";
        if (is_json)
            json_text_put(stderr, files[i]);
        else
            fputs(files[i], stderr);
    }
    if (is_json) {
        fprintf(stderr, "], \"percent\": %d, \"picture_seconds\": %.3f, \"seconds\": %.3f", p->told_percent,
                now - p->frame_begun, now - p->begun);
        tell_frame_as_json(p);
        fputs("}\n", stderr);
    } else {
        fprintf(stderr, " in %s", time_text(now - p->frame_begun, time, sizeof time));
        if (p->frame_count > 0)
            fprintf(stderr, " (frame %d of %d)", p->frame + 1, p->frame_count);
        fputc('\n', stderr);
    }
    end_writing();
}

ag_status progress_prepare_film(progress *p, ag_context *context, const ag_output_settings *output)
{
    ag_view *view;
    if (p->style != PROGRESS_PICTURE)
        return AG_OK;
    AG_TRY(ag_view_create(context, output, &view)); /* it may log a message, which takes the lock */
    pthread_mutex_lock(&terminal);
    film_watch_begin(&p->watch, view, &p->abilities);
    pthread_mutex_unlock(&terminal);
    return AG_OK;
}

ag_status progress_show_film(progress *p, const ag_film *film)
{
    pthread_mutex_lock(&terminal);
    const ag_status status = film_watch_show(&p->watch, film);
    pthread_mutex_unlock(&terminal);
    return status;
}

void progress_leave_film(progress *p, bool is_drawn)
{
    begin_writing(p);
    if (p->watch.film)
        clear_bar(p);
    if (is_drawn)
        film_watch_draw(&p->watch, stderr, passes_seconds(), true);
    film_watch_end(&p->watch);
    end_writing();
}

void progress_finish(progress *p)
{
    begin_writing(p);
    clear_bar(p);
    terminal_query_forget();
    end_writing();
}

/* bench_page.c: see bench_page.h. */
#define _POSIX_C_SOURCE 200809L
#include "bench/bench_page.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char HEAD[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>afterglow-bench</title>\n<style>\n"
    "body{font:15px/1.45 system-ui,sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\n"
    "table{border-collapse:collapse;margin:.7em 0}td,th{padding:.15em .7em;border-bottom:1px solid #ddd;"
    "text-align:right}\ntd:first-child,th:first-child{text-align:left}code{font-size:.9em}\n"
    ".bad{color:#a00}.good{color:#070}svg{max-width:100%;height:auto}svg text{font:12px system-ui,sans-serif}\n"
    "</style></head><body>\n";

static const char *const COLORS[] = {"#1b6ca8", "#c0562b", "#3a8f4d", "#7b4fa3"};

/* --- values --- */

static const char *text_at(const json_t *object, const char *name)
{
    const char *text = json_string_value(json_object_get(object, name));
    return text ? text : "not told";
}

static double number_at(const json_t *object, const char *name)
{
    return json_number_value(json_object_get(object, name));
}

static double median_at(const json_t *object, const char *name)
{
    return number_at(json_object_get(object, name), "median");
}

static void put_text(FILE *page, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '<': fputs("&lt;", page); break;
        case '>': fputs("&gt;", page); break;
        case '&': fputs("&amp;", page); break;
        case '"': fputs("&quot;", page); break;
        default: fputc(*text, page);
        }
    }
}

static void put_row(FILE *page, const char *name, const char *value)
{
    fputs("<tr><td>", page);
    put_text(page, name);
    fputs("</td><td>", page);
    put_text(page, value);
    fputs("</td></tr>\n", page);
}

static void put_list(FILE *page, const json_t *reasons)
{
    size_t i;
    json_t *reason;
    fputs("<ul class=\"bad\">", page);
    json_array_foreach(reasons, i, reason)
    {
        fputs("<li>", page);
        put_text(page, json_string_value(reason) ? json_string_value(reason) : "");
        fputs("</li>", page);
    }
    fputs("</ul>\n", page);
}

static const json_t *find_part(const json_t *result, const char *scene, const char *phase, int threads)
{
    size_t i;
    json_t *part;
    json_array_foreach(json_object_get(result, "parts"), i, part)
    {
        if (strcmp(text_at(part, "scene"), scene) == 0 && strcmp(text_at(part, "phase"), phase) == 0 &&
            (int)number_at(part, "threads") == threads)
            return part;
    }
    return NULL;
}

/* --- a plot of speed-ups: threads across, both axes logarithmic --- */

enum { PLOT_WIDTH = 640, PLOT_HEIGHT = 400, PLOT_LEFT = 55, PLOT_RIGHT = 150, PLOT_TOP = 15, PLOT_BOTTOM = 45 };

typedef struct plot {
    FILE *page;
    double most; /* threads, and speed-up */
    int key;     /* lines of the key so far */
} plot;

static double plot_x(const plot *p, double threads)
{
    return PLOT_LEFT + (PLOT_WIDTH - PLOT_LEFT - PLOT_RIGHT) * log2(threads) / log2(p->most);
}

static double plot_y(const plot *p, double speedup)
{
    double at = log2(speedup < 0.5 ? 0.5 : speedup) / log2(p->most);
    return PLOT_HEIGHT - PLOT_BOTTOM - (PLOT_HEIGHT - PLOT_TOP - PLOT_BOTTOM) * at;
}

static void put_key(plot *p, const char *name, const char *style)
{
    int y = PLOT_TOP + 15 + 20 * p->key++;
    fprintf(p->page, "<line x1=\"%d\" y1=\"%d\" x2=\"%d\" y2=\"%d\" %s/><text x=\"%d\" y=\"%d\">%s</text>\n",
            PLOT_WIDTH - PLOT_RIGHT + 12, y, PLOT_WIDTH - PLOT_RIGHT + 36, y, style, PLOT_WIDTH - PLOT_RIGHT + 42,
            y + 4, name);
}

static void put_axes(plot *p)
{
    fprintf(p->page,
            "<svg viewBox=\"0 0 %d %d\" width=\"%d\" role=\"img\" aria-label=\"speed-up by threads\">\n"
            "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#999\"/>\n",
            PLOT_WIDTH, PLOT_HEIGHT, PLOT_WIDTH, PLOT_LEFT, PLOT_TOP, PLOT_WIDTH - PLOT_LEFT - PLOT_RIGHT,
            PLOT_HEIGHT - PLOT_TOP - PLOT_BOTTOM);
    for (double n = 1.0; n <= p->most * 1.001; n *= 2.0)
        fprintf(p->page,
                "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\" stroke=\"#eee\"/><line x1=\"%d\" y1=\"%.1f\" "
                "x2=\"%d\" y2=\"%.1f\" stroke=\"#eee\"/>\n<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>"
                "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n",
                plot_x(p, n), PLOT_TOP, plot_x(p, n), PLOT_HEIGHT - PLOT_BOTTOM, PLOT_LEFT, plot_y(p, n),
                PLOT_WIDTH - PLOT_RIGHT, plot_y(p, n), plot_x(p, n), PLOT_HEIGHT - PLOT_BOTTOM + 18, n, PLOT_LEFT - 6,
                plot_y(p, n) + 4.0, n);
    fprintf(p->page, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">threads</text>\n",
            (PLOT_LEFT + PLOT_WIDTH - PLOT_RIGHT) / 2, PLOT_HEIGHT - 8);
}

/* field: of each level, held against the first one's. */
static void put_stream(plot *p, const json_t *levels, const char *field, const char *name, const char *style)
{
    size_t i;
    json_t *level;
    double first = median_at(json_array_get(levels, 0), field);
    fprintf(p->page, "<polyline fill=\"none\" %s points=\"", style);
    json_array_foreach(levels, i, level) fprintf(p->page, "%.1f,%.1f ", plot_x(p, number_at(level, "threads")),
                                                 plot_y(p, median_at(level, field) / first));
    fputs("\"/>\n", p->page);
    put_key(p, name, style);
}

static void put_frames(plot *p, const json_t *result, const char *scene, const char *color)
{
    size_t i;
    json_t *level;
    char style[64];
    snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"2\"", color);
    fprintf(p->page, "<polyline fill=\"none\" %s points=\"", style);
    json_array_foreach(json_object_get(result, "levels"), i, level)
    {
        const json_t *part = find_part(result, scene, "frame", (int)number_at(level, "threads"));
        if (part)
            fprintf(p->page, "%.1f,%.1f ", plot_x(p, number_at(level, "threads")),
                    plot_y(p, number_at(part, "speedup")));
    }
    fputs("\"/>\n", p->page);
    put_key(p, scene, style);
}

static void put_plot(FILE *page, const json_t *result)
{
    static const char *const scenes[] = {"room", "interior", "glass"};
    const json_t *levels = json_object_get(result, "levels");
    plot p = {.page = page, .most = number_at(json_array_get(levels, json_array_size(levels) - 1), "threads")};
    if (p.most < 2.0)
        return;
    fputs("<h2>Speed-up</h2>\n<p>Whole frames, and what pure arithmetic and streams through memory get on as many "
          "threads in the same run.</p>\n",
          page);
    put_axes(&p);
    for (int i = 0; i < 3; i++)
        put_frames(&p, result, scenes[i], COLORS[i]);
    put_stream(&p, levels, "arithmetic_per_s", "arithmetic", "stroke=\"#222\" stroke-dasharray=\"6 3\"");
    put_stream(&p, levels, "memory_bytes_per_s", "memory", "stroke=\"#888\" stroke-dasharray=\"2 3\"");
    fputs("</svg>\n", page);
}

/* --- tables --- */

static void put_score(FILE *page, const json_t *score, const char *name)
{
    const json_t *whole = json_object_get(score, "whole");
    char value[128];
    if (!whole)
        return;
    if (json_is_true(json_object_get(score, "steady")))
        snprintf(value, sizeof value, "%.0f", number_at(whole, "median"));
    else
        snprintf(value, sizeof value, "%.0f, from %.0f to %.0f", number_at(whole, "median"), number_at(whole, "least"),
                 number_at(whole, "most"));
    put_row(page, name, value);
}

static void put_summary(FILE *page, const json_t *result)
{
    char text[160];
    const json_t *machine = json_object_get(result, "machine"), *c = json_object_get(result, "certificate");
    const json_t *build = json_object_get(result, "build"), *best = json_object_get(result, "score_best");
    bool is_valid = json_is_true(json_object_get(c, "valid"));
    fputs("<h1>afterglow-bench: ", page);
    put_text(page, text_at(machine, "cpu"));
    fputs("</h1>\n<table>\n", page);
    put_score(page, json_object_get(result, "score_one"), "Score of one thread");
    snprintf(text, sizeof text, "Score of %.0f threads", number_at(best, "threads"));
    put_score(page, best, text);
    snprintf(text, sizeof text, "%.0f cores, %.0f threads, %.0f NUMA nodes; %.0f threads allowed",
             number_at(machine, "cores"), number_at(machine, "threads"), number_at(machine, "numa_nodes"),
             number_at(machine, "threads_allowed"));
    put_row(page, "Machine", text);
    if (number_at(machine, "clock_most_mhz") > 0.0)
        snprintf(text, sizeof text, "%.0f to %.0f MHz, %s", number_at(machine, "clock_least_mhz"),
                 number_at(machine, "clock_most_mhz"),
                 json_is_true(json_object_get(machine, "clock_is_fixed"))    ? "fixed"
                 : json_is_false(json_object_get(machine, "clock_is_fixed")) ? "not fixed"
                                                                             : "not told whether fixed");
    else
        snprintf(text, sizeof text, "not told");
    put_row(page, "Clock", text);
    put_row(page, "System", text_at(machine, "system"));
    snprintf(text, sizeof text, "Afterglow %s, %s, Embree %s, %s, %s", text_at(build, "version"),
             text_at(build, "compiler"), text_at(build, "embree"), text_at(build, "libm"), text_at(build, "isa"));
    put_row(page, "Build", text);
    put_row(page, "Size", text_at(result, "size"));
    fprintf(page, "<tr><td>Certificate</td><td class=\"%s\">%s, <code>%s</code>, known build: %s</td></tr>\n</table>\n",
            is_valid ? "good" : "bad", is_valid ? "valid" : "not valid", text_at(c, "hash"), text_at(c, "known_build"));
    if (json_array_size(json_object_get(result, "refused")) > 0) {
        fputs("<p>No score:</p>\n", page);
        put_list(page, json_object_get(result, "refused"));
    }
    put_list(page, json_object_get(c, "reasons"));
}

static void put_parts(FILE *page, const json_t *result)
{
    size_t i;
    json_t *part;
    fputs("<h2>Phases</h2>\n<p>Items a second, the median of the turns; the spread is the most less the least, over "
          "the median. Efficiency is the speed-up over the number of threads, and over the speed-ups of arithmetic and "
          "memory streams.</p>\n<table><tr><th>scene, phase</th><th>threads</th><th>a second</th><th>spread</th>"
          "<th>speed-up</th><th>efficiency</th><th>of arithmetic</th><th>of memory</th><th>waiting</th>"
          "<th>cache hits</th><th>instructions a cycle</th></tr>\n",
          page);
    json_array_foreach(json_object_get(result, "parts"), i, part)
    {
        const json_t *rate = json_object_get(part, "rate");
        double cycles = number_at(part, "cycles");
        fprintf(page,
                "<tr><td>%s, %s</td><td>%.0f</td><td>%.4g %ss</td><td>%.1f %%</td><td>%.2f</td><td>%.2f</td>"
                "<td>%.2f</td><td>%.2f</td>",
                text_at(part, "scene"), text_at(part, "phase"), number_at(part, "threads"), number_at(rate, "median"),
                text_at(part, "item"), 100.0 * number_at(rate, "spread"), number_at(part, "speedup"),
                number_at(part, "efficiency"), number_at(part, "efficiency_of_arithmetic"),
                number_at(part, "efficiency_of_memory"));
        if (json_object_get(part, "requests"))
            fprintf(page, "<td>%.2g %%</td><td>%.1f %%</td>", 100.0 * number_at(part, "waiting_share"),
                    100.0 * number_at(part, "cache_hits"));
        else
            fputs("<td></td><td></td>", page);
        if (cycles > 0.0)
            fprintf(page, "<td>%.2f</td></tr>\n", number_at(part, "instructions") / cycles);
        else
            fputs("<td></td></tr>\n", page);
    }
    fputs("</table>\n", page);
}

char *bench_page(const json_t *result)
{
    char *text = NULL;
    size_t size = 0;
    FILE *page = open_memstream(&text, &size);
    if (!page)
        return NULL;
    fputs(HEAD, page);
    put_summary(page, result);
    put_plot(page, result);
    put_parts(page, result);
    fputs("</body></html>\n", page);
    bool is_whole = !ferror(page);
    is_whole = fclose(page) == 0 && is_whole;
    if (is_whole)
        return text;
    free(text);
    return NULL;
}

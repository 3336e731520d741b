/* page_pixel.c: see page_pixel.h. */
#define _POSIX_C_SOURCE 200809L
#include "page_pixel.h"

#include "json_text.h"
#include "option_values.h"

#include <math.h>
#include <stdlib.h>

enum { OK = 200, BAD_REQUEST = 400, NOT_FOUND = 404, UNAVAILABLE = 503, NAME_SIZE = 1024 };

static http_answer refusal(unsigned status, const char *text) { return (http_answer){.status = status, .text = text}; }

static void write_values(FILE *out, const page_film *f, const page_layer *layer, const float *values, size_t pixel)
{
    const size_t count = (size_t)f->width * (size_t)f->height;
    const bool is_picture = layer->kind == PAGE_LAYER_PICTURE;
    fputs("{\"values\": [", out);
    for (int c = 0; c < (is_picture ? 3 : layer->channel_count); c++) {
        const double value = (double)(is_picture ? values[3 * pixel + (size_t)c] : values[(size_t)c * count + pixel]);
        fputs(c > 0 ? ", " : "", out);
        if (isfinite(value)) /* JSON has no others */
            fprintf(out, "%.9g", value);
        else
            fputs("null", out);
    }
    fputs("]", out);
}

/* Writes the names of what the pixel shows, by how much of it: the ranks of a matte are in that order. */
static void write_matte(FILE *out, const page_film *f, const page_layer *layer, const float *values, size_t pixel)
{
    char name[NAME_SIZE];
    const size_t count = (size_t)f->width * (size_t)f->height;
    int written = 0;
    fprintf(out, ", \"%s\": [", layer->matte == AG_LAYER_CRYPTO_OBJECT ? "objects" : "materials");
    for (int rank = 0; rank + 1 < layer->channel_count; rank += 2) {
        const float coverage = values[(size_t)(rank + 1) * count + pixel];
        if (!(coverage > 0.0f) ||
            !ag_film_matte_name(f->film, layer->matte, values[(size_t)rank * count + pixel], name, sizeof name))
            continue;
        fputs(written++ > 0 ? ", {\"name\": " : "{\"name\": ", out);
        json_text_put(out, name);
        fprintf(out, ", \"coverage\": %.4f}", (double)coverage);
    }
    fputs("]", out);
}

/* Writes the pixel's values in the layer and all mattes of the film. Returns false where one of them has yet to be
 * copied. */
static bool write_pixel(FILE *out, page_film *f, const page_layer *layer, size_t pixel)
{
    uint64_t version;
    const float *values = page_film_values(f, layer, &version);
    bool is_whole = values != NULL;
    if (values)
        write_values(out, f, layer, values, pixel);
    for (size_t i = 0; i < f->layer_count; i++) {
        if (f->layers[i].kind != PAGE_LAYER_MATTE)
            continue;
        const float *matte = page_film_values(f, &f->layers[i], &version);
        is_whole = is_whole && matte;
        if (is_whole)
            write_matte(out, f, &f->layers[i], matte, pixel);
    }
    fputs("}\n", out);
    return is_whole;
}

static http_answer answer_of_film(page_film *f, const http_request *request, bool *out_is_lacking)
{
    const char *x_text = http_request_value(request, "x"), *y_text = http_request_value(request, "y"),
               *name = http_request_value(request, "layer");
    const page_layer *layer = page_film_find(f, name ? name : "");
    char *text = NULL;
    size_t size = 0;
    int x, y;
    if (!x_text || !y_text || !parse_int(x_text, 0, f->width - 1, &x) || !parse_int(y_text, 0, f->height - 1, &y))
        return refusal(BAD_REQUEST, "There is no such pixel.\n");
    if (!layer)
        return refusal(NOT_FOUND, "There is no such layer.\n");
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return refusal(UNAVAILABLE, "There is no memory for it.\n");
    const bool is_whole = write_pixel(out, f, layer, (size_t)y * (size_t)f->width + (size_t)x);
    *out_is_lacking = !is_whole;
    if (fclose(out) != 0 || !is_whole) {
        free(text);
        return refusal(UNAVAILABLE, "The layers are on their way: ask again.\n");
    }
    shared_bytes *held = shared_bytes_take((unsigned char *)text, size, NULL);
    return held ? (http_answer){.status = OK, .type = "application/json", .held = held}
                : refusal(UNAVAILABLE, "There is no memory for it.\n");
}

http_answer page_pixel_answer(page_film *film, const http_request *request, bool *out_is_lacking)
{
    *out_is_lacking = false;
    if (!page_film_begin(film))
        return refusal(UNAVAILABLE, "There is no picture now: ask again.\n");
    const http_answer answer = answer_of_film(film, request, out_is_lacking);
    page_film_end(film);
    return answer;
}

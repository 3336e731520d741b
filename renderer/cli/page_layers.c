/* page_layers.c: see page_layers.h. */
#include "page_layers.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char MATTE_OBJECT[] = "CryptoObject", MATTE_MATERIAL[] = "CryptoMaterial";
/* The depth where a ray meets nothing. */
static const float FAR = 1e9f;

static bool begins(const char *name, const char *with) { return strncmp(name, with, strlen(with)) == 0; }

/* Finds the layer that a channel belongs to, by its name, and the channel's letter within it, 0: it stands alone. */
static void name_layer(const char *channel, char *out_name, size_t size, char *out_letter)
{
    const char *dot = strrchr(channel, '.');
    const bool is_beauty = strlen(channel) == 1 && strchr("RGB", channel[0]);
    *out_letter = is_beauty ? channel[0] : dot && dot[1] && !dot[2] ? dot[1] : '\0';
    if (is_beauty)
        snprintf(out_name, size, "picture");
    else if (begins(channel, MATTE_OBJECT) || begins(channel, MATTE_MATERIAL))
        snprintf(out_name, size, "%s", begins(channel, MATTE_OBJECT) ? MATTE_OBJECT : MATTE_MATERIAL);
    else
        snprintf(out_name, size, "%.*s", *out_letter ? (int)(dot - channel) : (int)strlen(channel), channel);
}

static page_layer_kind kind_of(const char *name, char letter)
{
    if (strcmp(name, "picture") == 0)
        return PAGE_LAYER_PICTURE;
    if (strcmp(name, MATTE_OBJECT) == 0 || strcmp(name, MATTE_MATERIAL) == 0)
        return PAGE_LAYER_MATTE;
    if (letter == 'R')
        return begins(name, "variance") || begins(name, "Variance") || begins(name, "RelativeVariance")
                   ? PAGE_LAYER_VECTOR
                   : PAGE_LAYER_COLOR;
    return letter == 'X' ? PAGE_LAYER_VECTOR : PAGE_LAYER_NUMBER;
}

page_layer *page_layers_list(const ag_film *film, size_t *out_count)
{
    const int channel_count = ag_film_channel_count(film);
    page_layer *layers = calloc((size_t)channel_count + 1, sizeof *layers);
    size_t count = 0;
    for (int i = 0; layers && i < channel_count; i++) {
        char name[64], letter;
        name_layer(ag_film_channel_name(film, i), name, sizeof name, &letter);
        page_layer *last = count > 0 ? &layers[count - 1] : NULL;
        if (!last || strcmp(last->name, name) != 0 || last->channel_count == PAGE_LAYER_CHANNELS) {
            last = &layers[count++];
            *last = (page_layer){.kind = kind_of(name, letter),
                                 .matte = strcmp(name, MATTE_OBJECT) == 0 ? AG_LAYER_CRYPTO_OBJECT
                                                                          : AG_LAYER_CRYPTO_MATERIAL};
            memcpy(last->name, name, sizeof name);
        }
        last->channels[last->channel_count++] = i;
    }
    *out_count = count;
    return layers;
}

/* Finds the least and the greatest of the values, without those that stand for nothing. */
static void find_range(const float *values, size_t count, float *out_least, float *out_span)
{
    float least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i]) && values[i] < FAR) {
            least = fminf(least, values[i]);
            most = fmaxf(most, values[i]);
        }
    *out_least = most > least ? least : most > 0.0f ? 0.0f : least;
    *out_span = most > *out_least ? most - *out_least : 1.0f;
}

static void draw_numbers(const float *plane, size_t count, float least, float span, float *out, size_t stride)
{
    for (size_t i = 0; i < count; i++) {
        const float share = (plane[i] - least) / span;
        out[i * stride] = share > 0.0f ? fminf(share, 1.0f) : 0.0f;
    }
}

static void draw_vectors(const page_layer *layer, const float *planes, size_t count, float *out)
{
    bool are_unit = true;
    for (size_t i = 0; i < count * (size_t)layer->channel_count && are_unit; i++)
        are_unit = fabsf(planes[i]) <= 1.001f;
    const bool is_normal = are_unit && (strcmp(layer->name, "N") == 0 || strcmp(layer->name, "Ns") == 0);
    for (int c = 0; c < 3; c++) {
        const float *plane = planes + (size_t)(c < layer->channel_count ? c : 0) * count;
        float least = -1.0f, span = 2.0f;
        if (!is_normal)
            find_range(plane, count, &least, &span);
        draw_numbers(plane, count, least, span, out + c, 3);
    }
}

/* Colours of neighbouring ids are far apart: bits of the id, mixed (Steele, Lea, Flood, "Fast splittable pseudorandom
 * number generators", 2014), are hue and lightness. */
static void color_of_id(float id, float weight, float out[3])
{
    uint32_t bits;
    memcpy(&bits, &id, sizeof bits);
    if (bits == 0)
        return;
    bits = (bits ^ bits >> 16) * 0x85ebca6bu;
    bits = (bits ^ bits >> 13) * 0xc2b2ae35u;
    bits ^= bits >> 16;
    const float hue = 6.0f * (float)(bits & 0xffffu) / 65536.0f, light = 0.45f + 0.5f * (float)(bits >> 24) / 256.0f;
    for (int c = 0; c < 3; c++) {
        const float apart = fabsf(fmodf(hue - 2.0f * (float)c + 9.0f, 6.0f) - 3.0f);
        out[c] += weight * light * fminf(fmaxf(apart - 0.5f, 0.15f), 1.0f);
    }
}

void page_layer_draw(const page_layer *layer, const float *planes, size_t count, float *out_pixels)
{
    float least, span;
    memset(out_pixels, 0, 3 * count * sizeof *out_pixels);
    if (layer->kind == PAGE_LAYER_MATTE) {
        for (int rank = 0; rank + 1 < layer->channel_count; rank += 2)
            for (size_t i = 0; i < count; i++)
                color_of_id(planes[(size_t)rank * count + i], planes[(size_t)(rank + 1) * count + i],
                            out_pixels + 3 * i);
    } else if (layer->kind == PAGE_LAYER_VECTOR) {
        draw_vectors(layer, planes, count, out_pixels);
    } else {
        find_range(planes, count, &least, &span);
        for (int c = 0; c < 3; c++)
            draw_numbers(planes, count, least, span, out_pixels + c, 3);
    }
}

/* blender_shifts.c: see blender_shifts.h. Threads: none shared. */
#define _GNU_SOURCE
#include "model/blender_shifts.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_BYTES = 1 << 20, RECORD_BYTES = 256 }; /* a property's record is shorter */

typedef struct reading {
    blender_shifts *shifts;
    double width, x; /* of the camera that is being read; width 0: there is none yet */
    bool has_camera;
} reading;

static void take_shift(reading *r, double x, double y)
{
    float *all = r->shifts->of_all;
    if (!(fabs(x) <= 100.0 && fabs(y) <= 100.0))
        return;
    if (r->has_camera && (all[0] != (float)x || all[1] != (float)y))
        r->shifts->differ = true;
    all[0] = (float)x, all[1] = (float)y;
    r->has_camera = true;
}

/* The number of a property whose name has just ended: three strings, each a letter S, a length and its bytes, then
 * D. */
static bool get_double(const unsigned char *at, const unsigned char *end, double *out)
{
    for (int k = 0; k < 3; k++) {
        uint32_t length;
        if (end - at < 5 || *at != 'S')
            return false;
        memcpy(&length, at + 1, sizeof length);
        if (length > (uint32_t)(end - at - 5))
            return false;
        at += 5 + length;
    }
    if (end - at < 9 || *at != 'D')
        return false;
    memcpy(out, at + 1, sizeof *out);
    return true;
}

/* Cameras have their width before their offsets; the template of all cameras has it behind, and is none. */
static void take_property(reading *r, const unsigned char *at, const unsigned char *end)
{
    static const char *const NAMES[] = {"\11\0\0\0FilmWidth", "\13\0\0\0FilmOffsetX", "\13\0\0\0FilmOffsetY"};
    for (size_t k = 0; k < sizeof NAMES / sizeof *NAMES; k++) {
        const size_t size = k == 0 ? 13 : 15;
        double value;
        if ((size_t)(end - at) < size || memcmp(at, NAMES[k], size) != 0 || !get_double(at + size, end, &value))
            continue;
        if (k == 0)
            r->width = value;
        else if (k == 1)
            r->x = value;
        else if (r->width > 0.0)
            take_shift(r, r->x / r->width, value / r->width);
    }
}

static void read_fbx(FILE *file, unsigned char *block, reading *r)
{
    size_t held = 0, count;
    while ((count = fread(block + held, 1, BLOCK_BYTES - held, file)) > 0) {
        held += count;
        const unsigned char *end = block + held, *last = held > RECORD_BYTES ? end - RECORD_BYTES : block, *at = block;
        bool is_last = held < BLOCK_BYTES;
        while ((at = memmem(at, (size_t)(end - at), "Film", 4)) != NULL && (is_last || at < last)) {
            if (at - block >= 4)
                take_property(r, at - 4, end);
            at += 4;
        }
        if (is_last)
            break;
        held = RECORD_BYTES + 4;
        memmove(block, end - held, held);
    }
}

/* Finds the number behind an opening tag of that name and its attributes; returns whether there is one. */
static bool get_number(const char *tag, const char *name, double *out)
{
    const size_t length = strcspn(tag, " \t\r\n>");
    const char *begin = length == strlen(name) && memcmp(tag, name, length) == 0 ? strchr(tag, '>') : NULL;
    if (begin)
        *out = strtod(begin + 1, NULL);
    return begin != NULL;
}

static void read_collada(FILE *file, reading *r)
{
    char *tag = NULL; /* a tag and what follows it, up to and with the next tag's < */
    size_t size = 0;
    double y;
    while (getdelim(&tag, &size, '<', file) >= 0)
        if (!get_number(tag, "shiftx", &r->x) && get_number(tag, "shifty", &y))
            take_shift(r, r->x, y);
    free(tag);
}

void blender_shifts_read(const char *path, bool is_fbx, blender_shifts *out_shifts)
{
    reading r = {.shifts = out_shifts};
    *out_shifts = (blender_shifts){.differ = false};
    FILE *file = fopen(path, "r");
    unsigned char *block = malloc(BLOCK_BYTES);
    if (file && block && is_fbx)
        read_fbx(file, block, &r);
    else if (file)
        read_collada(file, &r);
    if (out_shifts->differ)
        out_shifts->of_all[0] = out_shifts->of_all[1] = 0.0f;
    free(block);
    if (file)
        fclose(file);
}

/* blender_lamps.c: see blender_lamps.h. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "model/blender_lamps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLENDER_AREA_LAMP = 4, BLENDER_DISK = 4, BLENDER_ELLIPSE = 5 }; /* numbers of Blender's own files */

/* Lamps as the library of the file has them, before nodes refer to them. */
typedef struct extra {
    char id[IMPORT_NAME_SIZE];
    int type, shape;
    float blend, size[2];
} extra;

typedef struct library {
    extra *items;
    size_t count;
} library;

/* Finds the value of an attribute in a line; returns false where there is none, or too long a one. */
static bool get_attribute(const char *line, const char *name, char *out, size_t size)
{
    const char *at = strstr(line, name);
    const char *begin = at ? strchr(at, '"') : NULL, *end = begin ? strchr(begin + 1, '"') : NULL;
    if (!end || (size_t)(end - begin) > size)
        return false;
    memcpy(out, begin + 1, (size_t)(end - begin) - 1);
    out[end - begin - 1] = '\0';
    return true;
}

/* Finds the number of <NAME ...>number</NAME>. */
static bool get_number(const char *line, const char *name, float *out)
{
    const char *at = strstr(line, name), *begin = at ? strchr(at, '>') : NULL;
    char *end;
    if (!begin)
        return false;
    float value = strtof(begin + 1, &end);
    if (end == begin + 1 || !isfinite(value))
        return false;
    *out = value;
    return true;
}

static void *grow(void *items, size_t count, size_t size)
{
    return (count & (count - 1)) == 0 ? realloc(items, (count ? 2 * count : 1) * size) : items;
}

static bool take_library_line(library *l, const char *line)
{
    float number;
    if (strstr(line, "<light ")) {
        extra *larger = grow(l->items, l->count, sizeof *larger);
        if (!larger)
            return false;
        l->items = larger;
        l->items[l->count] = (extra){.type = -1};
        if (!get_attribute(line, " id=", l->items[l->count].id, sizeof l->items->id))
            l->items[l->count].id[0] = '\0'; /* no node can refer to it, but the lines that follow belong to it */
        l->count++;
        return true;
    }
    extra *last = l->count > 0 ? &l->items[l->count - 1] : NULL;
    if (!last)
        return true;
    if (get_number(line, "<type sid=\"type\"", &number))
        last->type = (int)float_clamp(number, -1.0f, 100.0f);
    else if (get_number(line, "<area_shape ", &number))
        last->shape = (int)float_clamp(number, -1.0f, 100.0f);
    else if (get_number(line, "<spotblend ", &number))
        last->blend = number;
    else if (get_number(line, "<area_size ", &number))
        last->size[0] = number;
    else if (get_number(line, "<area_sizey ", &number))
        last->size[1] = number;
    return true;
}

static blender_lamp lamp_of(const extra *e, const char *node)
{
    blender_lamp lamp = {.is_area = e->type == BLENDER_AREA_LAMP, .spot_blend = float_clamp(e->blend, 0.0f, 1.0f)};
    const bool is_long = e->shape == 1 || e->shape == BLENDER_ELLIPSE;
    const float round = e->shape == BLENDER_DISK || e->shape == BLENDER_ELLIPSE ? 0.886226925f : 1.0f; /* sqrt pi / 2 */
    lamp.size[0] = e->size[0] * round;
    lamp.size[1] = (is_long ? e->size[1] : e->size[0]) * round;
    snprintf(lamp.node, sizeof lamp.node, "%s", node);
    return lamp;
}

/* node: the id of the node that the line is in. */
static bool take_node_line(const library *l, const char *line, const char *node, blender_lamps *lamps)
{
    char url[IMPORT_NAME_SIZE];
    if (!strstr(line, "<instance_light ") || !get_attribute(line, " url=", url, sizeof url))
        return true;
    for (size_t k = 0; k < l->count; k++)
        if (url[0] == '#' && l->items[k].type >= 0 && strcmp(l->items[k].id, url + 1) == 0) {
            blender_lamp *larger = grow(lamps->items, lamps->count, sizeof *larger);
            if (!larger)
                return false;
            lamps->items = larger;
            lamps->items[lamps->count++] = lamp_of(&l->items[k], node);
            break;
        }
    return true;
}

/* Takes the length of Blender's unit from the line of the asset that says it. */
static void take_unit(const char *line, float *metres)
{
    char text[64], *end;
    if (!strstr(line, "<unit ") || !get_attribute(line, " meter=", text, sizeof text))
        return;
    const float value = strtof(text, &end);
    if (end != text && value > 1e-6f && value < 1e6f)
        *metres = value;
}

void blender_lamps_read(const char *path, blender_lamps *out_lamps)
{
    library l = {0};
    char *line = NULL, node[IMPORT_NAME_SIZE] = "";
    size_t size = 0;
    bool is_library = false, is_sound = true;
    *out_lamps = (blender_lamps){.metres_per_unit = 1.0f};
    FILE *file = fopen(path, "r");
    while (file && is_sound && getline(&line, &size, file) >= 0) {
        take_unit(line, &out_lamps->metres_per_unit);
        if (strstr(line, "<library_lights>"))
            is_library = true;
        else if (strstr(line, "</library_lights>"))
            is_library = false;
        else if (strstr(line, "<node "))
            (void)get_attribute(line, " id=", node, sizeof node);
        else
            is_sound = is_library ? take_library_line(&l, line) : take_node_line(&l, line, node, out_lamps);
    }
    if (file)
        fclose(file);
    free(line);
    free(l.items);
}

const blender_lamp *blender_lamps_find(const blender_lamps *lamps, const char *node)
{
    for (size_t k = 0; k < lamps->count; k++)
        if (strcmp(lamps->items[k].node, node) == 0)
            return &lamps->items[k];
    return NULL;
}

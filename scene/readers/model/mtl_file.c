/* mtl_file.c: see mtl_file.h. Threads: one per scene. */
#include "model/mtl_file.h"

#include "status.h"
#include "text/text_lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct reader {
    text_lines lines;
    mtl_library *library;
    import_material *now;    /* NULL before the first newmtl */
    bool has_diffuse, has_d; /* d counts more than Tr */
} reader;

import_material mtl_material_make(const char *name)
{
    import_material m;
    memset(&m, 0, sizeof m);
    snprintf(m.name, sizeof m.name, "%s", name);
    m.illumination = -1;
    m.diffuse = rgb_gray(0.6f);
    m.filter = rgb_gray(1.0f);
    m.exponent = m.ior = m.roughness = m.metallic = -1.0f;
    m.opacity = 1.0f;
    for (int slot = 0; slot < IMPORT_SLOT_COUNT; slot++)
        m.pictures[slot] = (import_picture){.scale = {1.0f, 1.0f}, .strength = 1.0f};
    return m;
}

/* Statements. Each reads what follows its word. */

static ag_status begin_material(reader *r)
{
    mtl_library *l = r->library;
    text_word rest = text_lines_rest(&r->lines);
    char name[IMPORT_NAME_SIZE];
    if (l->count == l->capacity) {
        size_t larger = l->capacity ? 2 * l->capacity : 16;
        import_material *materials = realloc(l->materials, larger * sizeof *materials);
        if (!materials)
            return AG_ERROR_MEMORY;
        l->materials = materials;
        l->capacity = larger;
    }
    snprintf(name, sizeof name, "%.*s", (int)(rest.length < sizeof name ? rest.length : sizeof name - 1), rest.text);
    r->now = &l->materials[l->count];
    *r->now = mtl_material_make(name);
    r->has_diffuse = r->has_d = false;
    return name_table_set(&l->names, name, (uint32_t)l->count++);
}

static ag_status read_float(reader *r, const char *what, float *out_value)
{
    double value = 0.0;
    AG_TRY(text_lines_number(&r->lines, what, &value));
    *out_value = (float)value;
    return AG_OK;
}

/* Reads a colour. One number is grey; measured spectra and CIE's XYZ are not read. */
static ag_status read_color(reader *r, const char *what, rgb *out_color, bool *out_is_read)
{
    text_word first, ahead;
    text_lines before = r->lines;
    *out_is_read = false;
    if (text_lines_word(&r->lines, &first) && (text_word_is(&first, "spectral") || text_word_is(&first, "xyz"))) {
        log_at_once(r->lines.log, AG_LOG_WARNING, text_lines_where(&r->lines, first.text), "mtl:spectral",
                    "\"%s %.*s\" is not supported and is ignored, as are any others", what, (int)first.length,
                    first.text);
        return AG_OK;
    }
    r->lines = before;
    float c[3] = {0.0f, 0.0f, 0.0f};
    AG_TRY(read_float(r, what, &c[0]));
    before = r->lines;
    c[1] = c[2] = c[0];
    if (text_lines_word(&r->lines, &ahead)) {
        r->lines = before;
        AG_TRY(read_float(r, what, &c[1]));
        AG_TRY(read_float(r, what, &c[2]));
    }
    *out_color = rgb_make(c[0], c[1], c[2]);
    *out_is_read = true;
    return AG_OK;
}

/* Reads up to three numbers; *out_count of them are there. */
static void read_numbers(reader *r, double out_values[3], int *out_count)
{
    *out_count = 0;
    for (int k = 0; k < 3; k++) {
        text_lines before = r->lines;
        text_word word;
        if (!text_lines_word(&r->lines, &word) || !text_word_number(&word, &out_values[k])) {
            r->lines = before;
            return;
        }
        ++*out_count;
    }
}

/* Reads an option of a picture; returns false where the word is none. */
static bool read_option(reader *r, const text_word *word, import_picture *p)
{
    static const char *const ONE_WORD[] = {"-blendu", "-blendv", "-boost", "-texres", "-cc", "-imfchan", "-type"};
    double v[3] = {0.0, 0.0, 0.0};
    int count;
    text_word ignored;
    for (size_t k = 0; k < sizeof ONE_WORD / sizeof *ONE_WORD; k++)
        if (text_word_is(word, ONE_WORD[k])) {
            text_lines_word(&r->lines, &ignored);
            return true;
        }
    if (text_word_is(word, "-clamp")) {
        bool is_on = text_lines_word(&r->lines, &ignored) && text_word_is(&ignored, "on");
        p->wrap_s = p->wrap_t = is_on ? IMPORT_IS_CLAMPED : IMPORT_REPEATS;
        return true;
    }
    bool is_scale = text_word_is(word, "-s"), is_offset = text_word_is(word, "-o"),
         is_strength = text_word_is(word, "-bm");
    bool is_unsupported = text_word_is(word, "-mm") || text_word_is(word, "-t");
    if (!is_scale && !is_offset && !is_strength && !is_unsupported)
        return false;
    read_numbers(r, v, &count);
    if (is_unsupported)
        log_at_once(r->lines.log, AG_LOG_WARNING, text_lines_where(&r->lines, word->text), "mtl:option",
                    "the option \"%.*s\" is not supported and is ignored, as are any others", (int)word->length,
                    word->text);
    if (is_strength && count > 0)
        p->strength = (float)v[0];
    for (int k = 0; k < 2 && k < count; k++)
        *(is_scale ? &p->scale[k] : is_offset ? &p->offset[k] : &(float){0.0f}) = (float)v[k];
    return true;
}

static ag_status read_picture(reader *r, import_slot slot)
{
    import_picture p = {.scale = {1.0f, 1.0f}, .strength = 1.0f};
    for (;;) {
        text_lines before = r->lines;
        text_word word;
        if (!text_lines_word(&r->lines, &word) || word.text[0] != '-' || !read_option(r, &word, &p)) {
            r->lines = before;
            break;
        }
    }
    text_word rest = text_lines_rest(&r->lines);
    if (rest.length == 0 || rest.length >= sizeof p.path)
        return text_lines_refuse(&r->lines, rest, "the picture's name is %s",
                                 rest.length == 0 ? "missing" : "too long");
    memcpy(p.path, rest.text, rest.length);
    p.path[rest.length] = '\0';
    r->now->pictures[slot] = p;
    return AG_OK;
}

/* Returns whether the word is one of a list that ends with NULL. */
static bool is_one_of(const text_word *word, const char *const *list)
{
    for (; *list; list++)
        if (text_word_is(word, *list))
            return true;
    return false;
}

static ag_status read_value(reader *r, const text_word *word, bool *out_is_known)
{
    import_material *m = r->now;
    bool is_read;
    *out_is_known = true;
    if (text_word_is(word, "Kd")) {
        AG_TRY(read_color(r, "Kd", &m->diffuse, &is_read));
        r->has_diffuse = r->has_diffuse || is_read;
        return AG_OK;
    }
    const struct {
        const char *name;
        rgb *color;
        float *number;
    } VALUES[] = {{"Ks", &m->specular, NULL}, {"Ke", &m->emission, NULL},  {"Tf", &m->filter, NULL},
                  {"Ns", NULL, &m->exponent}, {"Ni", NULL, &m->ior},       {"Pr", NULL, &m->roughness},
                  {"Pm", NULL, &m->metallic}, {"Pc", NULL, &m->clearcoat}, {"Pcr", NULL, &m->clearcoat_roughness}};
    for (size_t k = 0; k < sizeof VALUES / sizeof *VALUES; k++)
        if (text_word_is(word, VALUES[k].name))
            return VALUES[k].color ? read_color(r, VALUES[k].name, VALUES[k].color, &is_read)
                                   : read_float(r, VALUES[k].name, VALUES[k].number);
    float value = 0.0f;
    if (text_word_is(word, "d")) {
        text_lines before = r->lines;
        text_word halo;
        if (text_lines_word(&r->lines, &halo) && !text_word_is(&halo, "-halo"))
            r->lines = before;
        r->has_d = true;
        return read_float(r, "d", &m->opacity);
    }
    if (text_word_is(word, "Tr")) {
        AG_TRY(read_float(r, "Tr", &value));
        if (!r->has_d)
            m->opacity = 1.0f - value;
        return AG_OK;
    }
    if (text_word_is(word, "illum")) {
        AG_TRY(read_float(r, "illum", &value));
        m->illumination = value >= 0.0f && value <= 10.0f ? (int32_t)value : -1;
        return AG_OK;
    }
    *out_is_known = false;
    return AG_OK;
}

static ag_status read_statement(reader *r, const text_word *word)
{
    static const struct {
        const char *name;
        import_slot slot;
    } PICTURES[] = {{"map_Kd", IMPORT_COLOR},  {"map_Ke", IMPORT_EMISSION},  {"map_emissive", IMPORT_EMISSION},
                    {"map_d", IMPORT_OPACITY}, {"map_Pr", IMPORT_ROUGHNESS}, {"map_Pm", IMPORT_METALLIC},
                    {"norm", IMPORT_NORMAL},   {"map_Kn", IMPORT_NORMAL},    {"bump", IMPORT_BUMP},
                    {"map_bump", IMPORT_BUMP}};
    static const char *const NO_CONCERN[] = {"Ka", "map_Ka", "sharpness", "map_aat", "Km", NULL};
    bool is_known;
    if (text_word_is(word, "newmtl"))
        return begin_material(r);
    if (!r->now)
        return text_lines_refuse(&r->lines, *word, "\"%.*s\" stands before the first newmtl",
                                 (int)(word->length < 40 ? word->length : 40), word->text);
    AG_TRY(read_value(r, word, &is_known));
    if (is_known)
        return AG_OK;
    for (size_t k = 0; k < sizeof PICTURES / sizeof *PICTURES; k++)
        if (text_word_is(word, PICTURES[k].name))
            return read_picture(r, PICTURES[k].slot);
    if (text_word_is(word, "disp") || text_word_is(word, "map_disp")) /* heights, which "bump" gives, too, and better */
        return r->now->pictures[IMPORT_BUMP].path[0] ? AG_OK : read_picture(r, IMPORT_BUMP);
    if (!is_one_of(word, NO_CONCERN)) {
        char key[64];
        snprintf(key, sizeof key, "mtl:%.*s", (int)(word->length < 40 ? word->length : 40), word->text);
        log_at_once(r->lines.log, AG_LOG_WARNING, text_lines_where(&r->lines, word->text), key,
                    "\"%.*s\" is not known, or not supported, and is ignored",
                    (int)(word->length < 40 ? word->length : 40), word->text);
    }
    return AG_OK;
}

/* A diffuse picture without a factor beside it is taken as it is, not multiplied by the default. */
static void finish_material(reader *r)
{
    if (r->now && !r->has_diffuse && r->now->pictures[IMPORT_COLOR].path[0])
        r->now->diffuse = rgb_gray(1.0f);
}

ag_status mtl_library_read(mtl_library *library, log_sink *log, const char *file, const char *text, size_t size)
{
    reader r = {.library = library};
    text_word word;
    ag_status status = AG_OK;
    text_lines_init(&r.lines, log, file, text, size);
    while (status == AG_OK && text_lines_next(&r.lines)) {
        text_lines_word(&r.lines, &word);
        if (text_word_is(&word, "newmtl"))
            finish_material(&r);
        status = read_statement(&r, &word);
    }
    finish_material(&r);
    return status;
}

void mtl_library_reset(mtl_library *library)
{
    free(library->materials);
    name_table_reset(&library->names);
    memset(library, 0, sizeof *library);
}

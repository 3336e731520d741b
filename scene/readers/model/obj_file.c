/* obj_file.c: the reader of Wavefront OBJ files (scene_reader.h), plain or gzip, and of the MTL files that they name.
 * There is one mesh for each material; polygons, concave ones too, are cut into triangles; corners without normals have
 * those of their smoothing group, or none. MTL files and pictures that are not there are warnings. Here are the
 * statements; vertices are counted first, so that faces may name those that follow.
 * Rests on: Wavefront, "Object Files", Advanced Visualizer Manual, appendix B1.
 * Flow: text_lines, mtl_file -> [here], obj_meshes -> importer -> scene. Threads: one per scene. */
#include "model/obj_private.h"
#include "scene_reader.h"
#include "status.h"
#include "text/text_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool obj_grow(void *items_pointer, size_t count, size_t *capacity, size_t item_size)
{
    if (count < *capacity)
        return true;
    void **items = items_pointer;
    size_t larger = *capacity ? *capacity + *capacity / 2 + 1 : 64;
    void *moved = realloc(*items, larger * item_size);
    if (!moved)
        return false;
    *items = moved;
    *capacity = larger;
    return true;
}

/* Statements */

static ag_status read_vertex(obj *o, int least, int most, double out_values[3])
{
    static const char *const WHAT[] = {"x", "y", "z"};
    out_values[0] = out_values[1] = out_values[2] = 0.0;
    for (int k = 0; k < most; k++) {
        text_lines before = o->lines;
        text_word word;
        if (k >= least && !text_lines_word(&o->lines, &word))
            break;
        o->lines = before;
        AG_TRY(text_lines_number(&o->lines, WHAT[k], &out_values[k]));
    }
    return AG_OK;
}

static ag_status read_position(obj *o)
{
    double v[3];
    text_word word;
    AG_TRY(read_vertex(o, 3, 3, v));
    o->positions[o->position_count++] = vec3_make((float)v[0], (float)v[1], (float)v[2]);
    int more = 0;
    while (text_lines_word(&o->lines, &word))
        more++;
    if (more >= 3)
        log_at_once(o->to.log, AG_LOG_WARNING, text_lines_where(&o->lines, o->lines.line_start), "obj:vertex colours",
                    "colours of vertices are not supported and are ignored");
    return AG_OK;
}

static ag_status read_uv(obj *o)
{
    double v[3];
    AG_TRY(read_vertex(o, 1, 2, v));
    o->uvs[o->uv_count++] = (vec2){(float)v[0], (float)v[1]};
    return AG_OK;
}

/* Reads a normal of any length, and scales its largest component to 1, since floats may not hold the file's. */
static ag_status read_normal(obj *o)
{
    double v[3];
    AG_TRY(read_vertex(o, 3, 3, v));
    double largest = double_max(fabs(v[0]), double_max(fabs(v[1]), fabs(v[2])));
    double scale = largest > 0.0 ? 1.0 / largest : 0.0;
    o->normals[o->normal_count++] = vec3_make((float)(v[0] * scale), (float)(v[1] * scale), (float)(v[2] * scale));
    return AG_OK;
}

/* Reads one of the numbers of a corner, at *at; OBJ_NONE where there is none. It counts from 1, or back from the last
 * one so far. */
static ag_status read_reference(obj *o, const char **at, const char *end, const text_word *word, const char *what,
                                size_t so_far, size_t total, uint32_t *out_index)
{
    *out_index = OBJ_NONE;
    bool is_negative = *at < end && **at == '-';
    const char *digits = *at + is_negative;
    uint64_t value = 0;
    const char *c = digits;
    for (; c < end && *c >= '0' && *c <= '9'; c++)
        value = value < UINT32_MAX ? 10 * value + (uint64_t)(*c - '0') : value;
    *at = c;
    if (c == digits)
        return is_negative ? text_lines_refuse(&o->lines, *word, "a corner should be V, V/T, V//N or V/T/N") : AG_OK;
    if (is_negative ? value == 0 || value > so_far : value == 0 || value > total)
        return text_lines_refuse(&o->lines, *word, "the corner refers to %s %s%llu, but there are %zu", what,
                                 is_negative ? "-" : "", (unsigned long long)value, is_negative ? so_far : total);
    *out_index = (uint32_t)(is_negative ? so_far - value : value - 1);
    return AG_OK;
}

static ag_status read_corner(obj *o, const text_word *word)
{
    const char *at = word->text, *end = at + word->length;
    obj_corner c = {OBJ_NONE, OBJ_NONE, OBJ_NONE};
    AG_TRY(read_reference(o, &at, end, word, "vertex", o->position_count, o->position_total, &c.position));
    if (at < end && *at == '/') {
        at++;
        AG_TRY(read_reference(o, &at, end, word, "texture vertex", o->uv_count, o->uv_total, &c.uv));
        if (at < end && *at == '/') {
            at++;
            AG_TRY(read_reference(o, &at, end, word, "normal", o->normal_count, o->normal_total, &c.normal));
        }
    }
    if (at != end || c.position == OBJ_NONE)
        return text_lines_refuse(&o->lines, *word, "a corner should be V, V/T, V//N or V/T/N");
    if (!obj_grow(&o->corners, o->corner_count, &o->corner_capacity, sizeof *o->corners))
        return AG_ERROR_MEMORY;
    o->corners[o->corner_count++] = c;
    return AG_OK;
}

static ag_status use_material(obj *o, const char *name)
{
    if (name_table_find(&o->used_names, name, &o->material))
        return AG_OK;
    if (!obj_grow(&o->used, o->used_count, &o->used_capacity, sizeof *o->used))
        return AG_ERROR_MEMORY;
    memset(&o->used[o->used_count], 0, sizeof *o->used);
    snprintf(o->used[o->used_count].name, sizeof o->used->name, "%s", name);
    o->material = (uint32_t)o->used_count++;
    return name_table_set(&o->used_names, name, o->material);
}

static ag_status read_face(obj *o, text_word word)
{
    obj_face f = {.first_corner = o->corner_count, .group = o->group};
    text_word next;
    while (text_lines_word(&o->lines, &next))
        AG_TRY(read_corner(o, &next));
    size_t count = o->corner_count - f.first_corner;
    if (count < 3) {
        o->to.left_out_count++;
        o->corner_count = f.first_corner;
        return AG_OK;
    }
    if (o->corner_count > OBJ_MAX_COUNT)
        return text_lines_refuse(&o->lines, word, "there are too many faces");
    if (o->material == OBJ_NONE) /* before any usemtl */
        AG_TRY(use_material(o, ""));
    f.corner_count = (uint32_t)count;
    f.material = o->material;
    if (!obj_grow(&o->faces, o->face_count, &o->face_capacity, sizeof *o->faces))
        return AG_ERROR_MEMORY;
    o->faces[o->face_count++] = f;
    obj_material *u = &o->used[f.material];
    u->face_count++;
    u->triangle_count += count - 2;
    u->corner_count = count > u->corner_count ? count : u->corner_count;
    return AG_OK;
}

static ag_status read_group(obj *o)
{
    text_word word;
    double value = 0.0;
    o->group = 0;
    if (!text_lines_word(&o->lines, &word) || text_word_is(&word, "off"))
        return AG_OK;
    if (text_word_is(&word, "on"))
        value = 1.0;
    else if (!text_word_number(&word, &value) || value < 0.0 || value > (double)OBJ_FIRST_SMOOTH)
        return text_lines_refuse(&o->lines, word, "a smoothing group should be a number or off");
    o->group = (uint32_t)value;
    return AG_OK;
}

/* Reads the MTL file of that name, in the folder of the OBJ file; *out_is_there is false where it cannot be read. */
static ag_status read_library(obj *o, text_word name, bool *out_is_there, char *error, size_t error_size)
{
    const char *file = o->to.where.file, *slash = strrchr(file, '/');
    size_t folder = slash && name.text[0] != '/' ? (size_t)(slash - file) + 1 : 0;
    char *path = malloc(folder + name.length + 1);
    text_file text;
    if (!path)
        return AG_ERROR_MEMORY;
    memcpy(path, file, folder);
    memcpy(path + folder, name.text, name.length);
    path[folder + name.length] = '\0';
    for (char *c = path + folder; *c; c++)
        if (*c == '\\')
            *c = '/';
    ag_status status = AG_ERROR_INPUT;
    snprintf(error, error_size, "it is standard input's name");
    if (strcmp(path, "-") != 0) /* only the user may name that */
        status = text_file_read(o->to.run, path, error, error_size, &text);
    *out_is_there = status == AG_OK;
    if (status == AG_OK) {
        const char *interned = scene_intern_file_name(o->to.scene, path);
        status = interned ? mtl_library_read(&o->library, o->to.log, interned, text.text, text.size) : AG_ERROR_MEMORY;
        text_file_reset(&text);
    }
    free(path);
    return status == AG_ERROR_INPUT ? AG_OK : status;
}

/* Names may have blanks in them, or there may be several. */
static ag_status read_libraries(obj *o)
{
    char error[128] = "", key[512];
    bool is_there;
    text_lines words = o->lines;
    text_word rest = text_lines_rest(&o->lines), word;
    if (rest.length == 0)
        return text_lines_refuse(&o->lines, rest, "the material library's name is missing");
    AG_TRY(read_library(o, rest, &is_there, error, sizeof error));
    while (!is_there && text_lines_word(&words, &word)) {
        bool is_found = false;
        if (word.length != rest.length) /* else it has just been tried */
            AG_TRY(read_library(o, word, &is_found, error, sizeof error));
        if (!is_found) {
            snprintf(key, sizeof key, "mtllib:%.*s", (int)(word.length < 400 ? word.length : 400), word.text);
            log_at_once(o->to.log, AG_LOG_WARNING, text_lines_where(&o->lines, word.text), key,
                        "the material library \"%.*s\" cannot be read: %s",
                        (int)(word.length < 400 ? word.length : 400), word.text, error);
        }
    }
    return AG_OK;
}

static ag_status read_use(obj *o)
{
    char name[IMPORT_NAME_SIZE];
    text_word rest = text_lines_rest(&o->lines);
    snprintf(name, sizeof name, "%.*s", (int)(rest.length < sizeof name ? rest.length : sizeof name - 1), rest.text);
    return use_material(o, name);
}

static ag_status read_statement(obj *o, const text_word *word)
{
    static const char *const NO_CONCERN[] = {"o", "g", "lod", "bevel", "c_interp", "d_interp", "mg"};
    int shown = (int)(word->length < 40 ? word->length : 40);
    if (text_word_is(word, "v"))
        return read_position(o);
    if (text_word_is(word, "vt"))
        return read_uv(o);
    if (text_word_is(word, "vn"))
        return read_normal(o);
    if (text_word_is(word, "f") || text_word_is(word, "fo"))
        return read_face(o, *word);
    if (text_word_is(word, "s"))
        return read_group(o);
    if (text_word_is(word, "usemtl"))
        return read_use(o);
    if (text_word_is(word, "mtllib"))
        return read_libraries(o);
    if (text_word_is(word, "l") || text_word_is(word, "p")) {
        o->to.left_out_count++;
        return AG_OK;
    }
    for (size_t k = 0; k < sizeof NO_CONCERN / sizeof *NO_CONCERN; k++)
        if (text_word_is(word, NO_CONCERN[k]))
            return AG_OK;
    log_at_once(o->to.log, AG_LOG_WARNING, text_lines_where(&o->lines, word->text), "obj:statement",
                "\"%.*s\" is not known, or not supported, and is ignored, as are any others", shown, word->text);
    return AG_OK;
}

/* Reading */

static ag_status count_vertices(obj *o)
{
    text_lines lines = o->lines;
    text_word word;
    while (text_lines_next(&lines) && text_lines_word(&lines, &word)) {
        o->position_total += text_word_is(&word, "v");
        o->uv_total += text_word_is(&word, "vt");
        o->normal_total += text_word_is(&word, "vn");
    }
    if (o->position_total > OBJ_MAX_COUNT || o->uv_total > OBJ_MAX_COUNT || o->normal_total > OBJ_MAX_COUNT)
        return importer_refuse(&o->to, "there are too many vertices");
    o->positions = malloc((o->position_total + 1) * sizeof *o->positions);
    o->uvs = malloc((o->uv_total + 1) * sizeof *o->uvs);
    o->normals = malloc((o->normal_total + 1) * sizeof *o->normals);
    return o->positions && o->uvs && o->normals ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status read_statements(obj *o)
{
    text_word word;
    size_t lines = 0, size = (size_t)(o->lines.end - o->lines.text);
    while (text_lines_next(&o->lines)) {
        text_lines_word(&o->lines, &word);
        AG_TRY(read_statement(o, &word));
        if (++lines % 4096 == 0) {
            if (run_is_cancelled(o->to.run))
                return AG_CANCELLED;
            run_progress(o->to.run, AG_PHASE_LOAD, (double)(o->lines.at - o->lines.text) / (double)size);
        }
    }
    return AG_OK;
}

static ag_status load(obj *o)
{
    AG_TRY(count_vertices(o));
    AG_TRY(read_statements(o));
    AG_TRY(obj_add_meshes(o));
    return importer_finish(&o->to);
}

ag_status obj_load_file(run_context *run, const char *path, scene *out_scene)
{
    obj o;
    char error[128];
    text_file text;
    memset(&o, 0, sizeof o);
    o.material = OBJ_NONE;
    AG_TRY(importer_init(&o.to, run, path, out_scene));
    run_progress(run, AG_PHASE_LOAD, 0.0);
    ag_status status = text_file_read(run, path, error, sizeof error, &text);
    if (status == AG_ERROR_INPUT)
        importer_refuse(&o.to, "cannot read the file: %s", error);
    if (status != AG_OK)
        return status;
    text_lines_init(&o.lines, run->log, o.to.where.file, text.text, text.size);
    status = load(&o);
    free(o.positions);
    free(o.uvs);
    free(o.normals);
    free(o.smooth);
    free(o.corners);
    free(o.faces);
    free(o.used);
    name_table_reset(&o.used_names);
    mtl_library_reset(&o.library);
    text_file_reset(&text);
    if (status == AG_OK)
        run_progress(run, AG_PHASE_LOAD, 1.0);
    return status;
}

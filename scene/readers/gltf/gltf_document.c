/* gltf_document.c: from a .gltf or .glb file to its JSON, and what the whole of it says: version, extensions, lists.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.2 (asset), 3.12 (extensions), 4 (GLB).
 * Flow: file -> [here] -> gltf_json. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "gltf/gltf_private.h"
#include "text/text_file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Syntax */

/* Writes the line around a position and a mark below it, as messages of other scene files have them. Long lines are
 * cut. */
static void make_excerpt(const char *json, size_t size, size_t position, char *excerpt, size_t excerpt_size)
{
    enum { BEFORE = 60, SHOWN = 100 };
    size_t begin = position, end = position, mark = 0;
    while (begin > 0 && json[begin - 1] != '\n' && position - begin < BEFORE)
        begin--;
    while (end < size && json[end] != '\n' && json[end] != '\r' && end - begin < SHOWN)
        end++;
    char line[SHOWN + 1], below[SHOWN + 2];
    for (size_t i = begin; i < end; i++) {
        unsigned char c = (unsigned char)json[i];
        line[i - begin] = c < ' ' || c == 0x7f ? ' ' : (char)c;
        if (i < position && (c & 0xc0) != 0x80) /* one column for each character of UTF-8 */
            below[mark++] = ' ';
    }
    line[end - begin] = below[mark] = '\0';
    snprintf(excerpt, excerpt_size, "\n    %s\n    %s^", line, below);
}

static ag_status parse_json(gltf_reader *r, const char *json, size_t size, bool is_chunk)
{
    char excerpt[320] = "";
    json_error_t error;
    if (size >= 3 && memcmp(json, "\xef\xbb\xbf", 3) == 0) /* skips the byte order mark of UTF-8 */
        json += 3, size -= 3;
    r->root = json_loadb(json, size, 0, &error);
    if (!r->root) {
        if (json_error_code(&error) == json_error_out_of_memory)
            return AG_ERROR_MEMORY;
        file_location where = {r->where.file, error.line, error.column > 0 ? error.column : 1};
        size_t position = error.position > 0 ? (size_t)error.position - 1 : 0;
        if (position <= size)
            make_excerpt(json, size, position, excerpt, sizeof excerpt);
        log_at(r->run->log, AG_LOG_ERROR, where, "%s%s%s", is_chunk ? "in the JSON chunk: " : "", error.text, excerpt);
        return AG_ERROR_SCENE;
    }
    r->document = (gltf_value){r->root, NULL, NULL, 0};
    r->is_text = !is_chunk;
    return json_is_object(r->root) ? AG_OK : gltf_error(r, &r->document, "should be an object");
}

/* The binary container */

static uint32_t read_u32(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static ag_status AG_PRINTF(2, 3) refuse_container(const gltf_reader *r, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    log_at(r->run->log, AG_LOG_ERROR, r->where, "%s", text);
    return AG_ERROR_SCENE;
}

static ag_status open_container(gltf_reader *r, size_t size)
{
    enum { HEADER = 12, CHUNK_HEADER = 8 };
    const uint32_t json_type = 0x4e4f534a, binary_type = 0x004e4942;
    if (size < HEADER + CHUNK_HEADER)
        return refuse_container(r, "the binary file is cut short: it has %zu bytes, and its headers alone %d", size,
                                HEADER + CHUNK_HEADER);
    if (read_u32(r->text + 4) != 2)
        return refuse_container(r, "the binary file is of version %u; known is 2", read_u32(r->text + 4));
    size_t length = read_u32(r->text + 8);
    if (length > size)
        return refuse_container(r, "the binary file is cut short: it has %zu bytes of %zu", size, length);
    gltf_bytes json = {NULL, 0};
    for (size_t at = HEADER; at + CHUNK_HEADER <= length;) {
        size_t chunk_size = read_u32(r->text + at), left = length - at - CHUNK_HEADER;
        uint32_t type = read_u32(r->text + at + 4);
        if (chunk_size > left)
            return refuse_container(r, "a chunk of the binary file has %zu bytes, but %zu are left", chunk_size, left);
        gltf_bytes chunk = {(const unsigned char *)r->text + at + CHUNK_HEADER, chunk_size};
        if (!json.data && type != json_type)
            break;
        if (!json.data)
            json = chunk;
        else if (type == binary_type && !r->chunk.data)
            r->chunk = chunk; /* chunks of other types say nothing to us */
        at += CHUNK_HEADER + chunk_size;
    }
    if (!json.data)
        return refuse_container(r, "the first chunk of the binary file is not its JSON");
    return parse_json(r, (const char *)json.data, json.size, true);
}

/* The document's head: version and required extensions */

static ag_status check_asset(gltf_reader *r)
{
    gltf_value asset;
    const char *version = NULL, *needed = NULL, *generator = NULL;
    AG_TRY(gltf_get_object(r, &r->document, "asset", &asset));
    AG_TRY(gltf_require(r, &r->document, "asset"));
    AG_TRY(gltf_require(r, &asset, "version"));
    AG_TRY(gltf_get_text(r, &asset, "version", &version));
    AG_TRY(gltf_get_text(r, &asset, "minVersion", &needed));
    AG_TRY(gltf_get_text(r, &asset, "generator", &generator));
    if (strncmp(version, "2.", 2) != 0)
        return gltf_error(r, &asset, "it is glTF %s; known is 2.0", version);
    if (needed && strcmp(needed, "2.0") != 0)
        return gltf_error(r, &asset, "it needs glTF %s; known is 2.0", needed);
    r->lamp_units = gltf_lamp_units_of(
        r->scene->request ? r->scene->request->gltf_light_units : GLTF_LIGHTS_BY_GENERATOR, generator);
    r->is_blenders = generator && strstr(generator, "glTF Blender I/O");
    for (size_t i = 0; generator && generator[i] && i + 1 < sizeof r->generator; i++)
        r->generator[i] = (unsigned char)generator[i] < ' ' || generator[i] == 127 ? '?' : generator[i];
    return AG_OK;
}

typedef enum extension_support { NOT_KNOWN, IGNORED, KNOWN } extension_support;

/* IGNORED: the picture can be made without the extension, though it looks different; a warning names it where it is
 * used. */
static extension_support find_extension(const char *name)
{
    static const struct {
        const char *name;
        extension_support support;
    } EXTENSIONS[] = {
        {"KHR_lights_punctual", KNOWN},
        {"KHR_materials_anisotropy", KNOWN},
        {"KHR_materials_clearcoat", KNOWN},
        {"KHR_materials_emissive_strength", KNOWN},
        {"KHR_materials_ior", KNOWN},
        {"KHR_materials_pbrSpecularGlossiness", KNOWN},
        {"KHR_materials_sheen", KNOWN},
        {"KHR_materials_specular", KNOWN},
        {"KHR_materials_transmission", KNOWN},
        {"KHR_materials_unlit", KNOWN},
        {"KHR_materials_volume", KNOWN},
        {"KHR_mesh_quantization", KNOWN},
        {"KHR_texture_transform", KNOWN},
        {"KHR_animation_pointer", KNOWN}, /* of animations alone */
        {"KHR_xmp", KNOWN},               /* who made it, and when */
        {"KHR_xmp_json_ld", KNOWN},
        {"KHR_materials_diffuse_transmission", IGNORED},
        {"KHR_materials_dispersion", IGNORED},
        {"KHR_materials_iridescence", IGNORED},
        {"KHR_materials_variants", IGNORED},
        {"KHR_node_visibility", IGNORED},
    };
    for (size_t i = 0; i < sizeof EXTENSIONS / sizeof *EXTENSIONS; i++)
        if (strcmp(EXTENSIONS[i].name, name) == 0)
            return EXTENSIONS[i].support;
    return NOT_KNOWN;
}

static ag_status check_extensions(const gltf_reader *r)
{
    static const char *const KEYS[2] = {"extensionsRequired", "extensionsUsed"};
    for (int k = 0; k < 2; k++) {
        gltf_value names;
        AG_TRY(gltf_get_array(r, &r->document, KEYS[k], &names));
        for (size_t i = 0; names.json && i < json_array_size(names.json); i++) {
            gltf_value name = gltf_element(&names, i);
            const char *text = json_string_value(name.json);
            if (!text)
                return gltf_error(r, &name, "should be a string");
            extension_support support = find_extension(text);
            if (support == NOT_KNOWN && k == 0)
                return gltf_error(r, &name, "the file needs the extension %s, which is not supported", text);
            if (support != KNOWN)
                gltf_warn_once(r, &name, text, "the extension %s is not supported, and ignored", text);
        }
    }
    return AG_OK;
}

static ag_status find_lists(gltf_reader *r)
{
    static const char *const NAMES[GLTF_LIST_COUNT] = {"accessors", "buffers",  "bufferViews", "cameras",  "images",
                                                       "materials", "meshes",   "nodes",       "samplers", "scenes",
                                                       "skins",     "textures", "lights"};
    gltf_value *parents = r->lists_parents;
    AG_TRY(gltf_get_extension(r, &r->document, "KHR_lights_punctual", &parents[0], &parents[1]));
    for (int i = 0; i < GLTF_LIST_COUNT; i++) {
        const gltf_value *parent = i == GLTF_LIGHTS ? &parents[1] : &r->document;
        AG_TRY(gltf_get_array(r, parent, NAMES[i], &r->lists[i]));
        size_t count = r->lists[i].json ? json_array_size(r->lists[i].json) : 0;
        if (count >= UINT32_MAX / 4)
            return gltf_error(r, &r->lists[i], "there are too many");
        r->list_counts[i] = (uint32_t)count;
    }
    return AG_OK;
}

ag_status gltf_document_read(gltf_reader *r, const char *path)
{
    char error[512];
    text_file file;
    ag_status status = text_file_read(r->run, path, error, sizeof error, &file);
    if (status == AG_ERROR_INPUT)
        log_at(r->run->log, AG_LOG_ERROR, r->where, "cannot read the file: %s", error);
    AG_TRY(status);
    r->text = file.text;
    AG_TRY(file.size >= 4 && memcmp(file.text, "glTF", 4) == 0 ? open_container(r, file.size)
                                                               : parse_json(r, file.text, file.size, false));
    AG_TRY(check_asset(r));
    AG_TRY(check_extensions(r));
    return find_lists(r);
}

/* ply_header.c: see ply_header.h.
 * Threads: one per file. */
#include "model/ply_header.h"

#include <ctype.h>
#include <string.h>

enum { MAX_WORDS = 6, LINE_BYTES = 1024 };

static bool find_type(const char *name, ply_type *out_type)
{
    static const struct {
        const char *name;
        ply_type type;
    } TYPES[] = {{"char", PLY_INT8},     {"int8", PLY_INT8},       {"uchar", PLY_UINT8},    {"uint8", PLY_UINT8},
                 {"short", PLY_INT16},   {"int16", PLY_INT16},     {"ushort", PLY_UINT16},  {"uint16", PLY_UINT16},
                 {"int", PLY_INT32},     {"int32", PLY_INT32},     {"uint", PLY_UINT32},    {"uint32", PLY_UINT32},
                 {"float", PLY_FLOAT32}, {"float32", PLY_FLOAT32}, {"double", PLY_FLOAT64}, {"float64", PLY_FLOAT64}};
    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++)
        if (strcmp(name, TYPES[i].name) == 0) {
            *out_type = TYPES[i].type;
            return true;
        }
    return false;
}

static int find_slot(const ply_element *element, const ply_property *property, const char *name)
{
    static const struct {
        const char *name;
        int slot;
    } SLOTS[] = {{"x", PLY_X},         {"y", PLY_Y},         {"z", PLY_Z},         {"nx", PLY_NX},      {"ny", PLY_NY},
                 {"nz", PLY_NZ},       {"u", PLY_U},         {"v", PLY_V},         {"s", PLY_U},        {"t", PLY_V},
                 {"texture_u", PLY_U}, {"texture_v", PLY_V}, {"texture_s", PLY_U}, {"texture_t", PLY_V}};
    if (strcmp(element->name, "face") == 0)
        return property->is_list && (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0)
                   ? PLY_CORNERS
                   : PLY_NO_SLOT;
    if (strcmp(element->name, "vertex") == 0 && !property->is_list)
        for (size_t i = 0; i < sizeof SLOTS / sizeof *SLOTS; i++)
            if (strcmp(name, SLOTS[i].name) == 0)
                return SLOTS[i].slot;
    return PLY_NO_SLOT;
}

/* Splits a line at its blanks; returns how many words there are, MAX_WORDS + 1 where there are more than that. */
static int split(char *line, char *words[MAX_WORDS])
{
    int count = 0;
    for (char *c = line; *c;) {
        while (*c == ' ' || *c == '\t')
            *c++ = '\0';
        if (!*c)
            break;
        if (count == MAX_WORDS)
            return MAX_WORDS + 1;
        words[count++] = c;
        while (*c && *c != ' ' && *c != '\t')
            c++;
    }
    return count;
}

static ag_status read_format(ply_stream *s, int count, char **words)
{
    static const char *const NAMES[] = {"", "ascii", "binary_little_endian", "binary_big_endian"};
    if (count != 3)
        return ply_fail(s, "\"format\" should have a name and a version");
    if (s->format != PLY_NO_FORMAT)
        return ply_fail(s, "the format is there twice");
    for (int i = PLY_ASCII; i <= PLY_BIG_ENDIAN; i++)
        if (strcmp(words[1], NAMES[i]) == 0)
            s->format = (ply_format)i;
    if (s->format == PLY_NO_FORMAT)
        return ply_fail(s, "unknown format \"%.40s\"", words[1]);
    if (strcmp(words[2], "1.0") != 0)
        return ply_fail(s, "unknown version \"%.40s\" of the format", words[2]);
    return AG_OK;
}

static ag_status read_element(ply_stream *s, int count, char **words, ply_header *h)
{
    if (count != 3)
        return ply_fail(s, "\"element\" should have a name and a count");
    if (h->element_count == PLY_MAX_ELEMENTS)
        return ply_fail(s, "there are more than %d kinds of elements", PLY_MAX_ELEMENTS);
    uint64_t number = 0;
    for (const char *c = words[2]; *c; c++) {
        if (!isdigit((unsigned char)*c))
            return ply_fail(s, "\"%.40s\" is no count", words[2]);
        if (number > (UINT64_MAX >> 8) / 10)
            return ply_fail(s, "the count %.40s is too large", words[2]);
        number = 10 * number + (uint64_t)(*c - '0');
    }
    ply_element *e = &h->elements[h->element_count];
    *e = (ply_element){.count = number, .line = s->line, .properties = h->properties + h->property_count};
    strncpy(e->name, words[1], sizeof e->name - 1);
    for (int i = 0; i <= PLY_VERTEX_SLOTS; i++)
        e->of_slot[i] = -1;
    const ply_element **known = strcmp(e->name, "vertex") == 0 ? &h->vertex
                                : strcmp(e->name, "face") == 0 ? &h->face
                                                               : NULL;
    if (known && *known)
        return ply_fail(s, "element \"%s\" is there twice", e->name);
    if (known)
        *known = e;
    h->element_count++;
    return AG_OK;
}

static ag_status read_property(ply_stream *s, int count, char **words, ply_header *h)
{
    ply_property p = {.is_list = count > 1 && strcmp(words[1], "list") == 0};
    if (count != (p.is_list ? 5 : 3))
        return ply_fail(s, "\"property\" should have a type and a name, or \"list\", two types and a name");
    if (h->element_count == 0)
        return ply_fail(s, "a property before any element");
    if (h->property_count == PLY_MAX_PROPERTIES)
        return ply_fail(s, "there are more than %d properties", PLY_MAX_PROPERTIES);
    if (p.is_list && !find_type(words[2], &p.count_type))
        return ply_fail(s, "unknown type \"%.40s\"", words[2]);
    if (p.is_list && p.count_type >= PLY_FLOAT32)
        return ply_fail(s, "a list's count should be of an integer type, not \"%.40s\"", words[2]);
    if (!find_type(words[count - 2], &p.type))
        return ply_fail(s, "unknown type \"%.40s\"", words[count - 2]);
    ply_element *e = &h->elements[h->element_count - 1];
    p.slot = find_slot(e, &p, words[count - 1]);
    if (p.slot == PLY_CORNERS && p.type >= PLY_FLOAT32)
        return ply_fail(s, "\"%.40s\" should be of an integer type, not \"%.40s\"", words[4], words[3]);
    if (p.slot != PLY_NO_SLOT && e->of_slot[p.slot] >= 0) {
        if (p.slot != PLY_U && p.slot != PLY_V) /* several pairs of texture coordinates: the first counts */
            return ply_fail(s, "property \"%.40s\" is there twice", words[count - 1]);
        p.slot = PLY_NO_SLOT;
    }
    if (p.slot != PLY_NO_SLOT)
        e->of_slot[p.slot] = (int)e->property_count;
    e->has_list = e->has_list || p.is_list;
    e->least_bytes += s->format == PLY_ASCII ? 2 : ply_type_bytes(p.is_list ? p.count_type : p.type);
    e->property_count++;
    h->properties[h->property_count++] = p;
    return AG_OK;
}

static ag_status read_magic(ply_stream *s)
{
    AG_TRY(ply_fill(s, 5));
    const unsigned char *b = s->bytes;
    if (s->end < 4 || memcmp(b, "ply", 3) != 0 || (b[3] != '\n' && b[3] != '\r'))
        return ply_fail(s, "this is no PLY file: it does not begin with a line \"ply\"");
    if (b[3] == '\r' && b[4] != '\n')
        s->line_end = '\r';
    char line[8];
    bool is_end;
    AG_TRY(ply_read_line(s, line, sizeof line, &is_end));
    s->line++;
    return AG_OK;
}

static ag_status check_header(ply_stream *s, const ply_header *h)
{
    static const char *const NAMES = "xyz";
    if (s->format == PLY_NO_FORMAT)
        return ply_fail(s, "the header has no format");
    if (!h->vertex || !h->face)
        return ply_fail(s, "the header has no element \"%s\"", h->vertex ? "face" : "vertex");
    for (int i = PLY_X; i <= PLY_Z; i++)
        if (h->vertex->of_slot[i] < 0)
            return ply_fail(s, "vertices have no property \"%c\"", NAMES[i]);
    if (h->face->of_slot[PLY_CORNERS] < 0)
        return ply_fail(s, "faces have no list \"vertex_indices\" or \"vertex_index\"");
    if (h->vertex->count >= UINT32_MAX / 4)
        return ply_fail(s, "%llu vertices are too many", (unsigned long long)h->vertex->count);
    return AG_OK;
}

ag_status ply_header_read(ply_stream *s, ply_header *out_header)
{
    memset(out_header, 0, sizeof *out_header);
    AG_TRY(read_magic(s));
    for (;; s->line++) {
        char line[LINE_BYTES], *words[MAX_WORDS];
        bool is_end;
        AG_TRY(ply_read_line(s, line, sizeof line, &is_end));
        if (is_end)
            return ply_fail(s, "the file ends within its header");
        int count = split(line, words);
        if (count == 0 || strcmp(words[0], "comment") == 0 || strcmp(words[0], "obj_info") == 0)
            continue;
        ag_status status;
        if (strcmp(words[0], "end_header") == 0 && count == 1)
            break;
        else if (strcmp(words[0], "format") == 0)
            status = read_format(s, count, words);
        else if (s->format == PLY_NO_FORMAT)
            status = ply_fail(s, "the format should come first, not \"%.40s\"", words[0]);
        else if (strcmp(words[0], "element") == 0)
            status = read_element(s, count, words, out_header);
        else if (strcmp(words[0], "property") == 0)
            status = read_property(s, count, words, out_header);
        else
            status = ply_fail(s, "unknown word \"%.40s\"", words[0]);
        AG_TRY(status);
    }
    AG_TRY(check_header(s, out_header));
    s->line++;
    return AG_OK;
}

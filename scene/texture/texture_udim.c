/* texture_udim.c: see texture_udim.h. */
#define _POSIX_C_SOURCE 200809L
#include "texture/texture_udim.h"

#include "log.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* --- names --- */

typedef enum token_kind { TOKEN_UDIM, TOKEN_UVTILE } token_kind;

static const char *const TOKENS[] = {"<UDIM>", "<UVTILE>"};

/* The token in the last part of a path, or NULL. */
static const char *find_token(const char *path, token_kind *out_kind)
{
    const char *slash = strrchr(path, '/');
    for (const char *at = slash ? slash : path; *at; at++)
        for (int kind = 0; kind < 2; kind++)
            if (strncasecmp(at, TOKENS[kind], strlen(TOKENS[kind])) == 0) {
                *out_kind = (token_kind)kind;
                return at;
            }
    return NULL;
}

bool texture_udim_is_pattern(const char *path)
{
    token_kind kind;
    return find_token(path, &kind) != NULL;
}

bool texture_udim_is_ambiguous(const char *path)
{
    token_kind kind;
    const char *token = find_token(path, &kind);
    return token && find_token(token + strlen(TOKENS[kind]), &kind);
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Digits without leading zeros, 1 to 4 of them; NULL where there are none. */
static const char *read_number(const char *text, uint32_t *out_number)
{
    uint32_t count = 0;
    *out_number = 0;
    if (*text == '0')
        return NULL;
    for (; is_digit(text[count]) && count < 5; count++)
        *out_number = 10 * *out_number + (uint32_t)(text[count] - '0');
    return count >= 1 && count <= 4 ? text + count : NULL;
}

/* The tile's number or coordinates that stand for the token at the beginning of text; gives what follows, or NULL where
 * that is no tile. */
static const char *read_slot(const char *text, token_kind kind, uint32_t *out_slot)
{
    uint32_t column, row;
    if (kind == TOKEN_UDIM) {
        const char *end = read_number(text, &row);
        if (!end || row < 1001)
            return NULL;
        *out_slot = row - 1001;
        return end;
    }
    const char *at = *text == 'u' ? read_number(text + 1, &column) : NULL;
    at = at && at[0] == '_' && at[1] == 'v' ? read_number(at + 2, &row) : NULL;
    if (!at || column > TEXTURE_UDIM_COLUMNS || row > TEXTURE_UDIM_SLOTS / TEXTURE_UDIM_COLUMNS)
        return NULL;
    *out_slot = column - 1 + TEXTURE_UDIM_COLUMNS * (row - 1);
    return at;
}

static int compare_slots(const void *a, const void *b) { return *(const uint16_t *)a - *(const uint16_t *)b; }

ag_status texture_udim_find(const char *path, uint16_t **out_slots, uint32_t *out_count)
{
    token_kind kind = TOKEN_UDIM;
    const char *token = find_token(path, &kind), *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path, *after = token + strlen(TOKENS[kind]);
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    uint16_t *slots = malloc(TEXTURE_UDIM_SLOTS * sizeof *slots);
    uint32_t count = 0;
    if (!folder || !slots) {
        free(folder);
        free(slots);
        return AG_ERROR_MEMORY;
    }
    DIR *entries = opendir(folder);
    for (struct dirent *e = entries ? readdir(entries) : NULL; e && count < TEXTURE_UDIM_SLOTS; e = readdir(entries)) {
        const size_t length = (size_t)(token - name);
        uint32_t slot;
        const char *rest = strncmp(e->d_name, name, length) == 0 ? read_slot(e->d_name + length, kind, &slot) : NULL;
        if (rest && strcmp(rest, after) == 0)
            slots[count++] = (uint16_t)slot;
    }
    if (entries)
        closedir(entries);
    free(folder);
    qsort(slots, count, sizeof *slots, compare_slots);
    *out_slots = slots;
    *out_count = count;
    return AG_OK;
}

char *texture_udim_file(const char *path, uint32_t slot)
{
    token_kind kind = TOKEN_UDIM;
    const char *token = find_token(path, &kind);
    const size_t size = strlen(path) + 16;
    char *file = malloc(size);
    if (!file)
        return NULL;
    if (kind == TOKEN_UDIM)
        snprintf(file, size, "%.*s%u%s", (int)(token - path), path, 1001 + slot, token + strlen(TOKENS[kind]));
    else
        snprintf(file, size, "%.*su%u_v%u%s", (int)(token - path), path, slot % TEXTURE_UDIM_COLUMNS + 1,
                 slot / TEXTURE_UDIM_COLUMNS + 1, token + strlen(TOKENS[kind]));
    return file;
}

void texture_udim_destroy(texture_udim *u)
{
    if (u)
        free(u->tiles);
    free(u);
}

/* --- looking up --- */

static const texture_image *tile_at(const texture_udim *u, float column, float row)
{
    if (!(column >= 0.0f && column < (float)TEXTURE_UDIM_COLUMNS && row >= 0.0f && row < 900.0f))
        return NULL;
    const uint32_t slot = (uint32_t)column + TEXTURE_UDIM_COLUMNS * (uint32_t)row;
    return slot < u->slot_count ? u->tiles[slot] : NULL;
}

static void note_missed(texture_udim *u, float column, float row)
{
    const bool is_slot = column >= 0.0f && column < (float)TEXTURE_UDIM_COLUMNS && row >= 0.0f && row < 900.0f;
    const uint32_t slot = is_slot ? (uint32_t)column + TEXTURE_UDIM_COLUMNS * (uint32_t)row : TEXTURE_UDIM_SLOTS;
    atomic_u32 *word = slot < TEXTURE_UDIM_SLOTS ? &u->missed[slot / 32] : &u->is_outside;
    const uint32_t bit = slot < TEXTURE_UDIM_SLOTS ? UINT32_C(1) << slot % 32 : 1;
    if (!(load_relaxed_u32(word) & bit)) /* so that it is not written again and again */
        fetch_or_relaxed_u32(word, bit);
}

bool texture_udim_enter(const texture_image **in_out_picture, texture_wraps *out_wraps, float *in_out_s,
                        float *in_out_t)
{
    static const float BORDER = 1e-4f;
    texture_udim *u = (*in_out_picture)->udim;
    const float s = *in_out_s, up = 1.0f - *in_out_t;
    const float columns[3] = {floorf(s), floorf(s - BORDER), floorf(s + BORDER)},
                rows[3] = {floorf(up), floorf(up - BORDER), floorf(up + BORDER)};
    for (int k = 0; k < 9; k++) {
        const float column = columns[k % 3], row = rows[k / 3];
        const texture_image *tile = tile_at(u, column, row);
        if (!tile)
            continue;
        *in_out_picture = tile;
        *out_wraps = texture_wraps_same(TEXTURE_WRAP_CLAMP);
        *in_out_s = s - column;
        *in_out_t = 1.0f - (up - row);
        return true;
    }
    note_missed(u, columns[0], rows[0]);
    return false;
}

hash128 texture_udim_content(const texture_udim *u)
{
    hash128 h = hash128_begin();
    HASH128_ADD(&h, u->slot_count);
    for (uint32_t k = 0; k < u->slot_count; k++) {
        const bool is_there = u->tiles[k] != NULL;
        HASH128_ADD(&h, is_there);
    }
    return h;
}

void texture_udim_tell_missed(const texture_image *i, struct log_sink *log)
{
    enum { NAMED = 8 };
    const texture_udim *u = i->udim;
    char list[16 * NAMED] = "", key[4096];
    uint32_t count = 0;
    size_t used = 0;
    for (uint32_t slot = 0; slot < TEXTURE_UDIM_SLOTS; slot++)
        if (load_relaxed_u32(&u->missed[slot / 32]) >> slot % 32 & 1 && count++ < NAMED)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%u", used > 0 ? ", " : "", 1001 + slot);
    const bool is_outside = load_relaxed_u32(&u->is_outside) != 0;
    if (count == 0 && !is_outside)
        return;
    snprintf(key, sizeof key, "udim:%s", i->path);
    log_once(log, AG_LOG_WARNING, key, "'%s': texture coordinates lie %s%s%s%s%s, where it is black", i->path,
             count > 0 ? "on tiles of which there is no file (" : "", list, count > NAMED ? ", ..." : "",
             count > 0 ? ")" : "",
             !is_outside ? ""
             : count > 0 ? " and outside of all tiles"
                         : "outside of all tiles");
}

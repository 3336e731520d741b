/* pbrt_lexer.c: see pbrt_lexer.h.
 * Threads: one at a time. */
#include "pbrt/pbrt_lexer.h"

#include "text/decimal.h"
#include "text/excerpt.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int clamp_to_int(ptrdiff_t v) { return v > INT_MAX ? INT_MAX : (int)v; }

static file_location location_at(const pbrt_lexer *lexer, const char *at)
{
    return (file_location){lexer->file, lexer->line, clamp_to_int(at - lexer->line_start + 1)};
}

void pbrt_lexer_init(pbrt_lexer *lexer, const char *file, const char *text, size_t size)
{
    memset(lexer, 0, sizeof *lexer);
    lexer->text = text;
    lexer->end = text + size;
    lexer->file = file;
    lexer->line = 1;
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) /* the byte order mark of UTF-8 says nothing */
        text += 3;
    lexer->next = lexer->line_start = text;
}

void pbrt_lexer_reset(pbrt_lexer *lexer)
{
    free(lexer->unescaped);
    memset(lexer, 0, sizeof *lexer);
}

/* Skips blanks, line ends and comments. */
static void skip_blanks(pbrt_lexer *lexer)
{
    const char *p = lexer->next;
    for (;;) {
        if (*p == ' ' || *p == '\t' || *p == '\r') {
            p++;
        } else if (*p == '\n') {
            p++;
            if (lexer->line < INT_MAX)
                lexer->line++;
            lexer->line_start = p;
        } else if (*p == '#') {
            while (*p != '\n' && *p != '\r' && *p != '\0')
                p++;
        } else {
            break;
        }
    }
    lexer->next = p;
}

static bool is_word_byte(char c) { return c > ' ' && c < 0x7f && c != '"' && c != '[' && c != ']' && c != '#'; }

static ag_status fail(pbrt_lexer *lexer, pbrt_token *out_token, const char *at, const char *message)
{
    snprintf(lexer->error, sizeof lexer->error, "%s", message);
    out_token->where = location_at(lexer, at);
    out_token->width = 1;
    return AG_ERROR_SCENE;
}

static ag_status fail_strange_byte(pbrt_lexer *lexer, pbrt_token *out_token, const char *at)
{
    if (*at == '\0')
        return fail(lexer, out_token, at, "NUL byte: this is not a text file");
    if (at - lexer->text <= 1 && (memcmp(lexer->text, "\xff\xfe", 2) == 0 || memcmp(lexer->text, "\xfe\xff", 2) == 0))
        return fail(lexer, out_token, at, "the file is UTF-16; only ASCII and UTF-8 can be read");
    char message[sizeof lexer->error];
    snprintf(message, sizeof message, "unexpected byte 0x%02x", (unsigned)(unsigned char)*at);
    return fail(lexer, out_token, at, message);
}

static bool unescape(char c, char *out)
{
    static const char NAMES[] = "bfnrt\\'\"", VALUES[] = "\b\f\n\r\t\\'\"";
    const char *found = c ? strchr(NAMES, c) : NULL;
    if (!found)
        return false;
    *out = VALUES[found - NAMES];
    return true;
}

static ag_status read_string(pbrt_lexer *lexer, pbrt_token *out_token)
{
    const char *start = lexer->next, *p = start + 1;
    size_t escapes = 0;
    for (; *p != '"'; p++) {
        if (*p == '\n' || *p == '\r' || p >= lexer->end)
            return fail(lexer, out_token, start, "unterminated string");
        if (*p == '\0')
            return fail_strange_byte(lexer, out_token, p);
        if ((unsigned char)*p < ' ' && *p != '\t')
            return fail_strange_byte(lexer, out_token, p);
        if (*p == '\\') {
            char value;
            if (p + 1 >= lexer->end || p[1] == '\n' || p[1] == '\r')
                return fail(lexer, out_token, start, "unterminated string");
            if (!unescape(p[1], &value))
                return fail(lexer, out_token, p, "unknown escape in a string");
            p++;
            escapes++;
        }
    }
    out_token->kind = PBRT_TOKEN_STRING;
    out_token->text = start + 1;
    out_token->length = (size_t)(p - start - 1) - escapes;
    lexer->next = p + 1;
    out_token->width = (size_t)(lexer->next - start);
    if (escapes == 0)
        return AG_OK;
    if (lexer->unescaped_capacity < out_token->length) {
        char *larger = realloc(lexer->unescaped, out_token->length);
        if (!larger)
            return AG_ERROR_MEMORY;
        lexer->unescaped = larger;
        lexer->unescaped_capacity = out_token->length;
    }
    char *out = lexer->unescaped;
    for (const char *q = start + 1; q < p; q++) {
        if (*q == '\\')
            unescape(*++q, out++);
        else
            *out++ = *q;
    }
    out_token->text = lexer->unescaped;
    return AG_OK;
}

/* Returns what stands behind the part of a word at p, a byte or ${...}, whatever stands in that. */
static const char *skip_word_part(const char *p)
{
    if (p[0] == '$' && p[1] == '{') {
        const char *q = p + 2;
        while (*q != '}' && ((unsigned char)*q >= ' ' || *q == '\t'))
            q++;
        if (*q == '}')
            return q + 1;
    }
    return p + 1;
}

ag_status pbrt_lexer_next(pbrt_lexer *lexer, pbrt_token *out_token)
{
    skip_blanks(lexer);
    const char *start = lexer->next;
    *out_token = (pbrt_token){.where = location_at(lexer, start), .width = 1, .text = start, .length = 1};
    if (start >= lexer->end) {
        out_token->kind = PBRT_TOKEN_END;
        out_token->length = out_token->width = 0;
        return AG_OK;
    }
    if (*start == '"')
        return read_string(lexer, out_token);
    if (*start == '[' || *start == ']') {
        out_token->kind = *start == '[' ? PBRT_TOKEN_OPEN : PBRT_TOKEN_CLOSE;
        lexer->next++;
        return AG_OK;
    }
    const char *p = start;
    while (is_word_byte(*p))
        p = skip_word_part(p);
    if (p == start)
        return fail_strange_byte(lexer, out_token, p);
    out_token->kind = PBRT_TOKEN_WORD;
    out_token->length = out_token->width = (size_t)(p - start);
    lexer->next = p;
    return AG_OK;
}

size_t pbrt_lexer_numbers(pbrt_lexer *lexer, size_t max, double *out_values)
{
    size_t count = 0;
    while (count < max) {
        skip_blanks(lexer);
        char c = *lexer->next;
        if (!((c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'))
            break;
        const char *behind = decimal_parse(lexer->next, &out_values[count]);
        if (!behind || is_word_byte(*behind) || !isfinite(out_values[count]))
            break;
        lexer->next = behind;
        count++;
    }
    return count;
}

bool pbrt_token_number(const pbrt_token *token, double *out_value)
{
    /* the byte behind a word is never part of a number, so the number cannot reach past it */
    return token->kind == PBRT_TOKEN_WORD && decimal_parse(token->text, out_value) == token->text + token->length;
}

bool pbrt_token_is(const pbrt_token *token, pbrt_token_kind kind, const char *text)
{
    return token->kind == kind && strlen(text) == token->length && memcmp(token->text, text, token->length) == 0;
}

void pbrt_lexer_excerpt(const pbrt_lexer *lexer, file_location where, size_t width, char *out_text, size_t size)
{
    text_excerpt(lexer->text, (size_t)(lexer->end - lexer->text), where, width, out_text, size);
}

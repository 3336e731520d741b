/* text_lines.c: see text_lines.h. Threads: one at a time. */
#include "text/text_lines.h"

#include "text/decimal.h"
#include "text/excerpt.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

void text_lines_init(text_lines *lines, log_sink *log, const char *file, const char *text, size_t size)
{
    memset(lines, 0, sizeof *lines);
    lines->log = log;
    lines->file = file;
    lines->text = text;
    lines->end = text + size;
    bool has_mark = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0; /* of UTF-8 */
    lines->line_start = lines->line_end = lines->at = text + (has_mark ? 3 : 0);
    lines->line = 1;
}

/* The end of the line that begins there, before its line end. */
static const char *find_end(const text_lines *lines, const char *start)
{
    const char *end = memchr(start, '\n', (size_t)(lines->end - start));
    return end ? end : lines->end;
}

static bool goes_on(const text_lines *lines, const char *start, const char *end)
{
    if (end == lines->end) /* there is no line behind it, nor with "\\\r" at the very end */
        return false;
    if (end > start && end[-1] == '\r')
        end--;
    return end > start && end[-1] == '\\';
}

static void find_line(text_lines *lines, const char *start)
{
    lines->line_start = lines->at = start;
    lines->lines_in_line = 1;
    const char *end = find_end(lines, start);
    for (const char *part = start; goes_on(lines, part, end); lines->lines_in_line++) {
        part = end + 1;
        end = find_end(lines, part);
    }
    lines->line_end = end;
}

/* A blank, or a backslash before a line end. */
static bool is_blank(const char *c, const char *end)
{
    if (*c == '\\') {
        const char *next = c + 1 < end && c[1] == '\r' ? c + 2 : c + 1;
        return next < end && *next == '\n';
    }
    return *c == ' ' || *c == '\t' || *c == '\r' || *c == '\n' || *c == '\v' || *c == '\f';
}

static bool skip_blanks(text_lines *lines)
{
    while (lines->at < lines->line_end && is_blank(lines->at, lines->line_end))
        lines->at++;
    return lines->at < lines->line_end && *lines->at != '#';
}

bool text_lines_next(text_lines *lines)
{
    for (;;) {
        const char *next = lines->lines_in_line == 0 ? lines->line_start : lines->line_end + 1;
        if (next >= lines->end)
            return false;
        lines->line += lines->lines_in_line;
        find_line(lines, next);
        if (skip_blanks(lines))
            return true;
    }
}

bool text_lines_word(text_lines *lines, text_word *out_word)
{
    if (!skip_blanks(lines)) {
        *out_word = (text_word){lines->at, 0};
        return false;
    }
    out_word->text = lines->at;
    while (lines->at < lines->line_end && !is_blank(lines->at, lines->line_end))
        lines->at++;
    out_word->length = (size_t)(lines->at - out_word->text);
    return true;
}

text_word text_lines_rest(text_lines *lines)
{
    skip_blanks(lines);
    const char *start = lines->at, *end = lines->line_end;
    while (end > start && is_blank(end - 1, lines->line_end))
        end--;
    lines->at = lines->line_end;
    return (text_word){start, (size_t)(end - start)};
}

bool text_word_is(const text_word *word, const char *text)
{
    return strlen(text) == word->length && strncasecmp(word->text, text, word->length) == 0;
}

bool text_word_number(const text_word *word, double *out_value)
{
    return decimal_parse(word->text, out_value) == word->text + word->length && word->length > 0 &&
           isfinite(*out_value);
}

ag_status text_lines_number(text_lines *lines, const char *what, double *out_value)
{
    text_word word;
    if (!text_lines_word(lines, &word))
        return text_lines_refuse(lines, word, "%s is missing", what);
    if (!text_word_number(&word, out_value))
        return text_lines_refuse(lines, word, "%s should be a finite number", what);
    return AG_OK;
}

file_location text_lines_where(const text_lines *lines, const char *at)
{
    int line = lines->line;
    const char *start = lines->line_start;
    for (const char *c = start; c < at; c++)
        if (*c == '\n') {
            line++;
            start = c + 1;
        }
    return (file_location){lines->file, line, (int)(at - start) + 1};
}

ag_status text_lines_refuse(const text_lines *lines, text_word word, const char *format, ...)
{
    char excerpt[320];
    file_location where = text_lines_where(lines, word.text);
    text_excerpt(lines->text, (size_t)(lines->end - lines->text), where, word.length > 0 ? word.length : 1, excerpt,
                 sizeof excerpt);
    va_list arguments;
    va_start(arguments, format);
    log_at_with_excerpt(lines->log, where, excerpt, format, arguments);
    va_end(arguments);
    return AG_ERROR_SCENE;
}

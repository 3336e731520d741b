/* file_location.c: see file_location.h. */
#include "text/file_location.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const LEVEL_NAMES[] = {"error", "warning", "info", "debug"};

/* The formatted text, in fixed if it fits, else from the heap; *out_heap is to be freed. */
static const char *format_text(char *fixed, size_t fixed_size, const char *format, va_list arguments, char **out_heap)
{
    va_list again;
    va_copy(again, arguments);
    *out_heap = NULL;
    int length = vsnprintf(fixed, fixed_size, format, arguments);
    if (length >= 0 && (size_t)length >= fixed_size) {
        *out_heap = malloc((size_t)length + 1);
        if (*out_heap)
            vsnprintf(*out_heap, (size_t)length + 1, format, again);
    }
    va_end(again);
    return *out_heap ? *out_heap : fixed;
}

static void log_located(log_sink *log, ag_log_level level, file_location where, const char *key, const char *text)
{
    char position[32] = "";
    if (where.file && where.line > 0)
        snprintf(position, sizeof position, "%d:%d:", where.line, where.column);
    const char *file = where.file ? where.file : "", *colon = where.file ? ":" : "", *gap = where.file ? " " : "";
    if (key)
        log_once(log, level, key, "%s%s%s%s%s: %s", file, colon, position, gap, LEVEL_NAMES[level], text);
    else
        log_message(log, level, "%s%s%s%s%s: %s", file, colon, position, gap, LEVEL_NAMES[level], text);
}

void log_at(log_sink *log, ag_log_level level, file_location where, const char *format, ...)
{
    char fixed[512], *heap;
    va_list arguments;
    va_start(arguments, format);
    const char *text = format_text(fixed, sizeof fixed, format, arguments, &heap);
    va_end(arguments);
    log_located(log, level, where, NULL, text);
    free(heap);
}

void log_at_with_excerpt(log_sink *log, file_location where, const char *excerpt, const char *format, va_list arguments)
{
    char fixed[512], *heap;
    const char *text = format_text(fixed, sizeof fixed, format, arguments, &heap);
    log_at(log, AG_LOG_ERROR, where, "%s%s", text, excerpt);
    free(heap);
}

void log_at_once(log_sink *log, ag_log_level level, file_location where, const char *key, const char *format, ...)
{
    char fixed[512], *heap;
    va_list arguments;
    va_start(arguments, format);
    const char *text = format_text(fixed, sizeof fixed, format, arguments, &heap);
    va_end(arguments);
    log_located(log, level, where, key, text);
    free(heap);
}

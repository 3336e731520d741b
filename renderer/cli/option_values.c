/* option_values.c: see option_values.h. */
#include "option_values.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool parse_integer(const char *text, long long least, long long most, long long *out_value)
{
    char *end;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    if (end == text || *end || errno || value < least || value > most)
        return false;
    *out_value = value;
    return true;
}

bool parse_int(const char *text, int least, int most, int *out_value)
{
    long long value;
    if (!parse_integer(text, least, most, &value))
        return false;
    *out_value = (int)value;
    return true;
}

bool parse_float(const char *text, float *out_value)
{
    char *end;
    *out_value = strtof(text, &end);
    return end != text && !*end;
}

bool parse_floats(const char *text, int most, float *out_values, int *out_count)
{
    for (*out_count = 0; *out_count < most;) {
        char *end;
        float value = strtof(text, &end);
        if (end == text || !isfinite(value) || (*end && *end != ','))
            return false;
        out_values[(*out_count)++] = value;
        if (!*end)
            return true;
        text = end + 1;
    }
    return false;
}

bool parse_seconds(const char *text, double *out_seconds)
{
    char *end;
    *out_seconds = strtod(text, &end);
    return end != text && !*end && *out_seconds > 0.0 && !isinf(*out_seconds);
}

bool parse_time(const char *text, double *out_seconds)
{
    int hours, minutes, seconds, used = 0;
    if (!strchr(text, ':'))
        return parse_seconds(text, out_seconds);
    if (sscanf(text, "%6d:%2d:%2d%n", &hours, &minutes, &seconds, &used) != 3 || text[used] || hours < 0 ||
        minutes < 0 || minutes > 59 || seconds < 0 || seconds > 59)
        return false;
    *out_seconds = 3600.0 * hours + 60.0 * minutes + seconds;
    return *out_seconds > 0.0;
}

bool parse_tile(const char *text, int *out_index, int *out_count)
{
    int used = 0;
    return sscanf(text, "%6d/%6d%n", out_index, out_count, &used) == 2 && text[used] == '\0' && *out_index >= 1 &&
           *out_index <= *out_count;
}

bool parse_word(const char *text, const char *const *words, int count, int *out_index)
{
    for (*out_index = 0; *out_index < count; ++*out_index)
        if (strcmp(text, words[*out_index]) == 0)
            return true;
    return false;
}

bool parse_bytes(const char *text, uint64_t *out_bytes)
{
    static const char UNITS[] = "KMGT";
    char number[32];
    const size_t length = strlen(text);
    const char *unit = length > 0 ? strchr(UNITS, text[length - 1]) : NULL;
    double bytes;
    if (length == 0 || length >= sizeof number)
        return false;
    memcpy(number, text, length + 1);
    if (unit)
        number[length - 1] = '\0';
    if (!parse_seconds(number, &bytes))
        return false;
    for (int i = 0; unit && i <= unit - UNITS; i++)
        bytes *= 1024.0;
    if (!(bytes >= 1.0 && bytes < 0x1p63))
        return false;
    *out_bytes = (uint64_t)bytes;
    return true;
}

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

bool parse_unsigned(const char *text, uint64_t most, uint64_t *out_value)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end || errno || value > most)
        return false;
    *out_value = value;
    return true;
}

bool parse_count(const char *text, uint64_t least, uint64_t *out_value)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= (double)least) || value > 4294967294.0 || value != floor(value))
        return false;
    *out_value = (uint64_t)value;
    return true;
}

bool parse_float(const char *text, float *out_value)
{
    char *end;
    *out_value = strtof(text, &end);
    return end != text && !*end;
}

bool parse_bound(const char *text, float *out_value)
{
    return parse_float(text, out_value) && *out_value >= 0.0f && !isinf(*out_value);
}

bool parse_fraction(const char *text, float *out_value)
{
    return parse_float(text, out_value) && *out_value > 0.0f && *out_value <= 1.0f;
}

bool parse_share(const char *text, float *out_value)
{
    return parse_float(text, out_value) && *out_value >= 0.0f && *out_value <= 1.0f;
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

bool parse_size(const char *text, int *out_width, int *out_height)
{
    int used = 0;
    return sscanf(text, "%6dx%6d%n", out_width, out_height, &used) == 2 && text[used] == '\0' && *out_width >= 1 &&
           *out_height >= 1 && *out_width <= 65536 && *out_height <= 65536;
}

bool parse_tile(const char *text, int *out_index, int *out_count)
{
    int used = 0;
    return sscanf(text, "%6d/%6d%n", out_index, out_count, &used) == 2 && text[used] == '\0' && *out_index >= 1 &&
           *out_index <= *out_count;
}

bool parse_crop(const char *text, double crop[4])
{
    int used = 0;
    return sscanf(text, "%lf,%lf,%lf,%lf%n", &crop[0], &crop[1], &crop[2], &crop[3], &used) == 4 &&
           text[used] == '\0' && crop[0] >= 0.0 && crop[0] < crop[1] && crop[1] <= 1.0 && crop[2] >= 0.0 &&
           crop[2] < crop[3] && crop[3] <= 1.0;
}

bool parse_word(const char *text, const char *const *words, int count, int *out_index)
{
    for (*out_index = 0; *out_index < count; ++*out_index)
        if (strcmp(text, words[*out_index]) == 0)
            return true;
    return false;
}

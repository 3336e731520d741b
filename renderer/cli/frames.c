/* frames.c: see frames.h. */
#include "frames.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBER_MAX = 99999999, DIGITS_MAX = 16 };

static bool read_number(const char **in_out_text, int *out_number)
{
    long number = 0;
    const char *c = *in_out_text;
    for (; *c >= '0' && *c <= '9' && number <= NUMBER_MAX; c++)
        number = 10 * number + (*c - '0');
    if (c == *in_out_text || number > NUMBER_MAX)
        return false;
    *in_out_text = c;
    *out_number = (int)number;
    return true;
}

static bool add_range(frame_list *frames, int first, int last, int step)
{
    int count = abs(last - first) / step + 1;
    if (count > FRAMES_MAX - frames->count)
        return false;
    int *larger = realloc(frames->numbers, (size_t)(frames->count + count) * sizeof *larger);
    if (!larger)
        return false;
    frames->numbers = larger;
    for (int i = 0; i < count; i++)
        frames->numbers[frames->count++] = first + (last < first ? -step : step) * i;
    return true;
}

bool frames_parse(const char *text, frame_list *out_frames)
{
    frame_list frames = {0};
    bool is_valid = true;
    do {
        int first = 0, last, step = 1;
        is_valid = read_number(&text, &first);
        last = first;
        if (is_valid && *text == '-') {
            text++;
            is_valid = read_number(&text, &last);
            if (is_valid && *text == 'x') {
                text++;
                is_valid = read_number(&text, &step) && step > 0;
            }
        }
        is_valid = is_valid && (*text == ',' || !*text) && add_range(&frames, first, last, step);
    } while (is_valid && *text++ == ',');
    if (is_valid)
        *out_frames = frames;
    else
        frames_reset(&frames);
    return is_valid;
}

void frames_reset(frame_list *frames)
{
    free(frames->numbers);
    *frames = (frame_list){0};
}

/* Returns the length of a placeholder at the beginning of the text, 0: there is none; and finds its digits. */
static int placeholder_at(const char *text, int *out_digits)
{
    int used = (int)strspn(text, "#");
    *out_digits = used;
    if (used > 0 && used <= DIGITS_MAX)
        return used;
    *out_digits = 1;
    if (text[0] != '%')
        return 0;
    if (text[1] == 'd')
        return 2;
    if (text[1] != '0' || text[2] < '1' || text[2] > '9' || text[3] != 'd')
        return 0;
    *out_digits = text[2] - '0';
    return 4;
}

bool frames_has_placeholder(const char *name)
{
    int digits;
    for (; *name; name++)
        if (placeholder_at(name, &digits) > 0)
            return true;
    return false;
}

char *frames_name(const char *name, int frame)
{
    char *made = malloc(strlen(name) * DIGITS_MAX + 1); /* no placeholder is shorter than a character */
    size_t length = 0;
    for (; made && *name;) {
        int digits, used = placeholder_at(name, &digits);
        if (used > 0)
            length += (size_t)sprintf(made + length, "%0*d", digits, frame);
        else
            made[length++] = *name;
        name += used > 0 ? used : 1;
    }
    if (made)
        made[length] = '\0';
    return made;
}

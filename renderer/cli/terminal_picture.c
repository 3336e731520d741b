/* terminal_picture.c: see terminal_picture.h. */
#define _DEFAULT_SOURCE
#include "terminal_picture.h"

#include "sixel.h"

#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { LEAST_COLUMNS = 20, LEAST_ROWS = 6, FREE_COLUMNS = 1, FREE_ROWS = 2 };

bool terminal_picture_room(int descriptor, terminal_size *out_size)
{
    struct winsize size;
    if (ioctl(descriptor, TIOCGWINSZ, &size) != 0)
        return false;
    *out_size = (terminal_size){size.ws_col, size.ws_row, size.ws_col > 0 ? size.ws_xpixel / size.ws_col : 0,
                                size.ws_row > 0 ? size.ws_ypixel / size.ws_row : 0};
    return size.ws_col >= LEAST_COLUMNS && size.ws_row >= LEAST_ROWS;
}

const char *terminal_picture_obstacle(int descriptor)
{
    terminal_size size;
    const char *kind = getenv("TERM");
    if (!isatty(descriptor))
        return "standard error is no terminal";
    if (!kind || strcmp(kind, "") == 0 || strcmp(kind, "dumb") == 0)
        return "the terminal knows no colours ($TERM)";
    return terminal_picture_room(descriptor, &size) ? NULL : "the terminal is too small, or does not tell its size";
}

void terminal_picture_fit(int width, int height, const terminal_size *terminal, bool is_by_sixels, int *out_width,
                          int *out_height)
{
    const double cell_width = is_by_sixels ? terminal->cell_width : 1.0,
                 cell_height = is_by_sixels ? terminal->cell_height : 2.0;
    const double across = cell_width * (terminal->columns - FREE_COLUMNS) / width,
                 down = cell_height * (terminal->rows - FREE_ROWS) / height;
    double scale = across < down ? across : down;
    scale = scale < 1.0 ? scale : 1.0;
    *out_width = (int)(width * scale + 1e-6);
    *out_height = (int)(height * scale + 1e-6);
    *out_width = *out_width > 0 ? *out_width : 1;
    *out_height = *out_height > 0 ? *out_height : 1;
}

void terminal_picture_reduce(const float *pixels, int width, int height, float *out_means, int out_width,
                             int out_height)
{
    for (int v = 0; v < out_height; v++)
        for (int u = 0; u < out_width; u++) {
            const int x0 = (int)((long long)u * width / out_width), x1 = (int)((u + 1LL) * width / out_width),
                      y0 = (int)((long long)v * height / out_height), y1 = (int)((v + 1LL) * height / out_height);
            double sum[3] = {0.0, 0.0, 0.0};
            for (int y = y0; y < y1; y++)
                for (int x = x0; x < x1; x++)
                    for (int c = 0; c < 3; c++)
                        sum[c] += (double)pixels[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c];
            for (int c = 0; c < 3; c++)
                *out_means++ = (float)(sum[c] / ((double)(x1 - x0) * (y1 - y0)));
        }
}

static int byte_of(float value) { return value > 0.0f ? (int)((value < 1.0f ? value : 1.0f) * 255.0f + 0.5f) : 0; }

/* Sets a colour unless it is the one set last. layer: 38 for the upper half, 48 for the lower one. */
static void write_color(FILE *file, int layer, const float *rgb, int last[3])
{
    const int now[3] = {byte_of(rgb[0]), byte_of(rgb[1]), byte_of(rgb[2])};
    if (memcmp(now, last, sizeof now) == 0)
        return;
    memcpy(last, now, sizeof now);
    fprintf(file, "\033[%d;2;%d;%d;%dm", layer, now[0], now[1], now[2]);
}

int terminal_picture_write(FILE *file, const float *shown, int width, int height)
{
    for (int y = 0; y < height; y += 2) {
        int upper[3] = {-1, -1, -1}, lower[3] = {-1, -1, -1};
        for (int x = 0; x < width; x++) {
            const float *pixel = shown + 3 * ((size_t)y * (size_t)width + (size_t)x);
            write_color(file, 38, pixel, upper);
            if (y + 1 < height)
                write_color(file, 48, pixel + 3 * (size_t)width, lower);
            fputs("\xe2\x96\x80", file);
        }
        fputs("\033[0m\033[K\n", file);
    }
    return (height + 1) / 2;
}

int terminal_picture_write_sixels(FILE *file, const float *shown, int width, int height, const terminal_size *terminal,
                                  int color_count, int drawn_rows)
{
    const int rows = (height + terminal->cell_height - 1) / terminal->cell_height;
    char *text = NULL;
    size_t length;
    FILE *made = open_memstream(&text, &length);
    if (!made)
        return 0;
    bool is_whole = sixel_write(made, shown, width, height, color_count);
    is_whole = fclose(made) == 0 && is_whole;
    if (is_whole) {
        fputc('\r', file);
        if (rows != drawn_rows) {
            terminal_picture_erase(file, drawn_rows);
            for (int i = 0; i < rows; i++)
                fputc('\n', file); /* makes the terminal scroll now, not while it draws */
        }
        /* terminals differ in where a picture leaves the cursor */
        fprintf(file, "\033[%dA\0337", rows);
        fwrite(text, 1, length, file);
        fprintf(file, "\0338\033[%dB\r", rows);
    }
    free(text);
    return is_whole ? rows : 0;
}

void terminal_picture_erase(FILE *file, int rows)
{
    fputc('\r', file);
    if (rows > 0)
        fprintf(file, "\033[%dA", rows);
    fputs("\033[J", file);
}

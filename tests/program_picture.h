/* program_picture.h: pictures that the program has rendered, and means over blocks of their pixels.
 * Flow: program_run.h -> [here] -> tests/test_program_*.c. Threads: one. */
#ifndef AFTERGLOW_PROGRAM_PICTURE_H
#define AFTERGLOW_PROGRAM_PICTURE_H

#include "image_reader.h"
#include "program_run.h"

#include <math.h>

typedef struct picture {
    int width, height;
    float *pixels; /* RGB, top row first; owned */
} picture;

static inline picture picture_read(const char *path)
{
    image read;
    if (image_read(path, &read, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
    assert_int_equal(read.channel_count, 3);
    return (picture){read.width, read.height, read.pixels};
}

static inline void picture_reset(picture *p)
{
    free(p->pixels);
    *p = (picture){0};
}

/* Renders in silence to float EXR. */
static inline picture render(const char *scene, const char *const *arguments)
{
    const char *all[PROGRAM_ARGUMENTS_MAX + 1];
    int count = 0;
    while (arguments[count]) {
        assert_true(count < PROGRAM_ARGUMENTS_MAX - 8);
        all[count] = arguments[count];
        count++;
    }
    const char *const ours[] = {"-q", "--type", "float", "-o", "picture.exr", scene, NULL};
    memcpy(all + count, ours, sizeof ours);
    program_run run = program_execute(NULL, all);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    return picture_read(in_folder("picture.exr"));
}

#define RENDER(scene, ...) render(scene, ARGUMENTS(__VA_ARGS__))

/* The value of an attribute of an EXR file in the folder: a copy, to be freed; NULL where there is none. */
static inline unsigned char *attribute_of(const char *name, const char *attribute, const char *type)
{
    size_t size;
    unsigned char *bytes = read_bytes(in_folder(name), &size);
    char key[128];
    int length = snprintf(key, sizeof key, "%s%c%s", attribute, '\0', type) + 1;
    const unsigned char *at = memmem(bytes, size, key, (size_t)length);
    unsigned char *value = NULL;
    if (at) {
        uint32_t count;
        memcpy(&count, at + length, sizeof count);
        value = calloc(count + 1, 1);
        assert_non_null(value);
        memcpy(value, at + length + sizeof count, count);
    }
    free(bytes);
    return value;
}

/* The mean of one channel over the block whose top left pixel is (x, y). */
static inline double picture_block(const picture *p, int x, int y, int size, int channel)
{
    double sum = 0.0;
    for (int j = y; j < y + size; j++)
        for (int i = x; i < x + size; i++)
            sum += (double)p->pixels[3 * (j * p->width + i) + channel];
    return sum / ((double)size * size);
}

static inline double picture_mean(const picture *p, int channel)
{
    double sum = 0.0;
    for (int i = 0; i < p->width * p->height; i++)
        sum += (double)p->pixels[3 * i + channel];
    return sum / ((double)p->width * p->height);
}

static inline void expect_near(const char *what, double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("%s: %.6g is not %.6g within %g %%, but %+.3f %% off", what, value, expected, 100.0 * relative,
                 100.0 * (value / expected - 1.0));
}

/* The same radiance everywhere: its mean, and each block. */
static inline void expect_uniform(const char *what, const picture *p, double expected, double of_mean, int block,
                                  double of_block)
{
    for (int c = 0; c < 3; c++)
        expect_near(what, picture_mean(p, c), expected, of_mean);
    for (int y = 0; y + block <= p->height; y += block)
        for (int x = 0; x + block <= p->width; x += block)
            expect_near(what, picture_block(p, x, y, block, 1), expected, of_block);
}

#endif

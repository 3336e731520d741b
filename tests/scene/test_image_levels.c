/* test_image_levels.c: tiles are read into memory that was measured when the file was opened: a file that says other
 * sizes by the time it is read is an error, and another file in its place is not looked into. Few files stay open. And
 * a picture that is made of a file's own levels is fingerprinted by its bytes and by what they are decoded with. Flow:
 * tests of scene/image/image_levels.c, scene/texture/texture_image.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/texture_fixture.h"
#include "fixtures/tiled_tiff.h"
#include "image/image_levels.h"
#include "image/image_module_loader.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/inotify.h>

enum {
    MANY = 129,
    DESCRIPTORS_MOST = 128,
    TILE_BYTES = TIFF_TILE * TIFF_TILE * 3
}; /* so many files are not held open at once */

static unsigned char number(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    return (unsigned char)(50 * level + x + 2 * y + channel);
}

static void tiles_are_of_the_header(void **state)
{
    (void)state;
    static unsigned char pixels[TILE_BYTES];
    tiff_write_levels("a.tx", 256, 3, number);
    const image_module *module = image_module_get(message, sizeof message);
    assert_non_null(module);
    image_levels_header header;
    void *open;
    assert_int_equal(module->open_levels(in_folder("a.tx"), "a.tx", &open, &header, message, sizeof message), AG_OK);
    assert_non_null(open);
    assert_int_equal(module->read_tile(open, &header, 1, 64, 0, 0, 3, true, pixels), AG_OK);
    assert_int_equal(pixels[3 * (TIFF_TILE + 2) + 1], number(1, 66, 1, 1));
    int *const said[5] = {&header.levels[1].width, &header.levels[1].height, &header.levels[1].tile_width_bits,
                          &header.levels[1].tile_height_bits, &header.file_channel_count};
    for (int k = 0; k < 5; k++) {
        --*said[k];
        assert_int_equal(module->read_tile(open, &header, 1, 64, 0, 0, 3, true, pixels), AG_ERROR_INPUT);
        ++*said[k];
    }
    assert_int_equal(module->read_tile(open, &header, 1, 64, 0, 0, 3, true, pixels), AG_OK);
    module->close_levels(open);
}

static int count_descriptors(void)
{
    DIR *all = opendir("/proc/self/fd");
    int count = 0;
    if (!all)
        skip();
    while (readdir(all))
        count++;
    closedir(all);
    return count;
}

/* Files that stay open leave descriptors to others: a process may have 1024 of them, or 256. */
static void few_files_stay_open(void **state)
{
    (void)state;
    image_levels *levels[MANY];
    tiff_write_levels("a.tx", 256, 3, number);
    assert_non_null(image_module_get(message, sizeof message));
    const int before = count_descriptors();
    for (int k = 0; k < MANY; k++) {
        assert_int_equal(image_levels_open(NULL, in_folder("a.tx"), &levels[k]), AG_OK);
        assert_non_null(levels[k]);
    }
    const int more = count_descriptors() - before;
    for (int k = 0; k < MANY; k++)
        image_levels_close(levels[k]);
    if (more < 1 || more > DESCRIPTORS_MOST)
        fail_msg("%d files take %d descriptors", MANY, more);
    assert_int_equal(count_descriptors(), before);
}

/* Another picture in the same file, of the same size and time as far as stat can tell. */
static void a_file_that_was_exchanged_is_an_error(void **state)
{
    (void)state;
    static unsigned char pixels[TILE_BYTES];
    image_levels *levels[MANY];
    struct stat before;
    tiff_write_levels("a.tx", 256, 3, number);
    for (int k = 0; k < MANY; k++) {
        assert_int_equal(image_levels_open(NULL, in_folder("a.tx"), &levels[k]), AG_OK);
        assert_non_null(levels[k]);
    }
    image_levels *last = levels[MANY - 1];
    assert_int_equal(image_levels_read(last, 0, 0, 0, 0, 3, true, pixels), AG_OK);
    assert_int_equal(stat(in_folder("a.tx"), &before), 0);
    tiff_write_levels("a.tx", 128, 3, number);
    assert_int_equal(truncate(in_folder("a.tx"), before.st_size), 0);
    const struct timespec times[2] = {before.st_atim, before.st_mtim};
    assert_int_equal(utimensat(AT_FDCWD, in_folder("a.tx"), times, 0), 0);
    assert_true(image_levels_is_unchanged(last));
    assert_int_equal(image_levels_read(last, 0, 0, 0, 0, 3, true, pixels), AG_ERROR_INPUT);
    for (int k = 0; k < MANY; k++)
        image_levels_close(levels[k]);
}

/* How many times a watched file was read since the last call. */
static int count_reads(int watch)
{
    _Alignas(struct inotify_event) char events[4096];
    const ssize_t length = read(watch, events, sizeof events);
    return length > 0 ? (int)((size_t)length / sizeof(struct inotify_event)) : 0;
}

/* Whether the scene may read a file was asked of the first one only, so nothing of another is read. */
static void another_file_in_its_place_is_not_read(void **state)
{
    (void)state;
    static unsigned char pixels[TILE_BYTES];
    image_levels *levels[MANY];
    const int watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (watch < 0)
        skip();
    tiff_write_levels("a.tx", 256, 3, number);
    tiff_write_levels("b.tx", 256, 3, number);
    for (int k = 0; k < MANY; k++) {
        assert_int_equal(image_levels_open(NULL, in_folder("a.tx"), &levels[k]), AG_OK);
        assert_non_null(levels[k]);
    }
    image_levels *last = levels[MANY - 1];
    assert_true(inotify_add_watch(watch, in_folder("a.tx"), IN_ACCESS) >= 0);
    assert_true(inotify_add_watch(watch, in_folder("b.tx"), IN_ACCESS) >= 0);
    assert_int_equal(image_levels_read(last, 0, 0, 0, 0, 3, true, pixels), AG_OK);
    assert_true(count_reads(watch) > 0);
    assert_int_equal(rename(in_folder("b.tx"), in_folder("a.tx")), 0);
    assert_int_equal(image_levels_read(last, 0, 0, 0, 0, 3, true, pixels), AG_ERROR_INPUT);
    assert_int_equal(count_reads(watch), 0);
    for (int k = 0; k < MANY; k++)
        image_levels_close(levels[k]);
    close(watch);
}

static hash128 content_of(const char *encoding)
{
    char world[256];
    snprintf(world, sizeof world,
             "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tx\" \"string encoding\" \"%s\"",
             encoding);
    reading r = read_world(world);
    assert_int_equal(r.status, AG_OK);
    assert_true(r.scene->textures.images[0]->is_by_file);
    const hash128 content = texture_image_content(r.scene->textures.images[0]);
    reading_destroy(&r);
    return content;
}

static void encodings_are_in_the_fingerprint(void **state)
{
    (void)state;
    static const char *const OTHERS[] = {"linear", "gamma 2", "gamma 2.2"};
    tiff_write_levels("a.tx", 128, 3, number);
    const hash128 first = content_of("sRGB");
    assert_true(hash128_is_equal(first, content_of("sRGB")));
    for (int k = 0; k < 3; k++)
        assert_false(hash128_is_equal(first, content_of(OTHERS[k])));
    assert_false(hash128_is_equal(content_of("gamma 2"), content_of("gamma 2.2")));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(tiles_are_of_the_header),
        TEST_IN_FOLDER(few_files_stay_open),
        TEST_IN_FOLDER(a_file_that_was_exchanged_is_an_error),
        TEST_IN_FOLDER(another_file_in_its_place_is_not_read),
        TEST_IN_FOLDER(encodings_are_in_the_fingerprint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

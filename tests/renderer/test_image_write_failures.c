/* test_image_write_failures.c: where a picture cannot be written the reason is told, and all files are as they were.
 * Flow: tests of renderer/output/image_file.c and threads/atomic_file.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/image_file_fixture.h"
#include "image/image_module_loader.h"

#include <signal.h>

static void full_disk_through_a_device(void **state)
{
    (void)state;
    static const char *const names[] = {"x.exr", "x.png", "x.tif", "x.jpg"};
    float pixels[WIDTH * HEIGHT * 3];
    struct stat status;
    fill(pixels, 3);
    for (size_t k = 0; k < 4; k++) {
        const image_description description = describe(3, image_format_of(names[k])->default_type);
        assert_int_equal(symlink("/dev/full", in_folder(names[k])), 0);
        expect_failure(image_file_write(NULL, in_folder(names[k]), &description, pixels, message, sizeof message),
                       AG_ERROR_OUTPUT, "No space left on device");
        assert_true(lstat(in_folder(names[k]), &status) == 0 && S_ISLNK(status.st_mode));
    }
    assert_int_equal(entry_count(), 4);
}

static void failed_writes_leave_all_as_it_was(void **state)
{
    (void)state;
    static const char *const names[] = {"x.exr", "x.png", "x.tif", "x.jpg"};
    enum { SIDE = 128 };
    float *pixels = malloc(SIDE * SIDE * 3 * sizeof *pixels);
    assert_non_null(pixels);
    uint32_t noise = 1; /* which no format packs into 4096 bytes */
    for (int i = 0; i < SIDE * SIDE * 3; i++) {
        noise = noise * 1664525u + 1013904223u;
        pixels[i] = (float)(noise >> 8) * 0x1p-24f;
    }
    void (*const saved_handler)(int) = signal(SIGXFSZ, SIG_IGN);
    for (size_t k = 0; k < 4; k++) {
        image_description description = describe(3, image_format_of(names[k])->default_type);
        description.width = description.height = description.full_width = description.full_height = SIDE;
        assert_int_equal(atomic_file_write(NULL, in_folder(names[k]), "as before", 9, message, sizeof message), AG_OK);
        struct rlimit saved;
        set_file_limit(4096, &saved);
        const ag_status status =
            image_file_write(NULL, in_folder(names[k]), &description, pixels, message, sizeof message);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &saved), 0);
        expect_failure(status, AG_ERROR_OUTPUT, "File too large");
        assert_non_null(strstr(message, names[k]));
        expect_text(in_folder(names[k]), "as before");
        assert_int_equal(entry_count(), (int)k + 1);
    }
    signal(SIGXFSZ, saved_handler);
    free(pixels);
}

static void folders_that_cannot_be_written(void **state)
{
    (void)state;
    float pixels[WIDTH * HEIGHT * 3];
    const image_description description = describe(3, IMAGE_HALF);
    fill(pixels, 3);
    assert_int_equal(atomic_file_write(NULL, in_folder("x.exr"), "as before", 9, message, sizeof message), AG_OK);
    assert_int_equal(chmod(folder, 0555), 0);
    const bool root = geteuid() == 0; /* whom permissions do not hold back */
    if (root)
        assert_int_equal(seteuid(NOBODY), 0);
    const ag_status written = image_file_write(NULL, in_folder("y.exr"), &description, pixels, message, sizeof message);
    char of_write[sizeof message];
    memcpy(of_write, message, sizeof message);
    const ag_status checked = image_file_check_target(in_folder("y.exr"), message, sizeof message);
    if (root)
        assert_int_equal(seteuid(0), 0);
    assert_int_equal(chmod(folder, 0755), 0);
    expect_failure(checked, AG_ERROR_OUTPUT, "Permission denied");
    assert_int_equal(written, AG_ERROR_OUTPUT);
    assert_non_null(strstr(of_write, "Permission denied"));
    expect_text(in_folder("x.exr"), "as before");
    assert_int_equal(entry_count(), 1);
}

static void targets_are_checked_beforehand(void **state)
{
    (void)state;
    assert_int_equal(image_file_check_target(in_folder("x.exr"), message, sizeof message), AG_OK);
    assert_int_equal(entry_count(), 0);
    expect_failure(image_file_check_target(in_folder("x.bmp"), message, sizeof message), AG_ERROR_OUTPUT, ".exr");
    expect_failure(image_file_check_target(in_folder("none/x.exr"), message, sizeof message), AG_ERROR_OUTPUT,
                   "No such file");
    assert_int_equal(mkdir(in_folder("d.exr"), 0777), 0);
    expect_failure(image_file_check_target(in_folder("d.exr"), message, sizeof message), AG_ERROR_OUTPUT,
                   "Is a directory");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(full_disk_through_a_device),
        TEST_IN_FOLDER(failed_writes_leave_all_as_it_was),
        TEST_IN_FOLDER(folders_that_cannot_be_written),
        TEST_IN_FOLDER(targets_are_checked_beforehand),
    };
    image_module_get(message,
                     sizeof message); /* opened after a picture was written, it crashes GCC 12's leak checker */
    return cmocka_run_group_tests(tests, NULL, NULL);
}

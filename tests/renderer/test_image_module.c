/* test_image_module.c: the module that knows OpenImageIO is opened when it is needed, once, and leaves the process as
 * it was. Flow: tests of scene/image/image_module_loader.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/image_file_fixture.h"
#include "image/image_module_loader.h"

#include <dirent.h>
#include <float.h>
#include <sys/wait.h>

enum { THREAD_LIMIT = 256 };

/* The ids of this process's threads. One that was joined may still be listed for a moment. */
static int list_threads(long ids[THREAD_LIMIT])
{
    int count = 0;
    DIR *directory = opendir("/proc/self/task");
    assert_non_null(directory);
    for (const struct dirent *entry = readdir(directory); entry && count < THREAD_LIMIT; entry = readdir(directory))
        if (entry->d_name[0] != '.')
            ids[count++] = strtol(entry->d_name, NULL, 10);
    closedir(directory);
    return count;
}

static bool is_loaded(const char *library)
{
    char line[1024];
    bool is_there = false;
    FILE *maps = fopen("/proc/self/maps", "r");
    assert_non_null(maps);
    while (!is_there && fgets(line, sizeof line, maps))
        is_there = strstr(line, library) != NULL;
    fclose(maps);
    return is_there;
}

/* First of all tests: once the module has been opened it stays. In a process of its own, since GCC 12's leak checker
 * crashes where the module is opened after a picture has been written. */
static void exr_needs_no_module(void **state)
{
    (void)state;
    float pixels[WIDTH * HEIGHT * 3];
    const image_description description = describe(3, IMAGE_HALF);
    fill(pixels, 3);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const bool is_fine =
            image_file_check_target(in_folder("x.exr"), message, sizeof message) == AG_OK &&
            image_file_check_target(in_folder("x.pfm"), message, sizeof message) == AG_OK &&
            image_file_write(NULL, in_folder("x.exr"), &description, pixels, message, sizeof message) == AG_OK &&
            !is_loaded(IMAGE_MODULE_FILE_NAME) && !is_loaded("libOpenImageIO");
        _exit(is_fine ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_int_equal(access(in_folder("x.exr"), F_OK), 0);
}

/* Second, so that it is here that the module is opened. */
static void module_opens_once_and_quietly(void **state)
{
    (void)state;
    const image_module *module = image_module_get(message, sizeof message);
    if (!module)
        print_error("%s\n", message);
    assert_non_null(module);
    assert_ptr_equal(image_module_get(message, sizeof message), module);
    assert_true(is_loaded(IMAGE_MODULE_FILE_NAME) && is_loaded("libOpenImageIO"));

    /* Denormals still count: no library's start-up code has changed our floating-point mode. */
    volatile float small = FLT_MIN;
    small *= 0.5f;
    assert_true(small > 0.0f);

    /* Encoding starts no thread. */
    long before[THREAD_LIMIT], after[THREAD_LIMIT];
    const int before_count = list_threads(before);
    float *pixels = calloc(512 * 512 * 3, sizeof *pixels);
    assert_non_null(pixels);
    image_description description = describe(3, IMAGE_UINT16);
    description.width = description.height = description.full_width = description.full_height = 512;
    write_picture(in_folder("x.png"), &description, pixels);
    const int after_count = list_threads(after);
    for (int i = 0; i < after_count; i++) {
        bool known = false;
        for (int k = 0; k < before_count; k++)
            known = known || after[i] == before[k];
        assert_true(known);
    }
    free(pixels);
}

static void missing_module_names_the_paths(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("empty"), 0777), 0);
    assert_int_equal(mkdir(in_folder("broken"), 0777), 0);
    assert_int_equal(
        atomic_file_write(NULL, in_folder("broken/" IMAGE_MODULE_FILE_NAME), "no library", 10, message, sizeof message),
        AG_OK);
    const char *const folders[] = {in_folder("empty"), in_folder("broken")};
    assert_null(image_module_open_from(folders, 2, message, sizeof message));
    assert_non_null(strstr(message, "/empty/" IMAGE_MODULE_FILE_NAME "' (not there)"));
    assert_non_null(strstr(message, "/broken/" IMAGE_MODULE_FILE_NAME));
    assert_non_null(strstr(message, "too short")); /* the loader's own words for a library of 10 bytes */
    assert_null(image_module_open_from(folders, 0, message, sizeof message));
    assert_true(strlen(message) > 0);
    assert_non_null(image_module_get(message, sizeof message)); /* which is not forgotten */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(exr_needs_no_module),
        TEST_IN_FOLDER(module_opens_once_and_quietly),
        TEST_IN_FOLDER(missing_module_names_the_paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

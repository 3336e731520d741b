/* test_picture_files.c: files of pictures that hold more than one, or samples in depth; and that the file which is read
 * is the one that was asked after. Flow: tests of scene/image/, through the pbrt reader. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/texture_fixture.h"
#include "image/image_levels.h"
#include "image/image_reader.h"
#include "text/input_file.h"

#include <sys/stat.h>
#include <unistd.h>

#define PICTURE(name)                                                                                                  \
    "Texture \"a\" \"spectrum\" \"imagemap\" \"string filter\" \"point\" \"string filename\" \"" name "\""

static void write_parts(const char *name, const image_description *description, const float *pixels)
{
    if (image_file_write(NULL, in_folder(name), description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
}

static void write_attribute(FILE *file, const char *name, const char *type, const void *value, uint32_t size)
{
    fwrite(name, 1, strlen(name) + 1, file);
    fwrite(type, 1, strlen(type) + 1, file);
    fwrite(&size, 1, sizeof size, file);
    fwrite(value, 1, size, file);
}

/* One pixel with one sample of Z, as OpenEXR lays deep scan lines out. */
static void write_deep(const char *name)
{
    static const uint32_t MAGIC[2] = {20000630, 2 | 0x800}, BOX[4] = {0, 0, 0, 0}, ONE = 1;
    static const float FLOAT = 1.0f, CENTER[2] = {0, 0};
    static const char CHANNELS[] = "Z\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0";
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    fwrite(MAGIC, 1, sizeof MAGIC, file);
    write_attribute(file, "channels", "chlist", CHANNELS, sizeof CHANNELS);
    write_attribute(file, "chunkCount", "int", &ONE, 4);
    write_attribute(file, "compression", "compression", "", 1);
    write_attribute(file, "dataWindow", "box2i", BOX, sizeof BOX);
    write_attribute(file, "displayWindow", "box2i", BOX, sizeof BOX);
    write_attribute(file, "lineOrder", "lineOrder", "", 1);
    write_attribute(file, "maxSamplesPerPixel", "int", &ONE, 4);
    write_attribute(file, "name", "string", "a", 1);
    write_attribute(file, "pixelAspectRatio", "float", &FLOAT, 4);
    write_attribute(file, "screenWindowCenter", "v2f", CENTER, sizeof CENTER);
    write_attribute(file, "screenWindowWidth", "float", &FLOAT, 4);
    write_attribute(file, "type", "string", "deepscanline", 12);
    write_attribute(file, "version", "int", &ONE, 4);
    fputc(0, file);
    const uint64_t offset = (uint64_t)ftell(file) + 8, sizes[3] = {4, 4, 4};
    fwrite(&offset, 1, sizeof offset, file);
    fwrite(BOX, 1, 4, file); /* the line, 0 */
    fwrite(sizes, 1, sizeof sizes, file);
    fwrite(&ONE, 1, sizeof ONE, file);
    fwrite(&FLOAT, 1, sizeof FLOAT, file);
    assert_int_equal(fclose(file), 0);
}

/* Of a file of several pictures the first is used, with a warning; a deep picture is an error that says so. */
static void several_pictures_are_told(void **state)
{
    (void)state;
    char command[1024];
    snprintf(command, sizeof command,
             "cd '%s' && oiiotool --create 8x4 3 --fill:color=.5,.5,.5 8x4 -d half -o one.exr && "
             "oiiotool one.exr one.exr --siappend -o parts.exr && oiiotool one.exr one.exr --siappend -o pages.tif",
             folder);
    assert_int_equal(system(command), 0);
    static const struct {
        const char *world;
        int warnings;
    } CASES[] = {{PICTURE("one.exr"), 0},
                 {PICTURE("parts.exr"), 1},
                 {PICTURE("pages.tif"), 1},
                 {"LightSource \"infinite\" \"string filename\" \"one.exr\"", 0},
                 {"LightSource \"infinite\" \"string filename\" \"parts.exr\"", 1}};
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        reading r = read_world(CASES[k].world);
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], CASES[k].warnings);
        if (CASES[k].warnings > 0)
            assert_non_null(strstr(r.said[AG_LOG_WARNING], "the file holds several pictures (parts, pages or frames), "
                                                           "of which the first alone is used"));
        reading_destroy(&r);
    }
    write_deep("deep.exr");
    reading r = read_world(PICTURE("deep.exr"));
    assert_int_equal(r.status, AG_ERROR_INPUT);
    assert_non_null(strstr(r.said[AG_LOG_ERROR], "it is a deep picture"));
    reading_destroy(&r);
}

static void write_pixel(const char *name, float gray)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    const image_description d = {.width = 1,
                                 .height = 1,
                                 .full_width = 1,
                                 .full_height = 1,
                                 .channel_count = 3,
                                 .channel_names = NAMES,
                                 .type = IMAGE_FLOAT};
    write_parts(name, &d, (const float[3]){gray, gray, gray});
}

/* A file is asked after when it is opened, not by its name before. */
static void confined_scenes_open_no_other_pictures(void **state)
{
    (void)state;
    write_pixel("outside.exr", 1.0f);
    assert_int_equal(mkdir(in_folder("inside"), 0755), 0);
    char path[512];
    const char *wrong;
    snprintf(path, sizeof path, "%s/inside/scene.pbrt", folder);
    input_files inputs = {0};
    assert_true(input_files_confine(&inputs, path, NULL, 0, &wrong));
    run_context run;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    run.inputs = &inputs;
    image read;
    image_levels *levels;
    assert_int_equal(image_read_compact(&run, in_folder("outside.exr"), &read, message, sizeof message),
                     AG_ERROR_INPUT);
    assert_non_null(strstr(message, "a confined scene may not read it"));
    assert_int_equal(image_read_colors(&run, in_folder("outside.exr"), &read, message, sizeof message), AG_ERROR_INPUT);
    assert_int_equal(image_levels_open(&run, in_folder("outside.exr"), &levels), AG_OK);
    assert_null(levels);
    run_context_reset(&run);
    input_files_reset(&inputs);
}

/* A library that opens files by name opens the one that was asked after, also where its name has become another's. */
static void opened_files_keep_their_content(void **state)
{
    (void)state;
    char first[512], path[INPUT_FILE_OPENED_SIZE];
    snprintf(first, sizeof first, "%s", in_folder("a.exr"));
    write_pixel("a.exr", 0.25f);
    const int descriptor = input_file_open(NULL, first, message, sizeof message);
    assert_true(descriptor >= 0);
    write_pixel("b.exr", 0.75f);
    assert_int_equal(rename(in_folder("b.exr"), first), 0);
    image read;
    const char *opened = input_file_opened_path(descriptor, first, path);
    assert_int_equal(image_read_colors(NULL, opened, &read, message, sizeof message), AG_OK);
    assert_near(read.pixels[0], 0.25, 0.0);
    image_reset(&read);
    close(descriptor);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(several_pictures_are_told),
        TEST_IN_FOLDER(confined_scenes_open_no_other_pictures),
        TEST_IN_FOLDER(opened_files_keep_their_content),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

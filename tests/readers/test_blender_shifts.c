/* test_blender_shifts.c: how far cameras of Blender's files shift their pictures, wherever in the file that stands.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/model_fixture.h"
#include "model/blender_shifts.h"

/* A property as binary FBX files have it. */
static void put_property(FILE *file, const char *name, double value)
{
    const char *const WORDS[] = {name, "double", "Number", ""};
    for (int k = 0; k < 4; k++) {
        const uint32_t length = (uint32_t)strlen(WORDS[k]);
        fputc('S', file);
        fwrite(&length, sizeof length, 1, file);
        fwrite(WORDS[k], 1, length, file);
    }
    fputc('D', file);
    fwrite(&value, sizeof value, 1, file);
}

/* The template of all cameras, and those that there are, after so many bytes. */
static const char *shifted_fbx(long before, int camera_count, const double shifts[][2])
{
    const char *path = in_folder("shifts.fbx");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    put_property(file, "FilmOffsetX", 0.0);
    put_property(file, "FilmOffsetY", 0.0);
    put_property(file, "FilmWidth", 0.8);
    for (long k = 0; k < before; k++)
        fputc('F', file);
    for (int k = 0; k < camera_count; k++) {
        put_property(file, "FilmWidth", 2.0);
        put_property(file, "FilmOffsetX", 2.0 * shifts[k][0]);
        put_property(file, "FilmOffsetY", 2.0 * shifts[k][1]);
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

static void shifts_of_blenders_cameras_are_read(void **state)
{
    (void)state;
    static const double ALIKE[][2] = {{0.25, -0.5}, {0.25, -0.5}}, APART[][2] = {{0.25, 0}, {0, 0}};
    blender_shifts shifts;
    for (long before = (1 << 20) - 400; before < (1 << 20) + 8;
         before += 7) { /* over the end of what is read at once */
        blender_shifts_read(shifted_fbx(before, 2, ALIKE), true, &shifts);
        assert_float_equal(shifts.of_all[0], 0.25, 0);
        assert_float_equal(shifts.of_all[1], -0.5, 0);
        assert_false(shifts.differ);
    }
    blender_shifts_read(shifted_fbx(0, 2, APART), true, &shifts);
    assert_true(shifts.differ);
    assert_float_equal(shifts.of_all[0], 0, 0);
    static const char EXTRA[] = "<shiftx sid=\"shiftx\" type=\"float\">0.5</shiftx>\n"
                                "<shifty sid=\"shifty\" type=\"float\">-0.125</shifty>\n";
    blender_shifts_read(model_write_text("shifts.dae", EXTRA), false, &shifts);
    assert_float_equal(shifts.of_all[0], 0.5, 0);
    assert_float_equal(shifts.of_all[1], -0.125, 0);
    static const char ONE_LINE[] = "<extra><shiftx sid=\"shiftx\">0.5</shiftx><shifty sid=\"shifty\">-0.125</shifty>",
                      LINES[] = "<shiftx\n sid=\"shiftx\">\n0.5</shiftx\n><shifty sid=\"shifty\"\n>-0.125</shifty>",
                      TWO_CAMERAS[] = "<a><shiftx sid=\"x\">0.5</shiftx><shifty sid=\"y\">0</shifty></a>"
                                      "<b><shiftx sid=\"x\">0.5</shiftx><shifty sid=\"y\">0.25</shifty></b>";
    static const char *const LAYOUTS[] = {ONE_LINE, LINES};
    for (int k = 0; k < 2; k++) {
        blender_shifts_read(model_write_text("shifts.dae", LAYOUTS[k]), false, &shifts);
        assert_float_equal(shifts.of_all[0], 0.5, 0);
        assert_float_equal(shifts.of_all[1], -0.125, 0);
    }
    blender_shifts_read(model_write_text("shifts.dae", TWO_CAMERAS), false, &shifts);
    assert_true(shifts.differ);
    blender_shifts_read("nothing.fbx", true, &shifts);
    assert_float_equal(shifts.of_all[0], 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(shifts_of_blenders_cameras_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

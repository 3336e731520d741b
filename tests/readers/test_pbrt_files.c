/* test_pbrt_files.c: scenes of several files: Include, Import, spectra, packed files, standard input.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/pbrt_fixture.h"
#include "fixtures/temporary_folder.h"

#include <fcntl.h>
#include <zlib.h>

static void write_file(const char *name, const char *text)
{
    FILE *f = fopen(in_folder(name), "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, strlen(text), f), strlen(text));
    assert_int_equal(fclose(f), 0);
}

static void check_file(const char *name, uint32_t shape_count)
{
    reading r = reading_create(in_folder(name), NULL, 0);
    if (r.said[AG_LOG_ERROR])
        print_error("%s", r.said[AG_LOG_ERROR]);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.scene->shape_count, shape_count);
    reading_destroy(&r);
}

/* expected: the message with % where the folder stands. */
static void check_file_error(const char *name, ag_status status, const char *expected)
{
    char text[4096] = "";
    for (const char *p = expected; *p; p++)
        snprintf(text + strlen(text), sizeof text - strlen(text), *p == '%' ? "%s" : "%.1s", *p == '%' ? folder : p);
    reading r = reading_create(in_folder(name), NULL, 0);
    assert_int_equal(r.status, status);
    assert_string_equal(r.said[AG_LOG_ERROR], text);
    reading_destroy(&r);
}

static void included_files_are_found(void **state)
{
    (void)state;
    write_file("top.pbrt", "WorldBegin Include \"parts/a.pbrt\" Shape \"sphere\" Include \"parts/b.pbrt\"");
    /* a: beside itself and from the top; the transform and an open parameter list go on behind its end */
    write_file("parts/a.pbrt", "Translate 1 0 0 Include \"b.pbrt\" Include \"parts/b.pbrt\" Shape \"sphere\"");
    write_file("parts/b.pbrt", "Shape \"disk\" # no line end");
    reading r = reading_create(in_folder("top.pbrt"), NULL, 0);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.scene->shape_count, 5);
    assert_int_equal(r.scene->shapes[4].kind, SHAPE_DISK);
    assert_vec3(transform_point(&r.scene->shapes[3].as.quadric.world_from_object, vec3_make(0, 0, 0)), 1, 0, 0, 0);
    reading_destroy(&r);
    /* a parameter list may go on in the file that included its beginning */
    write_file("open.pbrt", "WorldBegin Include \"begin.pbrt\" 7 ]");
    write_file("begin.pbrt", "Shape \"sphere\" \"float radius\" [");
    r = reading_create(in_folder("open.pbrt"), NULL, 0);
    assert_int_equal(r.status, AG_OK);
    assert_near(r.scene->shapes[0].as.quadric.radius, 7, 0);
    reading_destroy(&r);
}

static void included_files_are_told(void **state)
{
    (void)state;
    write_file("missing.pbrt", "WorldBegin\nInclude \"none.pbrt\"");
    check_file_error("missing.pbrt", AG_ERROR_INPUT,
                     "%/missing.pbrt:2:9: error: cannot read the file \"none.pbrt\": No such file or directory\n"
                     "    Include \"none.pbrt\"\n            ^~~~~~~~~~~\n");
    write_file("cycle.pbrt", "WorldBegin\nInclude \"cycle2.pbrt\"");
    write_file("cycle2.pbrt", "\n Include \"cycle.pbrt\"");
    check_file_error("cycle.pbrt", AG_ERROR_SCENE,
                     "%/cycle2.pbrt:2:10: error: \"cycle.pbrt\" includes itself: %/cycle2.pbrt:2 < %/cycle.pbrt:2\n"
                     "     Include \"cycle.pbrt\"\n             ^~~~~~~~~~~~\n");
    write_file("outer.pbrt", "WorldBegin\nInclude \"inner.pbrt\"");
    write_file("inner.pbrt", "\nShape \"none\"\n");
    check_file_error("outer.pbrt", AG_ERROR_SCENE, "%/inner.pbrt:2:1: error: unknown shape \"none\"\n");
    write_file("inner.pbrt", "\nShape \"none\" Identity\n");
    check_file_error("outer.pbrt", AG_ERROR_SCENE,
                     "%/inner.pbrt:2:1: error: unknown shape \"none\"\n    Shape \"none\" Identity\n    ^~~~~\n");
    check_file_error("none.pbrt", AG_ERROR_INPUT,
                     "%/none.pbrt: error: cannot read the file: No such file or directory\n");
}

static void imported_files_have_a_state_of_their_own(void **state)
{
    (void)state;
    write_file("top.pbrt", "WorldBegin Translate 0 3 0 CoordinateSystem \"up\" Attribute \"shape\" \"float radius\" 2\n"
                           "Import \"parts/a.pbrt\" Shape \"sphere\" NamedMaterial \"m\" Shape \"disk\"\n"
                           "CoordSysTransform \"up\" Shape \"disk\"");
    /* the last parameter list ends with the file; what is named is everybody's, but for coordinate systems */
    write_file("parts/a.pbrt",
               "Translate 1 0 0 Shape \"sphere\" CoordinateSystem \"up\" ReverseOrientation\n"
               "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" Include \"b.pbrt\" ColorSpace \"rec2020\"\n"
               "Attribute \"shape\" \"float radius\" 5 Shape \"sphere\" \"float zmax\" 1");
    write_file("parts/b.pbrt", "Translate 1 0 0");
    reading r = reading_create(in_folder("top.pbrt"), NULL, 0);
    if (r.said[AG_LOG_ERROR])
        print_error("%s", r.said[AG_LOG_ERROR]);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 0);
    const shape *shapes = r.scene->shapes;
    assert_int_equal(r.scene->shape_count, 5);
    static const double X[] = {1, 2, 0, 0, 0}, RADIUS[] = {2, 5, 2, 2, 2};
    for (int i = 0; i < 5; i++) {
        assert_vec3(transform_point(&shapes[i].as.quadric.world_from_object, vec3_make(0, 0, 0)), X[i], 3, 0, 1e-6);
        assert_near(shapes[i].as.quadric.radius, RADIUS[i], 0);
    }
    assert_true(shapes[1].flip_normal && !shapes[2].flip_normal);
    assert_true(shapes[3].material_index != shapes[2].material_index);
    reading_destroy(&r);

    write_file("outer.pbrt", "WorldBegin AttributeBegin\nImport \"inner.pbrt\" AttributeEnd");
    write_file("inner.pbrt", "AttributeBegin\n");
    check_file_error("outer.pbrt", AG_ERROR_SCENE,
                     "%/inner.pbrt:2:1: error: the file ends, but AttributeBegin at %/inner.pbrt:1:1 is still open\n"
                     "    \n    ^\n");
    write_file("inner.pbrt", "AttributeEnd\n");
    check_file_error(
        "outer.pbrt", AG_ERROR_SCENE,
        "%/inner.pbrt:1:1: error: AttributeEnd without AttributeBegin\n    AttributeEnd\n    ^~~~~~~~~~~~\n");
    write_file("inner.pbrt", "Shape \"sphere\" \"float radius\" [ 1");
    check_file_error("outer.pbrt", AG_ERROR_SCENE,
                     "%/inner.pbrt:1:34: error: \"float radius\" expects numbers, but the file ends\n"
                     "    Shape \"sphere\" \"float radius\" [ 1\n                                     ^\n");
    write_file("inner.pbrt", "Import \"outer.pbrt\"");
    check_file_error("outer.pbrt", AG_ERROR_SCENE,
                     "%/inner.pbrt:1:8: error: \"outer.pbrt\" includes itself: %/inner.pbrt:1 < %/outer.pbrt:2\n"
                     "    Import \"outer.pbrt\"\n           ^~~~~~~~~~~~\n");
    write_file("inner.pbrt", "Camera \"perspective\"");
    check_file_error("outer.pbrt", AG_ERROR_SCENE,
                     "%/inner.pbrt:1:1: error: Camera may only stand before WorldBegin\n"
                     "    Camera \"perspective\"\n    ^~~~~~\n");
}

static void spectra_are_read_from_files(void **state)
{
    (void)state;
    write_file("parts/glass.spd", "# wavelength value\n400 1.5\n700\t1.5 # end");
    write_file("top.pbrt", "WorldBegin Material \"dielectric\" \"spectrum eta\" \"parts/glass.spd\" Shape \"sphere\"\n"
                           "LightSource \"point\" \"spectrum I\" [ 300 2 900 2 ] \"float scale\" 3\n"
                           "Material \"diffuse\" \"spectrum reflectance\" [ 400 .3 700 .3 ] Shape \"sphere\"\n"
                           "LightSource \"point\" \"spectrum I\" \"stdillum-D65\"");
    reading r = reading_create(in_folder("top.pbrt"), NULL, 0);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 0);
    const scene *s = r.scene;
    assert_near(s->materials[s->shapes[0].material_index].ior, 1.5, 1e-6);
    assert_rgb(s->materials[s->shapes[1].material_index].reflectance, .3, .3, .3, 1e-6);
    assert_near(rgb_luminance(s->lights[0].as.point.intensity), 3, 1e-3);
    assert_rgb(s->lights[1].as.point.intensity, 1, 1, 1, 0);
    reading_destroy(&r);
    write_file("parts/glass.spd", "400 1.5\n700 x");
    check_file_error("top.pbrt", AG_ERROR_SCENE,
                     "%/parts/glass.spd:2:5: error: a number should stand here\n    700 x\n        ^\n");
    write_file("parts/glass.spd", "400 1.5 700");
    write_file("top.pbrt", "WorldBegin Material \"dielectric\" \"spectrum eta\" \"parts/glass.spd\"");
    check_file_error(
        "top.pbrt", AG_ERROR_SCENE,
        "%/top.pbrt:1:34: error: the file \"parts/glass.spd\" has 3 numbers: it should have wavelengths and "
        "values\n    WorldBegin Material \"dielectric\" \"spectrum eta\" \"parts/glass.spd\"\n"
        "                                     ^~~~~~~~~~~~~~\n");
    write_file("top.pbrt", "WorldBegin Material \"dielectric\" \"spectrum eta\" \"glass-none\"");
    check_file_error(
        "top.pbrt", AG_ERROR_INPUT,
        "%/top.pbrt:1:34: error: cannot read the file \"glass-none\": No such file or directory; nor has pbrt a "
        "spectrum of that name\n    WorldBegin Material \"dielectric\" \"spectrum eta\" \"glass-none\"\n"
        "                                     ^~~~~~~~~~~~~~\n");
}

static void deep_includes_are_refused(void **state)
{
    (void)state;
    char name[32], text[64];
    for (int i = 0; i < 40; i++) {
        snprintf(name, sizeof name, "deep%d.pbrt", i);
        snprintf(text, sizeof text, "Include \"deep%d.pbrt\"", i + 1);
        write_file(name, text);
    }
    reading r = reading_create(in_folder("deep0.pbrt"), NULL, 0);
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(strstr(r.said[AG_LOG_ERROR], "deep31.pbrt:1:9: error: more than 32 files include one another: "));
    assert_non_null(strstr(r.said[AG_LOG_ERROR], "deep31.pbrt:1 < "));
    reading_destroy(&r);
}

static void packed_files_and_standard_input_are_read(void **state)
{
    (void)state;
    const char *text = "WorldBegin Shape \"sphere\" Include \"parts/b.pbrt\"";
    write_file("parts/b.pbrt", "Shape \"disk\"");
    gzFile f = gzopen(in_folder("packed.pbrt.gz"), "wb");
    assert_non_null(f);
    assert_int_equal(gzputs(f, text), (int)strlen(text));
    assert_int_equal(gzclose(f), Z_OK);
    check_file("packed.pbrt.gz", 2);
    assert_int_equal(truncate(in_folder("packed.pbrt.gz"), 30), 0);
    check_file_error("packed.pbrt.gz", AG_ERROR_INPUT,
                     "%/packed.pbrt.gz: error: cannot read the file: the gzip file is cut short\n");

    write_file("stdin.pbrt", "WorldBegin Shape \"sphere\"\nBogus");
    int saved = dup(STDIN_FILENO), replaced = open(in_folder("stdin.pbrt"), O_RDONLY);
    assert_true(saved >= 0 && replaced >= 0);
    dup2(replaced, STDIN_FILENO);
    reading r = reading_create("-", NULL, 0);
    dup2(saved, STDIN_FILENO);
    close(saved);
    close(replaced);
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_int_equal(r.scene->shape_count, 1);
    assert_string_equal(r.said[AG_LOG_ERROR], "<stdin>:2:1: error: unknown directive Bogus\n    Bogus\n    ^~~~~\n");
    reading_destroy(&r);
}

/* All tests share a folder; files that one leaves there do not matter to the next. */
static int make_folders(void **state)
{
    return make_folder(state) == 0 && mkdir(in_folder("parts"), 0700) == 0 ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(included_files_are_found),
        cmocka_unit_test(included_files_are_told),
        cmocka_unit_test(imported_files_have_a_state_of_their_own),
        cmocka_unit_test(spectra_are_read_from_files),
        cmocka_unit_test(deep_includes_are_refused),
        cmocka_unit_test(packed_files_and_standard_input_are_read),
    };
    return cmocka_run_group_tests(tests, make_folders, remove_folder);
}

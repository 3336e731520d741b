/* test_program_denoise.c: --denoise without Open Image Denoise is an error before anything is rendered; with it, here a
 * library of the test's own that doubles what it is given and writes down how it was called, the calls are those that
 * its documentation asks for. And --dump-photons.
 * Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define SMALL                                                                                                          \
    "-q", "--size", "16x12", "--spp", "2", "--photons", "500", "--caustic-photons", "500", "--gather-samples", "4"

/* Release 2's names; -DOLD: release 1's. */
static const char LIBRARY[] =
    "#include <stdbool.h>\n#include <stddef.h>\n#include <stdio.h>\n#include <string.h>\n"
    "static float *color, *albedo, *normal, *output; static size_t count; static int fails;\n"
    "static void note(const char *what, const char *name, int value) {\n"
    "    FILE *f = fopen(\"calls.txt\", \"a\"); fprintf(f, \"%s %s %d\\n\", what, name, value); fclose(f); }\n"
    "#ifdef OLD\n#define NAME(new, old) old\n#else\n#define NAME(new, old) new\n#endif\n"
    "void *oidnNewDevice(int type) { note(\"device\", \"type\", type); return &count; }\n"
    "void NAME(oidnSetDeviceInt, oidnSetDevice1i)(void *d, const char *n, int v) { (void)d; note(\"int\", n, v); }\n"
    "void NAME(oidnSetDeviceBool, oidnSetDevice1b)(void *d, const char *n, bool v) { (void)d; note(\"bool\", n, v); }\n"
    "void oidnCommitDevice(void *d) { (void)d; note(\"commit\", \"device\", 0); }\n"
    "int oidnGetDeviceError(void *d, const char **m) { (void)d; if (m) *m = \"no luck today\"; return fails; }\n"
    "void oidnReleaseDevice(void *d) { (void)d; note(\"release\", \"device\", 0); }\n"
    "void *oidnNewFilter(void *d, const char *type) { (void)d; note(\"filter\", type, 0); return &count; }\n"
    "void oidnSetSharedFilterImage(void *f, const char *n, void *p, int format, size_t w, size_t h, size_t o,\n"
    "                              size_t ps, size_t rs) {\n"
    "    (void)f; note(n, o + ps + rs ? \"strides\" : \"packed\", format); count = w * h * 3;\n"
    "    if (!strcmp(n, \"color\")) color = p; else if (!strcmp(n, \"albedo\")) albedo = p;\n"
    "    else if (!strcmp(n, \"normal\")) normal = p; else output = p; }\n"
    "void NAME(oidnSetFilterBool, oidnSetFilter1b)(void *f, const char *n, bool v) { (void)f; note(\"bool\", n, v); }\n"
    "void oidnCommitFilter(void *f) { (void)f; note(\"commit\", \"filter\", 0); }\n"
    "void oidnExecuteFilter(void *f) { (void)f; note(\"execute\", \"filter\", 0);\n"
    "    bool is_unit = true; for (size_t i = 0; i < count; i += 3)\n"
    "        is_unit = is_unit && normal[i] * normal[i] + normal[i + 1] * normal[i + 1] + normal[i + 2] * normal[i + "
    "2] "
    "< 1.001f\n"
    "            && albedo[i] >= 0 && albedo[i] <= 1;\n"
    "    note(\"auxiliary\", is_unit ? \"good\" : \"bad\", 0);\n"
    "    for (size_t i = 0; i < count; i++) output[i] = 2 * color[i];\n"
    "    FILE *g = fopen(\"fail\", \"r\"); if (g) { fails = 1; fclose(g); } }\n"
    "void oidnReleaseFilter(void *f) { (void)f; note(\"release\", \"filter\", 0); }\n";

static void build_library(const char *name, const char *flag)
{
    char command[1024];
    write_text("fake.c", LIBRARY);
    const char *compiler = getenv("CC");
    snprintf(command, sizeof command, "cd %s && %s -shared -fPIC %s -o %s fake.c", folder, compiler ? compiler : "cc",
             flag, name);
    assert_int_equal(system(command), 0);
    setenv("LD_LIBRARY_PATH", folder, 1);
}

static void test_not_there(void **state)
{
    (void)state;
    setenv("LD_LIBRARY_PATH", folder, 1);
    program_run run = RUN(SMALL, "--denoise", "-o", "p.exr", PROGRAM_SCENES "floor.pbrt");
    if (run.exit_code == 0) { /* a machine that has it */
        program_run_reset(&run);
        skip();
    }
    expect_exit(&run, 3);
    expect_said(&run, "denoising needs Open Image Denoise, and its library is not there");
    program_run_reset(&run);
    expect_listing("");
    write_text("libOpenImageDenoise.so.2", "no library");
    run = RUN(SMALL, "--denoise", "-o", "p.exr", PROGRAM_SCENES "floor.pbrt");
    expect_exit(&run, 3);
    program_run_reset(&run);
    unsetenv("LD_LIBRARY_PATH");
}

static void test_calls(void **state)
{
    (void)state;
    static const struct {
        const char *name, *flag;
    } releases[] = {{"libOpenImageDenoise.so.2", "-DNEW"}, {"libOpenImageDenoise.so.1", "-DOLD"}};
    picture noisy = RENDER(PROGRAM_SCENES "mirror_wall.pbrt", SMALL, "-t", "2");
    for (int i = 0; i < 2; i++) {
        build_library(releases[i].name, releases[i].flag);
        picture p = RENDER(PROGRAM_SCENES "mirror_wall.pbrt", SMALL, "-t", "2", "--denoise");
        for (int k = 0; k < 3 * p.width * p.height; k++)
            assert_true(p.pixels[k] == 2.0f * noisy.pixels[k]);
        size_t size;
        char *calls = (char *)read_bytes(in_folder("calls.txt"), &size);
        assert_string_equal(calls, "device type 1\nint numThreads 2\nbool setAffinity 0\ncommit device 0\nfilter RT 0\n"
                                   "color packed 3\noutput packed 3\nalbedo packed 3\nnormal packed 3\nbool hdr 1\n"
                                   "commit filter 0\nexecute filter 0\nauxiliary good 0\nrelease filter 0\n"
                                   "release device 0\n");
        free(calls);
        picture_reset(&p);
        unlink(in_folder("calls.txt"));
        unlink(in_folder(releases[i].name));
    }
    build_library("libOpenImageDenoise.so.2", "-DNEW");
    write_text("fail", "");
    program_run run = RUN(SMALL, "--denoise", "-o", "p.exr", PROGRAM_SCENES "mirror_wall.pbrt");
    expect_exit(&run, 3);
    expect_said(&run, "Open Image Denoise: no luck today");
    assert_int_not_equal(access(in_folder("p.exr"), F_OK), 0);
    program_run_reset(&run);
    picture_reset(&noisy);
    unsetenv("LD_LIBRARY_PATH");
}

static void test_photons(void **state)
{
    (void)state;
    program_run run = RUN(SMALL, "--dump-photons", "p.ply", "--stats", "s.json", "-o", "p.exr", "--photons=800",
                          PROGRAM_SCENES "glass_and_metal.pbrt");
    expect_exit(&run, 0);
    program_run_reset(&run);
    size_t size;
    unsigned char *bytes = read_bytes(in_folder("p.ply"), &size);
    json_t *stats = stats_read(in_folder("s.json"));
    long long caustic = stats_integer(stats, "photons.stored_caustic");
    assert_true(caustic > 0);
    char count[64];
    snprintf(count, sizeof count, "element vertex %lld\n", 800 + caustic);
    assert_non_null(strstr((const char *)bytes, count));
    const char *end = strstr((const char *)bytes, "end_header\n");
    assert_non_null(end);
    const unsigned char *at = (const unsigned char *)end + strlen("end_header\n");
    assert_int_equal(size - (size_t)(at - bytes), (size_t)(800 + caustic) * 50);
    long long demanded = 0;
    for (long long i = 0; i < 800 + caustic; i++, at += 50) {
        float values[12];
        memcpy(values, at, sizeof values);
        assert_int_equal(at[48], i >= 800);
        demanded += at[49];
        assert_true(values[1] > -0.01f && values[1] < 2.01f); /* within the room, going towards the surface */
        assert_true(values[3] * values[6] + values[4] * values[7] + values[5] * values[8] < 0.05f);
        assert_true(values[9] > 0.0f);
    }
    assert_int_equal(demanded, stats_integer(stats, "irradiance.distinct"));
    json_decref(stats);
    free(bytes);
    run = RUN(SMALL, "--dump-photons", "q.ply", "--integrator", "path", PROGRAM_SCENES "floor.pbrt");
    expect_exit(&run, 2);
    expect_said(&run, "path tracing has no photons");
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_not_there),
        TEST_IN_FOLDER(test_calls),
        TEST_IN_FOLDER(test_photons),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_program_hard_input.c: files that are missing, cut, damaged, of another kind or out of all proportion: the exit
 * code, the location that is named, and that nothing is left behind. What the readers say of each mistake is in their
 * unit tests.
 *
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#include <zlib.h>

#define QUICK "--photons=300", "--spp=1", "--gather-samples=2", "--size=8x6"
#define BEGIN "Camera \"perspective\"\nWorldBegin\n"

#define PLY_HEAD(format)                                                                                               \
    "ply\nformat " format " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"             \
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"

static void write_bytes(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static int count_of(const char *text, const char *part)
{
    int count = 0;
    for (text = strstr(text, part); text; text = strstr(text + 1, part))
        count++;
    return count;
}

/* The scene is refused: with 1, at that location, in one error; and no picture or statistics are there. */
static void expect_refused(const char *scene, const char *location, const char *reason)
{
    int before = entry_count();
    program_run run = RUN("-q", QUICK, "-o", "a.exr", "--stats=a.json", scene);
    expect_exit(&run, 1);
    assert_string_equal(run.out, "");
    expect_said(&run, location);
    expect_said(&run, reason);
    assert_int_equal(count_of(run.err, "error: "), 1);
    program_run_reset(&run);
    assert_int_equal(entry_count(), before);
}

static void expect_accepted(const char *scene, const char *warning)
{
    static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
    for (int k = 0; k < 2; k++) {
        program_run run = RUN(QUICK, "--progress=none", INTEGRATORS[k], "-o", "a.exr", "--stats=a.json", scene);
        expect_exit(&run, 0);
        if (warning)
            expect_said(&run, warning);
        else
            assert_string_equal(run.err, "");
        program_run_reset(&run);
        json_t *stats = stats_read(in_folder("a.json"));
        assert_int_equal(stats_integer(stats, "samples_not_finite"), 0);
        json_decref(stats);
        picture p = picture_read(in_folder("a.exr"));
        for (int i = 0; i < 3 * p.width * p.height; i++)
            assert_true(isfinite(p.pixels[i]));
        picture_reset(&p);
    }
}

/* ---- the scene file itself ---- */

/* Names in files of models reach messages, and must not reach the terminal as commands. */
static void test_names_that_command_terminals(void **state)
{
    (void)state;
    static const char *const FILES[][2] = {
        {"a.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"extensionsRequired\": [\"E\\u001b[31m\"]}"},
        {"a.obj", "mtllib E\033[31m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n"},
        {"a.ply", "ply\nformat E\033[31m 1.0\n"}};
    for (int i = 0; i < 3; i++) {
        program_run run = RUN(QUICK, "-o", "a.exr", write_text(FILES[i][0], FILES[i][1]));
        expect_exit(&run, 1);
        expect_said(&run, "E?[31m");
        assert_null(strchr(run.err, '\033'));
        program_run_reset(&run);
    }
}

static void test_no_scenes(void **state)
{
    (void)state;
    static const unsigned char PICTURE[] = "\x76\x2f\x31\x01\x02\0\0\0channels\0chlist\0";
    static const unsigned char WIDE[] = "\xff\xfe"
                                        "C\0a\0m\0e\0r\0a\0";
    expect_refused(write_text("empty.pbrt", ""), "empty.pbrt:1:1: error: ", "the file ends without WorldBegin");
    expect_refused(write_text("blank.pbrt", "# nothing\n\n"), "blank.pbrt:3:1: error: ", "without WorldBegin");
    write_bytes("binary.pbrt", PICTURE, sizeof PICTURE);
    expect_refused("binary.pbrt", "binary.pbrt:1:1: error: ", "unknown directive v/");
    write_bytes("wide.pbrt", WIDE, sizeof WIDE);
    expect_refused("wide.pbrt", "wide.pbrt:1:1: error: ", "the file is UTF-16; only ASCII and UTF-8 can be read");
    write_bytes("nul.pbrt", "Camera\0", 7);
    expect_refused("nul.pbrt", "nul.pbrt:1:7: error: ", "NUL byte: this is not a text file");
    program_run run = RUN("-o", "a.exr", write_text("stage.usda", "#usda 1.0\ndef Xform"));
    expect_exit(&run, 1);
    expect_said(&run, "stage.usda:2:1: error: unknown directive def");
    expect_said(&run, "warning: no reader knows files that end in .usda");
    program_run_reset(&run);
}

static void test_byte_order_mark_and_line_ends(void **state)
{
    (void)state;
    expect_accepted(write_text("dos.pbrt", "\xef\xbb\xbf"
                                           "Camera \"perspective\"\r\nWorldBegin\r\n# a word\r\n"
                                           "LightSource \"point\"\r\nTranslate 0 0 3\r\nShape \"sphere\"\r\n"),
                    NULL);
    expect_refused(write_text("bad.pbrt", "\xef\xbb\xbf"
                                          "Camera \"perspective\"\r\nWorldBegin\r\n\tShape \"sphare\"\r\n"),
                   "bad.pbrt:3:2: error: ", "unknown shape \"sphare\"");
}

/* A megabyte without a line's end: the location is right, and what is shown of it is short. */
static void test_long_lines(void **state)
{
    (void)state;
    enum { LENGTH = 1 << 20 };
    char *text = malloc(LENGTH + 256);
    assert_non_null(text);
    size_t used = (size_t)sprintf(text, "%s", "Camera \"perspective\" WorldBegin LightSource \"point\" ");
    memset(text + used, ' ', LENGTH);
    sprintf(text + used + LENGTH, "Shape \"sphere\"");
    expect_accepted(write_text("long.pbrt", text), NULL);
    sprintf(text + used + LENGTH, "Shape \"sphare\"");
    char location[64];
    snprintf(location, sizeof location, "bad.pbrt:1:%zu: error: ", used + LENGTH + 1);
    program_run run = RUN("-q", "-o", "b.exr", write_text("bad.pbrt", text));
    expect_exit(&run, 1);
    expect_said(&run, location);
    assert_true(strlen(run.err) < 600);
    program_run_reset(&run);
    /* one word, and one string, as long */
    memset(text, 'x', LENGTH);
    text[LENGTH] = '\0';
    run = RUN("-q", "-o", "b.exr", write_text("word.pbrt", text));
    expect_exit(&run, 1);
    expect_said(&run, "word.pbrt:1:1: error: unknown directive xxx");
    assert_true(strlen(run.err) < 600);
    program_run_reset(&run);
    memcpy(text, "WorldBegin Shape \"", 18);
    strcpy(text + LENGTH - 1, "\"");
    run = RUN("-q", "-o", "b.exr", write_text("string.pbrt", text));
    expect_exit(&run, 1);
    expect_said(&run, "string.pbrt:1:12: error: unknown shape \"xxx");
    program_run_reset(&run);
    free(text);
}

/* ---- files that scenes name ---- */

static void test_includes(void **state)
{
    (void)state;
    write_text("b.pbrt", "Shape \"sphere\"\nInclude \"a.pbrt\"\n");
    expect_refused(write_text("a.pbrt", BEGIN "  Include \"b.pbrt\"\n"),
                   "b.pbrt:2:9: error: ", "\"a.pbrt\" includes itself: ");
    expect_refused(write_text("self.pbrt", "Include \"self.pbrt\"\n"), "self.pbrt:1:9: error: ", "includes itself");
    expect_refused(write_text("import.pbrt", BEGIN "Import \"import.pbrt\"\n"),
                   "import.pbrt:3:8: error: ", "includes itself");
    expect_refused(write_text("none.pbrt", BEGIN "Include \"nowhere.pbrt\"\n"),
                   "none.pbrt:3:9: error: ", "cannot read the file \"nowhere.pbrt\": No such file or directory");
    expect_refused(write_text("folder.pbrt", BEGIN "Include \".\"\n"), "folder.pbrt:3:9: error: ", "Is a directory");
    write_bytes("cut.gz", "\x1f\x8b\x08\0\0\0\0\0", 8);
    expect_refused(write_text("cut.pbrt", BEGIN "Include \"cut.gz\"\n"),
                   "cut.pbrt:3:9: error: ", "the gzip file is cut short");
}

static void test_closed_files(void **state)
{
    (void)state;
    const program_setting nobody = {.is_nobody = true};
    write_text("closed.ply", PLY_HEAD("ascii") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    write_text("closed.pbrt", BEGIN);
    write_text("a.pbrt", BEGIN "Include \"closed.pbrt\"\n");
    write_text("b.pbrt", BEGIN "Shape \"plymesh\" \"string filename\" \"closed.ply\"\n");
    assert_int_equal(chmod(in_folder("closed.ply"), 0), 0);
    assert_int_equal(chmod(in_folder("closed.pbrt"), 0), 0);
    assert_int_equal(chmod(folder, 0777), 0); /* the picture could be written */
    static const char *const CASES[][2] = {
        {"closed.pbrt", "closed.pbrt: error: "}, {"a.pbrt", "a.pbrt:3:9: error: "}, {"b.pbrt", "b.pbrt:3:1: error: "}};
    for (int i = 0; i < 3; i++) {
        program_run run = program_execute(&nobody, ARGUMENTS("-q", "-o", "a.exr", CASES[i][0]));
        expect_exit(&run, 1);
        expect_said(&run, CASES[i][1]);
        expect_said(&run, "Permission denied");
        program_run_reset(&run);
    }
    expect_listing("a.pbrt b.pbrt closed.pbrt closed.ply");
}

static void test_ply_files(void **state)
{
    (void)state;
    static const char BODY[] = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    static const struct {
        const char *text, *reason;
    } CASES[] = {
        {"", "this is no PLY file"},
        {"ply\n", "the file ends within its header"},
        {PLY_HEAD("ascii") "0 0 0\n1 0 0\n",
         "the header promises 3 of element \"vertex\", but the file is cut short: it has room for 2"},
        {PLY_HEAD("binary_little_endian") "0123456789", "the file is cut short"},
        {PLY_HEAD("ascii") "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "\"nan\" is no number"},
        {PLY_HEAD("ascii") "0 0 0\n1 0 1e39\n0 1 0\n3 0 1 2\n", "z is no finite number"},
        {PLY_HEAD("ascii") "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "index 3 is out of range, there are 3 vertices"},
        {PLY_HEAD("ascii") "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "index -1 is out of range, there are 3 vertices"},
    };
    static const char scene[] = "a.pbrt";
    write_text(scene, BEGIN "Shape \"plymesh\" \"string filename\" \"a.ply\"\n");
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        write_text("a.ply", CASES[i].text);
        expect_refused(scene, "a.pbrt:3:1: error: Shape \"plymesh\": ", CASES[i].reason);
    }
    /* packed, and cut in the middle */
    gzFile packed = gzopen(in_folder("a.ply"), "wb");
    assert_non_null(packed);
    assert_true(gzputs(packed, PLY_HEAD("ascii")) > 0 && gzputs(packed, BODY) > 0);
    assert_int_equal(gzclose(packed), Z_OK);
    size_t size;
    free(read_bytes(in_folder("a.ply"), &size));
    assert_int_equal(truncate(in_folder("a.ply"), (off_t)size - 9), 0);
    expect_refused(scene, "a.pbrt:3:1: error: Shape \"plymesh\": ", "the gzip file is cut short");
    remove(in_folder("a.ply"));
    expect_refused(scene, "a.pbrt:3:1: error: ", "No such file or directory");
    assert_int_equal(mkdir(in_folder("a.ply"), 0755), 0);
    expect_refused(scene, "a.pbrt:3:1: error: ", "Is a directory");
}

static void test_pictures(void **state)
{
    (void)state;
    /* a PNG whose header says 65535 x 65535: with its checksum, and nothing more */
    unsigned char huge[] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\xff\xff\0\0\xff\xff\x08\x02\0\0\0\0\0\0\0"
                           "\0\0\0\0IDAT\0\0\0\0\0\0\0\0IEND\0\0\0\0";
    enum { IHDR = 12, IHDR_SIZE = 17, IDAT = 37, IEND = 49 };
    static const int CHUNKS[3][2] = {{IHDR, IHDR_SIZE}, {IDAT, 4}, {IEND, 4}};
    for (int size = 0; size < 2; size++) { /* then 8 x 8, without data */
        for (int k = 0; k < 8 && size == 1; k++)
            huge[IHDR + 4 + k] = k % 4 == 3 ? 8 : 0;
        for (int i = 0; i < 3; i++) {
            unsigned long sum = crc32(0, huge + CHUNKS[i][0], (unsigned)CHUNKS[i][1]);
            for (int k = 0; k < 4; k++)
                huge[CHUNKS[i][0] + CHUNKS[i][1] + k] = (unsigned char)(sum >> (24 - 8 * k));
        }
        write_bytes(size == 0 ? "huge.png" : "bare.png", huge, sizeof huge - 1);
    }
    write_bytes("garbage.exr", "\x76\x2f\x31\x01 and so on", 14);
    write_text("garbage.hdr", "this is no picture");
    assert_int_equal(mkdir(in_folder("folder.png"), 0755), 0);
    static const char *const CASES[][2] = {
        {"none.png", "No such file or directory"},
        {"folder.png", "Is a directory"},
        {"garbage.exr", "cannot open it"},
        {"garbage.hdr", "cannot open it"},
        {"huge.png", "its header promises 65535 x 65535 pixels of 3 channels, which a file of 57 bytes cannot hold"}};
    for (int i = 0; i < 5; i++) {
        char text[512];
        snprintf(text, sizeof text, BEGIN "LightSource \"infinite\" \"string filename\" \"%s\"\n", CASES[i][0]);
        expect_refused(write_text("light.pbrt", text), "light.pbrt:3:24: error: ", CASES[i][1]);
        snprintf(text, sizeof text, BEGIN "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\"\n",
                 CASES[i][0]);
        expect_refused(write_text("texture.pbrt", text), "texture.pbrt:3:35: error: ", CASES[i][1]);
    }
    /* the library's reasons are one line */
    program_run run =
        RUN(QUICK, "-o", "a.exr",
            write_text("light.pbrt", BEGIN "LightSource \"infinite\" \"string filename\" \"bare.png\"\n"));
    expect_exit(&run, 1);
    expect_said(&run, "OpenImageIO cannot decode it: PNG read error: Not enough image data; PNG");
    program_run_reset(&run);
}

static void test_spectra(void **state)
{
    (void)state;
    static const char scene[] = "a.pbrt";
    write_text(scene, BEGIN "LightSource \"point\" \"spectrum I\" \"a.spd\"\n");
    write_text("a.spd", "400 1\n500 green\n");
    expect_refused(scene, "a.spd:2:5: error: ", "a number should stand here");
    write_text("a.spd", "400 1 500\n");
    expect_refused(scene, "a.pbrt:3:21: error: ", "has 3 numbers: it should have wavelengths and values");
    write_bytes("a.spd",
                "\x7f"
                "ELF\x02\x01\x01\0",
                8);
    expect_refused(scene, "a.spd:1:1: error: ", "0x7f");
}

/* ---- out of all proportion ---- */

static void test_more_than_fits(void **state)
{
    (void)state;
    expect_refused(write_text("levels.pbrt", BEGIN "Shape \"loopsubdiv\" \"integer levels\" 30 \"point3 P\" "
                                                   "[ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]\n"),
                   "levels.pbrt:3:20: error: ", "1 triangles subdivided 30 times are more than ");
    write_text("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                        "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                        "end_header\n0123456789");
    expect_refused(write_text("ply.pbrt", BEGIN "Shape \"plymesh\" \"string filename\" \"a.ply\"\n"),
                   "ply.pbrt:3:1: error: ", "4000000000 vertices are too many");
    /* parameters without end */
    enum { COUNT = 100000 };
    char *text = malloc(COUNT * 24), *end = text;
    assert_non_null(text);
    end += sprintf(end, BEGIN "Shape \"sphere\"\n");
    for (int i = 0; i < COUNT; i++)
        end += sprintf(end, "\"float p%d\" %d\n", i, i);
    expect_refused(write_text("parameters.pbrt", text),
                   "parameters.pbrt:1004:1: error: ", "Shape has more than 1000 parameters");
    /* states within states: no recursion that a stack could be too small for */
    end = text + sprintf(text, BEGIN);
    for (int i = 0; i < COUNT; i++)
        end += sprintf(end, "AttributeBegin\n");
    expect_refused(write_text("states.pbrt", text),
                   "states.pbrt:100003:1: error: ", "the file ends, but AttributeBegin at ");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_names_that_command_terminals),
        TEST_IN_FOLDER(test_no_scenes),
        TEST_IN_FOLDER(test_byte_order_mark_and_line_ends),
        TEST_IN_FOLDER(test_long_lines),
        TEST_IN_FOLDER(test_includes),
        TEST_IN_FOLDER(test_closed_files),
        TEST_IN_FOLDER(test_ply_files),
        TEST_IN_FOLDER(test_pictures),
        TEST_IN_FOLDER(test_spectra),
        TEST_IN_FOLDER(test_more_than_fits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_ply_file.c: PLY files: ascii, binary of both orders and gzip give one and the same mesh; every error by its
 * message; files cut short or damaged at every byte.
 * Threads: one. */
/* ctest: serial */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/ply_fixture.h"
#include "fixtures/sanitizer.h"
#include "model/ply_file.h"

#include <fcntl.h>

/* Seven vertices with normals, uvs and what is passed over; a triangle, a quadrilateral, a pentagon, and an edge. */
static text small_file(format f, const char *index_type, const char *count_type)
{
    static const int FACES[4][6] = {{3, 0, 1, 2}, {4, 0, 2, 3, 4}, {2, 5, 6}, {5, 6, 5, 4, 3, 2}};
    text t = {NULL, 0, 0};
    char line[256];
    snprintf(line, sizeof line,
             "ply\nformat %s 1.0\ncomment made by hand\nobj_info element vertex 99\nelement material 2\n"
             "property uchar red\nproperty list uint8 float weights\nelement vertex 7\nproperty double x\n",
             FORMAT_NAMES[f]);
    append_text(&t, line);
    append_text(&t,
                "property float y\nproperty short quality\nproperty float32 z\nproperty float nx\nproperty float ny\n"
                "property double nz\nproperty float s\nproperty float64 t\nelement face 4\nproperty uchar flags\n");
    snprintf(line, sizeof line,
             "property list %s %s vertex_indices\nproperty list uchar int face_indices\nend_header\n", count_type,
             index_type);
    append_text(&t, line);
    for (int i = 0; i < 2; i++) {
        append_number(&t, f, "uchar", 7 + i);
        append_number(&t, f, "uint8", i);
        if (i == 1)
            append_number(&t, f, "float", 0.25);
        end_line(&t, f);
    }
    for (int i = 0; i < 7; i++) {
        append_number(&t, f, "double", i * 0.5);
        append_number(&t, f, "float", (i * i) % 5 * 0.125);
        append_number(&t, f, "short", -3 * i);
        append_number(&t, f, "float32", i % 3 - 1.0);
        append_number(&t, f, "float", i - 3);
        append_number(&t, f, "float", 1);
        append_number(&t, f, "double", -2 * i);
        append_number(&t, f, "float", i / 8.0);
        append_number(&t, f, "float64", 1 - i / 8.0);
        end_line(&t, f);
    }
    for (int i = 0; i < 4; i++) {
        append_number(&t, f, "uchar", 200);
        append_number(&t, f, count_type, FACES[i][0]);
        for (int c = 1; c <= FACES[i][0]; c++)
            append_number(&t, f, index_type, FACES[i][c]);
        append_number(&t, f, "uchar", 1);
        append_number(&t, f, "int", -i);
        end_line(&t, f);
    }
    return t;
}

static void check_small(const char *path)
{
    static const uint32_t INDICES[] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 6, 5, 4, 6, 4, 3, 6, 3, 2};
    ply_mesh m;
    message[0] = '\0';
    if (ply_file_read(path, NULL, message, sizeof message, &m) != AG_OK)
        fail_msg("%s", message);
    assert_int_equal(m.mesh.vertex_count, 7);
    assert_int_equal(m.mesh.triangle_count, 6);
    assert_int_equal(m.lines, 1);
    assert_int_equal(m.odd_vectors, 0);
    assert_memory_equal(m.mesh.indices, INDICES, sizeof INDICES);
    for (int i = 0; i < 7; i++) {
        assert_vec3(m.mesh.positions[i], i * 0.5, (i * i) % 5 * 0.125, i % 3 - 1.0, 0);
        assert_vec3(m.mesh.normals[i], i - 3, 1, -2 * i, 0);
        assert_true(m.mesh.uvs[i].x == (float)i / 8.0f && m.mesh.uvs[i].y == 1.0f - (float)i / 8.0f);
    }
    assert_vec3(m.mesh.positions[7], 0, 0, 0, 0);
    ply_mesh_reset(&m);
}

/* --- reading --- */

static void formats_and_types_give_one_mesh(void **state)
{
    (void)state;
    static const char *const TYPES[] = {"char", "uchar", "short", "ushort", "int",   "uint",
                                        "int8", "uint8", "int16", "uint16", "int32", "uint32"};
    for (int f = ASCII; f <= BIG; f++)
        for (int i = 0; i < 12; i++) {
            text t = small_file((format)f, TYPES[i], TYPES[(i + 7 * f) % 12]);
            check_small(write_file("a.ply", t.bytes, t.size));
            check_small(write_file("a.ply.gz", t.bytes, t.size));
            free(t.bytes);
        }
}

static ag_status read_text(const char *ply, ply_mesh *out_mesh)
{
    return ply_file_read(write_file("a.ply", ply, strlen(ply)), NULL, message, sizeof message, out_mesh);
}

static void ascii_files_may_be_laid_out_freely(void **state)
{
    (void)state;
    static const char *const FILES[] = {
        HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        HEAD "0 0 0 1e0 +0 -0.0\r\n\n\t0 1 .0 3 0\n1 2   \n\n",
        "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x \r\nproperty\tfloat  y\r\nproperty float z\r\n"
        "element face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 "
        "2\r\n",
        "ply\rformat ascii 1.0\relement vertex 3\rproperty float x\rproperty float y\rproperty float z\r"
        "element face 1\rproperty list uchar int vertex_index\rend_header\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r",
        /* faces first, lists within vertices, kinds without properties or without any of them */
        "ply\nformat ascii 1.0\nelement nothing 1000000000000\nelement none 0\nproperty int a\n" FACE(1)
            VERTEX(3) "property list uchar float weights\nelement edge 1\nproperty int a\nend_header\n"
                      "3 0 1 2\n0 0 0 0\n1 0 0 2 5 6\n0 1 0 1 9\n7\n",
    };
    for (size_t i = 0; i < sizeof FILES / sizeof *FILES; i++) {
        ply_mesh m;
        if (read_text(FILES[i], &m) != AG_OK)
            fail_msg("file %zu: %s", i, message);
        const uint32_t indices[] = {0, 1, 2};
        assert_int_equal(m.mesh.vertex_count, 3);
        assert_int_equal(m.mesh.triangle_count, 1);
        assert_memory_equal(m.mesh.indices, indices, sizeof indices);
        assert_vec3(m.mesh.positions[1], 1, 0, 0, 0);
        assert_vec3(m.mesh.positions[2], 0, 1, 0, 0);
        assert_null(m.mesh.normals);
        assert_null(m.mesh.uvs);
        ply_mesh_reset(&m);
    }
}

static void texture_coordinates_have_four_names(void **state)
{
    (void)state;
    static const char *const NAMES[][2] = {
        {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}, {"v", "u"}, {"u", "w"}};
    for (int i = 0; i < 6; i++) {
        char file[512];
        snprintf(file, sizeof file,
                 "ply\nformat ascii 1.0\n" VERTEX(3) "property float %s\nproperty float %s\nproperty float s\n"
                                                     "property float t\n" FACE(
                                                         0) "end_header\n0 0 0 1 2 8 9\n1 0 0 3 4 8 9\n0 1 0 5 6 8 9\n",
                 NAMES[i][0], NAMES[i][1]);
        ply_mesh m;
        assert_int_equal(read_text(file, &m), AG_OK);
        assert_non_null(m.mesh.uvs);
        assert_near(m.mesh.uvs[1].x, i == 4 ? 4 : 3, 0);
        assert_near(m.mesh.uvs[1].y, i == 4 ? 3 : i == 5 ? 9 : 4, 0);
        ply_mesh_reset(&m);
    }
}

/* Several times the reader's buffer, so that records lie across its ends. */
static void large_files_are_read(void **state)
{
    (void)state;
    enum { COUNT = 100003 };
    for (int f = ASCII; f <= BIG; f++) {
        char head[256];
        text t = {NULL, 0, 0};
        snprintf(head, sizeof head,
                 "ply\nformat %s 1.0\nelement vertex %d\nproperty double x\nproperty float y\nproperty float z\n"
                 "property char c\nelement face %d\nproperty list uchar uint vertex_indices\nend_header\n",
                 FORMAT_NAMES[f], COUNT, COUNT);
        append_text(&t, head);
        for (int i = 0; i < COUNT; i++) {
            append_number(&t, (format)f, "double", i * 0.25);
            append_number(&t, (format)f, "float", -i);
            append_number(&t, (format)f, "float", i % 1000);
            append_number(&t, (format)f, "char", 0);
            end_line(&t, (format)f);
        }
        for (int i = 0; i < COUNT; i++) {
            int corners = i % 7 == 0 ? 4 : 3;
            append_number(&t, (format)f, "uchar", corners);
            for (int c = 0; c < corners; c++)
                append_number(&t, (format)f, "uint", (i + c) % COUNT);
            end_line(&t, (format)f);
        }
        for (int gz = 0; gz < 2; gz++) {
            ply_mesh m;
            const char *path = write_file(gz ? "a.ply.gz" : "a.ply", t.bytes, t.size);
            if (ply_file_read(path, NULL, message, sizeof message, &m) != AG_OK)
                fail_msg("%s", message);
            assert_int_equal(m.mesh.vertex_count, COUNT);
            assert_int_equal(m.mesh.triangle_count, COUNT + (COUNT + 6) / 7);
            const uint32_t *index = m.mesh.indices;
            for (int i = 0; i < COUNT; i++) {
                assert_true(m.mesh.positions[i].x == (float)(i * 0.25) && m.mesh.positions[i].y == (float)-i &&
                            m.mesh.positions[i].z == (float)(i % 1000));
                for (int k = 0; k < (i % 7 == 0 ? 2 : 1); k++, index += 3)
                    assert_true(index[0] == (uint32_t)i && index[1] == (uint32_t)((i + 1 + k) % COUNT) &&
                                index[2] == (uint32_t)((i + 2 + k) % COUNT));
            }
            ply_mesh_reset(&m);
        }
        free(t.bytes);
    }
}

/* --- errors --- */

static void check_error(const char *ply, const char *expected)
{
    ply_mesh m;
    char whole[512];
    ag_status status = read_text(ply, &m);
    snprintf(whole, sizeof whole, "%s%s", in_folder("a.ply"), expected);
    assert_int_equal(status, AG_ERROR_INPUT);
    assert_string_equal(message, whole);
    assert_null(m.mesh.positions);
    assert_null(m.mesh.indices);
}

static void errors_name_line_and_cause(void **state)
{
    (void)state;
#define ASCII_HEAD "ply\nformat ascii 1.0\n"
    check_error("", ":1: this is no PLY file: it does not begin with a line \"ply\"");
    check_error("plyformat", ":1: this is no PLY file: it does not begin with a line \"ply\"");
    check_error("ply\n", ":2: the file ends within its header");
    check_error("ply\nformat ascii 1.0\nend_header", ":3: the header has no element \"vertex\"");
    check_error("ply\nend_header\n", ":2: the header has no format");
    check_error("ply\nelement vertex 3\n", ":2: the format should come first, not \"element\"");
    check_error("ply\nformat ascii\n", ":2: \"format\" should have a name and a version");
    check_error("ply\nformat pdf 1.0\n", ":2: unknown format \"pdf\"");
    check_error("ply\nformat ascii 2.0\n", ":2: unknown version \"2.0\" of the format");
    check_error(ASCII_HEAD "format ascii 1.0\n", ":3: the format is there twice");
    check_error(ASCII_HEAD "elephant vertex 3\n", ":3: unknown word \"elephant\"");
    check_error(ASCII_HEAD "element vertex\n", ":3: \"element\" should have a name and a count");
    check_error(ASCII_HEAD "element vertex -3\n", ":3: \"-3\" is no count");
    check_error(ASCII_HEAD "element vertex 3.5\n", ":3: \"3.5\" is no count");
    check_error(ASCII_HEAD "element vertex 99999999999999999999\n", ":3: the count 99999999999999999999 is too large");
    check_error(ASCII_HEAD VERTEX(3) VERTEX(3), ":7: element \"vertex\" is there twice");
    check_error(ASCII_HEAD "property float x\n", ":3: a property before any element");
    check_error(ASCII_HEAD "element vertex 3\nproperty float\n",
                ":4: \"property\" should have a type and a name, or \"list\", two types and a name");
    check_error(ASCII_HEAD "element vertex 3\nproperty real x\n", ":4: unknown type \"real\"");
    check_error(ASCII_HEAD "element vertex 3\nproperty list real int x\n", ":4: unknown type \"real\"");
    check_error(ASCII_HEAD "element vertex 3\nproperty list float int x\n",
                ":4: a list's count should be of an integer type, not \"float\"");
    check_error(ASCII_HEAD "element face 3\nproperty list int float vertex_index\n",
                ":4: \"vertex_index\" should be of an integer type, not \"float\"");
    check_error(ASCII_HEAD "element vertex 3\nproperty float x\nproperty float x\n",
                ":5: property \"x\" is there twice");
    check_error(ASCII_HEAD "element vertex 3\nproperty float x\nproperty float y\n" FACE(1) "end_header\n",
                ":8: vertices have no property \"z\"");
    check_error(ASCII_HEAD "element vertex 3\nproperty list uchar float x\nproperty float y\n" FACE(1) "end_header\n",
                ":8: vertices have no property \"x\"");
    check_error(ASCII_HEAD VERTEX(3) "end_header\n", ":7: the header has no element \"face\"");
    check_error(ASCII_HEAD VERTEX(3) "element face 1\nproperty int vertex_indices\nend_header\n",
                ":9: faces have no list \"vertex_indices\" or \"vertex_index\"");
    check_error(ASCII_HEAD VERTEX(2000000000) FACE(1) "end_header\n", ":9: 2000000000 vertices are too many");
    check_error(HEAD "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", ":11:3: vertex 1: \"nan\" is no number");
    check_error(HEAD "0 0 0\n1 -inf 0\n0 1 0\n3 0 1 2\n", ":11:3: vertex 1: \"-inf\" is no number");
    check_error(HEAD "0 0 0\n1 0 1e39\n0 1 0\n3 0 1 2\n", ":11:5: vertex 1: z is no finite number");
    check_error(HEAD "0 0 0\n1 0 0,5\n0 1 0\n3 0 1 2\n", ":11:5: vertex 1: \"0,5\" is no number");
    check_error(HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ":13:7: face 0: index 3 is out of range, there are 3 vertices");
    check_error(HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
                ":13:7: face 0: index -1 is out of range, there are 3 vertices");
    check_error(HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1.5 2\n",
                ":13:5: face 0: index 1.5 is out of range, there are 3 vertices");
    check_error(HEAD "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", ":13:1: face 0: a list cannot have -3 entries");
    check_error(HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 \n", ":14:1: face 0: the file ends here");
    check_error(HEAD "0 0 0\n1 0 0\n",
                ":3: the header promises 3 of element \"vertex\", but the file is cut short: it has "
                "room for 2");
    check_error(HEAD "0 0 0\n1 0 0\n0 1 0\n", ":13:1: face 0: the file ends here");
}

static void binary_errors_name_element_and_byte(void **state)
{
    (void)state;
    static const struct {
        double x;
        int32_t index;
        const char *expected;
    } CASES[] = {{INFINITY, 2, ": vertex 1 (byte %zu): x is no finite number"},
                 {NAN, 2, ": vertex 1 (byte %zu): x is no finite number"},
                 {0, 3, ": face 1 (byte %zu): index 3 is out of range, there are 3 vertices"},
                 {0, -1, ": face 1 (byte %zu): index -1 is out of range, there are 3 vertices"},
                 {0, INT32_MIN, ": face 1 (byte %zu): index -2147483648 is out of range, there are 3 vertices"}};
    for (int f = LITTLE; f <= BIG; f++)
        for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
            char head[256], expected[256], whole[512];
            text t = {NULL, 0, 0};
            snprintf(head, sizeof head, "ply\nformat %s 1.0\n" VERTEX(3) FACE(2) "end_header\n", FORMAT_NAMES[f]);
            append_text(&t, head);
            size_t begin = t.size;
            for (int i = 0; i < 9; i++)
                append_number(&t, (format)f, "float", i == 3 ? CASES[k].x : i);
            for (int i = 0; i < 2; i++) {
                append_number(&t, (format)f, "uchar", 3);
                for (int c = 0; c < 3; c++)
                    append_number(&t, (format)f, "int", i == 1 && c == 2 ? CASES[k].index : c);
            }
            snprintf(expected, sizeof expected, CASES[k].expected, begin + (k < 2 ? 12 : 36 + 13 + 9));
            const char *path = write_file("a.ply", t.bytes, t.size);
            snprintf(whole, sizeof whole, "%s%s", path, expected);
            ply_mesh m;
            assert_int_equal(ply_file_read(path, NULL, message, sizeof message, &m), AG_ERROR_INPUT);
            assert_string_equal(message, whole);
            free(t.bytes);
        }
}

static void files_that_cannot_be_read_say_why(void **state)
{
    (void)state;
    ply_mesh m;
    expect_failure(ply_file_read(in_folder("none.ply"), NULL, message, sizeof message, &m), AG_ERROR_INPUT,
                   "none.ply: No such file or directory");
    expect_failure(ply_file_read(folder, NULL, message, sizeof message, &m), AG_ERROR_INPUT, "Is a directory");
    /* the checksum of a gzip file, in its last 8 bytes, is looked at */
    text t = small_file(LITTLE, "int", "uchar");
    size_t size;
    unsigned char *packed = read_bytes(write_file("a.ply.gz", t.bytes, t.size), &size);
    packed[size - 6] ^= 1;
    expect_failure(ply_file_read(write_file("b.ply", packed, size), NULL, message, sizeof message, &m), AG_ERROR_INPUT,
                   "incorrect data check");
    free(packed);
    free(t.bytes);
}

static void a_cancelled_run_stops(void **state)
{
    (void)state;
    text t = small_file(LITTLE, "int", "uchar");
    const char *path = write_file("a.ply", t.bytes, t.size);
    run_context run;
    ply_mesh m;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    assert_int_equal(ply_file_read(path, &run, message, sizeof message, &m), AG_OK);
    ply_mesh_reset(&m);
    run_cancel(&run);
    assert_int_equal(ply_file_read(path, &run, message, sizeof message, &m), AG_CANCELLED);
    run_context_reset(&run);
    free(t.bytes);
}

/* A file cut anywhere is an error, but where only the last line's end is missing. */
static void files_cut_anywhere_are_errors(void **state)
{
    (void)state;
    for (int f = ASCII; f <= BIG; f++) {
        text t = small_file((format)f, "int", "uchar");
        size_t packed_size;
        unsigned char *packed = read_bytes(write_file("a.ply.gz", t.bytes, t.size), &packed_size);
        for (int gz = 0; gz < 2; gz++) {
            const void *bytes = gz ? (const void *)packed : t.bytes;
            size_t size = gz ? packed_size : t.size, needed = !gz && f == ASCII ? size - 2 : size;
            const char *path = write_file("cut", bytes, size);
            for (size_t length = size; length-- > 0;) {
                ply_mesh m;
                assert_int_equal(truncate(path, (off_t)length), 0);
                ag_status status = ply_file_read(path, NULL, message, sizeof message, &m);
                if (status != (length < needed ? AG_ERROR_INPUT : AG_OK))
                    fail_msg("%s cut to %zu of %zu bytes: %s", FORMAT_NAMES[f], length, size, ag_status_text(status));
                ply_mesh_reset(&m);
            }
        }
        free(packed);
        free(t.bytes);
    }
}

/* Whatever a byte is, reading ends, and what is read is whole. */
static void files_damaged_anywhere_do_no_harm(void **state)
{
    (void)state;
    static const unsigned char VALUES[] = {0x00, 0x20, 0x39, 0xff};
    int good = 0, bad = 0;
    for (int f = ASCII; f <= BIG; f++) {
        text t = small_file((format)f, "int", "int");
        const char *path = write_file("a.ply", t.bytes, t.size);
        int descriptor = open(path, O_WRONLY);
        assert_true(descriptor >= 0);
        for (size_t i = 0; i < t.size; i++)
            for (size_t v = 0; v <= sizeof VALUES; v++) {
                const void *byte = v < sizeof VALUES ? (const void *)&VALUES[v] : &t.bytes[i];
                assert_int_equal(pwrite(descriptor, byte, 1, (off_t)i), 1);
                if (v == sizeof VALUES)
                    continue; /* it is as it was */
                ply_mesh m;
                ag_status status = ply_file_read(path, NULL, message, sizeof message, &m);
                assert_true(status == AG_OK || status == AG_ERROR_INPUT);
                good += status == AG_OK;
                bad += status != AG_OK;
                for (uint32_t k = 0; k < 3 * m.mesh.triangle_count; k++)
                    assert_true(m.mesh.indices[k] < m.mesh.vertex_count);
                for (uint32_t k = 0; k < m.mesh.vertex_count; k++)
                    assert_true(vec3_is_finite(m.mesh.positions[k]));
                ply_mesh_reset(&m);
            }
        close(descriptor);
        free(t.bytes);
    }
    assert_true(good > 500 && bad > 500);
}

/* With a gigabyte of address space left, a header's promise of many gigabytes is an error of the file. */
static void memory_is_not_taken_by_the_headers_word(void **state)
{
    (void)state;
    static const char *const FILES[] = {
        "ply\nformat binary_little_endian 1.0\n" VERTEX(1000000000) FACE(1) "end_header\n0123456789abcdef",
        "ply\nformat binary_little_endian 1.0\n" VERTEX(1) FACE(1000000000) "end_header\n0123456789ab\1\1",
        "ply\nformat ascii 1.0\n" VERTEX(1) FACE(1000000000000) "end_header\n0 0 0\n1 0\n",
        "ply\nformat ascii 1.0\n" VERTEX(1) "element face 1\nproperty list uint int vertex_index\nend_header\n"
                                            "0 0 0\n4000000000 0 0 0 0\n",
        "ply\nformat binary_big_endian 1.0\nelement junk 3\nproperty list uint double a\n" VERTEX(1)
            FACE(1) "end_header\n\377\377\377\377 and so on",
    };
#if !IS_SANITIZED
    struct rlimit saved;
    assert_int_equal(getrlimit(RLIMIT_AS, &saved), 0);
    assert_int_equal(setrlimit(RLIMIT_AS, &(struct rlimit){(rlim_t)1 << 30, saved.rlim_max}), 0);
#endif
    for (size_t i = 0; i < sizeof FILES / sizeof *FILES; i++)
        for (int gz = 0; gz < 2; gz++) {
            ply_mesh m;
            const char *path = write_file(gz ? "a.ply.gz" : "a.ply", FILES[i], strlen(FILES[i]));
            ag_status status = ply_file_read(path, NULL, message, sizeof message, &m);
            if (status != AG_ERROR_INPUT)
                fail_msg("file %zu: %s", i, ag_status_text(status));
            if (!gz && i < 3)
                assert_non_null(strstr(message, "the header promises 1000000000"));
        }
#if !IS_SANITIZED
    assert_int_equal(setrlimit(RLIMIT_AS, &saved), 0);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(formats_and_types_give_one_mesh),
        TEST_IN_FOLDER(ascii_files_may_be_laid_out_freely),
        TEST_IN_FOLDER(texture_coordinates_have_four_names),
        TEST_IN_FOLDER(large_files_are_read),
        TEST_IN_FOLDER(errors_name_line_and_cause),
        TEST_IN_FOLDER(binary_errors_name_element_and_byte),
        TEST_IN_FOLDER(files_that_cannot_be_read_say_why),
        TEST_IN_FOLDER(a_cancelled_run_stops),
        TEST_IN_FOLDER(files_cut_anywhere_are_errors),
        TEST_IN_FOLDER(files_damaged_anywhere_do_no_harm),
        TEST_IN_FOLDER(memory_is_not_taken_by_the_headers_word),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_scene_borrowing.c: meshes whose arrays stay the host's: the bits of copied ones, no copy where none is needed,
 * no write, and what is changed in them is seen when it is said. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/scene_desk.h"

#include <malloc.h>
#include <sys/mman.h>

enum { SIDE = 200, VERTICES = SIDE * SIDE, TRIANGLES_OF_GRID = 2 * (SIDE - 1) * (SIDE - 1), COUNT = 3 * SIZE * SIZE };

/* A wavy sheet, in memory that can be locked against writing; behind P there is room. */
typedef struct sheet {
    float *p, *uv, *n;
    int32_t *indices;
    size_t bytes;
} sheet;

static void *map(size_t bytes)
{
    void *at = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(at != MAP_FAILED);
    return at;
}

static void make_heights(sheet *s, float phase)
{
    for (int i = 0; i < VERTICES; i++) {
        const float x = (float)(i % SIDE) / (SIDE - 1), y = (float)(i / SIDE) / (SIDE - 1);
        s->p[3 * i] = 2.0f * x - 1.0f;
        s->p[3 * i + 1] = 2.0f * y - 1.0f;
        s->p[3 * i + 2] = 0.3f + 0.2f * sinf(9.0f * x + phase) * cosf(7.0f * y);
        s->uv[2 * i] = x;
        s->uv[2 * i + 1] = y;
        s->n[3 * i] = 0.3f * x;
        s->n[3 * i + 1] = 0.1f;
        s->n[3 * i + 2] = -2.0f;
    }
}

static void make_sheet(sheet *s)
{
    s->bytes = VERTICES * 8 * sizeof(float);
    s->p = map(s->bytes);
    s->uv = map(s->bytes);
    s->n = map(s->bytes);
    s->indices = map(TRIANGLES_OF_GRID * 3 * sizeof *s->indices);
    make_heights(s, 0.0f);
    int32_t *to = s->indices;
    for (int y = 0; y + 1 < SIDE; y++)
        for (int x = 0; x + 1 < SIDE; x++) {
            const int32_t at = y * SIDE + x, cell[6] = {at, at + 1, at + SIDE, at + 1, at + SIDE + 1, at + SIDE};
            memcpy(to, cell, sizeof cell);
            to += 6;
        }
}

static void lock_sheet(sheet *s, int protection)
{
    assert_int_equal(mprotect(s->p, s->bytes, protection), 0);
    assert_int_equal(mprotect(s->uv, s->bytes, protection), 0);
    assert_int_equal(mprotect(s->n, s->bytes, protection), 0);
    assert_int_equal(mprotect(s->indices, TRIANGLES_OF_GRID * 3 * sizeof *s->indices, protection), 0);
}

static void drop_sheet(sheet *s)
{
    munmap(s->p, s->bytes);
    munmap(s->uv, s->bytes);
    munmap(s->n, s->bytes);
    munmap(s->indices, TRIANGLES_OF_GRID * 3 * sizeof *s->indices);
}

typedef struct words {
    ag_parameter parameters[4];
    ag_shape shape;
} words;

static void describe(const sheet *s, bool is_borrowed, bool has_normals, words *w)
{
    w->parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, 3 * VERTICES, .floats = s->p};
    w->parameters[1] = (ag_parameter){"uv", AG_PARAMETER_POINT2, 2 * VERTICES, .floats = s->uv};
    w->parameters[2] = (ag_parameter){"indices", AG_PARAMETER_INTEGER, 3 * TRIANGLES_OF_GRID, .integers = s->indices};
    w->parameters[3] = (ag_parameter){"N", AG_PARAMETER_NORMAL, 3 * VERTICES, .floats = s->n};
    w->shape = ag_default_shape();
    w->shape.type = "trianglemesh";
    w->shape.parameters = w->parameters;
    w->shape.parameter_count = has_normals ? 4 : 3;
    w->shape.borrows_arrays = is_borrowed;
}

static void render_sheet(const sheet *s, bool is_borrowed, int variant, float *out_pixels)
{
    desk d;
    words w;
    ag_instance shown = ag_default_instance();
    begin_lit(&d);
    describe(s, is_borrowed, variant == 1, &w);
    w.shape.world_from_shape = variant == 2 ? ASIDE : NULL;
    w.shape.world_from_shape_end = variant == 3 ? ASIDE : NULL;
    w.shape.is_light = variant == 4;
    w.shape.object = shown.object = variant == 5 ? "o" : NULL;
    assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_OK);
    if (variant == 5)
        assert_int_equal(ag_scene_add_instance(d.made, &shown, NULL), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    render(d.context, d.made, out_pixels);
    end(&d);
}

/* Borrowed arrays may lie in read-only memory: nobody writes to them. */
static void borrowed_arrays_have_the_bits_of_copied_ones(void **state)
{
    (void)state;
    sheet s;
    float copied[COUNT], borrowed[COUNT];
    make_sheet(&s);
    for (int variant = 0; variant < 8; variant++) {
        if (variant == 6)
            s.p[100] = -0.0f; /* which the identity makes 0 */
        if (variant == 7)
            s.indices[31] = s.indices[30]; /* a triangle without area */
        lock_sheet(&s, PROT_READ);
        render_sheet(&s, false, variant, copied);
        render_sheet(&s, true, variant, borrowed);
        lock_sheet(&s, PROT_READ | PROT_WRITE);
        assert_memory_equal(copied, borrowed, sizeof copied);
    }
    drop_sheet(&s);
}

static size_t used_bytes(void)
{
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/* The heap, once the call is over: a copy is all arrays, what is borrowed hardly anything. */
static void borrowed_arrays_take_no_memory(void **state)
{
    (void)state;
    const size_t arrays = VERTICES * 5 * sizeof(float) + TRIANGLES_OF_GRID * 3 * sizeof(int32_t);
    sheet s;
    size_t grown[2];
    make_sheet(&s);
    for (int is_borrowed = 0; is_borrowed < 2; is_borrowed++) {
        desk d;
        words w;
        begin_lit_editable(&d);
        describe(&s, is_borrowed, false, &w);
        const size_t before = used_bytes();
        assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_OK);
        const size_t after = used_bytes();
        grown[is_borrowed] = after > before ? after - before : 0; /* the heap may shrink */
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        end(&d);
    }
    drop_sheet(&s);
    if (used_bytes() == 0)
        skip(); /* a sanitizer's heap, which does not tell */
    assert_true(grown[0] >= arrays);
    if (grown[1] >= arrays / 100)
        fail_msg("%zu bytes were taken for arrays of %zu that are borrowed", grown[1], arrays);
}

/* Changes that the host makes in borrowed arrays count once it has told of them. */
static void changed_arrays_are_seen(void **state)
{
    (void)state;
    sheet s;
    desk d;
    words w;
    ag_handle handle;
    float first[COUNT], changed[COUNT], afresh[COUNT];
    make_sheet(&s);
    begin_lit_editable(&d);
    describe(&s, true, true, &w);
    assert_int_equal(ag_scene_add_shape(d.made, &w.shape, &handle), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    render(d.context, d.made, first);
    make_heights(&s, 2.0f);
    assert_int_equal(ag_scene_change_shape(d.made, handle, &w.shape), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    assert_int_equal(ag_scene_commit_counts(d.made).trees_built, 2);
    render(d.context, d.made, changed);
    render_sheet(&s, false, 1, afresh);
    assert_memory_not_equal(first, changed, sizeof first);
    assert_memory_equal(changed, afresh, sizeof changed);
    /* removed, it is no longer needed */
    assert_int_equal(ag_scene_remove(d.made, handle), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    drop_sheet(&s);
    render(d.context, d.made, changed);
    end(&d);
}

/* Numbers written in place, and a commit that fails: nothing is rendered by trees that do not fit them, and what comes
 * right afterwards is the scene made afresh. Numbers that are as they were do no harm. */
static void arrays_written_before_a_commit_that_fails(void **state)
{
    (void)state;
    sheet s;
    float first[COUNT], after[COUNT], afresh[COUNT];
    ag_film *film = NULL;
    const ag_render_settings settings = ag_default_render_settings();
    make_sheet(&s);
    for (int is_removed = 0; is_removed < 2; is_removed++) {
        desk d;
        words w;
        ag_handle handle;
        begin_lit_editable(&d);
        make_heights(&s, 0.0f);
        describe(&s, true, true, &w);
        assert_int_equal(ag_scene_add_shape(d.made, &w.shape, &handle), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        render(d.context, d.made, first);
        assert_int_equal(ag_scene_change_shape(d.made, handle, &w.shape), AG_OK);
        assert_int_equal(ag_scene_assign_material(d.made, handle, "nothing"), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
        render(d.context, d.made, after); /* nobody has written there */
        assert_memory_equal(first, after, sizeof first);
        make_heights(&s, 2.0f);
        assert_int_equal(ag_scene_change_shape(d.made, handle, &w.shape), AG_OK);
        assert_int_equal(ag_scene_assign_material(d.made, handle, "nothing"), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
        assert_int_equal(ag_render(d.context, d.made, &settings, &film), AG_ERROR_ARGUMENT);
        expect_said(&d, "ag_scene_add_shape:1:0: error: its borrowed arrays were written to");
        assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
        assert_int_equal(ag_scene_assign_material(d.made, handle, NULL), AG_OK); /* which reads nothing anew */
        assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
        assert_int_equal(ag_render(d.context, d.made, &settings, &film), AG_ERROR_ARGUMENT);
        if (is_removed) {
            assert_int_equal(ag_scene_remove(d.made, handle), AG_OK);
            assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_OK);
        } else {
            assert_int_equal(ag_scene_change_shape(d.made, handle, &w.shape), AG_OK);
        }
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        render(d.context, d.made, after);
        render_sheet(&s, false, 1, afresh);
        assert_memory_not_equal(first, after, sizeof first);
        assert_memory_equal(after, afresh, sizeof after);
        end(&d);
    }
    drop_sheet(&s);
}

/* Begins a scene with a sheet whose arrays it borrows, and does not commit it. out_handle: NULL is fine. */
static void begin_with_borrowed(desk *d, bool is_editable, const sheet *s, ag_handle *out_handle)
{
    words w;
    if (is_editable)
        begin_lit_editable(d);
    else
        begin_lit(d);
    describe(s, true, true, &w);
    assert_int_equal(ag_scene_add_shape(d->made, &w.shape, out_handle), AG_OK);
}

/* Arrays that the host has freed are named by renderings and commits, and read by neither: unmapped ones, and such as
 * allocators write into. */
static void freed_arrays_are_told(void **state)
{
    (void)state;
    ag_film *film = NULL;
    const ag_render_settings settings = ag_default_render_settings();
    for (int variant = 0; variant < 4; variant++) {
        const bool is_editable = variant % 2 == 1, is_unmapped = variant / 2 == 1;
        desk d;
        sheet s;
        ag_handle handle;
        float pixels[COUNT];
        make_sheet(&s);
        begin_with_borrowed(&d, is_editable, &s, &handle);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        render(d.context, d.made, pixels);
        if (is_unmapped)
            drop_sheet(&s);
        else
            memset(s.indices, 0x7f, 2 * sizeof(void *)); /* as the links of a list of free memory */
        assert_int_equal(ag_render(d.context, d.made, &settings, &film), AG_ERROR_ARGUMENT);
        expect_said(&d, "a mesh of 79202 triangles: arrays that it borrows were freed or written to");
        if (is_editable) {
            assert_int_equal(ag_scene_assign_material(d.made, handle, NULL), AG_OK);
            assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
            expect_said(
                &d, "error: arrays that it borrows were freed or written to: the shape has to be changed or removed");
            assert_int_equal(ag_render(d.context, d.made, &settings, &film), AG_ERROR_ARGUMENT);
            assert_int_equal(ag_scene_remove(d.made, handle), AG_OK);
            assert_int_equal(ag_scene_commit(d.made), AG_OK);
            render(d.context, d.made, pixels);
        }
        end(&d);
        if (!is_unmapped)
            drop_sheet(&s);
    }
}

/* Borrowed arrays that the host frees before the first commit are an error, which is told. */
static void arrays_freed_before_the_commit_are_told(void **state)
{
    (void)state;
    for (int is_editable = 0; is_editable < 2; is_editable++) {
        desk d;
        sheet s;
        make_sheet(&s);
        begin_with_borrowed(&d, is_editable, &s, NULL);
        drop_sheet(&s);
        assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
        expect_said(&d, "arrays that it borrows were freed or written to");
        end(&d);
    }
}

static void refused(desk *d, const words *w, const char *what)
{
    assert_int_equal(ag_scene_add_shape(d->made, &w->shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(d, what);
}

/* A byte further. */
static const void *skewed(const void *array) { return (const char *)array + 1; }

/* Borrowed or copied, it is ignored. */
static void uv_of_another_count_is_told(void **state)
{
    (void)state;
    sheet s;
    make_sheet(&s);
    for (int is_borrowed = 0; is_borrowed < 2; is_borrowed++) {
        desk d;
        words w;
        begin_lit_editable(&d);
        describe(&s, is_borrowed, false, &w);
        w.parameters[1].count = 8;
        assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_OK);
        expect_said(&d, "ag_scene_add_shape:1:2: warning: Shape \"trianglemesh\": \"uv\" should have 80000 numbers as "
                        "\"P\" goes, but has 8, and is ignored");
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        end(&d);
    }
    drop_sheet(&s);
}

static void what_cannot_be_borrowed_is_told(void **state)
{
    (void)state;
    static const double doubles[9] = {0.0};
    static const float odd[9] = {0.0f, NAN};
    static const int32_t far[3] = {0, 1, 3};
    sheet s;
    desk d;
    words w;
    make_sheet(&s);
    begin_lit_editable(&d);
    describe(&s, true, false, &w);
    w.shape.type = "sphere";
    refused(&d, &w, "of a \"trianglemesh\" alone arrays can be borrowed");
    describe(&s, true, false, &w);
    w.parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, 9, .doubles = doubles};
    refused(&d, &w, "ag_scene_add_shape:2:1: error: \"P\": what is borrowed of it should be floats");
    w.parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, 8, .floats = odd};
    refused(&d, &w, "its count is no multiple of 3");
    w.parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, 9, .floats = odd};
    refused(&d, &w, "a value is not finite");
    describe(&s, true, false, &w);
    w.parameters[0].floats = skewed(s.p);
    refused(&d, &w, "\"P\": to be borrowed it should begin at an address that is a multiple of 4");
    describe(&s, true, false, &w);
    w.parameters[1].floats = skewed(s.uv);
    refused(&d, &w, "\"uv\": to be borrowed it should begin at an address that is a multiple of 4");
    describe(&s, true, false, &w);
    w.parameters[2].integers = skewed(s.indices);
    refused(&d, &w, "\"indices\": to be borrowed it should begin at an address that is a multiple of 4");
    describe(&s, true, false, &w);
    w.shape.parameter_count = 2;
    refused(&d, &w, "there should be \"point3 P\" and \"integer indices\"");
    w.shape.parameters = NULL;
    refused(&d, &w, "of 2 parameters there is no array");
    describe(&s, true, false, &w);
    w.parameters[0].count = 9;
    w.parameters[1].count = 6;
    w.parameters[2] = (ag_parameter){"indices", AG_PARAMETER_INTEGER, 3, .integers = far};
    assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_ERROR_SCENE);
    expect_said(&d, "index 3 (value 3 of \"indices\") is out of range, there are 3 vertices");
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    drop_sheet(&s);
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(borrowed_arrays_have_the_bits_of_copied_ones, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(borrowed_arrays_take_no_memory, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(changed_arrays_are_seen, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(arrays_written_before_a_commit_that_fails, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(freed_arrays_are_told, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(arrays_freed_before_the_commit_are_told, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(uv_of_another_count_is_told, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_cannot_be_borrowed_is_told, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_arena.c: scratch memory is aligned, apart, given back in order, and used again.
 * Threads: one. */
#include "arena.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

static void test_aligned_and_apart(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    arena *a = arena_create(1024);
    assert_non_null(a);
    unsigned char *parts[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        parts[i] = arena_alloc(a, i * 7);
        assert_non_null(parts[i]);
        assert_int_equal((uintptr_t)parts[i] % 64, 0);
        memset(parts[i], (int)i, i * 7);
    }
    for (size_t i = 0; i < COUNT; i++) {
        for (size_t j = 0; j < i * 7; j++)
            assert_int_equal(parts[i][j], (unsigned char)i);
        for (size_t j = 0; j < i; j++)
            assert_ptr_not_equal(parts[i], parts[j]); /* parts of no bytes are apart as well */
    }
    arena_destroy(a);
}

static void test_restore_gives_back_and_uses_again(void **state)
{
    (void)state;
    arena *a = arena_create(4096);
    arena_mark empty = arena_save(a);
    int *kept = arena_alloc(a, sizeof *kept);
    *kept = 42;
    arena_mark mark = arena_save(a);
    void *first = arena_alloc(a, 100), *second = arena_alloc(a, 100000), *third = arena_alloc(a, 100);
    for (int i = 0; i < 10; i++) { /* equal requests find equal memory again */
        arena_restore(a, mark);
        assert_ptr_equal(arena_alloc(a, 100), first);
        assert_ptr_equal(arena_alloc(a, 100000), second);
        assert_ptr_equal(arena_alloc(a, 100), third);
    }
    assert_int_equal(*kept, 42);
    arena_mark inner = arena_save(a);
    void *fourth = arena_alloc(a, 64);
    arena_restore(a, inner);
    assert_ptr_equal(arena_alloc(a, 64), fourth);
    arena_restore(a, mark);
    arena_restore(a, empty);
    assert_ptr_equal(arena_alloc(a, sizeof *kept), kept);
    arena_destroy(a);
}

static void test_peak(void **state)
{
    (void)state;
    arena *a = arena_create(256);
    assert_int_equal(arena_peak_bytes(a), 0);
    arena_mark empty = arena_save(a);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < 100; i++)
            assert_non_null(arena_alloc(a, 65)); /* 128 each, two to a block */
        assert_int_equal(arena_peak_bytes(a), 12800);
        arena_restore(a, empty);
    }
    assert_non_null(arena_alloc(a, 10000));
    assert_int_equal(arena_peak_bytes(a), 12800);
    assert_non_null(arena_alloc(a, 10000));
    assert_int_equal(arena_peak_bytes(a), 2 * 10048);
    arena_destroy(a);
}

/* Requests of every size in turn, some larger than all before: what is spare is found again, in whatever order. */
static void test_spare_blocks(void **state)
{
    (void)state;
    arena *a = arena_create(64);
    arena_mark empty = arena_save(a);
    void *large = arena_alloc(a, 1 << 20);
    arena_restore(a, empty);
    for (uint32_t i = 0, x = 1; i < 2000; i++) {
        x = x * 1664525u + 1013904223u;
        size_t size = x >> 16;
        unsigned char *before = arena_alloc(a, 1), *p = arena_alloc(a, size + 1);
        assert_non_null(before);
        assert_non_null(p);
        *before = 1;
        p[0] = p[size] = 2;
        assert_int_equal(*before, 1);
        if (x >> 30 == 0)
            arena_restore(a, empty);
    }
    arena_restore(a, empty);
    unsigned char *again = arena_alloc(a, 1 << 20);
    assert_ptr_equal(again, large); /* the only block so large at the time is still there */
    arena_destroy(a);
}

static void test_too_large(void **state)
{
    (void)state;
    arena_destroy(NULL);
    arena *a = arena_create(1000);
    assert_null(arena_alloc(a, SIZE_MAX));
    assert_null(arena_alloc(a, SIZE_MAX / 2));
    unsigned char *p = arena_alloc(a, 10); /* a refusal leaves it as it was */
    assert_non_null(p);
    memset(p, 1, 10);
    assert_int_equal(arena_peak_bytes(a), 64);
    arena_destroy(a);
    a = arena_create(0);
    assert_non_null(arena_alloc(a, 5000));
    arena_destroy(a);
    a = arena_create(SIZE_MAX);
    assert_null(arena_alloc(a, 1));
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_aligned_and_apart),
        cmocka_unit_test(test_restore_gives_back_and_uses_again),
        cmocka_unit_test(test_peak),
        cmocka_unit_test(test_spare_blocks),
        cmocka_unit_test(test_too_large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_tile_scheduler.c: tiles cover the image once, follow one another along the curve, and are small at the end.
 * Threads: assertions are the main thread's; workers only write down what they claimed. */
#define _GNU_SOURCE
#include "tile_scheduler.h"

#include "atomics.h"
#include "thread_pool.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static tile_scheduler *create(int x0, int y0, int x1, int y1, int tile_size, unsigned worker_count)
{
    tile_scheduler *s = NULL;
    assert_int_equal(tile_scheduler_create(x0, y0, x1, y1, tile_size, worker_count, &s), AG_OK);
    assert_non_null(s);
    return s;
}

typedef struct claims {
    tile_scheduler *scheduler;
    int x0, y0, width, height, tile_size;
    unsigned char *times; /* each pixel was claimed; plain memory, so that TSan sees a pixel claimed twice */
    unsigned char *index_times;
    atomic_u64 wrong_tiles;
} claims;

static void claim_all(void *user, unsigned worker_index)
{
    (void)worker_index;
    claims *c = user;
    for (tile t; tile_scheduler_next(c->scheduler, &t);) {
        if (t.x0 < c->x0 || t.y0 < c->y0 || t.x1 > c->x0 + c->width || t.y1 > c->y0 + c->height || t.x0 >= t.x1 ||
            t.y0 >= t.y1 || t.x1 - t.x0 > c->tile_size || t.y1 - t.y0 > c->tile_size ||
            t.index >= tile_scheduler_count(c->scheduler)) {
            fetch_add_relaxed_u64(&c->wrong_tiles, 1);
            continue;
        }
        c->index_times[t.index]++;
        for (int y = t.y0 - c->y0; y < t.y1 - c->y0; y++)
            for (int x = t.x0 - c->x0; x < t.x1 - c->x0; x++)
                c->times[y * c->width + x]++;
    }
}

static void test_every_pixel_once(void **state)
{
    (void)state;
    static const struct {
        int x0, y0, width, height, tile_size;
    } images[] = {
        {0, 0, 1, 1, 8},         {0, 0, 400, 400, 32},  {0, 0, 401, 399, 16},  {-7, 13, 333, 5, 8},
        {1000, -500, 3, 777, 8}, {5, 5, 256, 256, 256}, {0, 0, 257, 255, 256}, {-100, -100, 97, 203, 64},
    };
    static const unsigned worker_counts[] = {1, 2, 3, 8, 64};
    for (size_t k = 0; k < sizeof worker_counts / sizeof worker_counts[0]; k++) {
        thread_pool *pool = NULL;
        assert_int_equal(thread_pool_create(worker_counts[k], &pool), AG_OK);
        for (size_t i = 0; i < sizeof images / sizeof images[0]; i++) {
            claims c = {.x0 = images[i].x0,
                        .y0 = images[i].y0,
                        .width = images[i].width,
                        .height = images[i].height,
                        .tile_size = images[i].tile_size};
            c.scheduler = create(c.x0, c.y0, c.x0 + c.width, c.y0 + c.height, c.tile_size, worker_counts[k]);
            uint32_t tile_count = tile_scheduler_count(c.scheduler);
            size_t pixel_count = (size_t)c.width * (size_t)c.height;
            c.times = calloc(pixel_count, 1);
            c.index_times = calloc(tile_count, 1);
            assert_non_null(c.times);
            assert_non_null(c.index_times);
            thread_pool_run(pool, claim_all, &c);
            assert_int_equal(load_relaxed_u64(&c.wrong_tiles), 0);
            for (size_t p = 0; p < pixel_count; p++)
                assert_int_equal(c.times[p], 1);
            for (uint32_t t = 0; t < tile_count; t++)
                assert_int_equal(c.index_times[t], 1);
            tile none;
            assert_false(tile_scheduler_next(c.scheduler, &none)); /* there is no tile any more */
            free(c.times);
            free(c.index_times);
            tile_scheduler_destroy(c.scheduler);
        }
        thread_pool_destroy(pool);
    }
}

/* Without workers nothing is split, so that each tile is one cell of the curve. */
static void test_neighbours_follow_one_another(void **state)
{
    (void)state;
    for (int columns = 1; columns <= 33; columns++)
        for (int rows = 1; rows <= 33; rows++) {
            tile_scheduler *s = create(0, 0, 8 * columns, 8 * rows, 8, 0);
            assert_int_equal(tile_scheduler_count(s), columns * rows);
            tile before, t;
            int diagonal_count = 0;
            assert_true(tile_scheduler_next(s, &before));
            assert_true(before.x0 == 0 && before.y0 == 0);
            while (tile_scheduler_next(s, &t)) {
                int dx = abs(t.x0 - before.x0) / 8, dy = abs(t.y0 - before.y0) / 8;
                if (dx > 1 || dy > 1)
                    fail_msg("%d x %d: a jump of %d, %d", columns, rows, dx, dy);
                diagonal_count += dx + dy > 1;
                before = t;
            }
            /* On a chequered board steps change colour: some boards leave no way without one diagonal step. */
            assert_in_range(diagonal_count, 0, 1);
            if (columns == rows && (columns & (columns - 1)) == 0)
                assert_int_equal(diagonal_count, 0); /* Hilbert's own curve */
            tile_scheduler_destroy(s);
        }
}

/* The curve keeps tiles that are claimed in a row in a compact patch, which rows of an image would not. */
static void test_runs_are_compact(void **state)
{
    (void)state;
    tile_scheduler *s = create(0, 0, 512, 512, 8, 0);
    for (int run = 0; run < 64; run++) {
        int x0 = INT_MAX, y0 = INT_MAX, x1 = 0, y1 = 0;
        for (int i = 0; i < 64; i++) {
            tile t;
            assert_true(tile_scheduler_next(s, &t));
            x0 = t.x0 < x0 ? t.x0 : x0;
            y0 = t.y0 < y0 ? t.y0 : y0;
            x1 = t.x1 > x1 ? t.x1 : x1;
            y1 = t.y1 > y1 ? t.y1 : y1;
        }
        assert_int_equal((x1 - x0) * (y1 - y0), 64 * 64); /* 64 tiles of 8 x 8: exactly a square */
        assert_int_equal(x1 - x0, 64);
    }
    tile_scheduler_destroy(s);
}

static void test_small_at_the_end(void **state)
{
    (void)state;
    for (unsigned worker_count = 1; worker_count <= 64; worker_count *= 2) {
        tile_scheduler *s = create(0, 0, 1024, 1024, 32, worker_count);
        uint32_t count = tile_scheduler_count(s);
        int before = 32;
        uint64_t left = 1024 * 1024;
        for (uint32_t i = 0; i < count; i++) {
            tile t;
            assert_true(tile_scheduler_next(s, &t));
            assert_int_equal(t.index, i);
            int edge = t.x1 - t.x0;
            assert_int_equal(t.y1 - t.y0, edge);
            assert_true(edge == 32 || edge == 16 || edge == 8);
            assert_true(edge <= before);
            left -= (uint64_t)edge * (uint64_t)edge;
            assert_true(t.left == left);
            /* as long as a tile is large, each worker still finds several small ones after it */
            if (edge == 32)
                assert_true(count - 1 - i >= 8 * worker_count);
            if (edge == 16)
                assert_true(count - 1 - i >= 16 * worker_count);
            before = edge;
        }
        assert_int_equal(before, 8);
        tile_scheduler_destroy(s);
    }
}

/* The parts of a split tile touch each other too, and none is thinner than four pixels but for the image's edge. */
static void test_parts(void **state)
{
    (void)state;
    for (int tile_size = 8; tile_size <= 256; tile_size *= 2) {
        tile_scheduler *s = create(0, 0, tile_size, tile_size, tile_size, 1);
        int expected_edge = tile_size / 4 < 4 ? 4 : tile_size / 4;
        int parts = (tile_size / expected_edge) * (tile_size / expected_edge);
        assert_int_equal(tile_scheduler_count(s), parts);
        tile t, before = {.index = 0};
        for (int i = 0; tile_scheduler_next(s, &t); i++) {
            assert_int_equal(t.x1 - t.x0, expected_edge);
            if (i % 4 != 0)
                assert_int_equal(abs(t.x0 - before.x0) + abs(t.y0 - before.y0), expected_edge);
            before = t;
        }
        tile_scheduler_destroy(s);
    }
}

static void test_arguments(void **state)
{
    (void)state;
    static const struct {
        int x0, y0, x1, y1, tile_size;
    } wrong[] = {
        {0, 0, 0, 10, 16}, {0, 0, 10, 0, 16},  {5, 0, 4, 10, 16},   {0, 0, 10, 10, 0},   {0, 0, 10, 10, 4},
        {0, 0, 10, 10, 7}, {0, 0, 10, 10, 24}, {0, 0, 10, 10, 512}, {0, 0, 10, 10, -16},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        tile_scheduler *s = (tile_scheduler *)&s;
        assert_int_equal(
            tile_scheduler_create(wrong[i].x0, wrong[i].y0, wrong[i].x1, wrong[i].y1, wrong[i].tile_size, 4, &s),
            AG_ERROR_ARGUMENT);
        assert_null(s);
    }
    tile_scheduler *s = NULL;
    assert_int_equal(tile_scheduler_create(INT_MIN, INT_MIN, INT_MAX, INT_MAX, 8, 4, &s), AG_ERROR_MEMORY);
    assert_null(s);
    tile_scheduler_destroy(NULL);
    /* bounds at the far ends of int, where sums of coordinates would overflow */
    s = create(INT_MIN, INT_MAX - 3, INT_MIN + 9, INT_MAX, 8, 1);
    int64_t area = 0;
    for (tile t; tile_scheduler_next(s, &t);)
        area += (int64_t)(t.x1 - t.x0) * (t.y1 - t.y0);
    assert_int_equal(area, 27);
    tile_scheduler_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_pixel_once),
        cmocka_unit_test(test_neighbours_follow_one_another),
        cmocka_unit_test(test_runs_are_compact),
        cmocka_unit_test(test_small_at_the_end),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

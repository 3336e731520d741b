/* test_sampler.c: any 2^n consecutive aligned samples are a (0, n, 2)-net, in every pixel, in squares of pixels and for
 * every use; and uses know nothing of each other. Threads: one. */
#include "integrator/sampler.h"

#include "fixtures/test_scene.h"

static const int PIXELS[][2] = {{0, 0}, {1, 0}, {0, 1}, {399, 217}, {-3, 70000}};

/* Every box of width 2^-a and height 2^-(n - a) holds exactly one of the 2^n points. */
static void expect_net(const vec2 *points, int n)
{
    uint32_t count = 1u << n;
    for (int a = 0; a <= n; a++) {
        unsigned char filled[1 << 12] = {0};
        for (uint32_t i = 0; i < count; i++) {
            uint32_t x = (uint32_t)ldexpf(points[i].x, a), y = (uint32_t)ldexpf(points[i].y, n - a);
            uint32_t box = x << (n - a) | y;
            assert_true(box < count);
            assert_int_equal(filled[box], 0);
            filled[box] = 1;
        }
    }
}

static void aligned_runs_are_nets(void **state)
{
    (void)state;
    static const uint32_t RUNS[] = {0, 1, 2, 3, 977, 4885};
    static vec2 points[1 << 10];
    for (size_t p = 0; p < sizeof PIXELS / sizeof *PIXELS; p++)
        for (int use = 0; use < SAMPLE_USE_COUNT; use++)
            for (int vertex = 0; vertex < 3; vertex++) {
                sampler s = sampler_make(p, PIXELS[p][0], PIXELS[p][1], 0, 0);
                for (int n = 0; n <= 10; n++)
                    for (size_t run = 0; run < (n < 9 ? sizeof RUNS / sizeof *RUNS : 1); run++) {
                        for (uint32_t i = 0; i < 1u << n; i++)
                            points[i] = sampler_2d_of(&s, (sample_use)use, vertex, 1u << 21, (RUNS[run] << n) + i);
                        expect_net(points, n);
                    }
            }
}

/* The samples of a square of pixels, at a point that its width divides, are one net too: so errors of neighbours
 * cancel. Also at the far end of large pictures, and where each sample draws many numbers. */
static void squares_of_pixels_are_nets(void **state)
{
    (void)state;
    static const int CORNERS[][2] = {{0, 0}, {8, 0}, {248, 264}, {-8, 70000}};
    static vec2 points[1 << 12];
    for (size_t corner = 0; corner < sizeof CORNERS / sizeof *CORNERS; corner++)
        for (uint32_t bits = 0; bits <= 6; bits += 2)      /* of the samples of a pixel */
            for (uint32_t each = 1; each <= 16; each *= 4) /* numbers of a sample */
                for (int width = 1; width <= 8; width *= 2) {
                    uint32_t count = 0, samples = 1u << bits;
                    if ((uint32_t)(width * width) * samples * each > 1u << 12)
                        continue;
                    for (int y = 0; y < width; y++)
                        for (int x = 0; x < width; x++)
                            for (uint32_t i = 0; i < samples * each; i++) {
                                sampler s =
                                    sampler_make(5, CORNERS[corner][0] + x, CORNERS[corner][1] + y, i / each, bits);
                                points[count++] = sampler_2d_of(&s, SAMPLE_GATHER, 1, each, i % each);
                            }
                    expect_net(points, (int)sampler_bits(count));
                }
}

static void samples_are_in_the_unit_square(void **state)
{
    (void)state;
    double mean[2] = {0.0, 0.0};
    enum { COUNT = 100000 };
    for (uint32_t i = 0; i < COUNT; i++) {
        sampler s = sampler_make(1, (int)(i % 317), (int)(i / 317), i % 7, 3);
        vec2 u = sampler_2d(&s, (sample_use)(i % SAMPLE_USE_COUNT), (int)(i % 5));
        assert_true(u.x >= 0.0f && u.x < 1.0f && u.y >= 0.0f && u.y < 1.0f);
        mean[0] += u.x / COUNT, mean[1] += u.y / COUNT;
    }
    double tolerance = 4.0 * sqrt(1.0 / 12.0 / COUNT);
    assert_close(mean[0], 0.5, tolerance);
    assert_close(mean[1], 0.5, tolerance);
}

/* The numbers that a sample draws one by one are its own in the sequence of all samples. */
static void a_sampler_knows_its_sample(void **state)
{
    (void)state;
    sampler s = sampler_make(3, 4, 5, 6, 3), first = sampler_make(3, 4, 5, 0, 0);
    vec2 a = sampler_2d(&s, SAMPLE_LENS, 0), b = sampler_2d_of(&first, SAMPLE_LENS, 0, 8, 6);
    assert_memory_equal(&a, &b, sizeof a);
    a = sampler_2d_of(&s, SAMPLE_LIGHT, 2, 4, 3), b = sampler_2d_of(&first, SAMPLE_LIGHT, 2, 32, 27);
    assert_memory_equal(&a, &b, sizeof a);
}

/* 12 times the mean product of two centred coordinates: their correlation. */
typedef struct correlation {
    double sum;
    uint32_t count;
} correlation;

static void correlate(correlation *c, float a, float b)
{
    c->sum += 12.0 * ((double)a - 0.5) * ((double)b - 0.5);
    c->count++;
}

static void expect_none(correlation c) { assert_close(c.sum / c.count, 0.0, 4.5 / sqrt(c.count)); }

static void uses_are_decorrelated(void **state)
{
    (void)state;
    enum { STREAMS = 2 * SAMPLE_USE_COUNT * 2 };
    static correlation all[STREAMS][STREAMS];
    memset(all, 0, sizeof all);
    for (int pixel = 0; pixel < 4096; pixel++) {
        sampler s = sampler_make(1, pixel % 64, pixel / 64, (uint32_t)pixel % 4, 2);
        float u[STREAMS];
        for (int i = 0; i < STREAMS; i += 2) {
            vec2 v = sampler_2d(&s, (sample_use)(i / 2 % SAMPLE_USE_COUNT), i / 2 / SAMPLE_USE_COUNT);
            u[i] = v.x, u[i + 1] = v.y;
        }
        for (int i = 0; i < STREAMS; i++)
            for (int j = 0; j < i; j++)
                correlate(&all[i][j], u[i], u[j]);
    }
    for (int i = 0; i < STREAMS; i++)
        for (int j = 0; j < i; j++)
            expect_none(all[i][j]);
}

/* Within one pixel, one use's samples come in another order than the next one's; and so for pixels and seeds. */
static void orders_are_independent(void **state)
{
    (void)state;
    correlation uses = {0}, vertices = {0}, pixels = {0}, seeds = {0};
    for (int pixel = 0; pixel < 64; pixel++) {
        sampler s = sampler_make(1, pixel, 2, 0, 0), right = sampler_make(1, pixel + 1, 2, 0, 0),
                seed = sampler_make(2, pixel, 2, 0, 0);
        for (uint32_t i = 0; i < 64; i++) {
            float u = sampler_2d_of(&s, SAMPLE_LIGHT, 0, 64, i).x;
            correlate(&uses, u, sampler_2d_of(&s, SAMPLE_SCATTER, 0, 64, i).x);
            correlate(&vertices, u, sampler_2d_of(&s, SAMPLE_LIGHT, 1, 64, i).x);
            correlate(&pixels, u, sampler_2d_of(&right, SAMPLE_LIGHT, 0, 64, i).x);
            correlate(&seeds, u, sampler_2d_of(&seed, SAMPLE_LIGHT, 0, 64, i).x);
        }
    }
    expect_none(uses);
    expect_none(vertices);
    expect_none(pixels);
    expect_none(seeds);
}

/* Stratified samples integrate a smooth function far better than random numbers do. */
static void a_smooth_integral_converges_fast(void **state)
{
    (void)state;
    double square = 0.0;
    for (int pixel = 0; pixel < 256; pixel++) {
        sampler s = sampler_make(1, pixel, 0, 0, 0);
        double sum = 0.0;
        for (uint32_t i = 0; i < 256; i++) {
            vec2 u = sampler_2d_of(&s, SAMPLE_GATHER, 0, 256, i);
            sum += (double)u.x * (double)u.y;
        }
        double off = sum / 256.0 - 0.25;
        square += off * off / 256.0;
    }
    double random = sqrt((1.0 / 9.0 - 1.0 / 16.0) / 256.0);
    assert_true(sqrt(square) < random / 10.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(aligned_runs_are_nets),
        cmocka_unit_test(squares_of_pixels_are_nets),
        cmocka_unit_test(samples_are_in_the_unit_square),
        cmocka_unit_test(a_sampler_knows_its_sample),
        cmocka_unit_test(uses_are_decorrelated),
        cmocka_unit_test(orders_are_independent),
        cmocka_unit_test(a_smooth_integral_converges_fast),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* gather_directions.c: see gather_directions.h. Loops over columns, without a branch, which compilers turn into
 * vectors, once for any x86-64 and once for AVX2; each lane does the same IEEE steps, so it makes no difference but in
 * time. Threads: pure functions. */
#include "integrator/gather_directions.h"

#include "math/sampling.h"

#define IN_LINE static inline __attribute__((always_inline))

enum { AT_ONCE = 8 };

IN_LINE uint32_t whole_vectors(uint32_t count) { return (count + AT_ONCE - 1) / AT_ONCE * AT_ONCE; }

IN_LINE void fill_numbers(const sampler_sequence *sequence, uint32_t first, uint32_t count, float out_u[2][RAY_FAN_MAX])
{
    sampler_sequence s = *sequence;
    uint32_t index = (uint32_t)s.first + first, end = whole_vectors(count);
    float *restrict x = out_u[0], *restrict y = out_u[1];
    for (uint32_t i = 0; i < end; i++) {
        vec2 u = sampler_sequence_of_index(&s, index + i);
        x[i] = u.x;
        y[i] = u.y;
    }
}

/* Sequences whose index grows beyond 32 bits on the way: their scrambles change there. */
static void fill_numbers_one_by_one(sampler_sequence *sequence, uint32_t first, uint32_t count,
                                    float out_u[2][RAY_FAN_MAX])
{
    for (uint32_t i = 0; i < whole_vectors(count); i++) {
        vec2 u = sampler_sequence_at(sequence, first + (i < count ? i : 0));
        out_u[0][i] = u.x;
        out_u[1][i] = u.y;
    }
}

static bool is_of_one_scramble(const sampler_sequence *s, uint32_t first, uint32_t count)
{
    return (s->first + first) >> 32 == s->high && (s->first + first + count - 1) >> 32 == s->high;
}

IN_LINE void fill_directions(float u[2][RAY_FAN_MAX], uint32_t count, const frame *around, bool is_below,
                             float out_directions[3][RAY_FAN_MAX])
{
    frame f = *around;
    float side = is_below ? -1.0f : 1.0f, *restrict x = out_directions[0], *restrict y = out_directions[1],
          *restrict z = out_directions[2];
    const float *restrict u_x = u[0], *restrict u_y = u[1];
    for (uint32_t i = 0; i < whole_vectors(count); i++) {
        vec3 local = sample_cosine_hemisphere((vec2){u_x[i], u_y[i]});
        local.z *= side;
        vec3 direction = frame_to_world(&f, local);
        x[i] = direction.x;
        y[i] = direction.y;
        z[i] = direction.z;
    }
}

void gather_numbers_plain(sampler_sequence *sequence, uint32_t first, uint32_t count, float out_u[2][RAY_FAN_MAX])
{
    if (is_of_one_scramble(sequence, first, count))
        fill_numbers(sequence, first, count, out_u);
    else
        fill_numbers_one_by_one(sequence, first, count, out_u);
}

void gather_directions_plain(float u[2][RAY_FAN_MAX], uint32_t count, const frame *around, bool is_below,
                             float out_directions[3][RAY_FAN_MAX])
{
    fill_directions(u, count, around, is_below, out_directions);
}

#if defined(__x86_64__)
#define AVX2 __attribute__((target("avx2")))

AVX2 static void fill_numbers_avx2(const sampler_sequence *sequence, uint32_t first, uint32_t count,
                                   float out_u[2][RAY_FAN_MAX])
{
    fill_numbers(sequence, first, count, out_u);
}

AVX2 static void fill_directions_avx2(float u[2][RAY_FAN_MAX], uint32_t count, const frame *around, bool is_below,
                                      float out_directions[3][RAY_FAN_MAX])
{
    fill_directions(u, count, around, is_below, out_directions);
}

void gather_numbers(sampler_sequence *sequence, uint32_t first, uint32_t count, float out_u[2][RAY_FAN_MAX])
{
    if (__builtin_cpu_supports("avx2") && is_of_one_scramble(sequence, first, count))
        fill_numbers_avx2(sequence, first, count, out_u);
    else
        gather_numbers_plain(sequence, first, count, out_u);
}

void gather_directions(float u[2][RAY_FAN_MAX], uint32_t count, const frame *around, bool is_below,
                       float out_directions[3][RAY_FAN_MAX])
{
    if (__builtin_cpu_supports("avx2"))
        fill_directions_avx2(u, count, around, is_below, out_directions);
    else
        gather_directions_plain(u, count, around, is_below, out_directions);
}
#else
void gather_numbers(sampler_sequence *sequence, uint32_t first, uint32_t count, float out_u[2][RAY_FAN_MAX])
{
    gather_numbers_plain(sequence, first, count, out_u);
}

void gather_directions(float u[2][RAY_FAN_MAX], uint32_t count, const frame *around, bool is_below,
                       float out_directions[3][RAY_FAN_MAX])
{
    gather_directions_plain(u, count, around, is_below, out_directions);
}
#endif

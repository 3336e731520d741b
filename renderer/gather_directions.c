/* gather_directions.c: see gather_directions.h. One loop over columns, without a branch, which compilers turn into
 * vectors, once for any x86-64 and once for AVX2; each lane does the same IEEE steps, so it makes no difference but in
 * time.
 * Threads: pure functions. */
#include "gather_directions.h"

#include "math/sampling.h"

enum { AT_ONCE = 8 };

static inline __attribute__((always_inline)) void fill(const sampler_sequence *sequence, uint32_t first, uint32_t count,
                                                       const frame *around, float side,
                                                       float out_directions[3][RAY_FAN_MAX])
{
    sampler_sequence s = *sequence;
    frame f = *around;
    uint32_t index = (uint32_t)s.first + first, end = (count + AT_ONCE - 1) / AT_ONCE * AT_ONCE;
    float *restrict x = out_directions[0], *restrict y = out_directions[1], *restrict z = out_directions[2];
    for (uint32_t i = 0; i < end; i++) {
        vec3 local = sample_cosine_hemisphere(sampler_sequence_of_index(&s, index + i));
        local.z *= side;
        vec3 direction = frame_to_world(&f, local);
        x[i] = direction.x;
        y[i] = direction.y;
        z[i] = direction.z;
    }
}

/* Sequences whose index grows beyond 32 bits on the way: their scrambles change there. */
static void fill_one_by_one(sampler_sequence *sequence, uint32_t first, uint32_t count, const frame *around, float side,
                            float out_directions[3][RAY_FAN_MAX])
{
    for (uint32_t i = 0; i < count; i++) {
        vec3 local = sample_cosine_hemisphere(sampler_sequence_at(sequence, first + i));
        local.z *= side;
        vec3 direction = frame_to_world(around, local);
        out_directions[0][i] = direction.x;
        out_directions[1][i] = direction.y;
        out_directions[2][i] = direction.z;
    }
}

static bool is_of_one_scramble(const sampler_sequence *s, uint32_t first, uint32_t count)
{
    return (s->first + first) >> 32 == s->high && (s->first + first + count - 1) >> 32 == s->high;
}

void gather_directions_plain(sampler_sequence *sequence, uint32_t first, uint32_t count, const frame *around,
                             bool is_below, float out_directions[3][RAY_FAN_MAX])
{
    float side = is_below ? -1.0f : 1.0f;
    if (is_of_one_scramble(sequence, first, count))
        fill(sequence, first, count, around, side, out_directions);
    else
        fill_one_by_one(sequence, first, count, around, side, out_directions);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void fill_avx2(const sampler_sequence *sequence, uint32_t first, uint32_t count,
                                                      const frame *around, float side,
                                                      float out_directions[3][RAY_FAN_MAX])
{
    fill(sequence, first, count, around, side, out_directions);
}

void gather_directions(sampler_sequence *sequence, uint32_t first, uint32_t count, const frame *around, bool is_below,
                       float out_directions[3][RAY_FAN_MAX])
{
    if (__builtin_cpu_supports("avx2") && is_of_one_scramble(sequence, first, count))
        fill_avx2(sequence, first, count, around, is_below ? -1.0f : 1.0f, out_directions);
    else
        gather_directions_plain(sequence, first, count, around, is_below, out_directions);
}
#else
void gather_directions(sampler_sequence *sequence, uint32_t first, uint32_t count, const frame *around, bool is_below,
                       float out_directions[3][RAY_FAN_MAX])
{
    gather_directions_plain(sequence, first, count, around, is_below, out_directions);
}
#endif

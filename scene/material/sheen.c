/* sheen.c: see sheen.h. Threads: pure functions. */
#include "material/sheen.h"

#include "material/microfacet.h"
#include "material/sheen_albedo_table.h"
#include "math/exponential.h"

static float fibre_roughness(float roughness) { return float_clamp(roughness, SHEEN_ROUGHNESS_MIN, 1.0f); }

/* --- the table of albedos --- */

/* Where x in [0, 1] lies among even steps. */
static int find_step(float x, int count, float *out_rest)
{
    const float along = float_clamp(x, 0.0f, 1.0f) * (float)(count - 1);
    int step = (int)along;
    step = step < count - 2 ? step : count - 2;
    *out_rest = along - (float)step;
    return step;
}

static float along_row(const uint16_t *row, int column, float rest)
{
    return ((1.0f - rest) * (float)row[column] + rest * (float)row[column + 1]) / SHEEN_ALBEDO_UNIT;
}

static float look_up_row(const uint16_t *row, float cosine)
{
    float rest;
    const int column = find_step(sqrtf(float_clamp(cosine, 0.0f, 1.0f)), SHEEN_ALBEDO_COSINES, &rest);
    return along_row(row, column, rest);
}

static float look_up(const uint16_t (*rows)[SHEEN_ALBEDO_COSINES], float roughness, float cosine)
{
    float v;
    const float level = (fibre_roughness(roughness) - SHEEN_ROUGHNESS_MIN) / (1.0f - SHEEN_ROUGHNESS_MIN);
    const int row = find_step(sqrtf(level), SHEEN_ALBEDO_ROUGHNESSES, &v);
    return (1.0f - v) * look_up_row(rows[row], cosine) + v * look_up_row(rows[row + 1], cosine);
}

float sheen_albedo(sheen_model model, float roughness, float cosine)
{
    if (model == SHEEN_SCHLICK)
        return look_up_row(SHEEN_ALBEDO_SCHLICK, cosine) * SHEEN_ALBEDO_SCHLICK_MAX;
    return float_min(look_up(model == SHEEN_VELVET ? SHEEN_ALBEDO_VELVET : SHEEN_ALBEDO_CHARLIE, roughness, cosine),
                     1.0f);
}

float sheen_factor_max(sheen_model model) { return model == SHEEN_SCHLICK ? 1.0f / SHEEN_ALBEDO_SCHLICK_MAX : 1.0f; }

/* --- values --- */

/* x^y for x >= 0, y > 0; 0^y is 0. */
static float power(float x, float y)
{
    return x > 0.0f ? (float)exponential((double)y * natural_logarithm((double)x)) : 0.0f;
}

static float mix(float a, float b, float t) { return a + (b - a) * t; }

/* Estevez, Kulla 2017, table 1 and eq. 3: ln of Smith's Lambda, fitted. */
static float charlie_fit(float x, float a)
{
    const float t = (1.0f - a) * (1.0f - a);
    return mix(21.5473f, 25.3245f, t) / (1.0f + mix(3.82987f, 3.32435f, t) * power(x, mix(0.19823f, 0.16801f, t))) +
           mix(-1.97760f, -1.27393f, t) * x + mix(-4.32054f, -4.85967f, t);
}

static float charlie_lambda(float cosine, float a)
{
    const float logarithm =
        cosine < 0.5f ? charlie_fit(cosine, a) : 2.0f * charlie_fit(0.5f, a) - charlie_fit(1.0f - cosine, a);
    return (float)exponential((double)logarithm);
}

/* The fit lets the finest fibres reflect up to three times what they get at grazing angles. The lobe is divided by
 * that, in both directions, so that it stays reciprocal. */
static float charlie_excess(float roughness, float cosine)
{
    return float_max(look_up(SHEEN_ALBEDO_CHARLIE, roughness, cosine), 1.0f);
}

static float charlie(float roughness, vec3 o, vec3 i, vec3 h)
{
    const float r = fibre_roughness(roughness), a = r * r, inverse = 1.0f / a;
    const float sine2 = float_max(h.x * h.x + h.y * h.y, 0.0f);
    const float density = (2.0f + inverse) * power(sine2, 0.5f * inverse) / (2.0f * AG_PI);
    const float value = density / ((1.0f + charlie_lambda(o.z, a) + charlie_lambda(i.z, a)) * 4.0f * o.z * i.z);
    return value / (charlie_excess(roughness, o.z) * charlie_excess(roughness, i.z));
}

static float schlick(vec3 o, vec3 h)
{
    const float w = 1.0f - float_min(fabsf(vec3_dot(o, h)), 1.0f), w2 = w * w;
    return w2 * w2 * w;
}

/* The least cosine between directions and their half vector that has a meaning in float. */
static const float COSINE_MIN = 1e-5f;

static float velvet(float sigma, vec3 o, vec3 i, vec3 h)
{
    const float s = fibre_roughness(sigma), s2 = s * s, oh = vec3_dot(o, h);
    const float sine2 = h.x * h.x + h.y * h.y;
    if (!(sine2 > COSINE_MIN && oh > COSINE_MIN))
        return 0.0f;
    const float density = (float)exponential(-(double)(h.z * h.z / (sine2 * s2))) / (AG_PI * s2 * sine2 * sine2);
    const float unmasked = float_min(2.0f * h.z * float_min(o.z, i.z) / oh, 1.0f); /* Torrance and Sparrow's grooves */
    return density * unmasked / (4.0f * o.z * i.z);
}

float sheen_value(sheen_model model, float roughness, vec3 o, vec3 i)
{
    const vec3 h = ggx_half_vector(o, i);
    switch (model) {
    case SHEEN_CHARLIE: return charlie(roughness, o, i, h);
    case SHEEN_SCHLICK: return schlick(o, h);
    case SHEEN_VELVET: return velvet(roughness, o, i, h);
    }
    return 0.0f;
}

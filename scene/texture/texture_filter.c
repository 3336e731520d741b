/* texture_filter.c: see texture_filter.h. */
#include "texture/texture_filter.h"

#include "texture/texture_udim.h"

#include <string.h>

enum { PROBES_MAX = 16 };
/* Coarse look-ups keep levels at least so many pixels wide and high: what lies side by side in one picture, the parts
 * of an atlas, stays apart. */
enum { COARSE_SIDE_BITS = 8 };
/* Side of a level's pixels over the width of the ellipse: between pixels' middles, a level's value is a mean over some
 * two of them. */
static const float PIXEL_SHARE = 0.6f;

/* The footprint in pixels of the finest level. */
typedef struct ellipse {
    float length, width; /* of its axes, length >= width */
    vec2 along;          /* the longer axis, unit */
} ellipse;

/* The principal axes of what two conjugate diameters span: eigenvectors of a a^T + b b^T. false: it is not finite. */
static bool find_ellipse(const texture_level *finest, const texture_footprint *f, ellipse *out)
{
    const float w = (float)finest->width, h = (float)finest->height;
    const vec2 a = {f->axes[0].x * w, f->axes[0].y * h}, b = {f->axes[1].x * w, f->axes[1].y * h};
    const float xx = a.x * a.x + b.x * b.x, xy = a.x * a.y + b.x * b.y, yy = a.y * a.y + b.y * b.y;
    const float difference = 0.5f * (xx - yy), root = sqrtf(difference * difference + xy * xy);
    const float longest = 0.5f * (xx + yy) + root, area = fabsf(a.x * b.y - a.y * b.x);
    if (!(longest < 1e30f))
        return false;
    out->length = sqrtf(longest);
    out->width = out->length > 0.0f ? float_min(area / out->length, out->length) : 0.0f;
    vec2 v = difference > 0.0f ? (vec2){root + difference, xy} : (vec2){xy, root - difference};
    const float norm = sqrtf(v.x * v.x + v.y * v.y);
    out->along = norm > 0.0f ? (vec2){v.x / norm, v.y / norm} : (vec2){1.0f, 0.0f};
    return true;
}

/* log2(x) with straight lines between powers of two, for 1 <= x: the same bits everywhere. */
static float log2_by_lines(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    const int exponent = (int)(bits >> 23) - 127;
    bits = (bits & 0x7fffffu) | 0x3f800000u;
    memcpy(&x, &bits, sizeof x);
    return (float)exponent + (x - 1.0f);
}

/* Between the levels below and above `level`. A picture that is not to be blended stays so at its finest. */
static rgb value_between(const texture_mips *m, float level, texture_wraps wraps, texture_filter filter, float s,
                         float t)
{
    const uint32_t last = m->level_count - 1, below = level < (float)last ? (uint32_t)level : last;
    const float above_share = below < last ? level - (float)below : 0.0f;
    rgb value = texture_level_rgb(&m->levels[below], wraps, below == 0 ? filter : TEXTURE_FILTER_BILINEAR, s, t);
    if (!(above_share > 0.0f))
        return value;
    rgb above = texture_level_rgb(&m->levels[below + 1], wraps, TEXTURE_FILTER_BILINEAR, s, t);
    return rgb_add(rgb_scale(value, 1.0f - above_share), rgb_scale(above, above_share));
}

static uint32_t coarsest_level(const texture_level *finest)
{
    uint32_t side = finest->width < finest->height ? finest->width : finest->height, level = 0;
    while (side >> (level + 1) >= 1u << COARSE_SIDE_BITS)
        level++;
    return level;
}

rgb texture_filter_rgb(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t,
                       const texture_footprint *footprint)
{
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return rgb_gray(0.0f);
    const texture_mips *m = i->mips;
    ellipse e;
    if (!find_ellipse(&m->levels[0], footprint, &e))
        return value_between(m, footprint->is_coarse ? (float)coarsest_level(&m->levels[0]) : TEXTURE_LEVELS_MAX, wraps,
                             filter, s, t);
    if (footprint->is_coarse) {
        const float side = PIXEL_SHARE * e.width, most = (float)coarsest_level(&m->levels[0]);
        return value_between(m, side > 1.0f ? float_min(log2_by_lines(side), most) : 0.0f, wraps, filter, s, t);
    }
    /* each probe is as wide as the side of its pixels over PIXEL_SHARE; their middles cover the rest of the length */
    const float side = float_max(float_max(PIXEL_SHARE * e.width, e.length / PROBES_MAX), 1.0f),
                wide = side / PIXEL_SHARE;
    const float level = log2_by_lines(side), covered = sqrtf(float_max(e.length * e.length - wide * wide, 0.0f));
    const float wanted = ceilf(covered / side);
    const int count = wanted >= PROBES_MAX ? PROBES_MAX : wanted > 1.0f ? (int)wanted : 1;
    if (count == 1)
        return value_between(m, level, wraps, filter, s, t);
    const vec2 step = {e.along.x * covered / ((float)count * (float)i->width),
                       e.along.y * covered / ((float)count * (float)i->height)};
    rgb sum = rgb_gray(0.0f);
    for (int k = 0; k < count; k++) {
        const float at = (float)k - 0.5f * (float)(count - 1);
        sum = rgb_add(sum, value_between(m, level, wraps, filter, s + at * step.x, t + at * step.y));
    }
    return rgb_scale(sum, 1.0f / (float)count);
}

rgb texture_filter_color(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t,
                         const texture_footprint *footprint)
{
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return rgb_gray(0.0f);
    rgb c = texture_filter_rgb(i, wraps, filter, s, t, footprint);
    return i->colors.has_matrix ? image_colors_convert(&i->colors, c) : c;
}

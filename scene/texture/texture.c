/* texture.c: see texture.h.
 * Rests on: Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 10. Threads: pure functions. */
#include "texture/texture.h"

#include "math/sampling.h"
#include "surface.h"
#include "texture/texture_checkerboard.h"
#include "texture/texture_filter.h"
#include "texture/texture_noise.h"
#include "texture/texture_set.h"
#include "texture/texture_udim.h"

#include <string.h>

texture texture_make(texture_kind kind)
{
    texture t;
    memset(&t, 0, sizeof t);
    t.kind = kind;
    t.mapping.kind = TEXTURE_MAPPING_UV;
    t.mapping.scale = (vec2){1.0f, 1.0f};
    t.wraps = texture_wraps_same(TEXTURE_WRAP_REPEAT);
    t.filter = TEXTURE_FILTER_BILINEAR;
    t.scale = 1.0f;
    for (size_t i = 0; i < sizeof t.inputs / sizeof *t.inputs; i++)
        t.inputs[i].texture_index = SCENE_NO_TEXTURE;
    return t;
}

/* Where textures are looked up, and over what pictures are filtered. */
typedef struct lookup {
    const surface_hit *hit;
    const surface_footprint *footprint; /* NULL: nothing is */
} lookup;

static rgb evaluate(const texture_set *set, const texture *t, const lookup *at);

static rgb input_at(const texture_set *set, const texture *t, int which, const lookup *at)
{
    const texture_input *input = &t->inputs[which];
    return input->texture_index == SCENE_NO_TEXTURE ? input->value
                                                    : evaluate(set, &set->items[input->texture_index], at);
}

/* The second's share is amount. One that has no share is not asked: it may be costly. */
static rgb mix_inputs(const texture_set *set, const texture *t, float amount, const lookup *at)
{
    rgb first = amount == 1.0f ? rgb_gray(0.0f) : input_at(set, t, 0, at);
    rgb second = amount == 0.0f ? rgb_gray(0.0f) : input_at(set, t, 1, at);
    return rgb_add(rgb_scale(first, 1.0f - amount), rgb_scale(second, amount));
}

static rgb checkerboard(const texture_set *set, const texture *t, const lookup *at)
{
    const surface_hit *hit = at->hit;
    const texture_mapping *m = &t->mapping;
    const bool is_solid = m->kind == TEXTURE_MAPPING_SOLID;
    vec3 p, axes[2];
    if (is_solid) {
        p = texture_mapping_point(m, hit->position);
    } else {
        const vec2 st = texture_mapping_st(m, hit->uv, hit->position);
        p = vec3_make(st.x, st.y, 0.5f);
    }
    if (!at->footprint)
        return input_at(set, t, checkerboard_is_odd(p) ? 1 : 0, at);
    for (int k = 0; k < 2; k++) {
        if (is_solid) {
            axes[k] = texture_mapping_point_step(m, at->footprint->axes[k]);
            continue;
        }
        const vec2 step =
            texture_mapping_step(m, hit->uv, hit->position, at->footprint->uv_axes[k], at->footprint->axes[k]);
        axes[k] = vec3_make(step.x, step.y, 0.0f);
    }
    return mix_inputs(set, t, checkerboard_odd_share(p, axes, is_solid), at);
}

/* The second: over the footprint. */
static rgb picture_rgb(const texture *t, const texture_image *picture, vec2 st)
{
    return (t->is_data ? texture_image_rgb : texture_image_color)(picture, t->wraps, t->filter, st.x, 1.0f - st.y);
}

static rgb filtered_picture_rgb(const texture *t, const texture_image *picture, vec2 st, const lookup *at)
{
    const surface_footprint *on_surface = at->footprint;
    texture_footprint f = {.is_coarse = on_surface->is_coarse};
    for (int k = 0; k < 2; k++) {
        f.axes[k] = texture_mapping_step(&t->mapping, at->hit->uv, at->hit->position, on_surface->uv_axes[k],
                                         on_surface->axes[k]);
        f.axes[k].y = -f.axes[k].y;
    }
    return (t->is_data ? texture_filter_rgb : texture_filter_color)(picture, t->wraps, t->filter, st.x, 1.0f - st.y,
                                                                    &f);
}

static rgb image_value(const texture_set *set, const texture *t, const lookup *at)
{
    const surface_hit *hit = at->hit;
    const texture_image *picture = set->images[t->image_index];
    vec2 st = texture_mapping_st(&t->mapping, hit->uv, hit->position);
    if (!t->is_spectrum) {
        float value = t->scale * texture_image_float(picture, t->channel, t->wraps, t->filter, st.x, 1.0f - st.y);
        return rgb_gray(t->invert ? float_max(1.0f - value, 0.0f) : value);
    }
    const bool is_filtered = at->footprint && (picture->udim ? picture->udim->has_mips : picture->mips != NULL);
    rgb value = is_filtered ? filtered_picture_rgb(t, picture, st, at) : picture_rgb(t, picture, st);
    value = rgb_scale(value, t->scale);
    if (t->invert)
        value = rgb_sub(rgb_gray(1.0f), value);
    return rgb_make(float_max(value.r, 0.0f), float_max(value.g, 0.0f), float_max(value.b, 0.0f));
}

static rgb bilerp(const texture *t, const surface_hit *hit)
{
    vec2 st = texture_mapping_st(&t->mapping, hit->uv, hit->position);
    rgb at_s0 = rgb_add(rgb_scale(t->inputs[0].value, 1.0f - st.y), rgb_scale(t->inputs[1].value, st.y));
    rgb at_s1 = rgb_add(rgb_scale(t->inputs[2].value, 1.0f - st.y), rgb_scale(t->inputs[3].value, st.y));
    return rgb_add(rgb_scale(at_s0, 1.0f - st.x), rgb_scale(at_s1, st.x));
}

static float noise_in_plane(float x, float y) { return texture_noise(vec3_make(x, y, 0.5f)); }

/* Half of the cells around whole (s, t) have a dot, shifted as far as keeps it inside. */
static bool is_inside_dot(vec2 st)
{
    const float radius = 0.35f, shift = 0.5f - radius;
    float s = floorf(st.x + 0.5f), t = floorf(st.y + 0.5f);
    if (!(noise_in_plane(s + 0.5f, t + 0.5f) > 0.0f))
        return false;
    float away_s = st.x - (s + shift * noise_in_plane(s + 1.5f, t + 2.8f));
    float away_t = st.y - (t + shift * noise_in_plane(s + 4.5f, t + 9.8f));
    return away_s * away_s + away_t * away_t < radius * radius;
}

static float windy(vec3 p)
{
    float wind_strength = texture_fbm(vec3_scale(p, 0.1f), 0.5f, 3);
    return fabsf(wind_strength) * texture_fbm(p, 0.5f, 6);
}

/* The veins' colours along a curve of six cubic pieces, of which each begins a control point after the one before. */
static rgb marble_color(float t)
{
    static const rgb CONTROL[9] = {{0.58f, 0.58f, 0.6f}, {0.58f, 0.58f, 0.6f}, {0.58f, 0.58f, 0.6f},
                                   {0.5f, 0.5f, 0.5f},   {0.6f, 0.59f, 0.58f}, {0.58f, 0.58f, 0.6f},
                                   {0.58f, 0.58f, 0.6f}, {0.2f, 0.2f, 0.33f},  {0.58f, 0.58f, 0.6f}};
    enum { PIECES = 6 };
    int piece = (int)(t * (float)PIECES);
    piece = piece < PIECES ? piece : PIECES - 1;
    float u = t * (float)PIECES - (float)piece, v = 1.0f - u;
    const float weight[4] = {v * v * v, 3.0f * u * v * v, 3.0f * u * u * v, u * u * u}; /* Bernstein's */
    rgb sum = rgb_gray(0.0f);
    for (int i = 0; i < 4; i++)
        sum = rgb_add(sum, rgb_scale(CONTROL[piece + i], weight[i]));
    return rgb_scale(sum, 1.5f);
}

static rgb marble(const texture *t, vec3 point)
{
    vec3 p = vec3_scale(point, t->scale);
    double turns =
        ((double)p.y + (double)(t->variation * texture_fbm(p, t->roughness, t->octaves))) * 0.15915494309189534;
    float sine, cosine;
    sincos_turns(isfinite(turns) ? (float)(turns - floor(turns)) : 0.0f, &sine, &cosine);
    return marble_color(float_clamp(0.5f + 0.5f * sine, 0.0f, 1.0f));
}

static rgb evaluate(const texture_set *set, const texture *t, const lookup *at)
{
    const surface_hit *hit = at->hit;
    switch (t->kind) {
    case TEXTURE_CONSTANT: return t->inputs[0].value;
    case TEXTURE_SCALE: { /* by a float, which is grey, or by a colour */
        rgb factor = input_at(set, t, 1, at);
        return rgb_is_black(factor) ? rgb_gray(0.0f) : rgb_mul(input_at(set, t, 0, at), factor);
    }
    case TEXTURE_MIX: return mix_inputs(set, t, input_at(set, t, 2, at).r, at);
    case TEXTURE_DIRECTION_MIX:
        return mix_inputs(set, t, 1.0f - fabsf(vec3_dot(hit->geometric_normal, t->direction)), at);
    case TEXTURE_CHECKERBOARD: return checkerboard(set, t, at);
    case TEXTURE_IMAGE: return image_value(set, t, at);
    case TEXTURE_BILERP: return bilerp(t, hit);
    case TEXTURE_DOTS: {
        bool inside = is_inside_dot(texture_mapping_st(&t->mapping, hit->uv, hit->position));
        return input_at(set, t, inside ? 0 : 1, at);
    }
    default: break;
    }
    vec3 p = texture_mapping_point(&t->mapping, hit->position);
    switch (t->kind) {
    case TEXTURE_FBM: return rgb_gray(texture_fbm(p, t->roughness, t->octaves));
    case TEXTURE_WRINKLED: return rgb_gray(texture_turbulence(p, t->roughness, t->octaves));
    case TEXTURE_WINDY: return rgb_gray(windy(p));
    default: {
        rgb c = marble(t, p);
        return set->colors.space->is_rec709 ? c : working_space_reflectance(set->colors.space, c);
    }
    }
}

rgb texture_evaluate_rgb(const texture_set *set, uint32_t texture_index, const struct surface_hit *hit)
{
    return evaluate(set, &set->items[texture_index], &(lookup){hit, NULL});
}

rgb texture_filtered_rgb(const texture_set *set, uint32_t texture_index, const struct surface_hit *hit,
                         const surface_footprint *footprint)
{
    const texture *t = &set->items[texture_index];
    return evaluate(set, t, &(lookup){hit, texture_is_filtered(t) ? footprint : NULL});
}

float texture_evaluate_float(const texture_set *set, uint32_t texture_index, const struct surface_hit *hit)
{
    return evaluate(set, &set->items[texture_index], &(lookup){hit, NULL}).r;
}

/* --- what pictures do to a texture --- */

static const texture *input_texture(const texture_set *set, const texture *t, int which)
{
    uint32_t index = t->inputs[which].texture_index;
    return index == SCENE_NO_TEXTURE ? NULL : &set->items[index];
}

static bool has_pictures(const texture_set *set, const texture *t, int which)
{
    const texture *input = input_texture(set, t, which);
    return input && input->has_pictures;
}

static bool varies(const texture_set *set, const texture *t, int which)
{
    const texture *input = input_texture(set, t, which);
    return input && input->kind != TEXTURE_CONSTANT;
}

/* Whether its value is more than a weighted sum of its pictures' values, by weights that are alike everywhere. */
static bool is_product(const texture_set *set, const texture *t)
{
    const bool any = has_pictures(set, t, 0) || has_pictures(set, t, 1);
    switch (t->kind) {
    case TEXTURE_SCALE:
        return (has_pictures(set, t, 0) && varies(set, t, 1)) || (has_pictures(set, t, 1) && varies(set, t, 0));
    case TEXTURE_MIX:
        return (any && varies(set, t, 2)) || (has_pictures(set, t, 2) && (varies(set, t, 0) || varies(set, t, 1)));
    case TEXTURE_CHECKERBOARD: return varies(set, t, 0) || varies(set, t, 1);
    case TEXTURE_DOTS:
    case TEXTURE_DIRECTION_MIX: return any; /* one of the two is picked */
    default: return false;
    }
}

static float bound_of_values(const texture *t, const texture_image *picture)
{
    float least = picture->least, most = picture->most;
    if (picture->colors.has_matrix && !t->is_data) {
        const float low = least, high = most;
        least = most = 0.0f;
        for (int row = 0; row < 3; row++) {
            float row_least = 0.0f, row_most = 0.0f;
            for (int k = 0; k < 3; k++) {
                const float m = picture->colors.matrix[3 * row + k];
                row_least += m * (m < 0.0f ? high : low);
                row_most += m * (m < 0.0f ? low : high);
            }
            least = float_min(least, row_least);
            most = float_max(most, row_most);
        }
    }
    most *= t->scale;
    if (least < 0.0f || t->scale < 0.0f || (t->invert && most > 1.0f))
        return INFINITY;
    return t->invert ? 1.0f : most;
}

static float bound_of_picture(const texture_set *set, const texture *t)
{
    const texture_image *picture = set->images[t->image_index];
    if (!picture->udim)
        return bound_of_values(t, picture);
    float most = t->invert ? 1.0f : 0.0f; /* beyond the tiles all is black */
    for (uint32_t k = 0; k < picture->udim->slot_count; k++)
        if (picture->udim->tiles[k])
            most = float_max(most, bound_of_values(t, picture->udim->tiles[k]));
    return most;
}

static float bound_of_input(const texture_set *set, const texture *t, int which)
{
    const texture *input = input_texture(set, t, which);
    const rgb value = t->inputs[which].value;
    if (input)
        return input->most;
    return value.r < 0.0f || value.g < 0.0f || value.b < 0.0f ? INFINITY : rgb_max(value);
}

static float bound_of(const texture_set *set, const texture *t)
{
    switch (t->kind) {
    case TEXTURE_IMAGE: return bound_of_picture(set, t);
    case TEXTURE_CONSTANT: return bound_of_input(set, t, 0);
    case TEXTURE_SCALE: return bound_of_input(set, t, 0) * bound_of_input(set, t, 1);
    case TEXTURE_MIX:
        if (!(bound_of_input(set, t, 2) <= 1.0f))
            return INFINITY;
        return float_max(bound_of_input(set, t, 0), bound_of_input(set, t, 1));
    case TEXTURE_CHECKERBOARD: return float_max(bound_of_input(set, t, 0), bound_of_input(set, t, 1));
    default: return INFINITY; /* these are never filtered */
    }
}

void texture_find_pictures(const texture_set *set, texture *t)
{
    t->has_pictures = t->kind == TEXTURE_IMAGE || t->kind == TEXTURE_CHECKERBOARD;
    t->is_linear_in_pictures = !is_product(set, t);
    for (int i = 0; i < (int)(sizeof t->inputs / sizeof *t->inputs); i++) {
        const texture *input = input_texture(set, t, i);
        t->has_pictures = t->has_pictures || has_pictures(set, t, i);
        t->is_linear_in_pictures = t->is_linear_in_pictures && (!input || input->is_linear_in_pictures);
    }
    t->most = bound_of(set, t);
}

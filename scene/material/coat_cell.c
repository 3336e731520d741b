/* coat_cell.c: see coat_cell.h. */
#include "material/coat_cell.h"

#include "material/coat_lobe.h"
#include "material/fresnel.h"

enum {
    DIFFUSE_WALKS = 2048,   /* to a diffuse base, for each cosine */
    SCATTERED_WALKS = 8192, /* through a gap that scatters */
    UPWARD_WALKS = 32768    /* up from the base */
};

/* Where facets are not the same all round walks start all round, and the table is their mean. */
static float start_turn(const material *m, int k)
{
    bool is_round = m->alpha_u == m->alpha_v && m->base_alpha_u == m->base_alpha_v;
    double x = ((double)k + 0.5) * 0.61803398874989485; /* multiples of the golden section lie evenly */
    return is_round ? 0.0f : (float)(x - floor(x));
}

static vec3 turn_about_normal(vec3 v, float turn)
{
    float s, c;
    sincos_turns(turn, &s, &c);
    return (vec3){c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

static coat_layers layers_of(const material *m)
{
    coat_layers c;
    c.ior = m->ior;
    c.interface = (ggx){m->alpha_u, m->alpha_v};
    c.base = (ggx){m->base_alpha_u, m->base_alpha_v};
    c.interface_is_smooth = material_is_smooth(m->alpha_u, m->alpha_v) || m->ior == 1.0f;
    c.base_is_smooth = material_is_smooth(m->base_alpha_u, m->base_alpha_v);
    c.base_is_metal = m->kind == MATERIAL_COATED_CONDUCTOR;
    c.thickness = m->coat_thickness;
    c.scatters = !rgb_is_black(m->coat_albedo);
    c.g = m->coat_g;
    c.event_count_max = m->coat_bounces > 0 ? 2 * m->coat_bounces : 200;
    return c;
}

/* The share that is left of light that the gap has scattered so often. */
static rgb scattered_color(const material *m, int count)
{
    rgb color = rgb_gray(1.0f);
    for (int i = 0; i < count; i++)
        color = rgb_mul(color, m->coat_albedo);
    return color;
}

static float mean_of(rgb c) { return (c.r + c.g + c.b) / 3.0f; }

/* Over the hemisphere, weighted by the cosine. */
static float hemisphere_mean(const float values[COAT_COSINES])
{
    enum { STEPS = 256 };
    float sum = 0.0f;
    for (int i = 0; i < STEPS; i++) {
        float cosine = ((float)i + 0.5f) / STEPS;
        sum += 2.0f * cosine * coat_interpolate(values, cosine) / STEPS;
    }
    return sum;
}

/* --- the scattered lobe --- */

/* How far a path that came from +x goes on along the surface, -1 to 1. */
static float turn_of(vec3 direction)
{
    float along = sqrtf(direction.x * direction.x + direction.y * direction.y);
    return along > 0.0f ? -direction.x / along : 0.0f;
}

/* From `scattered`, and in `forward` the mean of turn_of times that. The product of the values at both ends is to have
 * this mean. */
static void fill_forward(coat_cell *cell)
{
    float mean = cell->scattered_mean > 0.0f ? hemisphere_mean(cell->forward) / cell->scattered_mean : 0.0f;
    for (int number = 0; number < COAT_COSINES; number++) {
        float turn = cell->scattered[number] > 0.0f ? cell->forward[number] / cell->scattered[number] : 0.0f;
        cell->forward[number] = mean > 1e-3f ? float_clamp(turn / sqrtf(mean), 0.0f, 0.95f) : 0.0f;
    }
}

static void fill_scattered_shares(coat_cell *cell, rgb by_order[COAT_ORDERS])
{
    float whole = 0.0f;
    for (int n = 0; n < COAT_ORDERS; n++)
        whole += mean_of(by_order[n]);
    cell->scattered_mean = hemisphere_mean(cell->scattered);
    if (!(whole > 0.0f) || !(cell->scattered_mean > 1e-5f)) {
        cell->scattered_mean = 0.0f;
        return;
    }
    for (int n = 0; n < COAT_ORDERS; n++)
        cell->scattered_share[n] = rgb_scale(by_order[n], 1.0f / whole);
    fill_forward(cell);
}

/* --- a diffuse base --- */

static void fill_diffuse(coat_cell *cell, const material *m, uint64_t key)
{
    const coat_layers layers = layers_of(m);
    rgb entered = rgb_gray(0.0f), scattered[COAT_ORDERS] = {{0.0f, 0.0f, 0.0f}};
    for (int number = 0; number < COAT_COSINES; number++) {
        rgb in = rgb_gray(0.0f), back_out = rgb_gray(0.0f);
        const int walks = layers.scatters ? SCATTERED_WALKS : DIFFUSE_WALKS;
        for (int k = 0; k < walks; k++) {
            float turn = start_turn(m, k);
            coat_numbers numbers = coat_numbers_make(key, (uint64_t)number, (uint32_t)k);
            vec3 out = turn_about_normal(coat_direction(coat_cosine(number)), turn);
            coat_path path = coat_walk_in(&layers, out, &numbers);
            rgb weight = rgb_scale(scattered_color(m, path.scatter_count), path.weight / (float)walks);
            if (path.end == COAT_END_BASE)
                in = rgb_add(in, weight);
            if (path.end == COAT_END_OUTSIDE) {
                back_out = rgb_add(back_out, weight);
                cell->forward[number] += mean_of(weight) * turn_of(turn_about_normal(path.direction, -turn));
            }
        }
        cell->entry[number] = mean_of(in);
        cell->scattered[number] = mean_of(back_out);
        /* weighted by the cosine, and by the spacing of the cosines */
        float root = (float)number, spread = root * coat_cosine(number);
        entered = rgb_add(entered, rgb_scale(in, spread));
        scattered[0] = rgb_add(scattered[0], rgb_scale(back_out, spread));
    }
    float mean = mean_of(entered);
    rgb tint = mean > 0.0f ? rgb_scale(entered, 1.0f / mean) : rgb_gray(1.0f);
    cell->entry_tint = layers.scatters ? rgb_mul(tint, tint) : rgb_gray(1.0f);
    fill_scattered_shares(cell, scattered);
    rgb back = rgb_gray(0.0f);
    for (int k = 0; k < UPWARD_WALKS; k++) {
        coat_numbers numbers = coat_numbers_make(key, COAT_COSINES, (uint32_t)k);
        float x = coat_numbers_next(&numbers);
        vec3 up = sample_cosine_hemisphere((vec2){x, coat_numbers_next(&numbers)});
        coat_path path = coat_walk_up(&layers, up, &numbers);
        if (path.end == COAT_END_BASE)
            back = rgb_add(back, rgb_scale(scattered_color(m, path.scatter_count), path.weight / UPWARD_WALKS));
    }
    cell->back = back;
    if (layers.interface_is_smooth && !layers.scatters)
        cell->back = rgb_gray(fresnel_dielectric_diffuse(1.0f / m->ior, m->coat_thickness));
}

/* --- a metal --- */

/* Walks of light that a metal reflects whole, from one direction. */
typedef struct metal_sums {
    float lobe[COAT_ORDERS];
    rgb scattered[COAT_ORDERS];
    float forward; /* of the scattered light, times turn_of */
} metal_sums;

static metal_sums walk_to_metal(const material *m, const coat_layers *layers, float cosine, int walks, uint64_t key,
                                uint64_t stream)
{
    metal_sums sums = {0};
    for (int k = 0; k < walks; k++) {
        float turn = start_turn(m, k);
        coat_numbers numbers = coat_numbers_make(key, stream, (uint32_t)k);
        coat_path path = coat_walk_in(layers, turn_about_normal(coat_direction(cosine), turn), &numbers);
        if (path.end != COAT_END_OUTSIDE)
            continue;
        int order = path.metal_count < COAT_ORDERS ? path.metal_count : COAT_ORDERS - 1;
        float weight = path.weight / (float)walks;
        if (path.was_trapped || path.scatter_count > 0) {
            rgb scattered = rgb_scale(scattered_color(m, path.scatter_count), weight);
            sums.scattered[order] = rgb_add(sums.scattered[order], scattered);
            sums.forward += mean_of(scattered) * turn_of(turn_about_normal(path.direction, -turn));
        } else {
            sums.lobe[order] += weight;
        }
    }
    return sums;
}

static bool fill_metal(coat_cell *cell, const material *m, int walks, uint64_t key)
{
    const coat_layers layers = layers_of(m);
    const coat_point point = coat_point_of(m);
    float orders[COAT_ORDERS] = {0.0f}, once[COAT_COSINES], whole = 0.0f;
    rgb scattered[COAT_ORDERS] = {{0.0f, 0.0f, 0.0f}};
    for (int number = 0; number < COAT_COSINES; number++) {
        metal_sums sums = walk_to_metal(m, &layers, coat_cosine(number), walks, key, (uint64_t)number);
        float spread = (float)number * coat_cosine(number);
        cell->forward[number] = sums.forward;
        once[number] = sums.lobe[1];
        for (int n = 0; n < COAT_ORDERS; n++) {
            cell->albedo[number] += sums.lobe[n];
            cell->scattered[number] += mean_of(sums.scattered[n]);
            orders[n] += spread * sums.lobe[n];
            whole += spread * sums.lobe[n];
            scattered[n] = rgb_add(scattered[n], rgb_scale(sums.scattered[n], spread));
        }
    }
    for (int n = 0; n < COAT_ORDERS && whole > 0.0f; n++)
        cell->lobe_share[n] = orders[n] / whole;
    fill_scattered_shares(cell, scattered);
    cell->breadth = layers.interface_is_smooth ? 1.0f : coat_lobe_fit_breadth(&point, &layers, key);
    return coat_lobe_fit_scales(cell, &point, &layers, once);
}

bool coat_cell_fill(coat_cell *out_cell, const material *m, int metal_walks, uint64_t key)
{
    if (m->kind == MATERIAL_COATED_CONDUCTOR)
        return fill_metal(out_cell, m, metal_walks, key);
    fill_diffuse(out_cell, m, key);
    return true;
}

/* coat_walk.c: see coat_walk.h. */
#include "material/coat_walk.h"

#include "material/fresnel.h"
#include "math/attenuation.h"

coat_numbers coat_numbers_make(uint64_t key, uint64_t stream, uint32_t k)
{
    static const double SPREAD = 1.0 / 1.1127756842787055; /* the root of x^7 = x + 1, for six dimensions */
    coat_numbers n;
    double power = 1.0;
    for (int j = 0; j < COAT_POINTS; j++) {
        power *= SPREAD;
        double x = 0.5 + ((double)k + 1.0) * power;
        n.points[j] = float_below_one((float)(x - floor(x)));
    }
    n.taken = 0;
    n.random = rng_make(key, stream, k);
    return n;
}

float coat_numbers_next(coat_numbers *numbers)
{
    return numbers->taken < COAT_POINTS ? numbers->points[numbers->taken++] : rng_float(&numbers->random);
}

static vec2 next_pair(coat_numbers *numbers)
{
    float x = coat_numbers_next(numbers);
    return (vec2){x, coat_numbers_next(numbers)};
}

static bool has_interface(const coat_layers *c) { return c->ior != 1.0f; }

/* Samples a facet of the interface visible from v, and writes its reflectance. */
static vec3 pick_facet(const coat_layers *c, vec3 v, vec2 u, float *out_reflected)
{
    float side = v.z >= 0.0f ? 1.0f : -1.0f;
    vec3 upper = vec3_scale(v, side);
    vec3 h = c->interface_is_smooth ? (vec3){0.0f, 0.0f, 1.0f} : ggx_sample_visible(c->interface, upper, u);
    *out_reflected = fresnel_dielectric(fabsf(vec3_dot(upper, h)), side > 0.0f ? c->ior : 1.0f / c->ior);
    return vec3_scale(h, side);
}

/* The share that other facets let pass, of light that a visible one has sent from v to w. */
static float unmasked(ggx facets, vec3 v, vec3 w)
{
    return ggx_masking_shadowing(facets, v, w) / ggx_masking(facets, v);
}

/* Both functions below leave *weight without the share of Fresnel's term. false: lost. */
static bool reflect_at(const coat_layers *c, vec3 v, vec3 h, float *weight, vec3 *out)
{
    *out = reflect_about(v, h);
    if (out->z * v.z <= 0.0f)
        return false;
    *weight *= c->interface_is_smooth ? 1.0f : unmasked(c->interface, v, *out);
    return true;
}

static bool transmit_at(const coat_layers *c, vec3 v, vec3 h, float *weight, vec3 *out)
{
    if (!has_interface(c)) {
        *out = vec3_negate(v);
        return true;
    }
    if (!refract_through(v, h, v.z > 0.0f ? c->ior : 1.0f / c->ior, out) || out->z * v.z >= 0.0f)
        return false;
    *weight *= c->interface_is_smooth ? 1.0f : unmasked(c->interface, v, *out);
    return true;
}

/* The optical depth that a share u of light does not reach. It is found by halving an interval, in plain IEEE steps:
 * the logarithm differs from one libm to the next. */
static float free_path(float u)
{
    float low = 0.0f, high = 100.0f;
    for (int i = 0; i < 40; i++) {
        float middle = 0.5f * (low + high);
        if (attenuation(middle) > 1.0f - u)
            low = middle;
        else
            high = middle;
    }
    return high;
}

static vec3 scatter(float g, vec3 along, vec2 u)
{
    float cosine = 1.0f - 2.0f * u.x, sine, s, c;
    if (fabsf(g) > 1e-3f) {
        float t = (1.0f - g * g) / (1.0f - g + 2.0f * g * u.x);
        cosine = float_clamp((1.0f + g * g - t * t) / (2.0f * g), -1.0f, 1.0f);
    }
    sine = sqrtf(float_max(1.0f - cosine * cosine, 0.0f));
    sincos_turns(u.y, &s, &c);
    frame f = frame_from_z(along);
    return vec3_normalize(frame_to_world(&f, (vec3){sine * c, sine * s, cosine}));
}

static bool reflect_by_metal(const coat_layers *c, vec3 v, vec2 u, float *weight, vec3 *out)
{
    *out = (vec3){-v.x, -v.y, v.z};
    if (c->base_is_smooth)
        return true;
    *out = reflect_about(v, ggx_sample_visible(c->base, v, u));
    if (out->z <= 0.0f)
        return false;
    *weight *= unmasked(c->base, v, *out);
    return true;
}

/* On from `height` along `way`. only_back: whatever meets the interface is reflected, by its share. */
static coat_path walk(const coat_layers *c, coat_path path, vec3 way, float height, bool only_back,
                      coat_numbers *numbers)
{
    for (int event = 0; event < c->event_count_max; event++) {
        if (way.z == 0.0f)
            return path;
        float next = way.z > 0.0f ? c->thickness : 0.0f, depth = fabsf(next - height) / fabsf(way.z);
        if (c->scatters) {
            float free = free_path(coat_numbers_next(numbers));
            if (free < depth) {
                height += free * way.z;
                way = scatter(c->g, way, next_pair(numbers));
                path.scatter_count++;
                continue;
            }
        } else {
            path.weight *= attenuation(depth);
        }
        height = next;
        vec3 v = vec3_negate(way);
        if (v.z > 0.0f) {
            path.metal_count += c->base_is_metal;
            if (!c->base_is_metal) {
                path.end = COAT_END_BASE;
                return path;
            }
            if (!reflect_by_metal(c, v, next_pair(numbers), &path.weight, &way))
                return path;
            continue;
        }
        float reflected;
        vec3 h = pick_facet(c, v, next_pair(numbers), &reflected);
        if (only_back || coat_numbers_next(numbers) < reflected) {
            path.was_trapped = path.was_trapped || reflected >= 1.0f;
            path.weight *= only_back ? reflected : 1.0f;
            if (!reflect_at(c, v, h, &path.weight, &way))
                return path;
            continue;
        }
        path.end = transmit_at(c, v, h, &path.weight, &path.direction) ? COAT_END_OUTSIDE : COAT_END_LOST;
        return path;
    }
    return path;
}

coat_path coat_walk_in(const coat_layers *layers, vec3 out, coat_numbers *numbers)
{
    coat_path path = {COAT_END_LOST, {0.0f, 0.0f, 0.0f}, 1.0f, 0, 0, false};
    float reflected;
    vec3 way, h = pick_facet(layers, out, next_pair(numbers), &reflected);
    path.weight = 1.0f - reflected;
    if (!(path.weight > 0.0f) || !transmit_at(layers, out, h, &path.weight, &way))
        return path;
    return walk(layers, path, way, layers->thickness, false, numbers);
}

coat_path coat_walk_up(const coat_layers *layers, vec3 up, coat_numbers *numbers)
{
    coat_path path = {COAT_END_LOST, {0.0f, 0.0f, 0.0f}, 1.0f, 0, 0, false};
    return walk(layers, path, up, 0.0f, !layers->scatters, numbers);
}

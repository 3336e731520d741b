/* infinite_light.c: light from infinitely far away in all directions, from everywhere or through a portal: then it
 * reaches only what sees through the portal. environment.c has its radiance.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.5. Threads: read-only. */
#include "light/environment.h"
#include "light/light_type.h"
#include "light/portal.h"
#include "rays/transmittance.h"
#include "scene.h"

static void init(light *l) { l->as.infinite.radiance = light_directions_make(); }

static void reset(light *l)
{
    environment_destroy(l->as.infinite.radiance.picture);
    portal_destroy(l->as.infinite.portal);
}

static void add_hash(const light *l, hash128 *h)
{
    const portal *p = l->as.infinite.portal;
    const bool has_portal = p != NULL;
    light_directions_add_hash(&l->as.infinite.radiance, h);
    HASH128_ADD(h, has_portal);
    if (!p)
        return;
    HASH128_ADD(h, p->corner);
    HASH128_ADD(h, p->axes);
    HASH128_ADD(h, p->width);
    HASH128_ADD(h, p->height);
}

static rgb power(const scene *s, const light *l)
{
    float disc = AG_PI * s->bounding_radius * s->bounding_radius;
    return l->as.infinite.portal ? rgb_scale(l->as.infinite.portal->irradiance,
                                             l->as.infinite.portal->width * l->as.infinite.portal->height)
                                 : rgb_scale(environment_integral(&l->as.infinite.radiance), disc);
}

static rgb escaped_radiance(const light *l, vec3 point, vec3 direction)
{
    if (l->as.infinite.portal && !portal_is_crossed(l->as.infinite.portal, point, direction))
        return rgb_gray(0.0f);
    return environment_whole_radiance(&l->as.infinite.radiance, direction);
}

static float escaped_pdf(const light *l, vec3 point, vec3 direction)
{
    return l->as.infinite.portal ? portal_pdf(l->as.infinite.portal, point, direction)
                                 : environment_whole_pdf(&l->as.infinite.radiance, direction);
}

static bool has_direction_numbers(const light *l) { return !l->as.infinite.portal; }

static bool direction_numbers(const light *l, vec3 direction, vec2 *out_u)
{
    return environment_sample_whole_numbers(&l->as.infinite.radiance, direction, out_u);
}

static environment *picture(const light *l) { return l->as.infinite.radiance.picture; }

static bool sample_from_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out)
{
    (void)s;
    out->is_delta = false;
    out->distance = INFINITY;
    out->shadow_target = point;
    if (!l->as.infinite.portal)
        return environment_sample_whole(&l->as.infinite.radiance, u, &out->direction, &out->radiance,
                                        &out->pdf_solid_angle);
    if (!portal_sample(l->as.infinite.portal, point, u, &out->direction, &out->pdf_solid_angle))
        return false;
    out->radiance = environment_whole_radiance(&l->as.infinite.radiance, out->direction);
    return !rgb_is_black(out->radiance);
}

/* Emits from a point in the portal, which is in the light's own medium, with the light that arrives there; window panes
 * outside of it transmit straight. */
static bool emit_through_portal(const scene *s, const light *l, const light_target *target,
                                const emission_numbers *numbers, light_emission *out)
{
    vec3 to_light;
    float pdf;
    if (!portal_sample_flux(l->as.infinite.portal, target, numbers, &out->origin, &to_light, &pdf))
        return false;
    rgb radiance = environment_whole_radiance(&l->as.infinite.radiance, to_light);
    if (rgb_is_black(radiance))
        return false;
    scene_ray back = scene_ray_make(out->origin, to_light);
    back.medium = l->medium;
    uint64_t cut = 0;
    rgb transmittance = transmittance_through_panes(s, back, INFINITY, &cut);
    out->direction = vec3_negate(to_light);
    out->flux = rgb_scale(rgb_mul(radiance, transmittance), vec3_dot(to_light, l->as.infinite.portal->axes.z) / pdf);
    return !rgb_is_black(out->flux);
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out)
{
    vec3 to_light;
    rgb radiance;
    float pdf;
    if (l->as.infinite.portal)
        return emit_through_portal(s, l, target, numbers, out);
    return environment_sample_whole(&l->as.infinite.radiance, numbers->direction, &to_light, &radiance, &pdf) &&
           light_emit_from_afar(s, l, target, numbers, vec3_negate(to_light), radiance, pdf, out);
}

/* Light by a portal is aimed as it is. */
static bool emission_numbers_of(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out)
{
    return !l->as.infinite.portal && light_numbers_from_afar(s, l, point, u, towards, in_out);
}

static bool reaches(const light *l, vec3 point, vec3 normal)
{
    return !l->as.infinite.portal || portal_reaches(l->as.infinite.portal, point, normal);
}

const light_type infinite_light = {.can_be_met = true,
                                   .is_everywhere = true,
                                   .init = init,
                                   .reset = reset,
                                   .add_hash = add_hash,
                                   .power = power,
                                   .sample_from_point = sample_from_point,
                                   .escaped_radiance = escaped_radiance,
                                   .escaped_pdf = escaped_pdf,
                                   .has_direction_numbers = has_direction_numbers,
                                   .direction_numbers = direction_numbers,
                                   .picture = picture,
                                   .emit = emit,
                                   .emission_numbers_of = emission_numbers_of,
                                   .reaches = reaches};

/* photon_path.c: see photon_path.h. */
#include "photon_path.h"

#include "material/lambert.h"
#include "onward_ways.h"
#include "quarter_octave.h"
#include "rays/transmittance.h"
#include "scene_extent.h"
#include "shape/alpha.h"

#include <stdlib.h>
#include <string.h>

/* Most scatterings of a path; its remaining flux is counted as truncated. */
enum { SCATTERING_CAP = 100 };
/* Most parts of a path in all, by splitting at all its surfaces. */
enum { SPLIT_MOST = 4096 };
/* Where a surface multiplies flux, each part takes so many times what it came with. */
static const float GAIN_OF_PART = 8.0f;
/* The room that a block's first photon makes. */
enum { PHOTONS_FIRST = 1024 };
/* How many of the ways on by a surface's gathered lobes are led by importons, where there are any. */
static const float LED_SHARE = 0.5f;
/* Of a caustic map's, which come by other ways as well that no importon tells of. */
static const float CAUSTIC_LED_SHARE = 0.2f;
/* Random streams, apart from those of the eye. */
enum { STREAM_GLOBAL = 1, STREAM_CAUSTIC = 2, STREAM_TRIALS = 2 /* added to those */ };

typedef struct photon_path {
    scene_ray ray;
    rgb flux;
    rng random;
    uint64_t key;
    float weight;    /* how dense such paths would be by power alone, over how dense guide and parts make them */
    float share;     /* of the begun path, that this part has */
    int scatterings; /* but for panes, where they are direct */
    int arrivals;    /* at surfaces, panes too */
    bool is_diffuse; /* has gone on from a surface by its gathered lobes */
} photon_path;

static void count_flux(double entry[3], rgb flux)
{
    entry[0] += (double)flux.r;
    entry[1] += (double)flux.g;
    entry[2] += (double)flux.b;
}

static photon *append_photon(path_block *out)
{
    if (out->count == out->capacity) {
        uint32_t capacity = out->capacity ? 2 * out->capacity : PHOTONS_FIRST;
        photon *larger = realloc(out->photons, capacity * sizeof *larger);
        if (!larger) {
            out->out_of_memory = true;
            return NULL;
        }
        out->photons = larger;
        out->capacity = capacity;
    }
    return &out->photons[out->count++];
}

/* How probable it is that a photon is stored. Where no light is asked for, those whose paths were picked more often
 * than by power are stored as rarely as if they had not been. */
static float keep_probability(const photon_path *path, float importance)
{
    return importance > 0.0f || !(path->weight < 1.0f) ? 1.0f : path->weight;
}

/* Picks the photons that are stored. false: this one is left out. */
static bool keep(photon_tracer *t, const photon_path *path, vec3 position, vec3 normal, uint64_t key, rgb *in_out_flux)
{
    const photon_tracing_settings *settings = t->settings;
    if (!settings->guide)
        return true;
    float importance = importance_map_at(settings->asked, position, normal);
    float probability = settings->stored_share * keep_probability(path, importance);
    if (!(probability < 1.0f))
        return true;
    rgb flux = *in_out_flux;
    bool is_kept = (float)(hash_combine(key, 0x6b656570u) >> 40) * 0x1p-24f < probability;
    *in_out_flux = is_kept ? rgb_scale(flux, 1.0f / probability) : rgb_gray(0.0f);
    count_flux(t->out->balance.thinned, rgb_sub(flux, *in_out_flux));
    return is_kept;
}

/* Where that point of a surface is when the shutter opens; its normal on the side that the path has arrived on. */
static surface_rest rest_of_arrival(const scene *s, const photon_path *path, const surface_hit *hit)
{
    surface_rest at = {hit->position, hit->geometric_normal, 1.0f};
    if (hit->instance_index != SCENE_NO_INSTANCE)
        at = surface_at_opening(s, hit);
    if (vec3_dot(hit->geometric_normal, path->ray.direction) > 0.0f)
        at.geometric_normal = vec3_negate(at.geometric_normal);
    return at;
}

static void store(photon_tracer *t, const photon_path *path, const surface_hit *hit, float arrival_factor)
{
    uint64_t key = hash_combine(path->key, (uint64_t)path->arrivals);
    rgb flux = path->flux;
    path_block *out = t->out;
    surface_rest at = rest_of_arrival(t->s, path, hit);
    vec3 normal = at.geometric_normal;
    float alpha = 1.0f;
    if (!shape_is_opaque(&t->s->shapes[hit->shape_index]))
        alpha = alpha_at_hit(t->s, hit);
    flux = rgb_scale(flux, alpha > 0.0f ? arrival_factor * at.area_ratio / alpha : 0.0f);
    if (t->trial) {
        float importance = importance_map_at(t->settings->asked, at.position, normal);
        t->counts->photons++;
        t->counts->asked += importance > 0.0f;
        t->counts->stored += (double)keep_probability(path, importance);
        t->counts->roots += (double)sqrtf(importance);
        t->counts->importance += (double)importance;
        t->trial->value += (flux.r + flux.g + flux.b) * sqrtf(importance);
        return;
    }
    count_flux(out->balance.arrived, flux);
    if (!keep(t, path, at.position, normal, key, &flux))
        return;
    if (out->count == t->limit) {
        count_flux(out->balance.cut, flux);
        return;
    }
    photon *p = append_photon(out);
    if (!p)
        return;
    p->position[0] = at.position.x;
    p->position[1] = at.position.y;
    p->position[2] = at.position.z;
    p->flux = flux_encode(flux, key);
    p->direction = arrival_encode(path->ray.direction, path->is_diffuse);
    p->normal = direction_encode(normal);
    memset(&p->slot, 0, sizeof p->slot);
    count_flux(out->balance.stored, flux_decode(p->flux));
}

/* Media absorb their share of a path's flux; roulette then keeps its flux about constant, so that no photons are spent
 * on faint light. Returns false where the path ends. No random number is drawn where nothing is absorbed. */
static bool pass_media(energy_balance *balance, rgb transmittance, rng *random, rgb *in_out_flux)
{
    if (transmittance.r == 1.0f && transmittance.g == 1.0f && transmittance.b == 1.0f)
        return true;
    rgb flux = *in_out_flux, left = rgb_mul(flux, transmittance);
    count_flux(balance->absorbed, rgb_sub(flux, left));
    if (rgb_is_black(left))
        return false;
    float survival = fminf(1.0f, rgb_max(left) / rgb_max(flux));
    if (rng_float(random) >= survival) {
        count_flux(balance->lost, left);
        return false;
    }
    *in_out_flux = rgb_scale(left, 1.0f / survival);
    count_flux(balance->gained, rgb_sub(*in_out_flux, left));
    return true;
}

/* The width of the area that a photon stands for where they lie evenly, in scene units; giants are not counted. Where
 * the paths are fixed it is rounded, so that what moves changes no other photon. */
static float photon_width(const scene *s, const photon_tracing_settings *settings)
{
    static const float RADIUS_SHARE_MAX = 1.0f / 64.0f;
    float radius = s->detail_radius > 0.0f ? s->detail_radius : s->bounding_radius;
    float width = fminf(sqrtf(s->surface_area / (float)settings->wanted), RADIUS_SHARE_MAX * radius);
    return settings->paths > 0 ? quarter_octave_nearest(width) : width;
}

/* Leaves a lamp, picked by its power or by the guide, at a time of the path's own where that matters. false: nothing
 * leaves. */
static bool begin_path(photon_tracer *t, uint64_t number, photon_path *out_path)
{
    const scene *s = t->s;
    const photon_tracing_settings *settings = t->settings;
    uint64_t stream = settings->kind == PHOTON_GLOBAL ? STREAM_GLOBAL : STREAM_CAUSTIC;
    rng random = rng_make(settings->seed, t->trial ? stream + STREAM_TRIALS : stream, number);
    uint64_t key = hash_combine(random.state, 0x70686f746f6eu);
    float probability, density = 1.0f, time = s->has_motion ? rng_float(&random) : 0.0f;
    emission_start begun =
        settings->guide ? emission_guide_sample(settings->guide, &random, &density) : emission_start_draw(&random);
    if (t->trial)
        *t->trial = (emission_trial){begun, 0.0f, density};
    const light *lamp = &s->lights[scene_pick_light_by_power(s, begun.u[0], &probability)];
    emission_numbers numbers = emission_start_numbers(&begun);
    light_emission start;
    if (!(probability > 0.0f) || !light_emit(s, lamp, t->target, &numbers, &random, &start))
        return false;
    float weight = 1.0f / density;
    scene_ray ray = scene_ray_make(start.origin, start.direction);
    ray.skips_uv = true;
    ray.slabs_are_panes = settings->panes_are_direct;
    ray.medium = start.medium;
    ray.time = time;
    if (settings->filters_textures)
        ray.cone = (ray_cone){photon_width(s, settings), 0.0f, true};
    rgb flux = rgb_scale(start.flux, (t->trial ? 1.0f : weight) / probability);
    *out_path = (photon_path){ray, flux, random, key, weight, 1.0f, 0, 0, false};
    count_flux(t->out->balance.emitted, out_path->flux);
    return true;
}

/* The surface that a path has arrived at. */
typedef struct arrival_surface {
    float led_share;   /* of the ways on, that follow: */
    onward_lead lead;  /* what importons tell, where led_share > 0 */
    const rgb *albedo; /* of a Lambertian surface; else NULL, and: */
    bsdf scattering;
} arrival_surface;

/* Of the ways on that a map's paths go: of those by diffuse lobes, or of a caustic map of all, where any of its lobes
 * is rough. */
static float led_share(const arrival_surface *m, photon_kind kind)
{
    if (m->albedo)
        return kind == PHOTON_GLOBAL ? LED_SHARE : 0.0f;
    if (kind == PHOTON_GLOBAL)
        return LED_SHARE * bsdf_probability(&m->scattering, BSDF_GATHERED);
    return bsdf_is_sampled_from_light(&m->scattering, BSDF_TRACED) ? CAUSTIC_LED_SHARE : 0.0f;
}

static void arrival_surface_find(const photon_tracer *t, const photon_path *path, const surface_hit *hit,
                                 arrival_surface *out_surface)
{
    const photon_tracing_settings *settings = t->settings;
    vec3 back = vec3_negate(path->ray.direction);
    out_surface->led_share = 0.0f;
    out_surface->albedo = lambert_albedo(t->s, hit);
    if (!out_surface->albedo)
        bsdf_init(t->s, hit, back, &out_surface->scattering);
    float share = settings->ways ? led_share(out_surface, settings->kind) : 0.0f;
    if (!(share > 0.0f) || !onward_ways_find(settings->ways, rest_of_arrival(t->s, path, hit).position,
                                             vec3_face_forward(hit->geometric_normal, back), &out_surface->lead))
        return;
    /* histograms are too coarse for what rough metal or a coat reflects */
    if (settings->kind == PHOTON_GLOBAL || out_surface->lead.cone_count > 0)
        out_surface->led_share = share;
}

static bool arrival_surface_has(const arrival_surface *m, bsdf_lobes lobes)
{
    return m->albedo ? (lobes & BSDF_GATHERED) != 0 : bsdf_has(&m->scattering, lobes);
}

/* Returns whether photons are stored at a hit, on surfaces that gather, and writes the factor of their flux. */
static bool arrival_surface_stores(const scene *s, const surface_hit *hit, vec3 arrived, const arrival_surface *m,
                                   float *out_factor)
{
    if (m->albedo) {
        *out_factor = lambert_arrival_factor(hit, arrived);
        return true;
    }
    if (!bsdf_has(&m->scattering, BSDF_GATHERED))
        return bsdf_arrival_factor_beside(s, hit, &m->scattering, out_factor);
    *out_factor = bsdf_arrival_factor(&m->scattering);
    return true;
}

/* Sets all of the sample. false: absorbed. */
static bool arrival_surface_sample(const arrival_surface *m, const surface_hit *hit, vec3 arrived, bsdf_lobes lobes,
                                   float u_lobe, vec2 u, bsdf_sample *out_next)
{
    float correction;
    if (!m->albedo)
        return bsdf_sample_direction(&m->scattering, lobes, BSDF_FLUX, u_lobe, u, out_next);
    if (!lambert_sample_flux(hit, arrived, u, &out_next->direction, &correction))
        return false;
    out_next->weight = rgb_scale(*m->albedo, correction);
    out_next->pdf_solid_angle = fabsf(vec3_dot(out_next->direction, hit->geometric_normal)) * AG_INV_PI;
    out_next->group = BSDF_GATHERED;
    out_next->is_delta = out_next->is_straight = false;
    return true;
}

/* Evaluates the surface's own density and weight of a direction that was sampled otherwise. */
static void arrival_surface_evaluate(const arrival_surface *m, const surface_hit *hit, vec3 arrived, bsdf_lobes lobes,
                                     vec3 direction, bsdf_sample *out_next)
{
    *out_next = (bsdf_sample){.direction = direction, .group = lobes == BSDF_TRACED ? BSDF_TRACED : BSDF_GATHERED};
    if (m->albedo) {
        vec3 normal = vec3_face_forward(hit->geometric_normal, vec3_negate(arrived));
        out_next->weight = rgb_scale(*m->albedo, lambert_arrival_factor(hit, arrived));
        out_next->pdf_solid_angle = fmaxf(vec3_dot(direction, normal), 0.0f) * AG_INV_PI;
        return;
    }
    float pdf = bsdf_pdf(&m->scattering, lobes, BSDF_FLUX, direction);
    rgb value = bsdf_evaluate(&m->scattering, lobes, BSDF_FLUX, direction);
    out_next->pdf_solid_angle = pdf;
    out_next->weight = rgb_scale(value, 1.0f / pdf);
    if (!(pdf > 0.0f) || !rgb_is_finite(out_next->weight))
        out_next->weight = rgb_gray(0.0f), out_next->pdf_solid_angle = 0.0f;
}

/* Samples the direction in which flux goes on: by the surface, or by the importons there. The weight is that of
 * sampling by the surface alone; *out_led is the ratio of that density to the mixture's, below 1 / (1 - LED_SHARE); 0:
 * the direction carries nothing. Returns false where the flux is absorbed. */
static bool sample_way_on(const arrival_surface *m, const surface_hit *hit, vec3 arrived, bsdf_lobes lobes,
                          float u_lobe, vec2 u, bsdf_sample *out_next, float *out_led)
{
    float share = m->led_share;
    *out_led = 1.0f;
    if (!(share > 0.0f))
        return arrival_surface_sample(m, hit, arrived, lobes, u_lobe, u, out_next);
    if (u_lobe < share) {
        arrival_surface_evaluate(m, hit, arrived, lobes, onward_lead_sample(&m->lead, u), out_next);
    } else {
        u_lobe = float_below_one((u_lobe - share) / (1.0f - share));
        if (!arrival_surface_sample(m, hit, arrived, lobes, u_lobe, u, out_next))
            return false;
    }
    float by_lead = out_next->is_delta ? 0.0f : onward_lead_density(&m->lead, out_next->direction);
    float by_surface = out_next->is_delta ? 1.0f : out_next->pdf_solid_angle;
    *out_led = by_surface > 0.0f ? by_surface / ((1.0f - share) * by_surface + share * by_lead) : 0.0f;
    return true;
}

/* Sends the path on from where its ray has arrived. false: it ends there. */
static bool scatter(photon_tracer *t, photon_path *path, const surface_hit *hit, const arrival_surface *m)
{
    const photon_tracing_settings *settings = t->settings;
    energy_balance *balance = &t->out->balance;
    rgb flux = path->flux;
    bool may_go_straight = settings->panes_are_direct && !m->albedo && m->scattering.is_pane;
    bool is_last = path->scatterings >= settings->max_scatterings;
    if (path->arrivals >= SCATTERING_CAP || (is_last && !may_go_straight)) {
        count_flux(balance->truncated, flux);
        return false;
    }

    /* a caustic map follows traced lobes alone */
    bsdf_lobes lobes = settings->kind == PHOTON_GLOBAL ? BSDF_ALL : BSDF_TRACED;
    if (!arrival_surface_has(m, lobes)) {
        count_flux(balance->lost, flux);
        return false;
    }
    float u_lobe = rng_float(&path->random), u_roulette = rng_float(&path->random);
    vec2 u = rng_vec2(&path->random);
    bsdf_sample next;
    float led;
    if (!sample_way_on(m, hit, path->ray.direction, lobes, u_lobe, u, &next, &led)) {
        count_flux(balance->absorbed, flux);
        return false;
    }
    bool goes_straight = may_go_straight && next.is_straight;
    if (is_last && !goes_straight) {
        count_flux(balance->truncated, flux);
        return false;
    }
    rgb scattered = rgb_mul(flux, next.weight);
    count_flux(balance->absorbed, rgb_sub(flux, scattered));

    /* roulette keeps the survivors' flux about constant */
    float largest = rgb_max(scattered), survival = largest > 0.0f ? largest / rgb_max(flux) : 0.0f;
    survival = survival < 1.0f ? survival : 1.0f;
    if (u_roulette >= survival) {
        count_flux(balance->lost, scattered);
        return false;
    }
    path->weight *= led;
    path->flux = rgb_scale(scattered, led / survival);
    count_flux(balance->gained, rgb_sub(path->flux, scattered));
    if (!(led > 0.0f))
        return false;
    path->ray = goes_straight ? scene_ray_continue(hit, &path->ray) : surface_ray(hit, path->ray, next.direction);
    if (next.group == BSDF_GATHERED && settings->filters_textures)
        path->ray.cone.spread = RAY_CONE_DIFFUSE_SPREAD;
    path->scatterings += !goes_straight;
    path->arrivals++;
    path->is_diffuse = path->is_diffuse || next.group == BSDF_GATHERED;
    return true;
}

/* Returns the root of the mean square of the importance that a path's flux has, by the lobes that may split it; 0: it
 * is not split. Mirrors would send all parts in one direction. Where few paths arrive it is the root of their share;
 * where paths are guided, more arrive, with less flux each. */
static float root_of_onward_importance(const photon_tracer *t, const photon_path *path, const surface_hit *hit,
                                       const arrival_surface *m)
{
    const photon_tracing_settings *settings = t->settings;
    if (settings->kind == PHOTON_CAUSTIC)
        return !m->albedo && bsdf_is_sampled_from_light(&m->scattering, BSDF_TRACED) ? settings->caustic_root : 0.0f;
    if (!arrival_surface_has(m, BSDF_GATHERED))
        return 0.0f;
    surface_rest at = rest_of_arrival(t->s, path, hit);
    float importance = importance_map_at(settings->onward, at.position, at.geometric_normal);
    if (m->led_share > 0.0f)
        importance /= fmaxf(m->led_share * onward_lead_gain(&m->lead), 1.0f);
    return sqrtf(importance);
}

/* Returns the number of parts into which a path is split before it is scattered. In proportion to its flux and to the
 * root of the share of it that arrives where light is requested, the variance is least for the total number of
 * parts. */
static uint32_t count_parts(const photon_tracer *t, const photon_path *path, const surface_hit *hit,
                            const arrival_surface *m)
{
    const photon_tracing_settings *settings = t->settings;
    bool is_last = path->scatterings >= settings->max_scatterings || path->arrivals >= SCATTERING_CAP;
    if (is_last)
        return 1;
    float gain = m->albedo ? 1.0f : bsdf_flux_gain(&m->scattering), parts = gain / GAIN_OF_PART;
    if (settings->split_above > 0.0f) {
        float flux = gain * (path->flux.r + path->flux.g + path->flux.b);
        if (t->trial)
            flux /= t->trial->density;
        parts = fmaxf(parts, flux * root_of_onward_importance(t, path, hit, m) / settings->split_above);
    }
    float most = SPLIT_MOST * path->share;
    return !(parts > 1.0f) ? 1 : (uint32_t)fmaxf(fminf(parts + 0.5f, most), 1.0f);
}

/* Returns one of the parts, which are equally bright, with random numbers of its own. */
static photon_path part_of_path(const photon_path *path, uint32_t part, uint32_t parts)
{
    photon_path out = *path;
    uint64_t number = (uint64_t)path->arrivals << 32 | part;
    float share = 1.0f / (float)parts;
    out.flux = rgb_scale(path->flux, share);
    out.weight *= share;
    out.share *= share;
    out.key = hash_combine(path->key, number);
    out.random.state = hash_combine(path->random.state, number);
    return out;
}

static void follow_path(photon_tracer *t, photon_path *path);

/* Stores a photon where the path's ray has arrived, and sends the path on, or its parts. false: it ends there. */
static bool arrive(photon_tracer *t, photon_path *path, const surface_hit *hit)
{
    vec3 arrived = path->ray.direction;
    arrival_surface m;
    float factor;
    arrival_surface_find(t, path, hit, &m);
    if ((t->settings->kind == PHOTON_GLOBAL || path->scatterings > 0) &&
        arrival_surface_stores(t->s, hit, arrived, &m, &factor))
        store(t, path, hit, factor);
    uint32_t parts = count_parts(t, path, hit, &m);
    t->out->parts += parts - 1;
    for (uint32_t i = 1; i < parts; i++) {
        photon_path part = part_of_path(path, i, parts);
        if (scatter(t, &part, hit, &m))
            follow_path(t, &part);
    }
    if (parts > 1)
        *path = part_of_path(path, 0, parts);
    return scatter(t, path, hit, &m);
}

static void follow_path(photon_tracer *t, photon_path *path)
{
    energy_balance *balance = &t->out->balance;
    bool goes_on = true;
    while (goes_on) {
        surface_hit hit;
        rgb transmittance;
        t->out->rays++;
        bool is_met = transmittance_intersect(t->s, &path->ray, &t->out->rays_cut, &hit, &transmittance);
        if (!pass_media(balance, transmittance, &path->random, &path->flux))
            return;
        if (!is_met)
            count_flux(balance->escaped, path->flux);
        if (is_met && ray_cone_is_wide(&path->ray.cone)) {
            path->ray.cone = ray_cone_at(&path->ray.cone, hit.distance);
            hit.footprint = ray_cone_footprint(&path->ray.cone, path->ray.direction);
        }
        goes_on = is_met && arrive(t, path, &hit);
    }
}

void photon_path_trace(photon_tracer *t, uint64_t number)
{
    photon_path path;
    if (begin_path(t, number, &path))
        follow_path(t, &path);
}

/* photon_path.c: see photon_path.h. */
#include "photon_path.h"

#include "medium/medium_roulette.h"
#include "photon_arrival.h"
#include "quarter_octave.h"
#include "scene_extent.h"

#include <stdlib.h>
#include <string.h>

/* A path meets at most so many surfaces, panes included; the flux that is left is counted as truncated. */
enum { ARRIVALS_MAX = 100 };
/* Most parts of a path in all, by splitting at all its surfaces. */
enum { SPLIT_MOST = 4096 };
/* Where a surface multiplies flux, the path is split so that the flux of no part grows by more than this factor. */
static const float GAIN_OF_PART = 8.0f;
/* The room that a block's first photon makes. */
enum { PHOTONS_FIRST = 1024 };
/* Random streams, apart from those of the eye. */
enum { STREAM_GLOBAL = 1, STREAM_CAUSTIC = 2, STREAM_TRIALS = 2 /* added to those */ };

typedef struct photon_path {
    scene_ray ray;
    rgb flux;
    rng random;
    uint64_t key;        /* of the path's number: photons' keys are made of it */
    float density_ratio; /* of such paths: their density by power alone, over that with guides and splitting */
    float share;         /* the fraction of the path from the lamp that this part is */
    int scatterings; /* that max_scatterings bounds: by surfaces, but for panes, where they are direct; and by media */
    int in_media;    /* by media, counted on their own */
    int arrivals;    /* at surfaces, panes too */
    bool is_diffuse; /* has gone on from a surface by its gathered lobes, or from a point in a medium */
} photon_path;

static void count_flux(double entry[3], rgb flux)
{
    entry[0] += (double)flux.r;
    entry[1] += (double)flux.g;
    entry[2] += (double)flux.b;
}

/* Makes room for one more photon. Returns false where memory runs out. */
static bool reserve_photon(path_block *out)
{
    if (out->count < out->capacity)
        return true;
    uint32_t capacity = out->capacity ? 2 * out->capacity : PHOTONS_FIRST;
    photon *larger = realloc(out->photons, capacity * sizeof *larger);
    if (!larger) {
        out->out_of_memory = true;
        return false;
    }
    out->photons = larger;
    out->capacity = capacity;
    return true;
}

/* How probable it is that a photon is stored. Where no light is asked for, those whose paths were picked more often
 * than by power are stored as rarely as if they had not been. */
static float keep_probability(const photon_path *path, float importance)
{
    return importance > 0.0f || !(path->density_ratio < 1.0f) ? 1.0f : path->density_ratio;
}

/* Decides whether a photon is stored, and makes up for those that are not by its flux. */
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

/* Counts a photon that a trial would store, and what it is worth. */
static void value_photon(photon_tracer *t, const photon_path *path, const surface_rest *rest, rgb flux)
{
    float importance = importance_map_at(t->settings->asked, rest->position, rest->geometric_normal);
    t->counts->photons++;
    t->counts->asked += importance > 0.0f;
    t->counts->stored += (double)keep_probability(path, importance);
    t->counts->roots += (double)sqrtf(importance);
    t->counts->importance += (double)importance;
    t->trial->value += (flux.r + flux.g + flux.b) * sqrtf(importance);
}

static void append_photon(photon_tracer *t, const photon_path *path, const surface_rest *rest, uint64_t key, rgb flux)
{
    path_block *out = t->out;
    if (out->count == t->limit) {
        count_flux(out->balance.cut, flux);
        return;
    }
    if (!reserve_photon(out))
        return;
    photon *p = &out->photons[out->count++];
    photon_set_position(p, rest->position);
    p->flux = flux_encode(flux, key);
    p->direction = arrival_encode(path->ray.direction, path->is_diffuse);
    p->normal = direction_encode(rest->geometric_normal);
    memset(&p->slot, 0, sizeof p->slot);
    count_flux(out->balance.stored, flux_decode(p->flux));
}

/* Stores the photon of an arrival, or in a trial values it. arrival_factor: see photon_arrival_stores. */
static void store(photon_tracer *t, const photon_path *path, const photon_arrival *at, float arrival_factor)
{
    uint64_t key = hash_combine(path->key, (uint64_t)path->arrivals);
    surface_rest rest = photon_arrival_rest(t->s, at);
    float alpha = photon_arrival_alpha(t->s, at);
    rgb flux = rgb_scale(path->flux, alpha > 0.0f ? arrival_factor * rest.area_ratio / alpha : 0.0f);
    if (t->trial) {
        value_photon(t, path, &rest, flux);
        return;
    }
    count_flux(t->out->balance.arrived, flux);
    if (keep(t, path, rest.position, rest.geometric_normal, key, &flux))
        append_photon(t, path, &rest, key, flux);
}

/* A way through media multiplies a path's flux by a weight. What it takes counts as absorbed: where media scatter, that
 * is right on average. Roulette then keeps the flux about constant, so that no photons are spent on faint light.
 * Returns false where the path ends. No random number is drawn where the weight is 1. */
static bool pass_media(energy_balance *balance, rgb weight, rng *random, rgb *in_out_flux)
{
    if (weight.r == 1.0f && weight.g == 1.0f && weight.b == 1.0f)
        return true;
    rgb flux = *in_out_flux, left = rgb_mul(flux, weight);
    count_flux(balance->absorbed, rgb_sub(flux, left));
    if (rgb_is_black(left))
        return false;
    float survival = float_min(rgb_max(left) / rgb_max(flux), 1.0f);
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
    float width = float_min(sqrtf(s->surface_area / (float)settings->wanted), RADIUS_SHARE_MAX * radius);
    return settings->paths > 0 ? quarter_octave_nearest(width) : width;
}

/* Leaves a lamp, picked by its power or by the guide, at a time of the path's own where that matters. Returns false
 * where nothing leaves. */
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
    emission_numbers numbers = emission_start_numbers(&begun, settings->focus);
    light_emission start;
    if (!(probability > 0.0f) || !light_emit(s, lamp, t->target, &numbers, &start))
        return false;
    scene_ray ray = scene_ray_make(start.origin, start.direction);
    ray.skips_uv = true;
    ray.slabs_are_panes = settings->panes_are_direct;
    ray.medium = start.medium;
    ray.time = time;
    if (settings->filters_textures)
        ray.cone = (ray_cone){photon_width(s, settings), 0.0f, true};
    float density_ratio = 1.0f / density;
    rgb flux = rgb_scale(start.flux, (t->trial ? 1.0f : density_ratio) / probability);
    *out_path = (photon_path){
        .ray = ray, .flux = flux, .random = random, .key = key, .density_ratio = density_ratio, .share = 1.0f};
    count_flux(t->out->balance.emitted, out_path->flux);
    return true;
}

/* Sends the path on from where it has arrived. Returns false where it ends. */
static bool scatter(photon_tracer *t, photon_path *path, const photon_arrival *at)
{
    const photon_tracing_settings *settings = t->settings;
    energy_balance *balance = &t->out->balance;
    rgb flux = path->flux;
    bool may_go_straight = settings->panes_are_direct && photon_arrival_is_pane(at);
    bool is_last = path->scatterings >= settings->max_scatterings;
    if (path->arrivals >= ARRIVALS_MAX || (is_last && !may_go_straight)) {
        count_flux(balance->truncated, flux);
        return false;
    }

    /* a caustic map follows traced lobes alone */
    bsdf_lobes lobes = settings->kind == PHOTON_GLOBAL ? BSDF_ALL : BSDF_TRACED;
    if (!photon_arrival_has(at, lobes)) {
        count_flux(balance->lost, flux);
        return false;
    }
    float u_lobe = rng_float(&path->random), u_roulette = rng_float(&path->random);
    vec2 u = rng_vec2(&path->random);
    bsdf_sample next;
    float density_ratio;
    if (!photon_arrival_sample(at, lobes, u_lobe, u, &next, &density_ratio)) {
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
    path->density_ratio *= density_ratio;
    path->flux = rgb_scale(scattered, density_ratio / survival);
    count_flux(balance->gained, rgb_sub(path->flux, scattered));
    if (!(density_ratio > 0.0f))
        return false;
    path->ray = goes_straight ? photon_arrival_ray_straight(at, &path->ray)
                              : photon_arrival_ray(at, &path->ray, next.direction);
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
static float root_of_onward_importance(const photon_tracer *t, const photon_arrival *at)
{
    const photon_tracing_settings *settings = t->settings;
    if (settings->kind == PHOTON_CAUSTIC)
        return photon_arrival_is_rough(at) ? settings->caustic_root : 0.0f;
    if (!photon_arrival_has(at, BSDF_GATHERED))
        return 0.0f;
    surface_rest rest = photon_arrival_rest(t->s, at);
    float importance = importance_map_at(settings->onward, rest.position, rest.geometric_normal);
    if (at->guided_share > 0.0f)
        importance /= float_max(at->guided_share * onward_guide_gain(&at->onward), 1.0f);
    return sqrtf(importance);
}

/* Returns the number of parts into which a path is split before it is scattered. In proportion to its flux and to the
 * root of the share of it that arrives where light is requested, the variance is least for the total number of
 * parts. */
static uint32_t count_parts(const photon_tracer *t, const photon_path *path, const photon_arrival *at)
{
    const photon_tracing_settings *settings = t->settings;
    bool is_last = path->scatterings >= settings->max_scatterings || path->arrivals >= ARRIVALS_MAX;
    if (is_last)
        return 1;
    float gain = photon_arrival_gain(at), parts = gain / GAIN_OF_PART;
    if (settings->split_above > 0.0f) {
        float flux = gain * (path->flux.r + path->flux.g + path->flux.b);
        if (t->trial)
            flux /= t->trial->density;
        parts = float_max(parts, flux * root_of_onward_importance(t, at) / settings->split_above);
    }
    float most = SPLIT_MOST * path->share;
    return !(parts > 1.0f) ? 1 : (uint32_t)float_max(float_min(parts + 0.5f, most), 1.0f);
}

/* Returns one of the parts, which are equally bright, with random numbers of its own. */
static photon_path part_of_path(const photon_path *path, uint32_t part, uint32_t parts)
{
    photon_path out = *path;
    uint64_t number = (uint64_t)path->arrivals << 32 | part;
    float share = 1.0f / (float)parts;
    out.flux = rgb_scale(path->flux, share);
    out.density_ratio *= share;
    out.share *= share;
    out.key = hash_combine(path->key, number);
    out.random.state = hash_combine(path->random.state, number);
    return out;
}

static void follow_path(photon_tracer *t, photon_path *path);

/* Stores a photon where the path has arrived, and sends the path on, or its parts. Returns false where it ends. */
static bool arrive(photon_tracer *t, photon_path *path, photon_arrival *at)
{
    float factor;
    photon_arrival_complete(t->s, t->settings, at);
    if ((t->settings->kind == PHOTON_GLOBAL || path->scatterings > 0) && photon_arrival_stores(t->s, at, &factor))
        store(t, path, at, factor);
    uint32_t parts = count_parts(t, path, at);
    t->out->parts += parts - 1;
    for (uint32_t i = 1; i < parts; i++) {
        photon_path part = part_of_path(path, i, parts);
        if (scatter(t, &part, at))
            follow_path(t, &part);
    }
    if (parts > 1)
        *path = part_of_path(path, 0, parts);
    return scatter(t, path, at);
}

/* Whether a path goes on that a medium has scattered once more. No random number is drawn where all paths do. */
static bool survives_in_medium(energy_balance *balance, photon_path *path)
{
    float before = medium_roulette_level(path->in_media), level = medium_roulette_level(++path->in_media);
    if (level == before)
        return true;
    rgb flux = path->flux;
    if (rng_float(&path->random) >= before / level) {
        count_flux(balance->lost, flux);
        return false;
    }
    path->flux = rgb_scale(flux, level / before);
    count_flux(balance->gained, rgb_sub(path->flux, flux));
    return true;
}

/* Sends the path on from where a medium has scattered it. Returns false where it ends. */
static bool scatter_in_medium(photon_tracer *t, photon_path *path, const photon_arrival *at)
{
    bool is_bounded = t->settings->media_are_bounded;
    if ((is_bounded && path->scatterings >= t->settings->max_scatterings) || path->in_media == MEDIUM_SCATTERINGS_MAX) {
        count_flux(t->out->balance.truncated, path->flux);
        return false;
    }
    if (!survives_in_medium(&t->out->balance, path))
        return false;
    photon_arrival_scatter_in_medium(t->s, at, rng_vec2(&path->random), &path->ray);
    path->scatterings += is_bounded;
    path->is_diffuse = true;
    return true;
}

/* Follows the path's ray, through media that scatter too. Light that they scatter is no caustic: a caustic map's paths
 * go straight on, with what is left of their flux. */
static ray_end meet(photon_tracer *t, photon_path *path, photon_arrival *out_at, rgb *out_weight)
{
    t->out->rays++;
    if (t->s->has_scattering_media && t->settings->kind == PHOTON_GLOBAL)
        return photon_arrival_travel(t->s, &path->ray, path->flux, rng_vec2(&path->random), &t->out->rays_cut, out_at,
                                     out_weight);
    return photon_arrival_meet(t->s, &path->ray, &t->out->rays_cut, out_at, out_weight) ? RAY_ENDS_AT_SURFACE
                                                                                        : RAY_ENDS_NOWHERE;
}

static void follow_path(photon_tracer *t, photon_path *path)
{
    energy_balance *balance = &t->out->balance;
    bool goes_on = true;
    while (goes_on) {
        photon_arrival at;
        rgb weight;
        ray_end end = meet(t, path, &at, &weight);
        if (!pass_media(balance, weight, &path->random, &path->flux))
            return;
        if (end == RAY_ENDS_NOWHERE)
            count_flux(balance->escaped, path->flux);
        goes_on = end == RAY_ENDS_IN_MEDIUM ? scatter_in_medium(t, path, &at)
                                            : end == RAY_ENDS_AT_SURFACE && arrive(t, path, &at);
    }
}

void photon_path_trace(photon_tracer *t, uint64_t number)
{
    photon_path path;
    if (begin_path(t, number, &path))
        follow_path(t, &path);
}

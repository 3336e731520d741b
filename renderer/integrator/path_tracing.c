/* path_tracing.c: see path_tracing.h. */
#include "integrator/path_tracing.h"

#include "integrator/eye_path.h"
#include "integrator/integrator.h"

/* Roulette that began at all of the light would leave up to 1.8 times the squared error, for as much time. */
static const eye_roulette ROULETTE = {3, 0.25f};

/* Picks one group of lobes by its share, where it matters which group scattered: rough lobes of both groups may send
 * light the same way. The random number is evenly distributed again afterwards. */
static bsdf_lobes pick_group(const vertex *v, float *in_out_u, rgb *in_out_throughput)
{
    float share = bsdf_probability(&v->scattering, BSDF_GATHERED);
    bool is_gathered = *in_out_u < share;
    float before = is_gathered ? 0.0f : share, picked = is_gathered ? share : 1.0f - share;
    *in_out_u = float_below_one((*in_out_u - before) / picked);
    *in_out_throughput = rgb_scale(*in_out_throughput, 1.0f / picked);
    return is_gathered ? BSDF_GATHERED : BSDF_TRACED;
}

void path_tracing_radiance(const transport *t, eye_worker *worker, const camera_sample *from, eye_sample *in_out)
{
    bool wants_all = transport_wants_all_light(t);
    eye_path path = eye_path_begin(from, ROULETTE, in_out->layers != NULL);
    for (;;) {
        vertex v;
        /* indirect light leaves out lamps that are seen, and light that falls straight on the first diffuse surface */
        bool has_met_diffuse = path.first_gathered > 0;
        bool counts_emission = wants_all || (has_met_diffuse && path.first_gathered < path.scatterings);
        if (!eye_path_trace(t, worker, &path, in_out, &v)) {
            if (counts_emission)
                eye_path_add_escaped(t, &path, in_out);
            return;
        }
        if (counts_emission)
            eye_path_add_emitted(t, &path, &v, in_out);
        if ((wants_all || has_met_diffuse) && !eye_path_is_last(t, &path) &&
            bsdf_is_sampled_from_light(&v.scattering, BSDF_ALL))
            eye_path_add_direct(t, worker, &path, &v, BSDF_ALL, 1, in_out);

        float u_lobe = eye_path_u_lobe(&path);
        bsdf_lobes lobes = wants_all || has_met_diffuse ? BSDF_ALL : pick_group(&v, &u_lobe, &path.throughput);
        if (!eye_path_go_on(t, &v, lobes, NULL, u_lobe, 1, &path))
            return;
    }
}

const integrator path_integrator = {.sample = path_tracing_radiance};

/* integrator.h: what an integrator is: how radiance along camera rays is found, and what has to be made for it first.
 * One file and one row of AG_INTEGRATOR_LIST each. Flow: render, render_tiles -> [here] -> shading or path_tracing.
 * Threads: sample and complete run on all workers at once; the others on the thread that renders. */
#ifndef AFTERGLOW_INTEGRATOR_H
#define AFTERGLOW_INTEGRATOR_H

#include "integrator/camera_sample.h"
#include "integrator/transport.h"

struct ag_rendering;

/* Each function may be NULL, which does nothing, but for sample. */
typedef struct integrator {
    bool has_photon_map;  /* it traces photons, so that their settings, layers and statistics apply */
    bool splits_samples;  /* its samples tell cost and variance of their gather rays, light samples and camera rays,
                             so that each block of the picture can choose how many there are (film/splitting.h) */
    float direct_guiding; /* the default of that setting */

    /* Called once, before all tiles: makes what tiles read, in the rendering, and refers to it in the transport.
     * Errors: AG_ERROR_MEMORY, AG_CANCELLED, those of a photon map's file. */
    ag_status (*prepare)(struct ag_rendering *r);
    /* Allocates the worker's own memory at full size, so that nothing can fail while tiles run; returns false when out
     * of memory. eye_workers_destroy frees it. */
    bool (*reserve)(const transport *t, eye_worker *worker);

    /* Called before each pass, which is one ag_rendering_continue; none of the workers is at work. After a whole pass
     * each pixel has as many samples as settings and film say, so what is learned from them for the next pass is the
     * same for any number of threads. It is called again where the pass before was cancelled or paused. Errors:
     * AG_ERROR_MEMORY, AG_CANCELLED; after AG_PAUSED the next call goes on. */
    ag_status (*begin_pass)(struct ag_rendering *r);

    /* Adds the radiance along a camera ray to a sample that has nothing in it but its bounds and room for layers; what
     * complete brings comes later. Where samples are split it is then called for each of the sample's further camera
     * rays, which add neither caustics nor gathered light (split_counts). */
    void (*sample)(const transport *t, eye_worker *worker, const camera_sample *from, eye_sample *in_out);
    /* Completes all samples that the worker has under way. */
    void (*complete)(const transport *t, eye_worker *worker);
} integrator;

/* Each row of AG_INTEGRATOR_LIST (render_settings.h) has an integrator WORD_integrator, in a file of its own. */
#define INTEGRATOR_DECLARATION(kind, word, about) extern const integrator word##_integrator;
AG_INTEGRATOR_LIST(INTEGRATOR_DECLARATION)
#undef INTEGRATOR_DECLARATION

/* Returns the integrator of that kind; NULL for any other number, which render_settings_check refuses. */
const integrator *integrator_of(ag_integrator kind);

#endif

/* scene_hash.h: fingerprints of a committed scene's contents (pixels, vertices and numbers, not file names), for
 * files that are valid for one scene alone: photon maps, checkpoints.
 * Flow: scene -> [here] -> photon_file, checkpoint. Threads: any number, of a committed scene. */
#ifndef AFTERGLOW_SCENE_HASH_H
#define AFTERGLOW_SCENE_HASH_H

#include "math/hash128.h"

struct scene;

/* Hashes all that the photons' paths depend on: shapes, objects, instances, materials, textures and their pictures,
 * media, lights. Camera, film, names and groups of lights may differ. */
hash128 scene_hash_of_light(const struct scene *s);

/* Hashes the rest that a picture depends on: camera, jitter, names, groups of lights. Other hints are part of the
 * renderer's settings and of the film's filter. */
hash128 scene_hash_of_view(const struct scene *s);

/* Hashes what rays that ask for surfaces (scene_find_surface, scene_is_blocked) find out about one shape: form, place
 * and holes. Two scenes give equal answers about equal shapes where scene_hash_of_passed_surfaces is equal as well. */
hash128 scene_hash_of_form(const struct scene *s, uint32_t shape_index);

/* Hashes what decides in all of the scene which surfaces such rays pass: alpha textures, and materials where there are
 * interfaces. */
hash128 scene_hash_of_passed_surfaces(const struct scene *s);

#endif

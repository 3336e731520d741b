/* photon_dump.c: see photon_dump.h. */
#include "output/photon_dump.h"

#include "atomic_file.h"
#include "integrator/integrator.h"
#include "rendering.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FLOATS = 12, RECORD_BYTES = FLOATS * 4 + 2, HEAD_BYTES = 1024 };

/* Notes for each photon whether its irradiance is there: in flags so many bytes apart. */
static void mark_demanded(const photon_map *map, unsigned char *first)
{
    for (uint32_t i = 0; i < map->irradiance_photons.count; i++) {
        uint32_t word = irradiance_slot_read(photon_map_slot(map, i));
        if (irradiance_word_is_ready(word))
            first[(size_t)photon_map_index(map, i) * RECORD_BYTES] = 1;
    }
}

/* PLY's "binary_little_endian", as this machine is. */
static unsigned char *write_map(const photon_map *map, unsigned char kind, unsigned char *at)
{
    unsigned char *first_mark = at + RECORD_BYTES - 1;
    for (uint32_t i = 0; i < map->set.count; i++) {
        const photon_block *block = &map->blocks[i / PHOTON_BLOCK_LANES];
        vec3 position = photon_block_position(map->blocks, i);
        vec3 normal = direction_decode(photon_block_normal(map->blocks, i));
        vec3 direction = arrival_direction(block->direction[i % PHOTON_BLOCK_LANES]);
        rgb flux = flux_decode(photon_block_flux(map->blocks, i));
        float share = 1.0f / (float)map->set.emitted_paths;
        const float values[FLOATS] = {position.x,  position.y,     position.z,     normal.x,
                                      normal.y,    normal.z,       direction.x,    direction.y,
                                      direction.z, flux.r * share, flux.g * share, flux.b * share};
        memcpy(at, values, sizeof values);
        at[sizeof values] = kind;
        at[sizeof values + 1] = 0;
        at += RECORD_BYTES;
    }
    mark_demanded(map, first_mark);
    return at;
}

ag_status photon_dump_write(const run_context *run, const photon_map *global, const photon_map *caustic,
                            const char *path, char *message, size_t message_size)
{
    static const char *const names[FLOATS] = {"x",  "y",  "z",  "nx",  "ny",    "nz",
                                              "dx", "dy", "dz", "red", "green", "blue"};
    size_t count = (size_t)global->set.count + caustic->set.count;
    unsigned char *bytes = malloc(HEAD_BYTES + count * RECORD_BYTES);
    if (!bytes)
        return AG_ERROR_MEMORY;
    char *head = (char *)bytes;
    int length = snprintf(head, HEAD_BYTES,
                          "ply\nformat binary_little_endian 1.0\ncomment Afterglow photons, power in W\n"
                          "element vertex %zu\n",
                          count);
    for (int i = 0; i < FLOATS; i++)
        length += snprintf(head + length, (size_t)(HEAD_BYTES - length), "property float %s\n", names[i]);
    length += snprintf(head + length, (size_t)(HEAD_BYTES - length),
                       "property uchar caustic\nproperty uchar demanded\nend_header\n");
    unsigned char *at = write_map(global, 0, bytes + length);
    at = write_map(caustic, 1, at);
    ag_status status = atomic_file_write(run, path, bytes, (size_t)(at - bytes), message, message_size);
    free(bytes);
    return status;
}

ag_status ag_rendering_write_photons(const ag_rendering *r, const char *path)
{
    if (!r || !path || !integrator_of(r->settings.integrator)->has_photon_map)
        return AG_ERROR_ARGUMENT;
    if (!photon_file_is_intact(&r->maps->file)) {
        log_message(r->context->log, AG_LOG_ERROR,
                    "'%s': the photon map was cut short or overwritten: no photons of it "
                    "are written",
                    r->map_name ? r->map_name : "");
        return AG_ERROR_SYSTEM;
    }
    char message[1024] = "";
    phase_begin begin = context_begin_phase();
    ag_status status =
        photon_dump_write(&r->context->run, &r->maps->global, &r->maps->caustic, path, message, sizeof message);
    context_add_to_phase(r->context, AG_PHASE_WRITE, begin);
    if (message[0] && status != AG_CANCELLED)
        log_message(r->context->log, AG_LOG_ERROR, "%s", message);
    return status;
}

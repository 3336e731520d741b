/* photon_merge.c: see photon_merge.h. */
#include "photon_merge.h"

#include <assert.h>

photon_merge_result photon_merge(photon_map *into, const photon_map *from, uint64_t *in_out_added,
                                 uint32_t *out_irradiance_photon)
{
    assert(into->irradiance_photons.count == from->irradiance_photons.count);
    for (uint32_t i = 0; i < into->irradiance_photons.count; i++) {
        uint32_t is = irradiance_slot_read(photon_map_slot(into, i)),
                 other = irradiance_slot_read(photon_map_slot(from, i));
        if (irradiance_word_is_ready(is) && irradiance_word_is_ready(other) && is != other) {
            *out_irradiance_photon = i;
            return PHOTON_MERGE_DIFFERS;
        }
    }
    for (uint32_t i = 0; i < into->irradiance_photons.count; i++) {
        uint32_t word = irradiance_slot_read(photon_map_slot(from, i)), found;
        if (!irradiance_word_is_ready(word) || !irradiance_slot_try_claim(photon_map_slot(into, i), 0, &found))
            continue;
        if (into->checks)
            store_relaxed_u8(&into->checks[i], irradiance_word_check(i, word));
        irradiance_slot_publish(photon_map_slot(into, i), 0, word);
        ++*in_out_added;
    }
    return PHOTON_MERGE_DONE;
}

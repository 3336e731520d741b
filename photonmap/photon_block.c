/* photon_block.c: see photon_block.h. */
#include "photon_block.h"

#include <string.h>

void photon_block_from_records(photon_block *block, uint32_t count)
{
    /* the slots are all empty while a map is built: 0, which is what memset leaves */
    unsigned char records[sizeof *block];
    memcpy(records, block, count * sizeof(photon));
    memset(block, 0, sizeof *block);
    for (uint32_t i = 0; i < PHOTON_BLOCK_LANES; i++) {
        photon p;
        if (i >= count) {
            for (int a = 0; a < 3; a++)
                block->position[a][i] = NAN;
            continue;
        }
        memcpy(&p, records + i * sizeof p, sizeof p);
        for (int a = 0; a < 3; a++)
            block->position[a][i] = p.position[a];
        block->flux[i] = p.flux;
        block->direction[i] = p.direction;
        block->normal[i] = p.normal;
    }
}

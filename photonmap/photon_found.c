/* photon_found.c: see photon_found.h.
 * Threads: see photon_found.h. */
#include "photon_found.h"

#include "disc_kernels.h"

/* Beside the photons wanted, of which each may lie in a leaf of its own. */
enum { SPARE_LEAVES = 64, ALIGNMENT = 64 };

/* In turn: neighbours that a selection compares, distances from a cache line on, leaves. */
static uint32_t neighbors_compared(uint32_t wanted) { return 2 * wanted + 64; }

uint32_t photon_neighbors_capacity(uint32_t wanted)
{
    enum { EACH = sizeof(photon_neighbor) };
    uint32_t leaves = wanted + SPARE_LEAVES, leaf_bytes = PHOTON_BLOCK_LANES * sizeof(float) + sizeof(uint32_t);
    return neighbors_compared(wanted) + (ALIGNMENT + leaves * leaf_bytes + EACH - 1) / EACH;
}

void photon_found_init(photon_found *found, const photon_tree *tree, uint32_t wanted, photon_neighbor *scratch)
{
    uint32_t leaves = wanted + SPARE_LEAVES, compared = neighbors_compared(wanted);
    uintptr_t after = (uintptr_t)(scratch + compared), aligned = (after + ALIGNMENT - 1) & ~(uintptr_t)(ALIGNMENT - 1);
    float *distances = (float *)(void *)((char *)(scratch + compared) + (aligned - after));
    *found = (photon_found){.blocks = tree->blocks,
                            .leaves = (uint32_t *)(void *)(distances + (size_t)leaves * PHOTON_BLOCK_LANES),
                            .distances_squared = distances,
                            .leaf_capacity = leaves,
                            .capacity = compared,
                            .other_squared = INFINITY,
                            .scratch = scratch};
}

/* Partitions neighbours so that the `wanted` nearest come first, the farthest of these last; 1 <= wanted <= count. */
static void quickselect(photon_neighbor *n, uint32_t count, uint32_t wanted)
{
    int64_t low = 0, high = (int64_t)count - 1, target = (int64_t)wanted - 1;
    while (low < high) {
        photon_neighbor a = n[low], b = n[low + (high - low) / 2], c = n[high];
        photon_neighbor pivot = a < b ? (b < c ? b : (a < c ? c : a)) : (a < c ? a : (b < c ? c : b));
        int64_t i = low, j = high;
        while (i <= j) {
            while (n[i] < pivot)
                i++;
            while (n[j] > pivot)
                j--;
            if (i <= j) {
                photon_neighbor hold = n[i];
                n[i++] = n[j];
                n[j--] = hold;
            }
        }
        if (target <= j)
            high = j;
        else if (target >= i)
            low = i;
        else
            return;
    }
}

/* Squared distances on a surface are spread evenly, so that counting tells where the last one wanted must be, and few
 * are left to be compared. */
void photon_found_keep_nearest(const disc_kernels *kernels, photon_found *found, uint32_t wanted)
{
    enum { COMPARED = 24, ROUNDS = 3, ASIDE = 6 }; /* photons */
    float low = -1.0f, high = found->limit;
    uint32_t low_count = 0, high_count = found->count; /* that are no farther */
    for (int round = 0; round < ROUNDS && high_count - low_count > COMPARED; round++) {
        float begin = float_max(low, 0.0f), each = (high - begin) / (float)(high_count - low_count);
        float middle = begin + each * ((float)(wanted - low_count) - 0.5f), aside = each * (float)ASIDE;
        const float most[DISC_COUNTS] = {middle - aside, middle, middle + aside};
        uint32_t within[DISC_COUNTS];
        kernels->count_within(found, most, within);
        for (int i = 0; i < DISC_COUNTS; i++) {
            if (!(most[i] > low && most[i] < high))
                continue;
            if (within[i] >= wanted) {
                high = most[i];
                high_count = within[i];
            } else {
                low = most[i];
                low_count = within[i];
            }
        }
    }
    photon_neighbor *compared = found->scratch;
    uint32_t count = kernels->list_between(found, low, high, compared), of_these = wanted - low_count;
    quickselect(compared, count, of_these);
    found->farthest = compared[of_these - 1];
    found->limit = photon_neighbor_distance_squared(found->farthest);
    for (uint32_t i = of_these; i < count; i++)
        if (photon_neighbor_distance_squared(compared[i]) == found->limit)
            photon_found_forget(found, compared[i]);
    found->count = wanted;
}

void photon_found_drop_empty_leaves(photon_found *found)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < found->leaf_count; i++) {
        const float *d = found->distances_squared + (size_t)i * PHOTON_BLOCK_LANES;
        bool has_some = false;
        for (uint32_t lane = 0; lane < PHOTON_BLOCK_LANES; lane++)
            has_some = has_some || d[lane] <= found->limit;
        if (has_some) {
            memmove(found->distances_squared + (size_t)left * PHOTON_BLOCK_LANES, d, PHOTON_BLOCK_LANES * sizeof *d);
            found->leaves[left++] = found->leaves[i];
        }
    }
    found->leaf_count = left;
}

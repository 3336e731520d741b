/* photon_file_write.c: what photon_file.h says of writing.
 * Rests on: posix_fallocate(3), pwrite(2). Threads: see photon_file.h. */
#define _GNU_SOURCE
#include "photon_file_header.h"

#include "math/rng.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

static photon_file_map record_of(const photon_map *map)
{
    return (photon_file_map){.emitted_paths = map->set.emitted_paths,
                             .rays = map->set.rays,
                             .rays_cut = map->set.rays_cut,
                             .balance = map->set.balance,
                             .nearest = map->nearest,
                             .max_radius = map->max_radius,
                             .min_radius_squared = map->min_radius_squared,
                             .mean_radius = map->mean_radius,
                             .flux_exponent_max = map->flux_exponent_max,
                             .irradiance_bias = map->irradiance_bias,
                             .is_steady = map->is_steady};
}

static int write_at(const run_context *run, int descriptor, const void *bytes, uint64_t size, uint64_t at)
{
    const char *next = bytes;
    while (size > 0) {
        if (run_is_cancelled(run))
            return ECANCELED;
        ssize_t written =
            pwrite(descriptor, next, (size_t)(size < PHOTON_FILE_CHUNK ? size : PHOTON_FILE_CHUNK), (off_t)at);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return written < 0 ? errno : ENOSPC;
        next += written;
        at += (uint64_t)written;
        size -= (uint64_t)written;
    }
    return 0;
}

/* Writes the check values of all irradiance photons, by pages; 0 where a slot is not ready, and behind the last one. */
static int write_checks(const run_context *run, int descriptor, const photon_tree *irradiance_photons, uint64_t at)
{
    int error = 0;
    for (uint32_t first = 0; first < irradiance_photons->count && error == 0;
         first += PHOTON_FILE_PAGE, at += PHOTON_FILE_PAGE) {
        uint8_t checks[PHOTON_FILE_PAGE] = {0};
        for (uint32_t i = 0; i < PHOTON_FILE_PAGE && i < irradiance_photons->count - first; i++) {
            uint32_t word = irradiance_slot_read(photon_block_slot(irradiance_photons->blocks, first + i));
            if (irradiance_word_is_ready(word))
                checks[i] = irradiance_word_check(first + i, word);
        }
        error = write_at(run, descriptor, checks, PHOTON_FILE_PAGE, at);
    }
    return error;
}

int photon_file_write(const run_context *run, int descriptor, const photon_file_key *key, const photon_map *global,
                      const photon_map *caustic)
{
    photon_file_header h;
    photon_file_header_init(&h);
    h.key = *key;
    h.maps[PHOTON_FILE_GLOBAL] = record_of(global);
    h.maps[PHOTON_FILE_CAUSTIC] = record_of(caustic);
    photon_tree trees[PHOTON_FILE_TREE_COUNT] = {
        [PHOTON_FILE_GLOBAL] = global->tree, [PHOTON_FILE_CAUSTIC] = caustic->tree};
    if (!photon_map_all_have_irradiance(global))
        trees[PHOTON_FILE_IRRADIANCE] = global->irradiance_photons;
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT; i++)
        h.trees[i] = (photon_file_tree){.count = trees[i].count, .depth = trees[i].depth};
    if (getrandom(&h.nonce, sizeof h.nonce, GRND_NONBLOCK) != (ssize_t)sizeof h.nonce) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        h.nonce = hash_mix64((uint64_t)now.tv_nsec ^ (uint64_t)now.tv_sec << 30 ^ (uint64_t)getpid() << 44);
    }
    h.file_bytes = photon_file_lay_out(h.trees, &h.checks_at);
    if (!photon_file_hash_content(run, trees, &h.content))
        return ECANCELED;
    h.self = photon_file_header_hash(&h);

    /* A mapped file must have its space on the disk: a disk that is full later would end processes by SIGBUS. A file
     * system that cannot reserve gets all bytes written below: none is left out. */
    int error = posix_fallocate(descriptor, 0, (off_t)h.file_bytes);
    if (error != 0 && error != EOPNOTSUPP && error != EINVAL && error != ENOSYS && error != EBADF)
        return error;
    static const char zeros[PHOTON_FILE_PAGE];
    uint64_t owners_end = photon_file_to_page(PHOTON_FILE_OWNERS_AT + CLAIM_OWNERS_MAX * sizeof(claim_owner));
    for (uint64_t at = 0; at < owners_end; at += PHOTON_FILE_PAGE)
        if ((error = write_at(run, descriptor, zeros, PHOTON_FILE_PAGE, at)) != 0)
            return error;
    error = write_at(run, descriptor, &h, sizeof h, 0);
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT && error == 0; i++) {
        const photon_file_tree *t = &h.trees[i];
        uint64_t size = photon_file_blocks_bytes(t), rest = photon_file_to_page(size) - size;
        error = write_at(run, descriptor, trees[i].blocks, size, t->blocks_at);
        if (error == 0)
            error = write_at(run, descriptor, zeros, rest, t->blocks_at + size);
        size = photon_file_nodes_bytes(t), rest = photon_file_to_page(size) - size;
        if (error == 0)
            error = write_at(run, descriptor, trees[i].nodes, size, t->nodes_at);
        if (error == 0)
            error = write_at(run, descriptor, zeros, rest, t->nodes_at + size);
    }
    return error == 0 ? write_checks(run, descriptor, &global->irradiance_photons, h.checks_at) : error;
}

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

/* Writes bytes at an offset. Returns 0, or an errno. */
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

/* Writes bytes at an offset, and zeros up to the next page. Returns 0, or an errno. */
static int write_pages(const run_context *run, int descriptor, const void *bytes, uint64_t size, uint64_t at)
{
    static const char zeros[PHOTON_FILE_PAGE];
    int error = write_at(run, descriptor, bytes, size, at);
    return error == 0 ? write_at(run, descriptor, zeros, photon_file_to_page(size) - size, at + size) : error;
}

/* Returns a number that no other file has, but for chance. */
static uint64_t make_nonce(void)
{
    uint64_t nonce;
    if (getrandom(&nonce, sizeof nonce, GRND_NONBLOCK) == (ssize_t)sizeof nonce)
        return nonce;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return hash_mix64((uint64_t)now.tv_nsec ^ (uint64_t)now.tv_sec << 30 ^ (uint64_t)getpid() << 44);
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
    h.nonce = make_nonce();
    h.file_bytes = photon_file_lay_out(h.trees, &h.checks_at);
    if (!photon_file_hash_content(run, trees, &h.content))
        return ECANCELED;
    h.self = photon_file_header_hash(&h);

    /* A mapped file must have its space on the disk: a disk that is full later would end processes by SIGBUS. A file
     * system that cannot reserve gets all bytes written below: none is left out. */
    int error = posix_fallocate(descriptor, 0, (off_t)h.file_bytes);
    if (error != 0 && error != EOPNOTSUPP && error != EINVAL && error != ENOSYS && error != EBADF)
        return error;
    static const claim_owner no_owners[CLAIM_OWNERS_MAX];
    error = write_pages(run, descriptor, &h, sizeof h, 0);
    if (error == 0)
        error = write_pages(run, descriptor, no_owners, sizeof no_owners, PHOTON_FILE_OWNERS_AT);
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT && error == 0; i++) {
        const photon_file_tree *t = &h.trees[i];
        error = write_pages(run, descriptor, trees[i].blocks, photon_file_blocks_bytes(t), t->blocks_at);
        if (error == 0)
            error = write_pages(run, descriptor, trees[i].nodes, photon_file_nodes_bytes(t), t->nodes_at);
    }
    return error == 0 ? write_checks(run, descriptor, &global->irradiance_photons, h.checks_at) : error;
}

/* photon_file.c: see photon_file.h; photon_file_write.c writes.
 * Rests on: mmap(2). Threads: see photon_file.h. */
#define _GNU_SOURCE
#include "photon_file_header.h"

#include "descriptor.h"
#include "file_system.h"
#include "map_guard.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

_Static_assert(ATOMIC_INT_LOCK_FREE == 2, "a lock inside the process would not hold between processes");

static photon_tree tree_of(void *memory, const photon_file_tree *t)
{
    photon_tree tree = {.count = t->count, .depth = t->depth};
    if (t->count > 0)
        tree.blocks = (photon_block *)(void *)((char *)memory + t->blocks_at);
    if (t->count > 0 && t->depth > 0)
        tree.nodes = (photon_tree_node *)(void *)((char *)memory + t->nodes_at);
    return tree;
}

static photon_map map_of(const photon_file_map *m, photon_tree tree, photon_tree irradiance_photons)
{
    photon_map map = {.set = {.count = tree.count,
                              .emitted_paths = m->emitted_paths,
                              .rays = m->rays,
                              .rays_cut = m->rays_cut,
                              .balance = m->balance},
                      .blocks = tree.blocks,
                      .tree = tree,
                      .irradiance_photons = irradiance_photons,
                      .nearest = m->nearest,
                      .max_radius = m->max_radius,
                      .min_radius_squared = m->min_radius_squared,
                      .mean_radius = m->mean_radius,
                      .flux_exponent_max = m->flux_exponent_max,
                      .is_steady = m->is_steady != 0,
                      .is_borrowed = true,
                      .has_been_cached = true};
    photon_map_derive(&map, m->irradiance_bias);
    return map;
}

/* A search in a map that was cut short or overwritten meanwhile goes by whatever its nodes say now, down to leaves that
 * are not there. Trees are no deeper than their leaves need, so that twice the file is room for all of them. */
static size_t reserved_bytes(const photon_file *file) { return 2 * file->size_bytes + 2 * PHOTON_FILE_PAGE; }

/* Reserves memory for the file and what lies behind it, which reads as zeros. Returns NULL where there is none. */
static void *reserve_memory(const photon_file *file)
{
    void *memory =
        mmap(NULL, reserved_bytes(file), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return memory == MAP_FAILED ? NULL : memory;
}

/* Maps the file, and takes an entry among its owners. message: where not, why. */
static bool map_shared(int descriptor, photon_file *file, char *message, size_t message_size)
{
    if (file_system_is_network(descriptor)) {
        snprintf(message, message_size, "it is on a network's file system");
        return false;
    }
    void *memory = reserve_memory(file);
    if (!memory ||
        mmap(memory, file->size_bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, descriptor, 0) == MAP_FAILED) {
        snprintf(message, message_size, "it cannot be mapped: %s", strerror(errno));
        if (memory)
            munmap(memory, reserved_bytes(file));
        return false;
    }
    claim_owner *table = (claim_owner *)(void *)((char *)memory + PHOTON_FILE_OWNERS_AT);
    if (!claim_owners_join(descriptor, table, &file->owners)) {
        snprintf(message, message_size, "too many processes use it, or its file system has no locks");
        munmap(memory, reserved_bytes(file));
        return false;
    }
    file->guard = map_guard_add(memory, file->size_bytes);
    file->memory = memory;
    file->descriptor = descriptor;
    file->is_shared = true;
    return true;
}

/* Reads the file into memory: a private mapping would still show what others write to pages that are not touched yet,
 * claims among it, whose values then never come. */
static photon_file_result read_copy(const run_context *run, int descriptor, photon_file *file, char *message,
                                    size_t message_size)
{
    char *memory = reserve_memory(file);
    if (!memory) {
        snprintf(message, message_size, "out of memory");
        return PHOTON_FILE_FAILED;
    }
    for (uint64_t at = 0; at < file->size_bytes;) {
        size_t left = (size_t)(file->size_bytes - at);
        ssize_t got = pread(descriptor, memory + at, left < PHOTON_FILE_CHUNK ? left : PHOTON_FILE_CHUNK, (off_t)at);
        bool is_cancelled = run_is_cancelled(run);
        if (got < 0 && errno == EINTR && !is_cancelled)
            continue;
        if (got <= 0 || is_cancelled) {
            snprintf(message, message_size, "%s", got < 0 ? strerror(errno) : "it is cut short");
            munmap(memory, reserved_bytes(file));
            return is_cancelled ? PHOTON_FILE_CANCELLED : got < 0 ? PHOTON_FILE_FAILED : PHOTON_FILE_REFUSED;
        }
        at += (uint64_t)got;
    }
    file->memory = memory;
    file->descriptor = -1;
    return PHOTON_FILE_OPEN;
}

/* Empties what is damaged: a word that is ready and does not have its check byte, and a claim that carries our number,
 * which is new. Others may be at work: each publishes behind its check byte, so what is ready here and whole has it. */
static uint32_t empty_damaged(photon_map *map, const claim_owners *owners)
{
    uint32_t damaged = 0;
    for (uint32_t i = 0; i < map->irradiance_photons.count; i++) {
        irradiance_slot *slot = photon_map_slot(map, i);
        uint32_t word = irradiance_slot_read(slot);
        bool is_ready = irradiance_word_is_ready(word);
        if ((is_ready && load_relaxed_u8(&map->checks[i]) != irradiance_word_check(i, word)) ||
            (owners && word == irradiance_word(IRRADIANCE_CLAIMED, load_relaxed_u32(&owners->claimer))))
            damaged += cas_acquire_release_u32(slot, &word, 0);
    }
    return damaged;
}

/* Empties claimed slots: in a copy nobody will publish what was being computed. */
static void drop_claims(photon_map *map)
{
    for (uint32_t i = 0; i < map->irradiance_photons.count; i++) {
        irradiance_slot *slot = photon_map_slot(map, i);
        if (!irradiance_word_is_ready(load_relaxed_u32(slot)))
            store_relaxed_u32(slot, 0);
    }
}

static photon_file_result open_maps(const run_context *run, int descriptor, const photon_file_header *h, bool may_share,
                                    photon_file *file, photon_map maps[PHOTON_FILE_MAP_COUNT], char *message,
                                    size_t message_size)
{
    file->size_bytes = (size_t)h->file_bytes;
    file->nonce = h->nonce;
    if (!may_share || !map_shared(descriptor, file, message, message_size)) {
        if (!may_share)
            snprintf(message, message_size, "it may not be written");
        char wrong[256];
        photon_file_result result = read_copy(run, descriptor, file, wrong, sizeof wrong);
        if (result != PHOTON_FILE_OPEN) {
            snprintf(message, message_size, "%s", wrong);
            return result;
        }
    }
    photon_tree trees[PHOTON_FILE_TREE_COUNT];
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT; i++)
        trees[i] = tree_of(file->memory, &h->trees[i]);
    maps[PHOTON_FILE_GLOBAL] =
        map_of(&h->maps[PHOTON_FILE_GLOBAL], trees[PHOTON_FILE_GLOBAL],
               trees[PHOTON_FILE_IRRADIANCE].count > 0 ? trees[PHOTON_FILE_IRRADIANCE] : trees[PHOTON_FILE_GLOBAL]);
    maps[PHOTON_FILE_CAUSTIC] =
        map_of(&h->maps[PHOTON_FILE_CAUSTIC], trees[PHOTON_FILE_CAUSTIC], trees[PHOTON_FILE_CAUSTIC]);
    hash128 content;
    if (!photon_file_hash_content(run, trees, &content))
        return PHOTON_FILE_CANCELLED;
    if (!photon_file_is_intact(file)) {
        snprintf(message, message_size, "it was changed while it was opened");
        return PHOTON_FILE_REFUSED;
    }
    if (!hash128_is_equal(content, h->content)) {
        snprintf(message, message_size, "it is damaged: its photons do not have their checksum");
        return PHOTON_FILE_REFUSED;
    }
    maps[PHOTON_FILE_GLOBAL].checks = (atomic_u8 *)(void *)((char *)file->memory + h->checks_at);
    file->damaged = empty_damaged(&maps[PHOTON_FILE_GLOBAL], file->is_shared ? &file->owners : NULL);
    for (int i = 0; i < PHOTON_FILE_MAP_COUNT && !file->is_shared; i++)
        drop_claims(&maps[i]);
    return PHOTON_FILE_OPEN;
}

/* Opens the file for writing where it may be shared; may_share becomes false where it may not be written. */
static int open_descriptor(const char *path, bool *in_out_may_share)
{
    /* O_NONBLOCK: a FIFO would wait for its writer */
    const int flags = O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
    int descriptor = open(path, flags | (*in_out_may_share ? O_RDWR : O_RDONLY));
    if (descriptor < 0 && *in_out_may_share && (errno == EACCES || errno == EROFS || errno == EPERM)) {
        *in_out_may_share = false;
        descriptor = open(path, flags | O_RDONLY);
    }
    return descriptor_beyond_standard(descriptor); /* what a host prints must not reach the map */
}

/* key: NULL for any. */
static photon_file_result open_file(const run_context *run, const char *path, const photon_file_key *key,
                                    bool may_share, photon_file_header *out_header, photon_file *out_file,
                                    photon_map *out_global, photon_map *out_caustic, char *message, size_t message_size)
{
    snprintf(message, message_size, "%s", "");
    int descriptor = open_descriptor(path, &may_share);
    if (descriptor < 0 && errno == ENOENT)
        return PHOTON_FILE_ABSENT;
    struct stat status;
    if (descriptor < 0 || fstat(descriptor, &status) != 0) {
        snprintf(message, message_size, "%s", strerror(errno));
        if (descriptor >= 0)
            close(descriptor);
        return PHOTON_FILE_FAILED;
    }
    photon_file file = {.descriptor = -1, .guard = -1};
    photon_map maps[PHOTON_FILE_MAP_COUNT];
    photon_file_result result = PHOTON_FILE_REFUSED;
    photon_file_header *h = out_header;
    ssize_t got = S_ISREG(status.st_mode) ? pread(descriptor, h, sizeof *h, 0) : 0;
    if (!S_ISREG(status.st_mode)) {
        snprintf(message, message_size, "it is no regular file");
        result = PHOTON_FILE_FAILED;
    } else if (got < 0) {
        snprintf(message, message_size, "%s", strerror(errno));
        result = PHOTON_FILE_FAILED;
    } else if (!photon_file_header_is_ours(h, (size_t)got)) {
        snprintf(message, message_size, "it is no photon map");
        result = PHOTON_FILE_FOREIGN;
    } else if (photon_file_header_is_valid(h, (uint64_t)got, (uint64_t)status.st_size, key, message, message_size)) {
        result = open_maps(run, descriptor, h, may_share, &file, maps, message, message_size);
    }
    if (file.descriptor != descriptor)
        close(descriptor);
    if (result != PHOTON_FILE_OPEN) {
        photon_file_close(&file);
        return result;
    }
    *out_file = file;
    *out_global = maps[PHOTON_FILE_GLOBAL];
    *out_caustic = maps[PHOTON_FILE_CAUSTIC];
    return PHOTON_FILE_OPEN;
}

photon_file_result photon_file_open(const run_context *run, const char *path, const photon_file_key *key,
                                    photon_file *out_file, photon_map *out_global, photon_map *out_caustic,
                                    char *message, size_t message_size)
{
    photon_file_header h;
    return open_file(run, path, key, true, &h, out_file, out_global, out_caustic, message, message_size);
}

photon_file_result photon_file_read(const run_context *run, const char *path, photon_file_key *out_key,
                                    hash128 *out_fixed, photon_file *out_file, photon_map *out_global,
                                    photon_map *out_caustic, char *message, size_t message_size)
{
    photon_file_header h;
    photon_file_result result =
        open_file(run, path, NULL, false, &h, out_file, out_global, out_caustic, message, message_size);
    if (result != PHOTON_FILE_OPEN)
        return result;
    *out_key = h.key;
    h.nonce = 0; /* the rest is the same for any process that traced it */
    *out_fixed = photon_file_header_hash(&h);
    return PHOTON_FILE_OPEN;
}

bool photon_file_has_memory(const photon_file *file) { return !file->is_shared || !map_guard_is_lost(file->guard); }

bool photon_file_is_intact(const photon_file *file)
{
    struct stat status;
    photon_file_header h;
    if (!file->is_shared)
        return true;
    return !map_guard_is_lost(file->guard) && fstat(file->descriptor, &status) == 0 &&
           (uint64_t)status.st_size == file->size_bytes &&
           pread(file->descriptor, &h, sizeof h, 0) == (ssize_t)sizeof h && h.nonce == file->nonce &&
           hash128_is_equal(h.self, photon_file_header_hash(&h)) && !map_guard_is_lost(file->guard);
}

void photon_file_close(photon_file *file)
{
    if (file->is_shared) {
        map_guard_remove(file->guard);
        munmap(file->memory, reserved_bytes(file));
        claim_owners_reset(&file->owners);
        close(file->descriptor); /* frees our entry among the owners */
    } else if (file->memory) {
        munmap(file->memory, reserved_bytes(file));
    }
    *file = (photon_file){.descriptor = -1, .guard = -1};
}

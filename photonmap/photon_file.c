/* photon_file.c: see photon_file.h.
 * Rests on: mmap(2), posix_fallocate(3), fcntl(2). Threads: see photon_file.h. */
#define _GNU_SOURCE
#include "photon_file.h"

#include "descriptor.h"
#include "file_system.h"
#include "map_guard.h"
#include "math/rng.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

_Static_assert(ATOMIC_INT_LOCK_FREE == 2, "a lock inside the process would not hold between processes");

/* Raise this whenever the layout changes, or which photons are traced: other estimates have another fingerprint. */
enum { LAYOUT_VERSION = 18 };
enum { GLOBAL, CAUSTIC, MAP_COUNT, IRRADIANCE_PHOTONS = MAP_COUNT, TREE_COUNT };
enum { PAGE = 4096, CHUNK_BYTES = 1 << 22 };
static const uint32_t BYTE_ORDER_MARK = 0x01020304;
static const char MAGIC[16] = "Afterglow map\r\n";

typedef struct tree_record {
    uint64_t blocks_at, nodes_at; /* bytes from the file's beginning */
    uint32_t count, depth;
} tree_record;

typedef struct map_record {
    uint64_t emitted_paths, rays, rays_cut;
    energy_balance balance;
    uint32_t nearest;
    float max_radius, min_radius_squared, mean_radius;
    int32_t flux_exponent_max, irradiance_bias;
} map_record;

typedef struct file_header {
    char magic[16];
    uint32_t byte_order, layout;
    uint32_t header_bytes, block_bytes, node_bytes, reserved;
    uint64_t file_bytes;
    uint64_t nonce; /* at random: no two files have the same */
    photon_file_key key;
    tree_record trees[TREE_COUNT]; /* IRRADIANCE_PHOTONS is empty where all photons are */
    uint64_t checks_at;            /* of the irradiance photons' check bytes, from the file's beginning */
    map_record maps[MAP_COUNT];
    hash128 content; /* of the photons and the nodes */
    hash128 self;    /* of all above */
} file_header;

enum { OWNERS_AT = PAGE };
_Static_assert(sizeof(file_header) <= OWNERS_AT, "the header has a page of its own");
_Static_assert(sizeof(photon_file_key) == 1184 && sizeof(map_record) == 288 && sizeof(tree_record) == 24,
               "no gaps: they are compared and hashed");
_Static_assert(offsetof(photon_block, slot) + PHOTON_BLOCK_LANES * sizeof(irradiance_slot) == sizeof(photon_block),
               "what never changes of a block is its first part");

/* --- layout --- */

static uint64_t to_page(uint64_t bytes) { return (bytes + PAGE - 1) / PAGE * PAGE; }

static uint64_t blocks_bytes(const tree_record *t) { return photon_block_count(t->count) * sizeof(photon_block); }

static uint64_t nodes_bytes(const tree_record *t) { return photon_tree_bytes(&(photon_tree){.depth = t->depth}); }

/* The number of the global map's irradiance photons. */
static uint32_t irradiance_photon_count(const tree_record trees[TREE_COUNT])
{
    return trees[IRRADIANCE_PHOTONS].count > 0 ? trees[IRRADIANCE_PHOTONS].count : trees[GLOBAL].count;
}

/* Where all lies, from counts and depths. Returns the file's size. */
static uint64_t lay_out(tree_record trees[TREE_COUNT], uint64_t *out_checks_at)
{
    uint64_t at = to_page(OWNERS_AT + CLAIM_OWNERS_MAX * sizeof(claim_owner));
    for (int i = 0; i < TREE_COUNT; i++) {
        trees[i].blocks_at = at;
        at += to_page(blocks_bytes(&trees[i]));
    }
    for (int i = 0; i < TREE_COUNT; i++) {
        trees[i].nodes_at = at;
        at += to_page(nodes_bytes(&trees[i]));
    }
    *out_checks_at = at;
    return at + to_page(irradiance_photon_count(trees));
}

static hash128 hash_of_header(const file_header *h)
{
    hash128 hash = hash128_begin();
    hash128_add(&hash, h, offsetof(file_header, self));
    return hash;
}

/* Hashes the photons, which never change. False when cancelled. */
static bool hash_content(const run_context *run, const photon_tree trees[TREE_COUNT], hash128 *out_hash)
{
    hash128 hash = hash128_begin();
    for (int i = 0; i < TREE_COUNT; i++) {
        uint64_t count = photon_block_count(trees[i].count);
        for (uint64_t k = 0; k < count; k++) {
            if ((k & 0xfff) == 0 && run_is_cancelled(run))
                return false;
            hash128_add(&hash, &trees[i].blocks[k], offsetof(photon_block, slot));
        }
        uint64_t size = photon_tree_bytes(&trees[i]);
        for (uint64_t at = 0; at < size; at += CHUNK_BYTES) {
            if (run_is_cancelled(run))
                return false;
            hash128_add(&hash, (const char *)trees[i].nodes + at,
                        (size_t)(size - at < CHUNK_BYTES ? size - at : CHUNK_BYTES));
        }
    }
    *out_hash = hash;
    return true;
}

/* --- writing --- */

static map_record record_of(const photon_map *map)
{
    return (map_record){.emitted_paths = map->set.emitted_paths,
                        .rays = map->set.rays,
                        .rays_cut = map->set.rays_cut,
                        .balance = map->set.balance,
                        .nearest = map->nearest,
                        .max_radius = map->max_radius,
                        .min_radius_squared = map->min_radius_squared,
                        .mean_radius = map->mean_radius,
                        .flux_exponent_max = map->flux_exponent_max,
                        .irradiance_bias = map->irradiance_bias};
}

static int write_at(const run_context *run, int descriptor, const void *bytes, uint64_t size, uint64_t at)
{
    const char *next = bytes;
    while (size > 0) {
        if (run_is_cancelled(run))
            return ECANCELED;
        ssize_t written = pwrite(descriptor, next, (size_t)(size < CHUNK_BYTES ? size : CHUNK_BYTES), (off_t)at);
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
    for (uint32_t first = 0; first < irradiance_photons->count && error == 0; first += PAGE, at += PAGE) {
        uint8_t checks[PAGE] = {0};
        for (uint32_t i = 0; i < PAGE && i < irradiance_photons->count - first; i++) {
            uint32_t word = irradiance_slot_read(photon_block_slot(irradiance_photons->blocks, first + i));
            if (irradiance_word_is_ready(word))
                checks[i] = irradiance_word_check(first + i, word);
        }
        error = write_at(run, descriptor, checks, PAGE, at);
    }
    return error;
}

int photon_file_write(const run_context *run, int descriptor, const photon_file_key *key, const photon_map *global,
                      const photon_map *caustic)
{
    file_header h;
    memset(&h, 0, sizeof h);
    memcpy(h.magic, MAGIC, sizeof MAGIC);
    h.byte_order = BYTE_ORDER_MARK;
    h.layout = LAYOUT_VERSION;
    h.header_bytes = sizeof h;
    h.block_bytes = sizeof(photon_block);
    h.node_bytes = sizeof(photon_tree_node);
    h.key = *key;
    h.maps[GLOBAL] = record_of(global);
    h.maps[CAUSTIC] = record_of(caustic);
    photon_tree trees[TREE_COUNT] = {[GLOBAL] = global->tree, [CAUSTIC] = caustic->tree};
    if (!photon_map_all_have_irradiance(global))
        trees[IRRADIANCE_PHOTONS] = global->irradiance_photons;
    for (int i = 0; i < TREE_COUNT; i++)
        h.trees[i] = (tree_record){.count = trees[i].count, .depth = trees[i].depth};
    if (getrandom(&h.nonce, sizeof h.nonce, GRND_NONBLOCK) != (ssize_t)sizeof h.nonce) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        h.nonce = hash_mix64((uint64_t)now.tv_nsec ^ (uint64_t)now.tv_sec << 30 ^ (uint64_t)getpid() << 44);
    }
    h.file_bytes = lay_out(h.trees, &h.checks_at);
    if (!hash_content(run, trees, &h.content))
        return ECANCELED;
    h.self = hash_of_header(&h);

    /* A mapped file must have its space on the disk: a disk that is full later would end processes by SIGBUS. A file
     * system that cannot reserve gets all bytes written below: none is left out. */
    int error = posix_fallocate(descriptor, 0, (off_t)h.file_bytes);
    if (error != 0 && error != EOPNOTSUPP && error != EINVAL && error != ENOSYS && error != EBADF)
        return error;
    static const char zeros[PAGE];
    uint64_t owners_end = to_page(OWNERS_AT + CLAIM_OWNERS_MAX * sizeof(claim_owner));
    for (uint64_t at = 0; at < owners_end; at += PAGE)
        if ((error = write_at(run, descriptor, zeros, PAGE, at)) != 0)
            return error;
    error = write_at(run, descriptor, &h, sizeof h, 0);
    for (int i = 0; i < TREE_COUNT && error == 0; i++) {
        const tree_record *t = &h.trees[i];
        uint64_t size = blocks_bytes(t), rest = to_page(size) - size;
        error = write_at(run, descriptor, trees[i].blocks, size, t->blocks_at);
        if (error == 0)
            error = write_at(run, descriptor, zeros, rest, t->blocks_at + size);
        size = nodes_bytes(t), rest = to_page(size) - size;
        if (error == 0)
            error = write_at(run, descriptor, trees[i].nodes, size, t->nodes_at);
        if (error == 0)
            error = write_at(run, descriptor, zeros, rest, t->nodes_at + size);
    }
    return error == 0 ? write_checks(run, descriptor, &global->irradiance_photons, h.checks_at) : error;
}

/* --- opening --- */

static bool is_text(const char *text, size_t size) { return memchr(text, '\0', size) != NULL; }

/* The first line "NOUN: VALUE" that differs. */
static void describe_other_setting(const char *is, const char *wanted, char *out, size_t size)
{
    while (strcspn(is, "\n") == strcspn(wanted, "\n") && strncmp(is, wanted, strcspn(is, "\n")) == 0 && is[0] &&
           wanted[0]) {
        is += strcspn(is, "\n") + (is[strcspn(is, "\n")] != '\0');
        wanted += strcspn(wanted, "\n") + (wanted[strcspn(wanted, "\n")] != '\0');
    }
    size_t noun = strcspn(is, ":\n");
    if (is[noun] == ':' && strncmp(is, wanted, noun + 2) == 0)
        snprintf(out, size, "it was made with another %.*s: %.*s, not %.*s", (int)noun, is,
                 (int)strcspn(is + noun + 2, "\n"), is + noun + 2, (int)strcspn(wanted + noun + 2, "\n"),
                 wanted + noun + 2);
    else
        snprintf(out, size, "it was made with other kinds of settings");
}

/* Names what the file was made of, where that differs from the key; "" where it fits. */
static void describe_difference(const photon_file_key *is, const photon_file_key *wanted, char *out, size_t size)
{
    snprintf(out, size, "%s", "");
    if (strncmp(is->machine, wanted->machine, sizeof is->machine) != 0)
        snprintf(out, size, "it was made on another machine: '%s', this is '%s'", is->machine, wanted->machine);
    else if (strncmp(is->program, wanted->program, sizeof is->program) != 0)
        snprintf(out, size, "it was made by another program: '%s', this is '%s'", is->program, wanted->program);
    else if (!hash128_is_equal(is->estimates, wanted->estimates))
        snprintf(out, size, "it was made by a program whose estimates of irradiance were others");
    else if (!hash128_is_equal(is->scene, wanted->scene))
        snprintf(out, size, "it was made of another scene: shapes, lights, materials or textures differ");
    else if (strncmp(is->settings, wanted->settings, sizeof is->settings) != 0)
        describe_other_setting(is->settings, wanted->settings, out, size);
    else if (!hash128_is_equal(is->aim_view, wanted->aim_view))
        snprintf(out, size, "its photons are aimed at another view");
}

/* Whether it is a file of ours, whole by its length, and fits the key, if any; where not, the message says why. */
static bool header_is_valid(const file_header *h, uint64_t got_bytes, uint64_t file_bytes, const photon_file_key *key,
                            char *message, size_t message_size)
{
    snprintf(message, message_size, "%s", "");
    if (got_bytes == 0)
        snprintf(message, message_size, "it is empty");
    else if (got_bytes < sizeof *h)
        snprintf(message, message_size, "it is cut short");
    else if (h->byte_order != BYTE_ORDER_MARK)
        snprintf(message, message_size, "it was made on a machine of another byte order");
    else if (h->layout != LAYOUT_VERSION)
        snprintf(message, message_size, "its layout is number %u, this program's is %d", h->layout, LAYOUT_VERSION);
    else if (h->header_bytes != sizeof *h || h->block_bytes != sizeof(photon_block) ||
             h->node_bytes != sizeof(photon_tree_node))
        snprintf(message, message_size, "it was made on a machine whose numbers have other sizes");
    else if (!hash128_is_equal(h->self, hash_of_header(h)) || !is_text(h->key.machine, sizeof h->key.machine) ||
             !is_text(h->key.program, sizeof h->key.program) || !is_text(h->key.settings, sizeof h->key.settings))
        snprintf(message, message_size, "it is damaged: its header does not have its checksum");
    else if (file_bytes != h->file_bytes)
        snprintf(message, message_size, "it is %s: %llu bytes, not %llu",
                 file_bytes < h->file_bytes ? "cut short" : "too long", (unsigned long long)file_bytes,
                 (unsigned long long)h->file_bytes);
    if (message[0])
        return false;
    tree_record trees[TREE_COUNT];
    memcpy(trees, h->trees, sizeof trees);
    for (int i = 0; i < TREE_COUNT; i++)
        if (trees[i].count == PHOTON_NONE || trees[i].depth > 28 ||
            photon_block_count(trees[i].count) > (uint64_t)1 << trees[i].depth)
            snprintf(message, message_size, "it is damaged: its counts cannot be");
    uint64_t checks_at;
    if (!message[0] && (lay_out(trees, &checks_at) != h->file_bytes || checks_at != h->checks_at ||
                        memcmp(trees, h->trees, sizeof trees) != 0))
        snprintf(message, message_size, "it is damaged: its parts do not lie where they should");
    if (!message[0] && key)
        describe_difference(&h->key, key, message, message_size);
    return message[0] == '\0';
}

static photon_tree tree_of(void *memory, const tree_record *t)
{
    photon_tree tree = {.count = t->count, .depth = t->depth};
    if (t->count > 0)
        tree.blocks = (photon_block *)(void *)((char *)memory + t->blocks_at);
    if (t->count > 0 && t->depth > 0)
        tree.nodes = (photon_tree_node *)(void *)((char *)memory + t->nodes_at);
    return tree;
}

static photon_map map_of(const map_record *m, photon_tree tree, photon_tree irradiance_photons)
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
                      .is_borrowed = true,
                      .has_been_cached = true};
    photon_map_set_bias(&map, m->irradiance_bias);
    return map;
}

/* Maps it, and takes an entry among its owners. message: where not, why. */
static bool share(int descriptor, photon_file *file, char *message, size_t message_size)
{
    if (file_system_is_network(descriptor)) {
        snprintf(message, message_size, "it is on a network's file system");
        return false;
    }
    void *memory = mmap(NULL, file->size_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    if (memory == MAP_FAILED) {
        snprintf(message, message_size, "it cannot be mapped: %s", strerror(errno));
        return false;
    }
    claim_owner *table = (claim_owner *)(void *)((char *)memory + OWNERS_AT);
    if (!claim_owners_join(descriptor, table, &file->owners)) {
        snprintf(message, message_size, "too many processes use it, or its file system has no locks");
        munmap(memory, file->size_bytes);
        return false;
    }
    file->guard = map_guard_add(memory, file->size_bytes);
    file->memory = memory;
    file->descriptor = descriptor;
    file->is_shared = true;
    return true;
}

/* Reads it into memory: a private mapping would still show what others write to pages that are not touched yet, claims
 * among it, whose values then never come. */
static photon_file_result copy(const run_context *run, int descriptor, photon_file *file, char *message,
                               size_t message_size)
{
    char *memory = aligned_alloc(PAGE, file->size_bytes);
    if (!memory) {
        snprintf(message, message_size, "out of memory");
        return PHOTON_FILE_FAILED;
    }
    for (uint64_t at = 0; at < file->size_bytes;) {
        size_t left = (size_t)(file->size_bytes - at);
        ssize_t got = pread(descriptor, memory + at, left < CHUNK_BYTES ? left : CHUNK_BYTES, (off_t)at);
        bool is_cancelled = run_is_cancelled(run);
        if (got < 0 && errno == EINTR && !is_cancelled)
            continue;
        if (got <= 0 || is_cancelled) {
            snprintf(message, message_size, "%s", got < 0 ? strerror(errno) : "it is cut short");
            free(memory);
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

static photon_file_result open_maps(const run_context *run, int descriptor, const file_header *h, bool may_share,
                                    photon_file *file, photon_map maps[MAP_COUNT], char *message, size_t message_size)
{
    file->size_bytes = (size_t)h->file_bytes;
    file->nonce = h->nonce;
    if (!may_share || !share(descriptor, file, message, message_size)) {
        if (!may_share)
            snprintf(message, message_size, "it may not be written");
        char wrong[256];
        photon_file_result result = copy(run, descriptor, file, wrong, sizeof wrong);
        if (result != PHOTON_FILE_OPEN) {
            snprintf(message, message_size, "%s", wrong);
            return result;
        }
    }
    photon_tree trees[TREE_COUNT];
    for (int i = 0; i < TREE_COUNT; i++)
        trees[i] = tree_of(file->memory, &h->trees[i]);
    maps[GLOBAL] = map_of(&h->maps[GLOBAL], trees[GLOBAL],
                          trees[IRRADIANCE_PHOTONS].count > 0 ? trees[IRRADIANCE_PHOTONS] : trees[GLOBAL]);
    maps[CAUSTIC] = map_of(&h->maps[CAUSTIC], trees[CAUSTIC], trees[CAUSTIC]);
    hash128 content;
    if (!hash_content(run, trees, &content))
        return PHOTON_FILE_CANCELLED;
    if (!photon_file_is_intact(file)) {
        snprintf(message, message_size, "it was changed while it was opened");
        return PHOTON_FILE_REFUSED;
    }
    if (!hash128_is_equal(content, h->content)) {
        snprintf(message, message_size, "it is damaged: its photons do not have their checksum");
        return PHOTON_FILE_REFUSED;
    }
    maps[GLOBAL].checks = (atomic_u8 *)(void *)((char *)file->memory + h->checks_at);
    file->damaged = empty_damaged(&maps[GLOBAL], file->is_shared ? &file->owners : NULL);
    for (int i = 0; i < MAP_COUNT && !file->is_shared; i++)
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
                                    bool may_share, file_header *out_header, photon_file *out_file,
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
    photon_map maps[MAP_COUNT];
    photon_file_result result = PHOTON_FILE_REFUSED;
    file_header *h = out_header;
    ssize_t got = S_ISREG(status.st_mode) ? pread(descriptor, h, sizeof *h, 0) : 0;
    if (!S_ISREG(status.st_mode)) {
        snprintf(message, message_size, "it is no regular file");
        result = PHOTON_FILE_FAILED;
    } else if (got < 0) {
        snprintf(message, message_size, "%s", strerror(errno));
        result = PHOTON_FILE_FAILED;
    } else if (memcmp(h->magic, MAGIC, (size_t)got < sizeof MAGIC ? (size_t)got : sizeof MAGIC) != 0) {
        snprintf(message, message_size, "it is no photon map");
        result = PHOTON_FILE_FOREIGN;
    } else if (header_is_valid(h, (uint64_t)got, (uint64_t)status.st_size, key, message, message_size)) {
        result = open_maps(run, descriptor, h, may_share, &file, maps, message, message_size);
    }
    if (file.descriptor != descriptor)
        close(descriptor);
    if (result != PHOTON_FILE_OPEN) {
        photon_file_close(&file);
        return result;
    }
    *out_file = file;
    *out_global = maps[GLOBAL];
    *out_caustic = maps[CAUSTIC];
    return PHOTON_FILE_OPEN;
}

photon_file_result photon_file_open(const run_context *run, const char *path, const photon_file_key *key,
                                    photon_file *out_file, photon_map *out_global, photon_map *out_caustic,
                                    char *message, size_t message_size)
{
    file_header h;
    return open_file(run, path, key, true, &h, out_file, out_global, out_caustic, message, message_size);
}

photon_file_result photon_file_read(const run_context *run, const char *path, photon_file_key *out_key,
                                    hash128 *out_fixed, photon_file *out_file, photon_map *out_global,
                                    photon_map *out_caustic, char *message, size_t message_size)
{
    file_header h;
    photon_file_result result =
        open_file(run, path, NULL, false, &h, out_file, out_global, out_caustic, message, message_size);
    if (result != PHOTON_FILE_OPEN)
        return result;
    *out_key = h.key;
    h.nonce = 0; /* all else is the same whoever traced it */
    *out_fixed = hash_of_header(&h);
    return PHOTON_FILE_OPEN;
}

bool photon_file_is_intact(const photon_file *file)
{
    struct stat status;
    file_header h;
    if (!file->is_shared)
        return true;
    return !map_guard_is_lost(file->guard) && fstat(file->descriptor, &status) == 0 &&
           (uint64_t)status.st_size == file->size_bytes &&
           pread(file->descriptor, &h, sizeof h, 0) == (ssize_t)sizeof h && h.nonce == file->nonce &&
           hash128_is_equal(h.self, hash_of_header(&h)) && !map_guard_is_lost(file->guard);
}

void photon_file_close(photon_file *file)
{
    if (file->is_shared) {
        map_guard_remove(file->guard);
        munmap(file->memory, file->size_bytes);
        claim_owners_reset(&file->owners);
        close(file->descriptor); /* frees our entry among the owners */
    } else {
        free(file->memory);
    }
    *file = (photon_file){.descriptor = -1, .guard = -1};
}

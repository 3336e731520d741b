/* photon_file_header.c: see photon_file_header.h. */
#include "photon_file_header.h"

#include <stdio.h>
#include <string.h>

static const uint32_t BYTE_ORDER_MARK = 0x01020304;
static const char MAGIC[16] = "Afterglow map\r\n";

_Static_assert(sizeof(photon_file_header) <= PHOTON_FILE_OWNERS_AT, "the header has a page of its own");
_Static_assert(sizeof(photon_file_key) == 1184 && sizeof(photon_file_map) == 296 && sizeof(photon_file_tree) == 24,
               "no gaps: they are compared and hashed");
_Static_assert(offsetof(photon_block, slot) + PHOTON_BLOCK_LANES * sizeof(irradiance_slot) == sizeof(photon_block),
               "what never changes of a block is its first part");

/* --- layout --- */

uint64_t photon_file_to_page(uint64_t bytes)
{
    return (bytes + PHOTON_FILE_PAGE - 1) / PHOTON_FILE_PAGE * PHOTON_FILE_PAGE;
}

uint64_t photon_file_blocks_bytes(const photon_file_tree *t)
{
    return photon_block_count(t->count) * sizeof(photon_block);
}

uint64_t photon_file_nodes_bytes(const photon_file_tree *t)
{
    return photon_tree_bytes(&(photon_tree){.depth = t->depth});
}

/* The number of the global map's irradiance photons. */
static uint32_t irradiance_photon_count(const photon_file_tree trees[PHOTON_FILE_TREE_COUNT])
{
    return trees[PHOTON_FILE_IRRADIANCE].count > 0 ? trees[PHOTON_FILE_IRRADIANCE].count
                                                   : trees[PHOTON_FILE_GLOBAL].count;
}

uint64_t photon_file_lay_out(photon_file_tree trees[PHOTON_FILE_TREE_COUNT], uint64_t *out_checks_at)
{
    uint64_t at = photon_file_to_page(PHOTON_FILE_OWNERS_AT + CLAIM_OWNERS_MAX * sizeof(claim_owner));
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT; i++) {
        trees[i].blocks_at = at;
        at += photon_file_to_page(photon_file_blocks_bytes(&trees[i]));
    }
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT; i++) {
        trees[i].nodes_at = at;
        at += photon_file_to_page(photon_file_nodes_bytes(&trees[i]));
    }
    *out_checks_at = at;
    return at + photon_file_to_page(irradiance_photon_count(trees));
}

hash128 photon_file_header_hash(const photon_file_header *h)
{
    hash128 hash = hash128_begin();
    hash128_add(&hash, h, offsetof(photon_file_header, self));
    return hash;
}

bool photon_file_hash_content(const run_context *run, const photon_tree trees[PHOTON_FILE_TREE_COUNT],
                              hash128 *out_hash)
{
    hash128 hash = hash128_begin();
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT; i++) {
        uint64_t count = photon_block_count(trees[i].count);
        for (uint64_t k = 0; k < count; k++) {
            if ((k & 0xfff) == 0 && run_is_cancelled(run))
                return false;
            hash128_add(&hash, &trees[i].blocks[k], offsetof(photon_block, slot));
        }
        uint64_t size = photon_tree_bytes(&trees[i]);
        for (uint64_t at = 0; at < size; at += PHOTON_FILE_CHUNK) {
            if (run_is_cancelled(run))
                return false;
            hash128_add(&hash, (const char *)trees[i].nodes + at,
                        (size_t)(size - at < PHOTON_FILE_CHUNK ? size - at : PHOTON_FILE_CHUNK));
        }
    }
    *out_hash = hash;
    return true;
}

void photon_file_header_init(photon_file_header *out_header)
{
    memset(out_header, 0, sizeof *out_header);
    memcpy(out_header->magic, MAGIC, sizeof MAGIC);
    out_header->byte_order = BYTE_ORDER_MARK;
    out_header->layout = PHOTON_FILE_LAYOUT;
    out_header->header_bytes = sizeof *out_header;
    out_header->block_bytes = sizeof(photon_block);
    out_header->node_bytes = sizeof(photon_tree_node);
}

/* --- checks --- */

bool photon_file_header_is_ours(const photon_file_header *h, size_t size)
{
    return memcmp(h->magic, MAGIC, size < sizeof MAGIC ? size : sizeof MAGIC) == 0;
}

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
        snprintf(out, size, "it was made by a program whose photons or estimates of irradiance were others");
    else if (!hash128_is_equal(is->scene, wanted->scene))
        snprintf(out, size, "it was made of another scene: shapes, lights, materials or textures differ");
    else if (strncmp(is->settings, wanted->settings, sizeof is->settings) != 0)
        describe_other_setting(is->settings, wanted->settings, out, size);
    else if (!hash128_is_equal(is->aim_view, wanted->aim_view))
        snprintf(out, size, "its photons are aimed at another view");
}

bool photon_file_header_is_valid(const photon_file_header *h, uint64_t got_bytes, uint64_t file_bytes,
                                 const photon_file_key *key, char *message, size_t message_size)
{
    snprintf(message, message_size, "%s", "");
    if (got_bytes == 0)
        snprintf(message, message_size, "it is empty");
    else if (got_bytes < sizeof *h)
        snprintf(message, message_size, "it is cut short");
    else if (h->byte_order != BYTE_ORDER_MARK)
        snprintf(message, message_size, "it was made on a machine of another byte order");
    else if (h->layout != PHOTON_FILE_LAYOUT)
        snprintf(message, message_size, "its layout is number %u, this program's is %d", h->layout, PHOTON_FILE_LAYOUT);
    else if (h->header_bytes != sizeof *h || h->block_bytes != sizeof(photon_block) ||
             h->node_bytes != sizeof(photon_tree_node))
        snprintf(message, message_size, "it was made on a machine whose numbers have other sizes");
    else if (!hash128_is_equal(h->self, photon_file_header_hash(h)) ||
             !is_text(h->key.machine, sizeof h->key.machine) || !is_text(h->key.program, sizeof h->key.program) ||
             !is_text(h->key.settings, sizeof h->key.settings))
        snprintf(message, message_size, "it is damaged: its header does not have its checksum");
    else if (file_bytes != h->file_bytes)
        snprintf(message, message_size, "it is %s: %llu bytes, not %llu",
                 file_bytes < h->file_bytes ? "cut short" : "too long", (unsigned long long)file_bytes,
                 (unsigned long long)h->file_bytes);
    if (message[0])
        return false;
    photon_file_tree trees[PHOTON_FILE_TREE_COUNT];
    memcpy(trees, h->trees, sizeof trees);
    for (int i = 0; i < PHOTON_FILE_TREE_COUNT; i++)
        if (trees[i].count == PHOTON_NONE || trees[i].depth > 28 ||
            photon_block_count(trees[i].count) > (uint64_t)1 << trees[i].depth ||
            (trees[i].depth > 0 && photon_block_count(trees[i].count) <= (uint64_t)1 << (trees[i].depth - 1)))
            snprintf(message, message_size, "it is damaged: its counts cannot be");
    uint64_t checks_at;
    if (!message[0] && (photon_file_lay_out(trees, &checks_at) != h->file_bytes || checks_at != h->checks_at ||
                        memcmp(trees, h->trees, sizeof trees) != 0))
        snprintf(message, message_size, "it is damaged: its parts do not lie where they should");
    if (!message[0] && key)
        describe_difference(&h->key, key, message, message_size);
    return message[0] == '\0';
}

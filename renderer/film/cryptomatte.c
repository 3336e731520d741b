/* cryptomatte.c: see cryptomatte.h. */
#include "film/cryptomatte.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- names to numbers --- */

static uint32_t rotate_left(uint32_t x, int bits) { return x << bits | x >> (32 - bits); }

/* Appleby's MurmurHash3_x86_32 with seed 0: four bytes at a time, the rest, and a final mix of all bits. */
static uint32_t murmur3(const unsigned char *bytes, size_t size)
{
    uint32_t hash = 0;
    for (size_t i = 0; i < size; i += 4) {
        uint32_t word = 0;
        size_t here = size - i < 4 ? size - i : 4;
        for (size_t k = 0; k < here; k++)
            word |= (uint32_t)bytes[i + k] << (8 * k);
        hash ^= rotate_left(word * 0xcc9e2d51u, 15) * 0x1b873593u;
        if (here == 4)
            hash = rotate_left(hash, 13) * 5 + 0xe6546b64u;
    }
    hash ^= (uint32_t)size;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

uint32_t cryptomatte_hash(const char *name)
{
    uint32_t hash = murmur3((const unsigned char *)name, strlen(name)), exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

/* The name of a shape that stands in the world, or of an instance; where neither has one, its number. */
static const char *object_name(const scene *s, uint32_t index, char *number, size_t size)
{
    const char *name;
    uint32_t shape_index = index;
    if (index >= s->shape_count) {
        uint32_t object_index = s->instances[index - s->shape_count].object_index;
        const scene_object *object = &s->objects[object_index];
        name = scene_name(s, NAMED_OBJECT, object_index);
        if (name)
            return name;
        snprintf(number, size, "object %u", object_index + 1);
        if (object->shape_count == 0)
            return number;
        shape_index = s->object_shapes[object->first_shape];
    } else {
        snprintf(number, size, "shape %u", index + 1);
    }
    name = scene_name(s, NAMED_SHAPE, shape_index);
    return name ? name : number;
}

static ag_status make_manifest(const scene *s, cryptomatte_kind kind, cryptomatte *matte)
{
    json_t *names = json_object();
    bool is_whole = names != NULL;
    for (uint32_t i = 0; is_whole && i < matte->count; i++) {
        char number[32], digits[16];
        const char *name;
        if (kind == CRYPTOMATTE_MATERIAL) {
            snprintf(number, sizeof number, "material %u", i + 1);
            name = scene_name(s, NAMED_MATERIAL, i);
            name = name ? name : number;
        } else {
            name = object_name(s, i, number, sizeof number);
        }
        matte->hashes[i] = cryptomatte_hash(name);
        snprintf(digits, sizeof digits, "%08x", matte->hashes[i]);
        json_object_set_new(names, name, json_string(digits)); /* what is not UTF-8 has a matte, but no name */
    }
    matte->manifest = is_whole ? json_dumps(names, JSON_COMPACT | JSON_SORT_KEYS) : NULL;
    json_decref(names);
    return matte->manifest ? AG_OK : AG_ERROR_MEMORY;
}

ag_status cryptomatte_create(const scene *s, cryptomatte_kind kind, cryptomatte *out_matte)
{
    static const char *const layers[] = {"CryptoObject", "CryptoMaterial"};
    static const char *const attributes[] = {"name", "hash", "conversion", "manifest"};
    cryptomatte m = {.layer = layers[kind]};
    m.count = kind == CRYPTOMATTE_OBJECT ? s->shape_count + s->instance_count : s->material_count;
    m.hashes = malloc(((size_t)m.count + 1) * sizeof *m.hashes);
    ag_status status = m.hashes ? make_manifest(s, kind, &m) : AG_ERROR_MEMORY;
    char key[16];
    snprintf(key, sizeof key, "%08x", murmur3((const unsigned char *)m.layer, strlen(m.layer)));
    for (int i = 0; i < 4; i++)
        snprintf(m.attribute_names[i], sizeof m.attribute_names[i], "cryptomatte/%.7s/%s", key, attributes[i]);
    if (status == AG_OK)
        *out_matte = m;
    else
        cryptomatte_reset(&m);
    return status;
}

void cryptomatte_reset(cryptomatte *matte)
{
    free(matte->hashes);
    free(matte->manifest);
    *matte = (cryptomatte){0};
}

bool cryptomatte_name(const cryptomatte *matte, float id, char *out_name, size_t size)
{
    uint32_t hash;
    char digits[16];
    const char *name;
    json_t *value, *names = matte->manifest ? json_loads(matte->manifest, 0, NULL) : NULL;
    bool is_found = false;
    memcpy(&hash, &id, sizeof hash);
    snprintf(digits, sizeof digits, "%08x", hash);
    json_object_foreach(names, name, value) if (!is_found && strcmp(json_string_value(value), digits) == 0)
    {
        snprintf(out_name, size, "%s", name);
        is_found = true;
    }
    json_decref(names);
    return is_found;
}

/* --- coverage --- */

void cryptomatte_add(const cryptomatte *matte, uint32_t id, int sign, cryptomatte_slot *slots)
{
    uint32_t hash = matte->hashes[id - 1];
    for (int i = 0; i < CRYPTOMATTE_SLOTS; i++)
        if (slots[i].hash == hash || slots[i].hash == 0) {
            slots[i].hash = hash;
            slots[i].signed_count += sign;
            return;
        }
}

void cryptomatte_rank(const cryptomatte_slot *slots, int rank, int64_t total, float *out_id, float *out_coverage)
{
    *out_id = *out_coverage = 0.0f;
    for (int i = 0; i < CRYPTOMATTE_SLOTS && slots[i].hash != 0; i++) {
        int before = 0; /* slots that come before this one: by their counts, then by hash */
        for (int k = 0; k < CRYPTOMATTE_SLOTS && slots[k].hash != 0; k++)
            before += slots[k].signed_count > slots[i].signed_count ||
                      (slots[k].signed_count == slots[i].signed_count && slots[k].hash < slots[i].hash);
        if (before != rank || slots[i].signed_count <= 0 || total <= 0)
            continue;
        memcpy(out_id, &slots[i].hash, sizeof *out_id);
        *out_coverage = float_min((float)((double)slots[i].signed_count / (double)total), 1.0f);
    }
}

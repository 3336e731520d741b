/* test_cryptomatte.c: hashes as Psyop's specification prints them; files decoded as a compositor does: by the
 * names in the manifest, through the ids' bits, to mattes that are the shares of the pixels.
 * Threads: the renderer's. */
#define _GNU_SOURCE
#include "context.h"
#include "film/cryptomatte.h"
#include "fixtures/layers_fixture.h"

#include <jansson.h>

/* These hashes are the specification's own examples of metadata. */
static void test_hashes(void **state)
{
    (void)state;
    assert_int_equal(cryptomatte_hash("bunny"), 0x13851a76);
    assert_int_equal(cryptomatte_hash("default"), 0x42c9679f);
    assert_int_equal(cryptomatte_hash("bunny_porcelain_mat"), 0xb24b26d4);
    /* whatever the name, a float that is a number and not denormal */
    for (int i = 0; i < 100000; i++) {
        char name[16];
        snprintf(name, sizeof name, "%d", i);
        uint32_t hash = cryptomatte_hash(name);
        float id;
        memcpy(&id, &hash, sizeof id);
        assert_true(isnormal(id));
    }
}

static void test_ranks(void **state)
{
    (void)state;
    uint32_t hashes[16];
    for (uint32_t i = 0; i < 16; i++)
        hashes[i] = 0x40000000 + i;
    const cryptomatte matte = {.hashes = hashes, .count = 16};
    cryptomatte_slot slots[CRYPTOMATTE_SLOTS] = {{0, 0}};
    static const uint32_t ids[] = {3, 1, 3, 2, 2, 3};
    for (int i = 0; i < 6; i++)
        cryptomatte_add(&matte, ids[i], 1, slots);
    cryptomatte_add(&matte, 1, -1, slots); /* a filter's negative lobe */
    static const uint32_t order[] = {2, 1};
    static const float shares[] = {3.0f / 5.0f, 2.0f / 5.0f};
    for (int rank = 0; rank < 3; rank++) {
        float id, coverage;
        cryptomatte_rank(slots, rank, 5, &id, &coverage);
        uint32_t bits;
        memcpy(&bits, &id, sizeof bits);
        assert_int_equal(bits, rank < 2 ? hashes[order[rank]] : 0);
        assert_true(coverage == (rank < 2 ? shares[rank] : 0.0f));
    }
    for (uint32_t i = 1; i <= 16; i++) /* more than there is room for */
        cryptomatte_add(&matte, i, 1, slots);
}

/* The coverage of a name, as a compositor finds it: all ranks whose id has the manifest's bits. */
static double matte_of(const ag_film *film, const cryptomatte *matte, const char *name, int pixel)
{
    json_t *manifest = json_loads(matte->manifest, 0, NULL);
    assert_non_null(manifest);
    const char *digits = json_string_value(json_object_get(manifest, name));
    if (!digits)
        fail_msg("%s is not in %s", name, matte->manifest);
    uint32_t wanted = (uint32_t)strtoul(digits, NULL, 16), bits;
    json_decref(manifest);
    double sum = 0.0;
    for (int rank = 0; rank < CRYPTOMATTE_RANKS; rank++) {
        char channel[64];
        snprintf(channel, sizeof channel, "%s%02d.%c", matte->layer, rank / 2, rank % 2 ? 'B' : 'R');
        float *ids = film_channel_of(film, channel);
        snprintf(channel, sizeof channel, "%s%02d.%c", matte->layer, rank / 2, rank % 2 ? 'A' : 'G');
        float *coverages = film_channel_of(film, channel);
        memcpy(&bits, &ids[pixel], sizeof bits);
        sum += bits == wanted ? (double)coverages[pixel] : 0.0;
        free(ids);
        free(coverages);
    }
    return sum;
}

/* A wall of two materials that meet at x = 0.1 between the pixels' edges at 0 and 0.25, in front of it at the right a
 * disk, which is an instance; above is nothing. */
static void test_scene(void **state)
{
    (void)state;
    studio *s = studio_open(
        "Film \"rgb\" PixelFilter \"box\" Camera \"perspective\" \"float fov\" 90 WorldBegin\n"
        "LightSource \"infinite\"\n"
        "MakeNamedMaterial \"brick \\\"red\\\"\" \"string type\" \"diffuse\"\n"
        "MakeNamedMaterial \"stone\" \"string type\" \"diffuse\"\n"
        "ObjectBegin \"coin\" Material \"conductor\" Shape \"disk\" \"float radius\" 0.2 ObjectEnd\n"
        "NamedMaterial \"brick \\\"red\\\"\"\n"
        "Shape \"bilinearmesh\" \"string name\" \"left \\\"wall\\\"\" \"point3 P\" [-9 -9 2  0.1 -9 2  -9 0 2  0.1 0 2]\n"
        "NamedMaterial \"stone\"\n"
        "Shape \"bilinearmesh\" \"point3 P\" [0.1 -9 2  9 -9 2  0.1 0 2  9 0 2]\n"
        "Translate 0.8 -0.8 1 ObjectInstance \"coin\"",
        2);
    s->settings.integrator = AG_INTEGRATOR_PATH;
    s->settings.samples_per_pixel = 64;
    s->settings.layers = AG_LAYER_CRYPTO_OBJECT | AG_LAYER_CRYPTO_MATERIAL;
    ag_film *film = studio_render(s);
    assert_int_equal(ag_film_channel_count(film), 3 + 2 * 2 * CRYPTOMATTE_RANKS);
    cryptomatte objects, materials;
    const scene *loaded = s->scene->s;
    assert_int_equal(cryptomatte_create(loaded, CRYPTOMATTE_OBJECT, &objects), AG_OK);
    assert_int_equal(cryptomatte_create(loaded, CRYPTOMATTE_MATERIAL, &materials), AG_OK);
    /* keys of seven digits, from the layers' names: the same in every frame */
    assert_string_equal(objects.attribute_names[0], "cryptomatte/3ae39a5/name");
    assert_string_equal(materials.attribute_names[3], "cryptomatte/be359d6/manifest");

    int row = 12 * 16; /* y from -1 to -1.25 */
    expect_within("brick at the left", matte_of(film, &materials, "brick \"red\"", row), 1.0, 0.0);
    expect_within("stone at the right", matte_of(film, &materials, "stone", row + 10), 1.0, 0.0);
    expect_within("the wall at the left", matte_of(film, &objects, "left \"wall\"", row), 1.0, 0.0);
    expect_within("the wall's share", matte_of(film, &objects, "left \"wall\"", row + 8), 0.4, 0.03);
    expect_within("brick's share", matte_of(film, &materials, "brick \"red\"", row + 8), 0.4, 0.03);
    expect_within("stone's share", matte_of(film, &materials, "stone", row + 8), 0.6, 0.03);
    expect_within("nothing", matte_of(film, &materials, "stone", 15), 0.0, 0.0);
    /* the coin: radius 0.2 around (0.8, -0.8) at distance 1: pixels 0.125 wide there, from column 12.8, row 12.8 */
    expect_within("coin", matte_of(film, &objects, "coin", 14 * 16 + 14), 1.0, 0.0);
    expect_within("coin elsewhere", matte_of(film, &objects, "coin", row), 0.0, 0.0);
    double area = 0.0;
    for (int i = 0; i < 256; i++)
        area += matte_of(film, &objects, "coin", i);
    expect_within("the coin's area in pixels", area, 3.14159265 * 0.04 / (0.125 * 0.125), 0.1);
    cryptomatte_reset(&objects);
    cryptomatte_reset(&materials);
    ag_film_destroy(film);
    studio_close(s);
}

/* Curves, which are put together where they are alike, stay apart where their names differ, moving ones too. */
static void test_names_of_curves(void **state)
{
    (void)state;
    static const char *const MOTIONS[2] = {"", "ActiveTransform EndTime Translate 1 0 0 "
                                               "ActiveTransform All "};
    for (int k = 0; k < 2; k++) {
        char text[1024];
        const char *hair = "\"point3 P\" [0 0 2  0 1 2  1 1 2  1 0 2]";
        snprintf(text, sizeof text,
                 "Camera \"perspective\" WorldBegin LightSource \"infinite\" %s\n"
                 "Shape \"curve\" \"string name\" \"fox\" %s Shape \"curve\" \"string name\" \"fox\" %s\n"
                 "Shape \"curve\" \"string name\" \"hare\" %s Shape \"curve\" %s Shape \"curve\" %s\n",
                 MOTIONS[k], hair, hair, hair, hair, hair);
        studio *s = studio_open(text, 1);
        const scene *made = s->scene->s;
        assert_int_equal(made->shape_count, 3);
        assert_int_equal(made->instance_count, k ? 3 : 0);
        assert_string_equal(scene_name(made, NAMED_SHAPE, 0), "fox");
        assert_string_equal(scene_name(made, NAMED_SHAPE, 1), "hare");
        assert_null(scene_name(made, NAMED_SHAPE, 2));
        studio_close(s);
    }
}

/* The file has Cryptomatte's header and its manifest. */
static void test_file(void **state)
{
    (void)state;
    studio *s = studio_open("Film \"rgb\" Camera \"perspective\" WorldBegin LightSource \"infinite\" "
                            "MakeNamedMaterial \"clay\" \"string type\" \"diffuse\" NamedMaterial \"clay\" "
                            "Translate 0 0 3 Shape \"sphere\"",
                            1);
    s->settings.layers = AG_LAYER_CRYPTO_MATERIAL;
    ag_film *film = studio_render(s);
    assert_int_equal(ag_film_write(s->context, film, NULL, in_folder("p.exr")), AG_OK);
    size_t size;
    unsigned char *bytes = read_bytes(in_folder("p.exr"), &size);
    static const char *const expected[] = {
        "cryptomatte/be359d6/name",       "CryptoMaterial00.R", "cryptomatte/be359d6/hash",     "MurmurHash3_32",
        "cryptomatte/be359d6/conversion", "uint32_to_float32",  "cryptomatte/be359d6/manifest", "\"clay\":\""};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        if (!memmem(bytes, size, expected[i], strlen(expected[i])))
            fail_msg("%s is not in the file", expected[i]);
    free(bytes);
    ag_film_destroy(film);
    studio_close(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hashes),        cmocka_unit_test(test_ranks), TEST_IN_FOLDER(test_scene),
        TEST_IN_FOLDER(test_names_of_curves), TEST_IN_FOLDER(test_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

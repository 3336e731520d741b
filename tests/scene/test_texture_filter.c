/* test_texture_filter.c: coarser levels of pictures and look-ups over footprints against closed forms: means at every
 * level, odd sizes among them; what is magnified keeps its bits; what is as large as a pixel its contrast; stripes seen
 * at a grazing angle are sharp across and even along. Threads: the run's. */
#include "fixtures/test_scene.h"

#include "texture/texture_filter.h"

#define BILINEAR TEXTURE_FILTER_BILINEAR
static const texture_wraps REPEAT = {TEXTURE_WRAP_REPEAT, TEXTURE_WRAP_REPEAT};

/* Bytes that stand for 0 to 1 linearly, of three channels, or floats. */
typedef struct made_picture {
    test_run r;
    texture_image i;
} made_picture;

static void make_picture(made_picture *p, uint32_t width, uint32_t height, bool is_float,
                         float (*value)(uint32_t x, uint32_t y, uint32_t channel))
{
    *p = (made_picture){0};
    test_run_init(&p->r, 2);
    texture_image *i = &p->i;
    *i = (texture_image){.width = width, .height = height, .channel_count = 3};
    for (int k = 0; k < 256; k++)
        i->table[k] = (float)k / 255.0f;
    const size_t count = (size_t)width * height * 3;
    if (is_float)
        i->values = malloc(count * sizeof *i->values);
    else
        i->bytes = malloc(count);
    assert_true(i->values || i->bytes);
    for (size_t k = 0; k < count; k++) {
        float v = value((uint32_t)(k / 3) % width, (uint32_t)(k / 3) / width, (uint32_t)(k % 3));
        if (is_float)
            i->values[k] = v;
        else
            i->bytes[k] = (unsigned char)(255.0f * v + 0.5f);
    }
    const texture_level finest = texture_image_finest(i);
    assert_int_equal(texture_mips_create(&p->r.run, &finest, &i->mips), AG_OK);
}

static void reset_picture(made_picture *p)
{
    texture_mips_destroy(p->i.mips);
    free(p->i.bytes);
    free(p->i.values);
    test_run_reset(&p->r);
}

static float noise(uint32_t x, uint32_t y, uint32_t channel)
{
    rng random = rng_make(1, channel, (uint64_t)y << 32 | x);
    return rng_float(&random);
}

static float checker(uint32_t x, uint32_t y, uint32_t channel)
{
    (void)channel;
    return (x + y) % 2 ? 1.0f : 0.0f;
}

/* Stripes along x, each one pixel wide. */
static float stripes(uint32_t x, uint32_t y, uint32_t channel)
{
    (void)x, (void)channel;
    return y % 2 ? 1.0f : 0.0f;
}

static double level_mean(const texture_level *l, uint32_t channel)
{
    const size_t count = (size_t)l->width * l->height;
    double sum = 0.0;
    for (size_t k = 0; k < count; k++) {
        const size_t at = k * l->channel_count + channel;
        sum += l->bytes                      ? (double)l->table[l->bytes[at]]
               : l->sample == TEXTURE_PACKED ? l->packed[at] / 65535.0
                                             : (double)l->values[at];
    }
    return sum / (double)count;
}

static texture_footprint footprint(float ax, float ay, float bx, float by)
{
    return (texture_footprint){.axes = {{ax, ay}, {bx, by}}};
}

static void assert_near(double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most))
        fail_msg("%.9g is not %.9g within %g", value, expected, most);
}

static void every_level_has_the_mean(void **state)
{
    (void)state;
    static const uint32_t SIZES[][2] = {{64, 64}, {63, 37}, {5, 3}, {1, 9}, {100, 1}, {1, 1}};
    for (size_t k = 0; k < 2 * sizeof SIZES / sizeof *SIZES; k++) {
        made_picture p;
        make_picture(&p, SIZES[k / 2][0], SIZES[k / 2][1], k % 2, noise);
        const texture_mips *m = p.i.mips;
        for (uint32_t level = 0; level < m->level_count; level++)
            for (uint32_t channel = 0; channel < 3; channel++)
                assert_near(level_mean(&m->levels[level], channel), level_mean(&m->levels[0], channel), 5e-5);
        const texture_level *last = &m->levels[m->level_count - 1];
        assert_int_equal(last->width, 1);
        assert_int_equal(last->height, 1);
        reset_picture(&p);
    }
}

/* Means are of linear values: half of the pixels at 1, the other half at 0 by a table that is far from straight. */
static void means_are_of_linear_values(void **state)
{
    (void)state;
    made_picture p;
    make_picture(&p, 8, 8, false, checker);
    for (int k = 0; k < 256; k++)
        p.i.table[k] = k == 255 ? 0.5f : 0.25f;
    const texture_level finest = p.i.mips->levels[0];
    texture_mips_destroy(p.i.mips);
    assert_int_equal(texture_mips_create(&p.r.run, &finest, &p.i.mips), AG_OK);
    assert_near(level_mean(&p.i.mips->levels[3], 0), 0.375, 1e-5);
    reset_picture(&p);
}

static bool is_same(rgb a, rgb b) { return memcmp(&a, &b, sizeof a) == 0; }

/* Up to a pixel and a half across the footprint nothing is filtered, at whatever angle it lies. */
static void magnified_pictures_keep_their_bits(void **state)
{
    (void)state;
    made_picture p;
    make_picture(&p, 64, 32, false, noise);
    rng random = rng_make(2, 0, 0);
    for (int k = 0; k < 1000; k++) {
        float s = 3.0f * rng_float(&random) - 1.0f, t = 3.0f * rng_float(&random) - 1.0f,
              wide = 1.5f * rng_float(&random);
        float sine, cosine;
        sincos_turns(rng_float(&random), &sine, &cosine);
        texture_footprint f =
            footprint(wide * cosine / 64.0f, wide * sine / 32.0f, -wide * sine / 64.0f, wide * cosine / 32.0f);
        f.is_coarse = k % 2;
        rgb plain = texture_image_color(&p.i, REPEAT, BILINEAR, s, t);
        assert_true(is_same(texture_filter_color(&p.i, REPEAT, BILINEAR, s, t, &f), plain));
    }
    reset_picture(&p);
}

/* The picture has one pixel for each pixel of the film. */
static void detail_seen_frontally_keeps_its_contrast(void **state)
{
    (void)state;
    made_picture p;
    make_picture(&p, 64, 64, false, checker);
    const texture_footprint f = footprint(1.0f / 64.0f, 0.0f, 0.0f, 1.0f / 64.0f);
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            rgb c =
                texture_filter_rgb(&p.i, REPEAT, BILINEAR, ((float)x + 0.5f) / 64.0f, ((float)y + 0.5f) / 64.0f, &f);
            assert_near((double)c.g, (x + y) % 2 ? 1.0 : 0.0, 1e-6);
        }
    reset_picture(&p);
}

/* Ten pixels along the stripes and one across: as sharp as without; ten across: the mean. */
static void stripes_are_sharp_across(void **state)
{
    (void)state;
    made_picture p;
    make_picture(&p, 256, 256, false, stripes);
    const float pixel = 1.0f / 256.0f;
    const texture_footprint along = footprint(10.0f * pixel, 0.0f, 0.0f, pixel),
                            across = footprint(pixel, 0.0f, 0.0f, 10.0f * pixel);
    for (int k = 0; k < 64; k++) {
        float s = 0.37f, t = ((float)k + 0.5f) * pixel;
        assert_near((double)texture_filter_rgb(&p.i, REPEAT, BILINEAR, s, t, &along).r, k % 2, 1e-3);
        assert_near((double)texture_filter_rgb(&p.i, REPEAT, BILINEAR, s, t, &across).r, 0.5, 0.05);
    }
    reset_picture(&p);
}

/* Over the whole picture, eye's and coarse ones, from a pixel wide to many pictures, the mean is that of the picture:
 * by random points, within four standard errors. Where the footprint is wide each value is near it. */
static void look_ups_have_the_mean(void **state)
{
    (void)state;
    enum { COUNT = 40000 / FEWER };
    made_picture p;
    make_picture(&p, 700, 525, false, noise);
    const double expected = level_mean(&p.i.mips->levels[0], 1);
    for (int k = 0; k < 12; k++) {
        const float wide = ldexpf(1.0f, k) / 700.0f;
        texture_footprint f = footprint(5.0f * wide, 2.0f * wide, -0.3f * wide, wide);
        f.is_coarse = k % 2;
        double sum = 0.0, squares = 0.0;
        for (uint32_t i = 0; i < COUNT; i++) {
            rng random = rng_make(3, (uint64_t)k, i);
            vec2 u = rng_vec2(&random);
            double v = (double)texture_filter_rgb(&p.i, REPEAT, BILINEAR, u.x, u.y, &f).g;
            sum += v, squares += v * v;
            if (k >= 8 && !f.is_coarse)
                assert_near(v, expected, 0.02);
        }
        double mean = sum / COUNT, error = sqrt(fmax(squares / COUNT - mean * mean, 0.0) / COUNT);
        assert_near(mean, expected, 4.0 * error + 3e-5);
    }
    reset_picture(&p);
}

/* Footprints that are no number, or without end, or empty. */
static void odd_footprints(void **state)
{
    (void)state;
    made_picture p;
    make_picture(&p, 64, 64, true, noise);
    const rgb plain = texture_image_color(&p.i, REPEAT, BILINEAR, 0.3f, 0.4f);
    const double mean = level_mean(&p.i.mips->levels[0], 0);
    texture_footprint f = footprint(0.0f, 0.0f, 0.0f, 0.0f);
    assert_true(is_same(texture_filter_color(&p.i, REPEAT, BILINEAR, 0.3f, 0.4f, &f), plain));
    const float odd[] = {NAN, INFINITY, -INFINITY, 1e30f, 1e12f};
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
        f = footprint(odd[k], 0.1f, odd[k], odd[k]);
        assert_near((double)texture_filter_color(&p.i, REPEAT, BILINEAR, 0.3f, 0.4f, &f).r, mean, 0.05);
    }
    reset_picture(&p);
}

/* Colours in products of pictures, or picked by them, go along with one another: these are not filtered. */
static void which_textures_are_filtered(void **state)
{
    (void)state;
    texture_set set = {0};
    texture textures[9];
    texture_image picture = {.least = 0.0f, .most = 1.0f}, *pictures[] = {&picture};
    set.items = textures;
    set.images = pictures;
    for (int k = 0; k < 2; k++) {
        textures[k] = texture_make(TEXTURE_IMAGE);
        texture_find_pictures(&set, &textures[k]);
    }
    textures[2] = texture_make(TEXTURE_SCALE); /* a picture by a number */
    textures[2].inputs[0].texture_index = 0;
    texture_find_pictures(&set, &textures[2]);
    textures[3] = texture_make(TEXTURE_SCALE); /* by another */
    textures[3].inputs[0].texture_index = 2;
    textures[3].inputs[1].texture_index = 1;
    texture_find_pictures(&set, &textures[3]);
    textures[4] = texture_make(TEXTURE_MIX); /* of two numbers, by a picture */
    textures[4].inputs[2].texture_index = 0;
    texture_find_pictures(&set, &textures[4]);
    textures[5] = textures[4]; /* of a picture, by a picture */
    textures[5].inputs[0].texture_index = 1;
    texture_find_pictures(&set, &textures[5]);
    textures[6] = texture_make(TEXTURE_CHECKERBOARD); /* of what cannot be */
    textures[6].inputs[1].texture_index = 5;
    texture_find_pictures(&set, &textures[6]);
    textures[7] = texture_make(TEXTURE_CHECKERBOARD); /* of a picture: its cells may go along with it */
    textures[7].inputs[1].texture_index = 0;
    texture_find_pictures(&set, &textures[7]);
    textures[8] = texture_make(TEXTURE_SCALE); /* of a picture, by a texture that varies */
    textures[8].inputs[0].texture_index = 0;
    textures[8].inputs[1].texture_index = 7;
    texture_find_pictures(&set, &textures[8]);
    static const bool EXPECTED[9] = {true, true, true, false, true, false, false, false, false};
    for (int k = 0; k < 9; k++) {
        assert_true(textures[k].has_pictures);
        assert_int_equal(textures[k].is_linear_in_pictures, EXPECTED[k]);
    }
}

static float most_of(texture_set *set, const texture *t)
{
    texture found = *t;
    texture_find_pictures(set, &found);
    return found.most;
}

/* Values that a texture bounds by 1 or 0 are cut there. */
static void bounds_of_values(void **state)
{
    (void)state;
    texture_set set = {0};
    texture_image picture = {.least = 0.0f, .most = 0.75f}, *pictures[] = {&picture};
    texture t = texture_make(TEXTURE_IMAGE), product = texture_make(TEXTURE_SCALE);
    set.items = &t;
    set.images = pictures;
    assert_true(most_of(&set, &t) == 0.75f);
    t.scale = 2.0f;
    assert_true(most_of(&set, &t) == 1.5f);
    t.most = 1.5f;
    product.inputs[0].texture_index = 0;
    product.inputs[1].value = rgb_gray(0.5f);
    assert_true(most_of(&set, &product) == 0.75f);
    product.inputs[1].value = rgb_gray(-0.5f);
    assert_true(isinf(most_of(&set, &product)));
    t.invert = true;
    assert_true(isinf(most_of(&set, &t)));
    t.scale = 1.0f;
    assert_true(most_of(&set, &t) == 1.0f);
    picture.least = -0.01f;
    assert_true(isinf(most_of(&set, &t)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_has_the_mean),
        cmocka_unit_test(means_are_of_linear_values),
        cmocka_unit_test(magnified_pictures_keep_their_bits),
        cmocka_unit_test(detail_seen_frontally_keeps_its_contrast),
        cmocka_unit_test(stripes_are_sharp_across),
        cmocka_unit_test(look_ups_have_the_mean),
        cmocka_unit_test(odd_footprints),
        cmocka_unit_test(which_textures_are_filtered),
        cmocka_unit_test(bounds_of_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

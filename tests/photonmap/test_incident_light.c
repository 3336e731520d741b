/* test_incident_light.c: what guides gather rays: the warp keeps to its density, which is never far below the cosine's;
 * photons draw rays to where they came from, those of their own normal and of a diffuse point alone; the same for any
 * number of threads, in less than a byte a photon. Threads: the map's, up to 4. */
/* ctest: sanitize */
#include "incident_light.h"

#include "fixtures/photon_field.h"

static const vec3 UP = {0.0f, 0.0f, 1.0f}, ALONG = {1.0f, 0.0f, 0.0f};

/* A photon on the unit square that `normal` stands on, its light from `from`. */
static void add(photon_set *set, rng *random, vec3 normal, vec3 from, bool is_diffuse)
{
    vec2 u = rng_vec2(random);
    vec3 at = normal.z > 0.5f ? (vec3){u.x, u.y, 0.0f} : (vec3){0.0f, u.x, u.y};
    field_add(set, at, normal, flux_encode(FIELD_FLUX, set->count));
    set->photons[set->count - 1].direction = arrival_encode(vec3_negate(from), is_diffuse);
}

static vec3 cosine_around(vec3 normal, rng *random)
{
    frame f = frame_from_z(normal);
    return vec3_normalize(frame_to_world(&f, sample_cosine_hemisphere(rng_vec2(random))));
}

static photon_set set_for(uint32_t count)
{
    photon_set set = {.photons = photon_records_create(count), .emitted_paths = count};
    assert_non_null(set.photons);
    return set;
}

typedef struct lit {
    test_run r;
    photon_map map;
    incident_light light;
} lit;

static void light_up(lit *l, photon_set *set, float share, unsigned threads)
{
    test_run_init(&l->r, threads);
    photon_map_settings settings = {.nearest = 50, .max_radius = 0.5f, .surface_area = 1.0f};
    assert_int_equal(photon_map_create(&l->r.run, set, &settings, 0.0, 1.0, &l->map), AG_OK);
    assert_int_equal(incident_light_create(&l->r.run, &l->map.tree, share, &l->light), AG_OK);
}

static void put_out(lit *l)
{
    incident_light_reset(&l->light);
    photon_map_reset(&l->map);
    test_run_reset(&l->r);
}

static vec3 guided(const incident_guide *g, vec2 u, float *out_weight)
{
    *out_weight = incident_guide_warp_one(g, &u);
    return frame_to_world(&g->around, sample_cosine_hemisphere(u));
}

enum { FEW_PHOTONS = 3000, STEPS = 256 };
static const vec3 MIDDLE = {0.5f, 0.5f, 0.0f};

/* Two photons of three; the third from anywhere. */
static photon_set mostly_from_one_side(rng *random)
{
    photon_set set = set_for(FEW_PHOTONS);
    vec3 from = vec3_normalize((vec3){0.6f, -0.3f, 0.7f});
    for (uint32_t k = 0; k < FEW_PHOTONS; k++)
        add(&set, random, UP, k % 3 ? from : cosine_around(UP, random), true);
    return set;
}

/* Over a regular grid the weights' mean is the density's integral, and the mean of weighted cosines is theirs. */
static void the_density_integrates_to_one(void **state)
{
    (void)state;
    const float shares[] = {0.1f, 0.5f, 1.0f};
    for (int i = 0; i < 3; i++) {
        rng random = test_random(1);
        photon_set set = mostly_from_one_side(&random);
        lit l;
        light_up(&l, &set, shares[i], 1);
        incident_guide g;
        assert_true(incident_light_find(&l.light, MIDDLE, UP, &g));
        double mass = 0.0, mean[3] = {0.0, 0.0, 0.0}, expected[3] = {0.0, 0.0, 0.0};
        float least = INFINITY, most = 0.0f;
        for (int k = 0; k < STEPS * STEPS; k++) {
            vec2 u = {((float)(k / STEPS) + 0.5f) / STEPS, ((float)(k % STEPS) + 0.5f) / STEPS}, v = u;
            float weight, again = incident_guide_warp_one(&g, &v);
            assert_true(v.x >= 0.0f && v.x < 1.0f && v.y >= 0.0f && v.y < 1.0f);
            vec3 d = guided(&g, u, &weight), even = frame_to_world(&g.around, sample_cosine_hemisphere(u));
            assert_true(weight == again && vec3_dot(d, UP) > 0.0f);
            least = fminf(least, weight), most = fmaxf(most, weight);
            mass += (double)weight / (STEPS * STEPS);
            const float is[3] = {d.x, d.y, d.z}, cosine[3] = {even.x, even.y, even.z};
            for (int a = 0; a < 3; a++) {
                mean[a] += (double)(weight * is[a]) / (STEPS * STEPS);
                expected[a] += (double)cosine[a] / (STEPS * STEPS);
            }
        }
        assert_close(mass, 1.0, 2e-3);
        for (int a = 0; a < 3; a++)
            assert_close(mean[a], expected[a], 2e-3);
        /* no ray weighs more than 1 / the even share, but for the rounding of a bin's ends */
        assert_true(most <= 1.02f / (1.0f - shares[i] * 0.9f));
        assert_true(least < 1.0f - 0.5f * shares[i]);
        put_out(&l);
    }
}

/* Warping many points at once gives the bits of warping each alone, with any instructions. */
static void many_are_warped_as_each_alone(void **state)
{
    (void)state;
    rng random = test_random(7);
    photon_set set = mostly_from_one_side(&random);
    lit l;
    light_up(&l, &set, 0.9f, 1);
    incident_guide g;
    assert_true(incident_light_find(&l.light, MIDDLE, UP, &g));
    for (uint32_t round = 0; round < 40 * INCIDENT_WARPS_MAX / FEWER; round++) {
        float u[2][INCIDENT_WARPS_MAX], many[2][INCIDENT_WARPS_MAX], weights[INCIDENT_WARPS_MAX];
        uint32_t count = 1 + round % INCIDENT_WARPS_MAX;
        for (uint32_t i = 0; i < INCIDENT_WARPS_MAX; i++) {
            vec2 point = rng_vec2(&random);
            u[0][i] = i % 16 == 3 ? 0x1.fffffep-1f : i % 16 == 4 ? 0.0f : point.x;
            u[1][i] = i % 16 == 5 ? 0x1.fffffep-1f : i % 16 == 4 ? 0.0f : point.y;
        }
        memcpy(many, u, sizeof u);
        incident_guide_warp(&g, count, many, weights);
        for (uint32_t i = 0; i < count; i++) {
            vec2 alone = {u[0][i], u[1][i]};
            float weight = incident_guide_warp_one(&g, &alone);
            assert_true(many[0][i] == alone.x && many[1][i] == alone.y && weights[i] == weight);
        }
    }
    put_out(&l);
}

/* Points in order stay in order: what is stratified stays so. */
static void the_warp_keeps_order(void **state)
{
    (void)state;
    rng random = test_random(2);
    photon_set set = set_for(FEW_PHOTONS);
    for (uint32_t k = 0; k < FEW_PHOTONS; k++)
        add(&set, &random, UP, vec3_normalize((vec3){0.1f, 0.4f, 0.5f}), true);
    lit l;
    light_up(&l, &set, 0.9f, 1);
    incident_guide g;
    assert_true(incident_light_find(&l.light, MIDDLE, UP, &g));
    vec2 before_x = {-1.0f, 0.0f}, before_y = {0.0f, -1.0f};
    for (int k = 0; k < 4096; k++) {
        vec2 x = {(float)k / 4096.0f, 0.3f}, y = {0.7f, (float)k / 4096.0f};
        incident_guide_warp_one(&g, &x);
        incident_guide_warp_one(&g, &y);
        assert_true(x.x >= before_x.x && y.y >= before_y.y);
        before_x = x, before_y = y;
    }
    put_out(&l);
}

static double mean_cosine_to(const incident_guide *g, vec3 to)
{
    double sum = 0.0;
    for (int k = 0; k < STEPS * STEPS; k++) {
        float weight;
        vec2 u = {((float)(k / STEPS) + 0.5f) / STEPS, ((float)(k % STEPS) + 0.5f) / STEPS};
        sum += (double)vec3_dot(guided(g, u, &weight), to) / (STEPS * STEPS);
    }
    return sum;
}

/* Tested with normals along all six axes and between them; without guiding the mean is two thirds of the cosine to the
 * normal. */
static void rays_go_where_photons_came_from(void **state)
{
    (void)state;
    rng random = test_random(3);
    for (int k = 0; k < 40; k++) {
        vec3 normal = direction_decode(direction_encode(random_direction(&random))); /* as photons have it */
        if (k < 6)
            normal = vec3_make(k / 2 == 0 ? 1.0f : 0.0f, k / 2 == 1 ? 1.0f : 0.0f, k / 2 == 2 ? 1.0f : 0.0f);
        if (k < 6 && k % 2)
            normal = vec3_negate(normal);
        vec3 from = cosine_around(normal, &random);
        if (vec3_dot(from, normal) < 0.2f)
            continue;
        photon_set set = set_for(FEW_PHOTONS);
        for (uint32_t i = 0; i < FEW_PHOTONS; i++)
            add(&set, &random, normal, from, true);
        lit l;
        light_up(&l, &set, 1.0f, 1);
        incident_guide g;
        assert_true(incident_light_find(&l.light, MIDDLE, normal, &g));
        assert_true(mean_cosine_to(&g, from) > 0.78);
        put_out(&l);
    }
}

static void light_straight_from_lamps_does_not_guide(void **state)
{
    (void)state;
    rng random = test_random(4);
    photon_set set = set_for(2 * FEW_PHOTONS);
    vec3 lamp = vec3_normalize((vec3){-0.7f, 0.1f, 0.5f}), wall = vec3_normalize((vec3){0.8f, 0.0f, 0.4f});
    for (uint32_t i = 0; i < FEW_PHOTONS; i++)
        add(&set, &random, UP, lamp, false);
    photon_set lamps_alone = set_for(FEW_PHOTONS);
    memcpy(lamps_alone.photons, set.photons, FEW_PHOTONS * sizeof(photon));
    lamps_alone.count = FEW_PHOTONS;
    for (uint32_t i = 0; i < FEW_PHOTONS; i++)
        add(&set, &random, UP, wall, true);
    incident_guide g;
    lit alone, both;
    light_up(&alone, &lamps_alone, 0.5f, 1);
    light_up(&both, &set, 1.0f, 1);
    assert_false(incident_light_find(&alone.light, MIDDLE, UP, &g));
    assert_true(incident_light_find(&both.light, MIDDLE, UP, &g));
    assert_true(mean_cosine_to(&g, wall) > 0.8);
    put_out(&alone);
    put_out(&both);
}

/* A floor and a wall share cells along their edge; each is guided by its own photons, and a ceiling by none. */
static void other_normals_do_not_guide(void **state)
{
    (void)state;
    rng random = test_random(5);
    photon_set set = set_for(200);
    vec3 of_floor = vec3_normalize((vec3){0.5f, 0.7f, 0.4f}), of_wall = vec3_normalize((vec3){0.5f, -0.7f, 0.4f});
    for (uint32_t i = 0; i < 200; i++)
        add(&set, &random, i % 2 ? UP : ALONG, i % 2 ? of_floor : of_wall, true);
    lit l;
    light_up(&l, &set, 1.0f, 1);
    assert_int_equal(l.light.cell_depth, 0);
    incident_guide g, h;
    assert_true(incident_light_find(&l.light, MIDDLE, UP, &g) && incident_light_find(&l.light, MIDDLE, ALONG, &h));
    assert_true(mean_cosine_to(&g, of_floor) > mean_cosine_to(&g, of_wall) + 0.3);
    assert_true(mean_cosine_to(&h, of_wall) > mean_cosine_to(&h, of_floor) + 0.3);
    assert_false(incident_light_find(&l.light, MIDDLE, vec3_negate(UP), &g));
    put_out(&l);
}

static void without_photons_or_share_there_is_nothing(void **state)
{
    (void)state;
    rng random = test_random(6);
    photon_set empty = {0}, set = set_for(FEW_PHOTONS), dark = set_for(FEW_PHOTONS);
    for (uint32_t i = 0; i < FEW_PHOTONS; i++) {
        add(&set, &random, UP, UP, true);
        add(&dark, &random, UP, UP, true);
        dark.photons[i].flux = 0;
    }
    lit none, off, black;
    incident_guide g;
    light_up(&none, &empty, 1.0f, 1);
    light_up(&off, &set, 0.0f, 1);
    light_up(&black, &dark, 1.0f, 1);
    assert_false(incident_light_find(&none.light, MIDDLE, UP, &g));
    assert_false(incident_light_find(&off.light, MIDDLE, UP, &g));
    assert_int_equal(incident_light_bytes(&none.light) + incident_light_bytes(&off.light), 0);
    /* photons without power say nothing: the cosine */
    assert_true(incident_light_find(&black.light, MIDDLE, UP, &g));
    vec2 u = {0.3f, 0.8f};
    assert_close(incident_guide_warp_one(&g, &u), 1.0, 1e-3);
    assert_close(u.x, 0.3, 1e-3);
    assert_close(u.y, 0.8, 1e-3);
    put_out(&none);
    put_out(&off);
    put_out(&black);
}

static void threads_make_no_difference_and_it_is_small(void **state)
{
    (void)state;
    enum { PHOTONS = 100000 / FEWER };
    lit l[2];
    for (int k = 0; k < 2; k++) {
        rng random = test_random(7);
        photon_set set = set_for(PHOTONS);
        for (uint32_t i = 0; i < PHOTONS; i++)
            add(&set, &random, i % 4 ? UP : ALONG, cosine_around(i % 4 ? UP : ALONG, &random), i % 5 != 0);
        light_up(&l[k], &set, 0.5f, k ? 4 : 1);
    }
    uint32_t cells = 1u << l[0].light.cell_depth;
    assert_int_equal(l[0].light.cell_depth, l[1].light.cell_depth);
    assert_int_equal(l[0].light.histogram_count, l[1].light.histogram_count);
    assert_memory_equal(l[0].light.cells, l[1].light.cells, cells * sizeof *l[0].light.cells);
    assert_memory_equal(l[0].light.histograms, l[1].light.histograms,
                        l[0].light.histogram_count * sizeof *l[0].light.histograms);
    assert_true(incident_light_bytes(&l[0].light) > 0 && incident_light_bytes(&l[0].light) < PHOTONS);
    put_out(&l[0]);
    put_out(&l[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_density_integrates_to_one),
        cmocka_unit_test(many_are_warped_as_each_alone),
        cmocka_unit_test(the_warp_keeps_order),
        cmocka_unit_test(rays_go_where_photons_came_from),
        cmocka_unit_test(light_straight_from_lamps_does_not_guide),
        cmocka_unit_test(other_normals_do_not_guide),
        cmocka_unit_test(without_photons_or_share_there_is_nothing),
        cmocka_unit_test(threads_make_no_difference_and_it_is_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

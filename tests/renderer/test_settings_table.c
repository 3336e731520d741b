/* test_settings_table.c: the table of settings is whole: every field has its row, every row its texts, its range holds,
 * and fingerprints change with just those settings that are marked as a part of them.
 * Threads: one. */
#include "checkpoint.h"
#include "fixtures/test_scene.h"
#include "photon_file.h"
#include "settings_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *at(const setting_row *row, ag_render_settings *settings)
{
    return (unsigned char *)settings + row->offset;
}

static size_t alignment_of(const setting_row *row)
{
    switch (row->kind) {
    case SETTING_FLAG: return _Alignof(bool);
    case SETTING_COUNT:
    case SETTING_SEED: return _Alignof(uint64_t);
    case SETTING_WINDOW: return _Alignof(double);
    case SETTING_FILE: return _Alignof(const char *);
    default: return _Alignof(int);
    }
}

/* Between a row's field and the next one's there is no more than alignment asks for. */
static void every_field_has_a_row(void **state)
{
    (void)state;
    size_t end = sizeof(size_t); /* struct_size comes first */
    const setting_row *row;
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++) {
        size_t alignment = alignment_of(row);
        if (row->offset != (end + alignment - 1) / alignment * alignment)
            fail_msg("%s: it begins at %zu, and the row before ends at %zu", row->noun, row->offset, end);
        end = row->offset + row->size;
    }
    assert_true(sizeof(ag_render_settings) - end < _Alignof(ag_render_settings));
}

static void names_are_there_once(void **state)
{
    (void)state;
    const setting_row *a, *b;
    for (size_t i = 0; (a = setting_at(i)) != NULL; i++) {
        assert_non_null(a->noun);
        if (a->text.name) {
            assert_non_null(a->text.help);
            assert_non_null(a->text.section);
            assert_true((a->text.argument == NULL) == (a->kind == SETTING_FLAG));
            for (int word = 0; a->kind == SETTING_WORD && a->words[word]; word++)
                if (!strstr(a->text.help, a->words[word]) || !strstr(a->text.manual, a->words[word]))
                    fail_msg("%s: \"%s\" is not in its help or its manual", a->text.name, a->words[word]);
        }
        assert_true(a->json || a->kind == SETTING_FILE);
        assert_true(a->json || !(a->marks & SETTING_IN_HEADER));
        for (size_t k = 0; k < i; k++) {
            b = setting_at(k);
            assert_string_not_equal(a->noun, b->noun);
            assert_true(!a->text.name || !b->text.name || strcmp(a->text.name, b->text.name) != 0);
            assert_true(!a->json || !b->json || strcmp(a->json, b->json) != 0);
        }
    }
}

static void defaults_are_as_documented(void **state)
{
    (void)state;
    ag_render_settings s = ag_default_render_settings();
    char wrong[256];
    const setting_row *row;
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++)
        if (!setting_check(row, &s, wrong, sizeof wrong))
            fail_msg("%s", wrong);
    assert_int_equal(s.integrator, AG_INTEGRATOR_PHOTONMAP);
    assert_int_equal(s.cache, AG_CACHE_ON_DEMAND);
    assert_int_equal(s.pane_light, AG_PANE_LIGHT_DIRECT);
    assert_true(s.width == 1280 && s.height == 720 && s.crop_window[1] == 1.0 && s.crop_window[3] == 1.0);
    assert_true(s.samples_per_pixel == 16 && s.noise_min_samples == 16 && s.max_depth == 100 && s.nearest == 50);
    assert_true(s.photon_count == AG_PHOTON_COUNT_AUTOMATIC && s.caustic_photon_count == AG_PHOTON_COUNT_AUTOMATIC);
    assert_int_equal(s.seed, 0);
    assert_true(s.exposure == 1.0f && s.irradiance_fraction == 1.0f && s.gather_guiding == AG_GATHER_GUIDING_AUTOMATIC);
    assert_true(s.photon_aim == AG_PHOTON_AIM_AUTOMATIC && s.gather_samples == 0 && s.noise_level == 0.0f);
    assert_true(s.layers == 0 && !s.denoise && s.photon_map_file == NULL);

    /* automatic is one value, and not those that a double takes for it */
    s.photon_count = AG_PHOTON_COUNT_AUTOMATIC + 1;
    bool is_refused = false;
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++)
        is_refused = is_refused || !setting_check(row, &s, wrong, sizeof wrong);
    assert_true(is_refused);

    /* the help's numbers are the table's, where it names one */
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++) {
        const char *told = row->text.name ? strstr(row->text.help, "(default ") : NULL;
        char *end = NULL;
        double number = told ? strtod(told + strlen("(default "), &end) : 0.0;
        bool is_number = told && end != told + strlen("(default ");
        if (is_number && !row->has_automatic && strcmp(row->text.name, "spp") != 0 && number != row->initial)
            fail_msg("--%s: the help says %g, the default is %g", row->text.name, number, row->initial);
    }
}

/* Another value, in its range. */
static void change(const setting_row *row, ag_render_settings *settings)
{
    void *value = at(row, settings);
    switch (row->kind) {
    case SETTING_WORD: *(unsigned *)value ^= 1u; break;
    case SETTING_INTEGER: *(int *)value = *(int *)value == (int)row->most ? (int)row->most - 1 : (int)row->most; break;
    case SETTING_COUNT:
    case SETTING_SEED: *(uint64_t *)value = *(uint64_t *)value == 5 ? 6 : 5; break;
    case SETTING_NUMBER:
        *(float *)value = row->most < 1e6 && *(float *)value != (float)row->most ? (float)row->most : 0.5f;
        break;
    case SETTING_FLAG: *(bool *)value = !*(bool *)value; break;
    case SETTING_SIZE: ((int *)value)[1]++; break;
    case SETTING_WINDOW: ((double *)value)[3] = 0.5; break;
    case SETTING_LAYERS: *(uint32_t *)value ^= AG_LAYER_DEPTH; break;
    case SETTING_FILE: *(const char **)value = "a.map"; break;
    }
}

/* Fingerprints change with the settings that are marked for them, and with no others. */
static void fingerprints_change_with_what_is_marked(void **state)
{
    (void)state;
    const setting_row *row;
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++) {
        ag_render_settings usual = ag_default_render_settings(), other = usual;
        unsigned char one[CHECKPOINT_SETTINGS_MAX], two[CHECKPOINT_SETTINGS_MAX];
        char one_map[PHOTON_FILE_SETTINGS_MAX], two_map[PHOTON_FILE_SETTINGS_MAX], wrong[256];
        change(row, &other);
        if (!setting_check(row, &other, wrong, sizeof wrong))
            fail_msg("%s", wrong);
        size_t size = settings_of_picture(&usual, one, sizeof one);
        assert_true(size <= sizeof one);
        assert_int_equal(settings_of_picture(&other, two, sizeof two), size);
        const char *differs = settings_of_picture_difference(one, two);
        if ((differs != NULL) != ((row->marks & SETTING_OF_PICTURE) != 0))
            fail_msg("%s: a checkpoint sees %s", row->noun, differs ? differs : "no difference");
        if (differs)
            assert_string_equal(differs, row->noun);
        assert_true(settings_of_photon_map(&usual, one_map, sizeof one_map) < sizeof one_map);
        assert_true(settings_of_photon_map(&other, two_map, sizeof two_map) < sizeof two_map);
        if ((strcmp(one_map, two_map) != 0) != row->text.is_of_photon_map)
            fail_msg("%s: a photon map's key is\n%s, then\n%s", row->noun, one_map, two_map);
    }
}

static void expect_fault(const setting_row *row, double number, const char *what)
{
    ag_render_settings s = ag_default_render_settings();
    char said[256] = "";
    if (row->kind == SETTING_NUMBER)
        *(float *)at(row, &s) = (float)number;
    else if (row->kind == SETTING_COUNT)
        *(uint64_t *)at(row, &s) = (uint64_t)number;
    else
        *(int *)at(row, &s) = (int)number;
    if (setting_check(row, &s, said, sizeof said))
        fail_msg("%s: %g, %s, is not refused", row->noun, number, what);
    assert_non_null(strstr(said, row->noun));
}

static void ranges_hold(void **state)
{
    (void)state;
    const setting_row *row;
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++) {
        if (row->kind == SETTING_NUMBER)
            expect_fault(row, (double)NAN, "no number");
        if (row->kind == SETTING_NUMBER && isfinite(row->most))
            expect_fault(row, row->most < 1e6 ? row->most * 1.001 : INFINITY, "above the most");
        if (row->kind == SETTING_NUMBER)
            expect_fault(row, row->is_above_least ? row->least : row->least - 0.5, "below the least");
        if (row->kind == SETTING_INTEGER || (row->kind == SETTING_COUNT && row->least > 0.0))
            expect_fault(row, row->has_automatic ? row->least - 2.0 : row->least - 1.0, "below the least");
        if (row->kind == SETTING_INTEGER || row->kind == SETTING_COUNT)
            expect_fault(row, row->most + 1.0, "above the most");
        if (row->kind == SETTING_WORD)
            expect_fault(row, 17, "no word");
    }
}

static void text_sets_what_it_says(void **state)
{
    (void)state;
    const setting_row *row;
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++) {
        ag_render_settings s = ag_default_render_settings(), other = s;
        const ag_render_settings usual = s;
        char text[SETTING_TEXT_MAX];
        const char *value = row->kind == SETTING_FLAG ? NULL : row->kind == SETTING_LAYERS ? "Z" : text;
        if (!row->text.name)
            continue;
        change(row, &other);
        setting_format(row, &other, text);
        assert_int_equal(ag_render_settings_set(&s, row->text.name, value), AG_OK);
        if (row->kind == SETTING_FILE)
            assert_string_equal(s.photon_map_file, "a.map");
        else
            assert_memory_equal(at(row, &s), at(row, &other), row->size);
        s = usual;
        assert_int_equal(ag_render_settings_set(&s, row->text.name, value ? NULL : "true"), AG_ERROR_ARGUMENT);
        if (row->kind != SETTING_FILE && value)
            assert_int_equal(ag_render_settings_set(&s, row->text.name, "some,nonsense"), AG_ERROR_ARGUMENT);
        assert_memory_equal(at(row, &s), at(row, (ag_render_settings *)(uintptr_t)&usual), row->size);
    }
    ag_render_settings s = ag_default_render_settings();
    assert_int_equal(ag_render_settings_set(&s, "no-such-setting", "1"), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_render_settings_set(&s, "photons", "2e6"), AG_OK);
    assert_int_equal(s.photon_count, 2000000);
    assert_int_equal(ag_render_settings_set(&s, "photon-aim", "0.8"), AG_OK);
    assert_int_equal(ag_render_settings_set(&s, "photon-aim", "-1"), AG_ERROR_ARGUMENT); /* automatic */
    assert_int_equal(ag_render_settings_set(&s, "gather-samples", "0"), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_render_settings_set(&s, "aov", "A"), AG_OK);
    assert_int_equal(ag_render_settings_set(&s, "aov", "Z,N"), AG_OK);
    assert_int_equal(s.layers, AG_LAYER_ALPHA | AG_LAYER_DEPTH | AG_LAYER_NORMAL);
}

/* Whoever lists settings by number sees those that have a name, each once. */
static void named_settings_are_listed(void **state)
{
    (void)state;
    size_t count = 0, named = 0;
    while (ag_setting_at(count))
        count++;
    for (size_t i = 0; setting_at(i); i++)
        if (setting_at(i)->text.name)
            assert_ptr_equal(ag_setting_at(named++), &setting_at(i)->text);
    assert_int_equal(count, named);
    assert_true(count > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_field_has_a_row),
        cmocka_unit_test(names_are_there_once),
        cmocka_unit_test(defaults_are_as_documented),
        cmocka_unit_test(fingerprints_change_with_what_is_marked),
        cmocka_unit_test(ranges_hold),
        cmocka_unit_test(text_sets_what_it_says),
        cmocka_unit_test(named_settings_are_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_definitions.c: values for names in a scene's text: where they go, what is missing, what is not used.
 * Threads: one. */
#include "fixtures/pbrt_fixture.h"
#include "text/definitions.h"

static definition ITEMS[] = {{"a", "1", false, false},
                             {"ab", "two", false, false},
                             {"_c3", "", false, false},
                             {"d", "$a ${ab} \" #", false, false}};

static void expect(const definitions *d, const char *text, bool is_quoted, const char *expected)
{
    char message[256] = "", *made = NULL;
    size_t length = 0;
    ag_status status = definitions_expand(d, text, strlen(text), is_quoted, message, sizeof message, &made, &length);
    if (status != AG_OK)
        fail_msg("%s: %s", text, message);
    if (!expected) {
        assert_null(made);
        return;
    }
    assert_string_equal(made, expected);
    assert_int_equal(length, strlen(expected));
    free(made);
}

static void expect_missing(const definitions *d, const char *text, bool is_quoted, const char *name)
{
    char message[256] = "", *made;
    size_t length;
    assert_int_equal(definitions_expand(d, text, strlen(text), is_quoted, message, sizeof message, &made, &length),
                     AG_ERROR_SCENE);
    assert_int_equal(strncmp(message, name, strlen(name)), 0);
    assert_int_equal(message[strlen(name)], ' ');
}

static void values_stand_for_names(void **state)
{
    (void)state;
    const definitions d = {ITEMS, sizeof ITEMS / sizeof *ITEMS};
    static const char *const TEXTS[][2] = {
        {"$a", "1"},
        {"$ab", "two"}, /* the whole name, not a beginning of it */
        {"${a}b", "1b"},
        {"$a$ab.$a", "1two.1"},
        {"x${_c3}y$_c3", "xy"},
        {"$d", "$a ${ab} \" #"}, /* values are not looked through */
        {"${a:-5}${e:-5 6}${e:-}", "15 6"},
        {"$1 $a", "$1 1"},
        {"$$a$", "$1$"},
        {"${} ${a ${a} ${a:x} $", "${} ${a 1 ${a:x} $"},
        {"${a:-", NULL},
        {"", NULL},
        {"$", NULL},
        {"a", NULL},
    };
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        expect(&d, TEXTS[i][0], true, TEXTS[i][1]);
        expect(&d, TEXTS[i][0], false, TEXTS[i][1]);
    }
    expect_missing(&d, "$abc", true, "$abc");
    expect_missing(&d, "$a ${e}", false, "$e");
}

static void without_definitions_strings_stay(void **state)
{
    (void)state;
    definition number = {"frame", "7", true, false};
    const definitions only_frame = {&number, 1}, none = {NULL, 0};
    expect(NULL, "$a ${b}", true, NULL);
    expect(&none, "$a ${b}", true, NULL);
    expect(&none, "$a ${b:-9}", true, "$a 9");
    expect(&only_frame, "$a $frame", true, "$a 7");
    expect_missing(&none, "$a", false, "$a");
    expect_missing(&only_frame, "$a", false, "$a");
    assert_null(definitions_unused(&none));
}

static void what_is_used_is_known(void **state)
{
    (void)state;
    definition items[] = {{"a", "1 2", false, false}, {"b", "x", true, false}, {"c", "3", false, false}};
    const definitions d = {items, 3};
    char *text = definitions_describe(&d);
    assert_string_equal(text, "");
    free(text);
    assert_ptr_equal(definitions_unused(&d), &items[0]);
    expect(&d, "$a", false, "1 2");
    assert_ptr_equal(definitions_unused(&d), &items[2]);
    expect(&d, "$c", false, "3");
    assert_null(definitions_unused(&d)); /* b is optional */
    text = definitions_describe(&d);
    assert_string_equal(text, "a=1 2, c=3");
    free(text);
    static const char *const VALID[] = {"a", "_", "a1", "Zz_9"}, *const WRONG[] = {"", "1a", "a-b", "a b", "$a", "ä"};
    for (int i = 0; i < 4; i++)
        assert_true(definition_name_is_valid(VALID[i]));
    for (int i = 0; i < 6; i++)
        assert_false(definition_name_is_valid(WRONG[i]));
}

/* Reads text with these definitions. */
static reading reading_with(const definitions *d, const char *text)
{
    reading r;
    run_context run;
    reading_begin(&r, &run);
    r.scene->definitions = d;
    r.status = pbrt_parse_text(&run, "t", text, strlen(text), r.scene);
    reading_end(&run);
    return r;
}

static void a_scene_takes_values_everywhere(void **state)
{
    (void)state;
    definition items[] = {{"radius", "2.5", false, false},
                          {"kind", "sphere", false, false},
                          {"red", "0.5 0.25", false, false},
                          {"where", "[1 2", false, false},
                          {"light", "LightSource \"point\" \"rgb I\" [1 2 3]", false, false},
                          {"word", "Shape", false, false},
                          {"name", "radius", false, false},
                          {"nothing", "  # none", false, false}};
    const definitions d = {items, sizeof items / sizeof *items};
    reading r = reading_with(&d, "WorldBegin $nothing\n"
                                 "Material \"diffuse\" \"rgb reflectance\" [ $red 0.125 ]\n"
                                 "Translate 1 ${e:-2} 3\n"
                                 "$word \"$kind\" \"float $name\" $radius\n"
                                 "$light \"point3 from\" $where 3 ]\n"
                                 "Shape \"${kind}\" \"float radius\" [ ${r:- 1} ]\n");
    if (r.status != AG_OK)
        fail_msg("%s", r.said[AG_LOG_ERROR]);
    assert_int_equal(r.scene->shape_count, 2);
    assert_int_equal(r.scene->light_count, 1);
    assert_near(shape_area(&r.scene->shapes[0]), 4.0 * 3.14159265 * 2.5 * 2.5, 1e-3);
    assert_near(shape_area(&r.scene->shapes[1]), 4.0 * 3.14159265, 1e-3);
    assert_null(definitions_unused(&d));
    reading_destroy(&r);
}

static void mistakes_have_locations(void **state)
{
    (void)state;
    definition items[] = {{"a", "x", false, false}, {"s", "\"x", false, false}, {"big", "1e999", false, false}};
    const definitions d = {items, 3};
    static const char *const TEXTS[][2] = {
        {"WorldBegin\n  Shape \"sphere\" \"float radius\" $b", "t:2:33: error: $b has no value here: -D b=VALUE would"
                                                               " give it one\n"},
        {"WorldBegin Shape \"$b\"", "t:1:18: error: $b has no value"},
        {"WorldBegin Shape \"sphere\" \"float radius\" $a", "t:1:42: error: \"float radius\" expects numbers, not x"},
        {"WorldBegin Shape $s", "t:1:18: error: in the value \"\"x\": unterminated string"},
        {"WorldBegin Shape \"sphere\" \"float radius\" [ $big ]", "t:1:44: error: the number is too large"},
        {"WorldBegin $a", "t:1:12: error: unknown directive x"},
        {"WorldBegin Shape \"sphere\" \"float radius\" ${a", "t:1:42: error:"},
    };
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        reading r = reading_with(&d, TEXTS[i][0]);
        assert_int_equal(r.status, AG_ERROR_SCENE);
        if (!strstr(r.said[AG_LOG_ERROR], TEXTS[i][1]))
            fail_msg("'%s' is not in: %s", TEXTS[i][1], r.said[AG_LOG_ERROR]);
        reading_destroy(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_stand_for_names),  cmocka_unit_test(without_definitions_strings_stay),
        cmocka_unit_test(what_is_used_is_known),   cmocka_unit_test(a_scene_takes_values_everywhere),
        cmocka_unit_test(mistakes_have_locations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

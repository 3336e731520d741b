/* test_pbrt_lexer.c: tokens and their locations, strings, numbers, what is refused; and the numbers' exact values.
 * Threads: one. */
#include "pbrt/pbrt_lexer.h"

#include "text/decimal.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct expected_token {
    pbrt_token_kind kind;
    int line, column;
    const char *text;
} expected_token;

static void check_tokens(const char *text, const expected_token *expected, size_t count)
{
    pbrt_lexer lexer;
    pbrt_token token;
    pbrt_lexer_init(&lexer, "f", text, strlen(text));
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(pbrt_lexer_next(&lexer, &token), AG_OK);
        assert_int_equal(token.kind, expected[i].kind);
        assert_string_equal(token.where.file, "f");
        assert_int_equal(token.where.line, expected[i].line);
        assert_int_equal(token.where.column, expected[i].column);
        assert_int_equal(token.length, strlen(expected[i].text));
        assert_memory_equal(token.text, expected[i].text, token.length);
    }
    for (int i = 0; i < 2; i++) { /* the end stays the end */
        assert_int_equal(pbrt_lexer_next(&lexer, &token), AG_OK);
        assert_int_equal(token.kind, PBRT_TOKEN_END);
    }
    pbrt_lexer_reset(&lexer);
}

#define CHECK_TOKENS(text, ...)                                                                                        \
    do {                                                                                                               \
        const expected_token expected[] = {__VA_ARGS__};                                                               \
        check_tokens(text, expected, sizeof expected / sizeof *expected);                                              \
    } while (0)

static void tokens_have_locations(void **state)
{
    (void)state;
    CHECK_TOKENS("Shape \"sphere\"\n  \"float radius\"[ 1.5 ]", {PBRT_TOKEN_WORD, 1, 1, "Shape"},
                 {PBRT_TOKEN_STRING, 1, 7, "sphere"}, {PBRT_TOKEN_STRING, 2, 3, "float radius"},
                 {PBRT_TOKEN_OPEN, 2, 17, "["}, {PBRT_TOKEN_WORD, 2, 19, "1.5"}, {PBRT_TOKEN_CLOSE, 2, 23, "]"});
    /* nothing needs blanks between it but words */
    CHECK_TOKENS("a\"b\"c[d]e#f\ng", {PBRT_TOKEN_WORD, 1, 1, "a"}, {PBRT_TOKEN_STRING, 1, 2, "b"},
                 {PBRT_TOKEN_WORD, 1, 5, "c"}, {PBRT_TOKEN_OPEN, 1, 6, "["}, {PBRT_TOKEN_WORD, 1, 7, "d"},
                 {PBRT_TOKEN_CLOSE, 1, 8, "]"}, {PBRT_TOKEN_WORD, 1, 9, "e"}, {PBRT_TOKEN_WORD, 2, 1, "g"});
}

static void blanks_and_comments_are_skipped(void **state)
{
    (void)state;
    CHECK_TOKENS("\xef\xbb\xbf# \xc3\xa4 \"[\r\n\tone # two\r\n\r\n three", {PBRT_TOKEN_WORD, 2, 2, "one"},
                 {PBRT_TOKEN_WORD, 4, 2, "three"});
    check_tokens("", NULL, 0);
    check_tokens(" \n# comment without a line end", NULL, 0);
}

static void strings_have_escapes(void **state)
{
    (void)state;
    CHECK_TOKENS("\"a\\\"b\\\\c\\n\\t\\r\\b\\f\\'\" \"\" \"\xc3\xa4#[]\"",
                 {PBRT_TOKEN_STRING, 1, 1, "a\"b\\c\n\t\r\b\f'"}, {PBRT_TOKEN_STRING, 1, 23, ""},
                 {PBRT_TOKEN_STRING, 1, 26, "\xc3\xa4#[]"});
}

static void bad_text_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t size;
        int line, column;
        const char *error;
    } CASES[] = {
        {"a \"b", 4, 1, 3, "unterminated string"},
        {"\n \"b\nc\"", 7, 2, 2, "unterminated string"},
        {"\"b\\", 3, 1, 1, "unterminated string"},
        {"\"b\\\n\"", 5, 1, 1, "unterminated string"},
        {"\"b\\x\"", 5, 1, 3, "unknown escape in a string"},
        {"\"b\001\"", 4, 1, 3, "unexpected byte 0x01"},
        {"\"b\0c\"", 5, 1, 3, "NUL byte: this is not a text file"},
        {" \0", 2, 1, 2, "NUL byte: this is not a text file"},
        {"# \0", 3, 1, 3, "NUL byte: this is not a text file"},
        {" \x7f", 2, 1, 2, "unexpected byte 0x7f"},
        {" \xc3\xa4", 3, 1, 2, "unexpected byte 0xc3"},
        {"\xff\xfe"
         "a\0",
         4, 1, 1, "the file is UTF-16; only ASCII and UTF-8 can be read"},
        {"\xfe\xff\0a", 4, 1, 1, "the file is UTF-16; only ASCII and UTF-8 can be read"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        pbrt_lexer lexer;
        pbrt_token token;
        ag_status status;
        pbrt_lexer_init(&lexer, "f", CASES[i].text, CASES[i].size);
        do
            status = pbrt_lexer_next(&lexer, &token);
        while (status == AG_OK && token.kind != PBRT_TOKEN_END);
        assert_int_equal(status, AG_ERROR_SCENE);
        assert_string_equal(lexer.error, CASES[i].error);
        assert_int_equal(token.where.line, CASES[i].line);
        assert_int_equal(token.where.column, CASES[i].column);
        pbrt_lexer_reset(&lexer);
    }
}

static void numbers_are_read_in_blocks(void **state)
{
    (void)state;
    const char *text = "1 -2.5e1 # comment\n +.5 7. ] 5x 1e999 -";
    double v[8];
    pbrt_lexer lexer;
    pbrt_token token;
    pbrt_lexer_init(&lexer, "f", text, strlen(text));
    assert_int_equal(pbrt_lexer_numbers(&lexer, 3, v), 3);
    assert_true(v[0] == 1.0 && v[1] == -25.0 && v[2] == 0.5);
    assert_int_equal(pbrt_lexer_numbers(&lexer, 8, v), 1);
    assert_true(v[0] == 7.0);
    assert_int_equal(pbrt_lexer_next(&lexer, &token), AG_OK);
    assert_int_equal(token.kind, PBRT_TOKEN_CLOSE);
    assert_int_equal(token.where.line, 2);
    assert_int_equal(token.where.column, 9);
    for (int i = 0; i < 3; i++) { /* what is no finite number is left for next */
        static const char *const WORDS[] = {"5x", "1e999", "-"};
        assert_int_equal(pbrt_lexer_numbers(&lexer, 8, v), 0);
        assert_int_equal(pbrt_lexer_next(&lexer, &token), AG_OK);
        assert_true(pbrt_token_is(&token, PBRT_TOKEN_WORD, WORDS[i]));
        assert_int_equal(pbrt_token_number(&token, v), i == 1);
        assert_true(i != 1 || isinf(v[0]));
    }
    pbrt_lexer_reset(&lexer);
}

static void excerpts_point_at_the_column(void **state)
{
    (void)state;
    const char *text = "one\n\ttwo three\r\nfour";
    char shown[300];
    pbrt_lexer lexer;
    pbrt_lexer_init(&lexer, "f", text, strlen(text));
    pbrt_lexer_excerpt(&lexer, (file_location){"f", 2, 6}, 5, shown, sizeof shown);
    assert_string_equal(shown, "\n     two three\n         ^~~~~");
    pbrt_lexer_excerpt(&lexer, (file_location){"f", 3, 5}, 1, shown, sizeof shown);
    assert_string_equal(shown, "\n    four\n        ^");
    pbrt_lexer_excerpt(&lexer, (file_location){"f", 9, 1}, 1, shown, sizeof shown);
    assert_string_equal(shown, "");
    char line[2001];
    memset(line, 'x', 2000);
    line[2000] = '\0';
    pbrt_lexer_init(&lexer, "f", line, 2000);
    pbrt_lexer_excerpt(&lexer, (file_location){"f", 1, 1500}, 2000, shown, sizeof shown);
    assert_true(strlen(shown) <= 2 * 105);
    assert_non_null(strchr(shown, '^'));
    pbrt_lexer_reset(&lexer);
}

static void check_decimal(const char *text)
{
    double value;
    const char *behind = decimal_parse(text, &value);
    if (!behind || *behind != '\0' || value != strtod(text, NULL))
        fail_msg("%s is read as %.17g", text, behind ? value : NAN);
}

/* The library rounds correctly; so must we. The tests run in the C locale. */
static void decimals_are_rounded_correctly(void **state)
{
    (void)state;
    static const char *const HARD[] = {"0",
                                       "-0",
                                       "1",
                                       ".5",
                                       "5.",
                                       "+3",
                                       "0.1",
                                       "0.30000000000000004",
                                       "9007199254740993",
                                       "9007199254740992.5",
                                       "9007199254740993.0000000000000000000000001",
                                       "1e22",
                                       "1e23",
                                       "8.5e22",
                                       "123456789012345678e5",
                                       "4.9e-324",
                                       "2.4703282292062327e-324",
                                       "2.4703282292062328e-324",
                                       "2.2250738585072011e-308",
                                       "1.7976931348623157e308",
                                       "1.7976931348623159e308",
                                       "1e400",
                                       "1e-400",
                                       "0.0000000000000000000000000000000000001e40",
                                       "9999999999999999999",
                                       "18446744073709551616",
                                       "1.00000000000000011102230246251565",
                                       "1.00000000000000011102230246251566e-3",
                                       "6929495644600919.5",
                                       "0e999999999999999999",
                                       "1e-99999999999999999999",
                                       "3.5184372088831999999e13"};
    for (size_t i = 0; i < sizeof HARD / sizeof *HARD; i++)
        check_decimal(HARD[i]);
    uint64_t random = 12345;
    for (int i = 0; i < 100000; i++) {
        char text[64];
        random = random * 6364136223846793005u + 1442695040888963407u;
        uint64_t digits = random >> (random >> 59);
        int exponent = (int)((random >> 20) % 50) - 25, point = (int)((random >> 30) % 20);
        char plain[32];
        int length = snprintf(plain, sizeof plain, "%llu", (unsigned long long)digits);
        point = point > length ? length : point;
        if (i % 2)
            snprintf(text, sizeof text, "%s%.*s.%se%d", i % 4 == 1 ? "-" : "", point, plain, plain + point, exponent);
        else
            snprintf(text, sizeof text, "%.*s.%s", point, plain, plain + point);
        check_decimal(text);
    }
}

static void half_way_decimals_are_rounded_correctly(void **state)
{
    (void)state;
    /* half way between two doubles, and one digit beside it: where double-double arithmetic must not guess */
    uint64_t random = 99;
    for (int i = 0; i < 20000; i++) {
        char text[64];
        random = random * 6364136223846793005u + 1442695040888963407u;
        uint64_t odd = (((uint64_t)1 << 53) + (random >> 12) % ((uint64_t)1 << 53)) | 1; /* 54 bits, the last set */
        snprintf(text, sizeof text, "%llu", (unsigned long long)(odd << (i % 6)));
        check_decimal(text);
        snprintf(text, sizeof text, "%llu.%d", (unsigned long long)odd, i % 10);
        check_decimal(text);
    }
}

static void what_is_no_decimal_is_refused(void **state)
{
    (void)state;
    static const char *const WRONG[] = {"", "-", "+", ".", "-.", "e5", ".e5", "nan", "inf", "--1", "x"};
    double value;
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++)
        assert_null(decimal_parse(WRONG[i], &value));
    static const char *const PARTLY[] = {"1e",    "1e+",   "0x10",
                                         "1.2.3", "1e5e5", "1-2"}; /* a number with more behind it */
    for (size_t i = 0; i < sizeof PARTLY / sizeof *PARTLY; i++) {
        const char *behind = decimal_parse(PARTLY[i], &value);
        assert_non_null(behind);
        assert_int_not_equal(*behind, '\0');
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tokens_have_locations),          cmocka_unit_test(blanks_and_comments_are_skipped),
        cmocka_unit_test(strings_have_escapes),           cmocka_unit_test(bad_text_is_refused),
        cmocka_unit_test(numbers_are_read_in_blocks),     cmocka_unit_test(excerpts_point_at_the_column),
        cmocka_unit_test(decimals_are_rounded_correctly), cmocka_unit_test(half_way_decimals_are_rounded_correctly),
        cmocka_unit_test(what_is_no_decimal_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

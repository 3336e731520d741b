/* test_log.c: messages arrive whole and one at a time, and once where once is asked; the texts of base.h.
 * Threads: assertions are the main thread's. */
#include "log.h"

#include "atomics.h"
#include "thread_pool.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <string.h>

/* Plain memory on purpose: two calls at once are a race that TSan sees. */
typedef struct heard {
    unsigned count, wrong_count;
    ag_log_level level;
    char message[4096];
} heard;

static void hear(void *user, ag_log_level level, const char *message)
{
    heard *h = user;
    h->count++;
    h->level = level;
    snprintf(h->message, sizeof h->message, "%s", message);
}

static void test_messages(void **state)
{
    (void)state;
    heard h = {.count = 0};
    log_sink *log = log_create(hear, &h);
    assert_non_null(log);
    log_message(log, AG_LOG_WARNING, "%s:%d: %s", "scene.pbrt", 7, "odd");
    assert_int_equal(h.count, 1);
    assert_int_equal(h.level, AG_LOG_WARNING);
    assert_string_equal(h.message, "scene.pbrt:7: odd");
    log_message(log, AG_LOG_DEBUG, "a line\nand another\r\n\n");
    assert_int_equal(h.level, AG_LOG_DEBUG);
    assert_string_equal(h.message, "a line\nand another");
    log_message(log, AG_LOG_INFO, "%s", "\n");
    assert_string_equal(h.message, "");
    /* what a terminal would obey, in ASCII and in UTF-8; other letters of two bytes stay */
    log_message(log, AG_LOG_INFO, "%s", "a\033[31m\tb\x7f\xc2\x9b\xc2\xa0\xc3\xa9\nd\001\xc2");
    assert_string_equal(h.message, "a?[31m b???\xc2\xa0\xc3\xa9\nd?\xc2");
    /* a byte that is a control character where it is no part of a letter: alone, behind one, of one cut short or in
     * more bytes than it needs */
    log_message(log, AG_LOG_INFO, "%s",
                "\x9b"
                "31m\xc3\xbc\x9b\xe2\x82\xac\x80\xf0\x9f\x98\x80\x9f\xe2\x82\xe0\x82\x9b\xa0\xe9");
    assert_string_equal(h.message, "?31m\xc3\xbc?\xe2\x82\xac?\xf0\x9f\x98\x80?\xe2?\xe0??\xa0\xe9");
    log_message(log, AG_LOG_INFO, "%s", "\xc4\x9b\xe2\x80\x9c\xc2"); /* letters that end with such a byte */
    assert_string_equal(h.message, "\xc4\x9b\xe2\x80\x9c\xc2");
    /* around the length up to which no memory is needed, and far beyond */
    static const int lengths[] = {510, 511, 512, 513, 4000};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        log_message(log, AG_LOG_ERROR, "%0*d", lengths[i], 9);
        assert_int_equal(strlen(h.message), lengths[i]);
        assert_int_equal(h.message[lengths[i] - 1], '9');
        assert_int_equal(strspn(h.message, "0"), lengths[i] - 1);
    }
    log_destroy(log);
}

static void test_nobody_listens(void **state)
{
    (void)state;
    log_message(NULL, AG_LOG_ERROR, "%d", 1);
    assert_false(log_once(NULL, AG_LOG_ERROR, "key", "%d", 1));
    log_destroy(NULL);
    log_sink *log = log_create(NULL, NULL);
    assert_non_null(log);
    log_message(log, AG_LOG_ERROR, "%d", 1);
    assert_false(log_once(log, AG_LOG_ERROR, "key", "%d", 1));
    log_destroy(log);
}

static void test_once_per_key(void **state)
{
    (void)state;
    heard h = {.count = 0};
    log_sink *log = log_create(hear, &h), *other = log_create(hear, &h);
    char key[16];
    for (int round = 0; round < 3; round++)
        for (unsigned i = 0; i < 500; i++) {
            snprintf(key, sizeof key, "%u", i * 7919u % 500u); /* in no sorted order, and the buffer is used again */
            assert_int_equal(log_once(log, AG_LOG_INFO, key, "key %s", key), round == 0);
        }
    assert_int_equal(h.count, 500);
    assert_true(log_once(log, AG_LOG_INFO, "", "an empty key is one too"));
    assert_false(log_once(log, AG_LOG_INFO, "", "an empty key is one too"));
    assert_true(log_once(other, AG_LOG_INFO, "1", "another sink, another memory"));
    assert_string_equal(h.message, "another sink, another memory");
    log_destroy(log);
    log_destroy(other);
}

typedef struct crowd {
    log_sink *log;
    atomic_u64 spoke_count;
} crowd;

static void expect_uniform(void *user, ag_log_level level, const char *message)
{
    (void)level;
    heard *h = user;
    h->count++;
    size_t length = strlen(message);
    char expected[2] = {message[0], '\0'};
    h->wrong_count += (length != 300 && length != 900) || strspn(message, expected) != length;
}

/* Each message repeats one letter, so that a mixture of two shows. */
static void speak_often(void *user, unsigned worker_index)
{
    crowd *c = user;
    char text[901];
    memset(text, 'a' + (int)worker_index, sizeof text);
    for (unsigned i = 0; i < 200; i++) {
        char key[16];
        snprintf(key, sizeof key, "%u", i);
        log_message(c->log, AG_LOG_INFO, "%.*s", i % 2 ? 300 : 900, text);
        if (log_once(c->log, AG_LOG_WARNING, key, "%.*s", 300, text))
            fetch_add_relaxed_u64(&c->spoke_count, 1);
    }
}

static void test_many_speakers(void **state)
{
    (void)state;
    heard h = {.count = 0};
    crowd c = {.log = log_create(expect_uniform, &h)};
    thread_pool *pool = NULL;
    assert_int_equal(thread_pool_create(8, &pool), AG_OK);
    thread_pool_run(pool, speak_often, &c);
    thread_pool_destroy(pool);
    assert_int_equal(load_relaxed_u64(&c.spoke_count), 200);
    assert_int_equal(h.count, 8 * 200 + 200);
    assert_int_equal(h.wrong_count, 0);
    log_destroy(c.log);
}

static void test_texts(void **state)
{
    (void)state;
    assert_string_equal(ag_status_text(AG_OK), "success");
    assert_string_equal(ag_status_text(AG_CANCELLED), "cancelled");
    for (int i = AG_OK; i <= AG_PAUSED; i++)
        for (int j = AG_OK; j < i; j++)
            assert_string_not_equal(ag_status_text((ag_status)i), ag_status_text((ag_status)j));
    assert_string_equal(ag_status_text((ag_status)(AG_PAUSED + 1)), "unknown status");
    assert_string_equal(ag_phase_name(AG_PHASE_LOAD), "load");
    assert_string_equal(ag_phase_name(AG_PHASE_WRITE), "write");
    assert_string_equal(ag_phase_name(AG_PHASE_COUNT), "unknown phase");
    int major = -1, minor = -1, patch = -1, length = 0;
    assert_int_equal(sscanf(ag_version(), "%d.%d.%d%n", &major, &minor, &patch, &length), 3);
    assert_int_equal(length, strlen(ag_version()));
    assert_true(major >= 0 && minor >= 0 && patch >= 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_messages),     cmocka_unit_test(test_nobody_listens),
        cmocka_unit_test(test_once_per_key), cmocka_unit_test(test_many_speakers),
        cmocka_unit_test(test_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* log.c: see log.h.
 * Flow: every part speaks through it; the program's callback decides what becomes of a message.
 * Threads: any; one mutex serialises the callback and protects the set of keys. */
#define _GNU_SOURCE
#include "log.h"

#include "utf8.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct log_sink {
    ag_log_fn *fn;
    void *user;
    pthread_mutex_t mutex;
    char **keys; /* that have spoken, sorted; owned */
    size_t key_count, key_capacity;
};

log_sink *log_create(ag_log_fn *fn, void *user)
{
    log_sink *log = calloc(1, sizeof *log);
    if (!log)
        return NULL;
    log->fn = fn;
    log->user = user;
    pthread_mutex_init(&log->mutex, NULL);
    return log;
}

void log_destroy(log_sink *log)
{
    if (!log)
        return;
    for (size_t i = 0; i < log->key_count; i++)
        free(log->keys[i]);
    free(log->keys);
    pthread_mutex_destroy(&log->mutex);
    free(log);
}

ag_log_fn *log_silence(log_sink *log)
{
    ag_log_fn *fn = log->fn;
    log->fn = NULL;
    return fn;
}

void log_speak(log_sink *log, ag_log_fn *fn) { log->fn = fn; }

static bool is_silent(const log_sink *log) { return !log || !log->fn; }

static bool is_upper_control(unsigned char c) { return c >= 0x80 && c < 0xa0; }

/* Names in a stranger's file may hold control characters that a terminal obeys: those of ASCII and of Latin-1, the
 * latter as single bytes or as UTF-8, which begins with 0xc2. Line ends stay, since messages have several lines. */
static void replace_controls(char *message)
{
    int size;
    for (unsigned char *c = (unsigned char *)message; *c; c += size > 0 ? size : 1) {
        size = utf8_character_size((const char *)c);
        if (*c == '\t')
            *c = ' ';
        else if ((*c < ' ' && *c != '\n') || *c == 0x7f || (size == 0 && is_upper_control(*c)))
            *c = '?';
        else if (size == 2 && c[0] == 0xc2 && is_upper_control(c[1]))
            c[0] = c[1] = '?';
    }
}

static void speak(log_sink *log, ag_log_level level, char *message, size_t length)
{
    while (length > 0 && (message[length - 1] == '\n' || message[length - 1] == '\r'))
        message[--length] = '\0';
    replace_controls(message);
    pthread_mutex_lock(&log->mutex);
    log->fn(log->user, level, message);
    pthread_mutex_unlock(&log->mutex);
}

/* Formats outside the mutex. A message that does not fit the stack goes to the heap; without memory it is cut. */
AG_PRINTF(3, 0) static void format_and_speak(log_sink *log, ag_log_level level, const char *format, va_list arguments)
{
    char small[512];
    va_list again;
    va_copy(again, arguments);
    int needed = vsnprintf(small, sizeof small, format, arguments);
    if (needed < 0) {
        /* a wide character cannot be converted: the message without its arguments is still better than none */
        snprintf(small, sizeof small, "%s", format);
        speak(log, level, small, strlen(small));
    } else if ((size_t)needed < sizeof small) {
        speak(log, level, small, (size_t)needed);
    } else {
        size_t size = (size_t)needed + 1;
        char *large = malloc(size);
        if (large)
            vsnprintf(large, size, format, again);
        speak(log, level, large ? large : small, large ? (size_t)needed : sizeof small - 1);
        free(large);
    }
    va_end(again);
}

void log_message(log_sink *log, ag_log_level level, const char *format, ...)
{
    if (is_silent(log))
        return;
    va_list arguments;
    va_start(arguments, format);
    format_and_speak(log, level, format, arguments);
    va_end(arguments);
}

/* Returns whether the key is new. Without memory to remember it, it counts as new, since a message twice is better than
 * none. */
static bool remember_key(log_sink *log, const char *key)
{
    size_t low = 0, high = log->key_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        int order = strcmp(log->keys[middle], key);
        if (order == 0)
            return false;
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    if (log->key_count == log->key_capacity) {
        size_t capacity = log->key_capacity ? 2 * log->key_capacity : 16;
        char **keys = realloc(log->keys, capacity * sizeof *keys);
        if (!keys)
            return true;
        log->keys = keys;
        log->key_capacity = capacity;
    }
    char *copy = strdup(key);
    if (!copy)
        return true;
    memmove(log->keys + low + 1, log->keys + low, (log->key_count - low) * sizeof *log->keys);
    log->keys[low] = copy;
    log->key_count++;
    return true;
}

bool log_once(log_sink *log, ag_log_level level, const char *key, const char *format, ...)
{
    if (is_silent(log))
        return false;
    pthread_mutex_lock(&log->mutex);
    bool is_new = remember_key(log, key);
    pthread_mutex_unlock(&log->mutex);
    if (!is_new)
        return false;
    va_list arguments;
    va_start(arguments, format);
    format_and_speak(log, level, format, arguments);
    va_end(arguments);
    return true;
}

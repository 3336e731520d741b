/* fuzz_driver.c: runs a fuzz target without libFuzzer: every seed as it is, then a fixed number of inputs made of the
 * seeds by chance, the same ones each time. What goes wrong is kept in a file of the working folder.
 * Use: TARGET [--count=N] [--first=N] [--dictionary=FILE] [--keep=FOLDER] [--write=FILE] SEED...
 *      (files and folders of files). --first=N --count=1 --write=FILE: the one input that was number N, kept.
 * Threads: one. */
#define _XOPEN_SOURCE 700
#include "fuzz.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

enum { INPUT_MAX = 1 << 16, PATIENCE_SECONDS = 120 };

typedef struct bytes {
    uint8_t *data; /* owned */
    size_t size;
} bytes;

typedef struct byte_lists {
    bytes *items;
    size_t count;
} byte_lists;

/* ---- chance ---- */

static uint64_t state;

/* Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014: SplitMix64. */
static uint64_t next_random(void)
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static size_t below(size_t n) { return n ? (size_t)(next_random() % n) : 0; }

/* ---- what is there to begin with ---- */

static void add(byte_lists *lists, const void *data, size_t size)
{
    lists->items = realloc(lists->items, (lists->count + 1) * sizeof *lists->items);
    FUZZ_CHECK(lists->items);
    bytes *item = &lists->items[lists->count++];
    item->data = malloc(size + 1);
    FUZZ_CHECK(item->data);
    memcpy(item->data, data, size);
    item->size = size;
}

static void reset(byte_lists *lists)
{
    for (size_t i = 0; i < lists->count; i++)
        free(lists->items[i].data);
    free(lists->items);
}

static int compare_names(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

/* Files larger than an input may be are passed over. */
static void add_seeds(byte_lists *seeds, const char *path)
{
    static uint8_t buffer[INPUT_MAX + 1];
    struct dirent **entries;
    int count = scandir(path, &entries, NULL, compare_names);
    if (count >= 0) {
        for (int i = 0; i < count; i++) {
            char inner[4096];
            snprintf(inner, sizeof inner, "%s/%s", path, entries[i]->d_name);
            if (entries[i]->d_name[0] != '.')
                add_seeds(seeds, inner);
            free(entries[i]);
        }
        free(entries);
        return;
    }
    FILE *file = fopen(path, "rb");
    if (!file) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(2);
    }
    size_t size = fread(buffer, 1, sizeof buffer, file);
    fclose(file);
    if (size <= INPUT_MAX)
        add(seeds, buffer, size);
}

/* libFuzzer's form: NAME="TEXT" or "TEXT", a line each; \\, \" and \xNN in the text. */
static void read_dictionary(byte_lists *words, const char *path)
{
    char line[512];
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(2);
    }
    while (fgets(line, sizeof line, file)) {
        char word[512];
        size_t size = 0;
        const char *p = strchr(line, '"');
        if (line[0] == '#' || !p)
            continue;
        for (p++; *p && *p != '"'; p++) {
            unsigned value;
            if (p[0] == '\\' && p[1] == 'x' && sscanf(p + 2, "%2x", &value) == 1) {
                word[size++] = (char)value;
                p += 3;
            } else {
                p += p[0] == '\\';
                word[size++] = *p;
            }
        }
        add(words, word, size);
    }
    fclose(file);
}

/* ---- changes ---- */

static uint8_t input[INPUT_MAX];
static size_t input_size;

/* Puts size bytes instead of removed ones; what does not fit is cut off. */
static void replace(size_t at, size_t removed, const void *data, size_t size)
{
    if (at > input_size)
        at = input_size;
    if (removed > input_size - at)
        removed = input_size - at;
    if (size > INPUT_MAX - at)
        size = INPUT_MAX - at;
    size_t behind = input_size - at - removed;
    if (behind > INPUT_MAX - at - size)
        behind = INPUT_MAX - at - size;
    memmove(input + at + size, input + at + removed, behind);
    memcpy(input + at, data, size);
    input_size = at + size + behind;
}

static bool is_blank(uint8_t c) { return c <= ' ' || c == '[' || c == ']' || c == '"' || c == ',' || c == ':'; }

/* A word of the text, at or behind some position. */
static void find_word(size_t *out_at, size_t *out_size)
{
    size_t at = below(input_size);
    while (at > 0 && !is_blank(input[at - 1]))
        at--;
    while (at < input_size && is_blank(input[at]))
        at++;
    size_t end = at;
    while (end < input_size && !is_blank(input[end]) && end - at < 64)
        end++;
    *out_at = at;
    *out_size = end - at;
}

static const char *const NUMBERS[] = {"0",          "-0",         "1",       "-1",    "2",    "3",   "0.5",
                                      "1e-30",      "1e30",       "-1e9",    "1e38",  "1e39", "nan", "1e308",
                                      "2147483647", "4294967296", "-5",      "1e-3",  "100",  "7",   "1e18",
                                      "inf",        "16",         "-0.0001", "1e400", "65536"};

static void change_once(const byte_lists *seeds, const byte_lists *words)
{
    static const uint32_t WHOLE[] = {0,          1,          0xff,       0x7f,       0x80,
                                     0xffff,     0x7fff,     0x7fffffff, 0x80000000, 0xffffffff,
                                     0x10000000, 0x3f800000, 0x7f800000, 0x7fc00000};
    uint8_t copy[256];
    size_t at = below(input_size), size, other, other_size;
    switch (below(13)) {
    case 0: /* one bit */
        if (input_size > 0)
            input[at] ^= (uint8_t)(1u << below(8));
        break;
    case 1: /* one byte */
        if (input_size > 0)
            input[at] = (uint8_t)next_random();
        break;
    case 2: /* a part is gone */ replace(at, 1 + below(below(2) ? 8 : 200), "", 0); break;
    case 3: /* a part comes twice */
        size = 1 + below(sizeof copy - 1);
        if (size > input_size - at)
            size = input_size - at;
        memcpy(copy, input + at, size);
        replace(below(input_size), 0, copy, size);
        break;
    case 4: /* a word of the language is there too */
    case 5: /* ... or stands for another */
        if (words->count > 0) {
            const bytes *word = &words->items[below(words->count)];
            find_word(&at, &size);
            replace(at, below(2) ? size : 0, word->data, word->size);
        }
        break;
    case 6:
    case 7: { /* a number instead of a word that begins as one */
        const char *number = NUMBERS[below(sizeof NUMBERS / sizeof *NUMBERS)];
        for (int i = 0; i < 8; i++) {
            find_word(&at, &size);
            if (size > 0 && (input[at] == '-' || input[at] == '.' || (input[at] >= '0' && input[at] <= '9')))
                break;
        }
        replace(at, size, number, strlen(number));
        break;
    }
    case 8: { /* from one seed into another */
        const bytes *seed = &seeds->items[below(seeds->count)];
        other = below(seed->size);
        replace(at, below(2) ? input_size : 0, seed->data + other, below(seed->size - other + 1));
        break;
    }
    case 9: /* cut short */ input_size = below(2) ? at : input_size - below(input_size < 8 ? input_size : 8); break;
    case 10: /* a word in another's position */
        find_word(&at, &size);
        if (size > sizeof copy)
            size = sizeof copy;
        memcpy(copy, input + at, size);
        find_word(&other, &other_size);
        replace(other, other_size, copy, size);
        break;
    default: { /* a whole number of 1, 2 or 4 bytes, either end first */
        uint32_t value = WHOLE[below(sizeof WHOLE / sizeof *WHOLE)];
        uint8_t raw[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16), (uint8_t)(value >> 24)};
        size = (size_t)1 << below(3);
        if (below(2))
            for (size_t i = 0; i < size / 2; i++) {
                uint8_t t = raw[i];
                raw[i] = raw[size - 1 - i];
                raw[size - 1 - i] = t;
            }
        replace(at, size, raw, size);
        break;
    }
    }
}

/* The number says all: each input can be made again alone. */
static void make_input(const byte_lists *seeds, const byte_lists *words, unsigned long number)
{
    const bytes *seed = &seeds->items[number % seeds->count];
    memcpy(input, seed->data, seed->size);
    input_size = seed->size;
    if (number < seeds->count)
        return;
    state = number * 0xd1342543de82ef95u;
    for (size_t changes = 1 + below(below(4) ? 3 : 20); changes > 0; changes--)
        change_once(seeds, words);
}

/* ---- when it goes wrong ---- */

static char kept_path[4096];
static unsigned long current_number;

/* Called when all may be broken: nothing but system calls. */
static void keep_input(void)
{
    static const char SAYS[] = "the input is kept in ";
    int file = open(kept_path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || write(file, input, input_size) != (ssize_t)input_size || write(2, SAYS, sizeof SAYS - 1) < 0 ||
        write(2, kept_path, strlen(kept_path)) < 0 || write(2, "\n", 1) < 0)
        return;
    close(file);
}

static void on_signal(int number)
{
    static const char SAYS[] = "the target hangs\n";
    if (number == SIGALRM && write(2, SAYS, sizeof SAYS - 1) < 0)
        _exit(1);
    keep_input();
    signal(number, SIG_DFL);
    raise(number);
}

void __sanitizer_set_death_callback(void (*callback)(void)) __attribute__((weak));

static void watch(const char *keep_folder, const char *target)
{
    char *folder = realpath(keep_folder, NULL);
    const char *slash = strrchr(target, '/');
    FUZZ_CHECK(folder);
    snprintf(kept_path, sizeof kept_path, "%.3000s/%.200s.finding", folder, slash ? slash + 1 : target);
    free(folder);
    signal(SIGALRM, on_signal);
    signal(SIGABRT, on_signal);
    if (__sanitizer_set_death_callback) {
        __sanitizer_set_death_callback(keep_input);
        return; /* it says more of these than we could; and its shadow needs the whole address space */
    }
    signal(SIGSEGV, on_signal);
    signal(SIGFPE, on_signal);
    const struct rlimit memory = {(rlim_t)3 << 30, (rlim_t)3 << 30};
    FUZZ_CHECK(setrlimit(RLIMIT_AS, &memory) == 0);
}

int main(int argc, char **argv)
{
    byte_lists seeds = {0}, words = {0};
    unsigned long first = 0, count = 1000;
    const char *keep = ".", *written = NULL;
    for (int i = 1; i < argc; i++) {
        if (strncmp(argv[i], "--count=", 8) == 0)
            count = strtoul(argv[i] + 8, NULL, 10);
        else if (strncmp(argv[i], "--first=", 8) == 0)
            first = strtoul(argv[i] + 8, NULL, 10);
        else if (strncmp(argv[i], "--dictionary=", 13) == 0)
            read_dictionary(&words, argv[i] + 13);
        else if (strncmp(argv[i], "--keep=", 7) == 0)
            keep = argv[i] + 7;
        else if (strncmp(argv[i], "--write=", 8) == 0)
            written = argv[i] + 8;
        else
            add_seeds(&seeds, argv[i]);
    }
    if (seeds.count == 0) {
        fprintf(stderr, "there are no seeds\n");
        return 2;
    }
    watch(keep, argv[0]);
    if (first == 0)
        count += seeds.count;
    for (current_number = first; current_number < first + count; current_number++) {
        make_input(&seeds, &words, current_number);
        if (written) {
            FILE *file = fopen(written, "wb");
            FUZZ_CHECK(file && fwrite(input, 1, input_size, file) == input_size && fclose(file) == 0);
        }
        alarm(PATIENCE_SECONDS);
        /* its own block, so that reading past its end is seen */
        uint8_t *exact = malloc(input_size ? input_size : 1);
        FUZZ_CHECK(exact);
        memcpy(exact, input, input_size);
        LLVMFuzzerTestOneInput(exact, input_size);
        free(exact);
    }
    alarm(0);
    printf("%zu seeds, %lu inputs: none does harm\n", seeds.count, count);
    reset(&seeds);
    reset(&words);
    return 0;
}

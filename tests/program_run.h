/* program_run.h: the program run as its users run it: started with arguments in a folder of its own, then asked for its
 * exit code, what it said, its pictures and its statistics. For the tests of the whole program.
 * Flow: $AFTERGLOW_PROGRAM -> [here] -> tests/test_program_*.c. Threads: one. */
#ifndef AFTERGLOW_PROGRAM_RUN_H
#define AFTERGLOW_PROGRAM_RUN_H

#include "temporary_folder.h"

#include <fcntl.h>
#include <grp.h>
#include <jansson.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>

#define PROGRAM_SCENES AG_SOURCE_DIR "/tests/scenes/"
/* How long a program may take before it counts as hung: no test looks at a shorter time. */
enum { PROGRAM_PATIENCE_SECONDS = 300, PROGRAM_ARGUMENTS_MAX = 64, PROGRAM_NOBODY = 65534 };

/* What is unusual about a run; all zero: nothing is. */
typedef struct program_setting {
    const char *input;      /* a file to be standard input; NULL: /dev/null */
    const char *output;     /* a file to be standard output; NULL: it is caught */
    const char *ocio;       /* $OCIO; NULL: not set */
    rlim_t file_size_limit; /* bytes; 0: none */
    bool is_nobody;         /* where the tests run as root, for whom no folder is closed */
} program_setting;

/* A program that runs. */
typedef struct program_process {
    pid_t id;
    FILE *out, *err;
} program_process;

/* A program that has ended. */
typedef struct program_run {
    int exit_code;   /* -1: a signal ended it */
    int signal;      /* that one, or 0 */
    char *out, *err; /* owned */
} program_run;

static inline const char *program_path(void)
{
    const char *path = getenv("AFTERGLOW_PROGRAM");
    if (!path || access(path, X_OK) != 0)
        fail_msg("AFTERGLOW_PROGRAM does not name the program: %s", path ? path : "not set");
    return path;
}

static inline void program_become(const char *path, const char *const *arguments, const program_setting *setting,
                                  const program_process *process)
{
    int input = open(setting->input ? setting->input : "/dev/null", O_RDONLY);
    int output = setting->output ? open(setting->output, O_WRONLY) : fileno(process->out);
    if (input < 0 || output < 0 || dup2(input, 0) < 0 || dup2(output, 1) < 0 || dup2(fileno(process->err), 2) < 0)
        _exit(126);
    if (chdir(folder) != 0)
        _exit(126);
    if (setting->ocio)
        setenv("OCIO", setting->ocio, 1);
    else
        unsetenv("OCIO");
    if (setting->file_size_limit) {
        const struct rlimit limit = {setting->file_size_limit, setting->file_size_limit};
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0)
            _exit(126);
    }
    if (setting->is_nobody && geteuid() == 0 &&
        (setgroups(0, NULL) != 0 || setgid(PROGRAM_NOBODY) != 0 || setuid(PROGRAM_NOBODY) != 0))
        _exit(126);
    /* The leak check at the end of a run can crash on the thread-local storage of threads that are just ending. */
    const char *asan = getenv("ASAN_OPTIONS");
    char with[1024];
    snprintf(with, sizeof with, "%s%sintercept_tls_get_addr=0", asan ? asan : "", asan && *asan ? ":" : "");
    setenv("ASAN_OPTIONS", with, 1);
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    execv(path, (char *const *)(uintptr_t)arguments); /* execv changes nothing there */
    _exit(127);
}

/* Starts it in the folder of the test; arguments end with NULL and begin behind the program's name. */
static inline program_process program_start(const program_setting *setting, const char *const *arguments)
{
    const char *path = program_path(), *all[PROGRAM_ARGUMENTS_MAX + 2] = {path};
    for (int i = 0; arguments[i]; i++) {
        assert_true(i < PROGRAM_ARGUMENTS_MAX);
        all[i + 1] = arguments[i];
    }
    program_process process = {.out = tmpfile(), .err = tmpfile()};
    assert_non_null(process.out);
    assert_non_null(process.err);
    process.id = fork();
    assert_true(process.id >= 0);
    if (process.id == 0)
        program_become(path, all, setting, &process);
    return process;
}

/* What has been written so far; the caller's to free. The file's position, which the program may share, stays. */
static inline char *program_said(FILE *file)
{
    struct stat info;
    assert_int_equal(fstat(fileno(file), &info), 0);
    char *text = calloc(1, (size_t)info.st_size + 1);
    assert_non_null(text);
    size_t length = 0;
    ssize_t got;
    while (length < (size_t)info.st_size &&
           (got = pread(fileno(file), text + length, (size_t)info.st_size - length, (off_t)length)) > 0)
        length += (size_t)got;
    return text;
}

static inline void program_pause(void)
{
    const struct timespec millisecond = {0, 1000000};
    nanosleep(&millisecond, NULL);
}

/* Waits until it has said something on standard error; fails when it ends before. */
static inline void program_wait_for(const program_process *process, const char *text)
{
    bool has_ended = false;
    for (;;) {
        char *said = program_said(process->err);
        bool is_there = strstr(said, text) != NULL;
        if (!is_there && has_ended)
            fail_msg("'%s' was never said, but: %s", text, said);
        free(said);
        if (is_there)
            return;
        siginfo_t info = {0};
        assert_int_equal(waitid(P_PID, (id_t)process->id, &info, WEXITED | WNOHANG | WNOWAIT), 0);
        has_ended = info.si_pid == process->id;
        program_pause();
    }
}

static inline program_run program_finish(program_process *process)
{
    int status;
    pid_t ended = 0;
    for (long i = 0; i < PROGRAM_PATIENCE_SECONDS * 1000L && ended == 0; i++) {
        ended = waitpid(process->id, &status, WNOHANG);
        if (ended == 0)
            program_pause();
    }
    if (ended == 0) {
        kill(process->id, SIGKILL);
        waitpid(process->id, &status, 0);
        fail_msg("the program has not ended");
    }
    assert_int_equal(ended, process->id);
    program_run run = {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
                       .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                       .out = program_said(process->out),
                       .err = program_said(process->err)};
    fclose(process->out);
    fclose(process->err);
    return run;
}

static inline void program_run_reset(program_run *run)
{
    free(run->out);
    free(run->err);
    *run = (program_run){0};
}

static inline program_run program_execute(const program_setting *setting, const char *const *arguments)
{
    const program_setting usual = {0};
    program_process process = program_start(setting ? setting : &usual, arguments);
    return program_finish(&process);
}

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define RUN(...)       program_execute(NULL, ARGUMENTS(__VA_ARGS__))

/* Ends with this code; what was said is shown where not. */
static inline void expect_exit(const program_run *run, int code)
{
    if (run->exit_code != code)
        fail_msg("exit code %d, signal %d instead of %d; it said: %s%s", run->exit_code, run->signal, code, run->out,
                 run->err);
}

static inline void expect_said(const program_run *run, const char *text)
{
    if (!strstr(run->err, text))
        fail_msg("'%s' is not in: %s", text, run->err);
}

/* A copy of a scene of tests/scenes in the folder, its texts replaced: pairs of old and new, ended by NULL. Each old
 * text is there. Gives the path, which stays valid for four further calls. */
static inline const char *scene_with(const char *name, const char *const *replacements)
{
    char original[512];
    snprintf(original, sizeof original, PROGRAM_SCENES "%s", name);
    size_t size;
    char *text = (char *)read_bytes(original, &size);
    for (int i = 0; replacements[i]; i += 2) {
        const char *old = replacements[i], *new = replacements[i + 1];
        char *at = strstr(text, old);
        if (!at)
            fail_msg("'%s' is not in %s", old, name);
        char *changed = malloc(strlen(text) + strlen(new) + 1);
        assert_non_null(changed);
        sprintf(changed, "%.*s%s%s", (int)(at - text), text, new, at + strlen(old));
        free(text);
        text = changed;
    }
    const char *path = in_folder(name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    free(text);
    return path;
}

#define SCENE_WITH(name, ...) scene_with(name, ARGUMENTS(__VA_ARGS__))

static inline const char *write_text(const char *name, const char *text)
{
    const char *path = in_folder(name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    return path;
}

static inline int compare_names(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* What is in the folder of the test: names in order, a blank between. */
static inline void expect_listing(const char *expected)
{
    enum { NAMES_MAX = 64 };
    char *names[NAMES_MAX], listing[2048] = "";
    int count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (const struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            assert_true(count < NAMES_MAX);
            names[count] = strdup(entry->d_name);
            assert_non_null(names[count++]);
        }
    closedir(directory);
    qsort(names, (size_t)count, sizeof *names, compare_names);
    for (int i = 0; i < count; i++) {
        size_t length = strlen(listing);
        snprintf(listing + length, sizeof listing - length, "%s%s", i > 0 ? " " : "", names[i]);
        free(names[i]);
    }
    assert_string_equal(listing, expected);
}

/* Statistics: a path of keys, "irradiance.computed". */
static inline json_t *stats_read(const char *path)
{
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error);
    if (!root)
        fail_msg("%s: %s", path, error.text);
    return root;
}

static inline const json_t *stats_find(const json_t *root, const char *keys)
{
    char key[64];
    const json_t *at = root;
    const char *rest = keys;
    while (at && *rest) {
        size_t length = strcspn(rest, ".");
        assert_true(length < sizeof key);
        snprintf(key, sizeof key, "%.*s", (int)length, rest);
        at = json_object_get(at, key);
        rest += length + (rest[length] == '.');
    }
    if (!at)
        fail_msg("the statistics have no %s", keys);
    return at;
}

static inline long long stats_integer(const json_t *root, const char *keys)
{
    const json_t *value = stats_find(root, keys);
    if (!json_is_integer(value))
        fail_msg("%s is not an integer", keys);
    return json_integer_value(value);
}

#endif

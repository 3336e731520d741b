/* test_import_process.c: the process's answer comes back whole; however it ends, that is an error and no more. */
#define _GNU_SOURCE
#include "fixtures/sanitizer.h"
#include "model/import_process.h"
#include "model/import_worker.h"

#include "fixtures/temporary_folder.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>

enum { ANSWER_BYTES = 5000000, MEMORY_BYTES = 100000000 };

/* The work of the process, by its name: this test's program, started anew. */
typedef bool task(int number, FILE *answer);

static bool answer_much(int number, FILE *answer)
{
    for (int k = 0; k < ANSWER_BYTES; k++)
        putc((k * 7 + number) & 0xff, answer);
    return true;
}

static bool crash(int number, FILE *answer)
{
    (void)answer;
#if IS_SANITIZED /* whose handlers these are */
    if (number == SIGSEGV || number == SIGABRT)
        signal(number, SIG_DFL);
#endif
    raise(number);
    return true;
}
static bool fail_quietly(int number, FILE *answer)
{
    (void)number, (void)answer;
    return false;
}
static bool say_nothing(int number, FILE *answer)
{
    printf("this goes nowhere");
    fflush(stdout);
    (void)number, (void)answer;
    return true;
}
static bool leave(int number, FILE *answer)
{
    (void)answer;
    _exit(number);
}

static bool take_memory(int number, FILE *answer)
{
    (void)number;
    /* never touched; volatile, or a compiler sees that nobody needs them */
    void *volatile half = malloc(MEMORY_BYTES / 2), *volatile whole = malloc(MEMORY_BYTES);
    fprintf(answer, "%s %s", half ? "half" : "none", whole ? "whole" : "no more");
    free(half);
    free(whole);
    return true;
}

/* How many are open. */
static bool count_descriptors(int number, FILE *answer)
{
    int count = 0;
    (void)number;
    for (int k = 0; k < 1000; k++)
        count += fcntl(k, F_GETFD) != -1;
    putc(count, answer);
    return true;
}

static bool never_end(int number, FILE *answer)
{
    (void)number, (void)answer;
    while (pause() != 0)
        continue;
    return true;
}

/* A process of its group, which says that it is there, and neither ends. */
static bool have_a_child(int number, FILE *answer)
{
    (void)number, (void)answer;
    const int told = open(getenv("CHILD_TELLS"), O_WRONLY);
    const pid_t child = fork();
    if (child == 0 && write(told, &(pid_t){getpid()}, sizeof child) != (ssize_t)sizeof child)
        _exit(1);
    if (child != 0)
        close(told);
    return never_end(number, answer);
}

static const struct {
    const char *name;
    task *run;
} TASKS[] = {
    {"answer", answer_much}, {"crash", crash},        {"fail", fail_quietly}, {"silence", say_nothing},
    {"leave", leave},        {"memory", take_memory}, {"forever", never_end}, {"descriptors", count_descriptors},
    {"child", have_a_child}};

/* The other side: this program's main, started by import_process_run. */
static int work(char **arguments)
{
    FILE *answer = import_worker_begin(MEMORY_BYTES);
    for (size_t k = 0; answer && k < sizeof TASKS / sizeof *TASKS; k++)
        if (strcmp(TASKS[k].name, arguments[1]) == 0)
            import_worker_end(answer, TASKS[k].run(atoi(arguments[2]), answer));
    return 1;
}

static ag_status run_task(const run_context *run, const char *name, int number, import_answer *out_answer,
                          char *out_message, size_t message_size)
{
    char text[16];
    snprintf(text, sizeof text, "%d", number);
    const char *const arguments[] = {"test_import_process", name, text, NULL};
    return import_process_run(run, "/proc/self/exe", arguments, out_answer, out_message, message_size);
}

static void answers_come_back_whole(void **state)
{
    (void)state;
    import_answer answer;
    assert_int_equal(run_task(NULL, "answer", 3, &answer, message, sizeof message), AG_OK);
    assert_int_equal(answer.size, ANSWER_BYTES);
    for (int k = 0; k < ANSWER_BYTES; k++)
        assert_true(answer.bytes[k] == ((k * 7 + 3) & 0xff));
    import_answer_reset(&answer);
    assert_null(answer.bytes);
}

static void expect_error(const char *name, int number, const char *text)
{
    import_answer answer;
    ag_status status = run_task(NULL, name, number, &answer, message, sizeof message);
    expect_failure(status, AG_ERROR_INPUT, text);
    assert_null(answer.bytes);
}

static void any_end_is_an_error(void **state)
{
    (void)state;
    expect_error("crash", SIGSEGV, "the importing process was ended by signal 11 (Segmentation fault)");
    expect_error("crash", SIGABRT, "was ended by signal 6 (Aborted)");
    expect_error("crash", SIGKILL, "was ended by signal 9 (Killed)");
    expect_error("fail", 0, "the importing process failed");
    expect_error("leave", 3, "the importing process failed");
    expect_error("silence", 0, "the importing process has answered nothing");
    expect_error("leave", 0, "the importing process has answered nothing");
}

/* Handlers and masks of the caller do not reach there. */
static void ignore(int number) { (void)number; }

static void signals_have_their_default_actions(void **state)
{
    (void)state;
    struct sigaction ours = {.sa_handler = ignore}, before;
    sigset_t mask, mask_before;
    sigaction(SIGTERM, &ours, &before);
    sigemptyset(&mask);
    sigaddset(&mask, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &mask, &mask_before);
    expect_error("crash", SIGTERM, "was ended by signal 15 (Terminated)");
    sigset_t now;
    pthread_sigmask(SIG_SETMASK, &mask_before, &now);
    assert_true(sigismember(&now, SIGTERM)); /* signals of this process are as they were */
    sigaction(SIGTERM, &before, NULL);
}

#if !IS_SANITIZED
static void memory_is_limited(void **state)
{
    (void)state;
    import_answer answer;
    assert_int_equal(run_task(NULL, "memory", 0, &answer, message, sizeof message), AG_OK);
    assert_int_equal(answer.size, strlen("half no more"));
    assert_memory_equal(answer.bytes, "half no more", answer.size);
    import_answer_reset(&answer);
}
#endif

static void *cancel(void *user)
{
    run_cancel(user);
    return NULL;
}

static void cancelling_ends_it(void **state)
{
    (void)state;
    import_answer answer;
    run_context run;
    pthread_t thread;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    assert_int_equal(pthread_create(&thread, NULL, cancel, &run), 0);
    assert_int_equal(run_task(&run, "forever", 0, &answer, message, sizeof message), AG_CANCELLED);
    pthread_join(thread, NULL);
    run_context_reset(&run);
}

/* Cancels when the child is there. */
typedef struct child_cancel {
    run_context run;
    int told;
    pid_t child;
} child_cancel;

static void *cancel_with_child(void *user)
{
    child_cancel *c = user;
    struct pollfd waiting = {.fd = c->told, .events = POLLIN};
    if (poll(&waiting, 1, 60000) != 1 || read(c->told, &c->child, sizeof c->child) != (ssize_t)sizeof c->child)
        c->child = 0;
    run_cancel(&c->run);
    return NULL;
}

static void cancelling_ends_its_children(void **state)
{
    (void)state;
    import_answer answer;
    child_cancel c = {.child = 0};
    pthread_t thread;
    run_context_init(&c.run, NULL, NULL, NULL, NULL);
    assert_int_equal(mkfifo(in_folder("told"), 0600), 0);
    c.told = open(in_folder("told"), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    assert_true(c.told >= 0);
    assert_int_equal(setenv("CHILD_TELLS", in_folder("told"), 1), 0);
    assert_int_equal(pthread_create(&thread, NULL, cancel_with_child, &c), 0);
    assert_int_equal(run_task(&c.run, "child", 0, &answer, message, sizeof message), AG_CANCELLED);
    pthread_join(thread, NULL);
    assert_true(c.child > 0);
    struct pollfd waiting = {.fd = c.told}; /* nobody has its other end when the child has ended */
    const int ended = poll(&waiting, 1, 10000);
    if (ended != 1)
        kill(c.child, SIGKILL);
    assert_int_equal(ended, 1);
    close(c.told);
    run_context_reset(&c.run);
}

/* Where the caller has ended before the process could ask to be ended with it, the task is not begun. */
static void nothing_is_done_for_a_caller_that_is_gone(void **state)
{
    (void)state;
    for (int is_gone = 0; is_gone < 2; is_gone++) {
        int ends[2], how;
        assert_int_equal(pipe2(ends, O_CLOEXEC), 0);
        if (is_gone)
            close(ends[0]);
        const pid_t id = fork();
        if (id == 0) {
            const int answer = fcntl(open("/dev/null", O_WRONLY), F_DUPFD, 10), end = fcntl(ends[1], F_DUPFD, 10);
            dup2(answer, IMPORT_ANSWER_DESCRIPTOR);
            dup2(end, IMPORT_END_DESCRIPTOR);
            execl("/proc/self/exe", "test_import_process", "leave", "7", (char *)NULL);
            _exit(99);
        }
        assert_true(id > 0);
        close(ends[1]);
        assert_int_equal(waitpid(id, &how, 0), id);
        assert_true(WIFEXITED(how));
        assert_int_equal(WEXITSTATUS(how), is_gone ? 1 : 7);
        if (!is_gone)
            close(ends[0]);
    }
}

/* Many at once, each with its own. */
static void *run_one(void *user)
{
    import_answer answer;
    char text[256];
    bool is_right = run_task(NULL, "answer", *(int *)user, &answer, text, sizeof text) == AG_OK &&
                    answer.size == ANSWER_BYTES && answer.bytes[0] == *(int *)user;
    import_answer_reset(&answer);
    return is_right ? user : NULL;
}

static void a_program_that_is_not_there_is_an_error(void **state)
{
    (void)state;
    import_answer answer;
    const char *const arguments[] = {"none", NULL};
    ag_status status = import_process_run(NULL, "./none", arguments, &answer, message, sizeof message);
    expect_failure(status, AG_ERROR_SYSTEM, "the program './none' cannot be started: No such file or directory");
    assert_null(answer.bytes);
}

/* Nothing that the caller has open reaches the process but what it is to have. */
static void descriptors_stay_here(void **state)
{
    (void)state;
    import_answer answer;
    int open_here = dup(1); /* without FD_CLOEXEC */
    assert_true(open_here >= 0);
    assert_int_equal(run_task(NULL, "descriptors", 0, &answer, message, sizeof message), AG_OK);
    assert_int_equal(answer.size, 1);
    assert_int_equal(answer.bytes[0], IMPORT_DESCRIPTORS_END);
    import_answer_reset(&answer);
    close(open_here);
}

static void threads_may_have_one_each(void **state)
{
    (void)state;
    pthread_t threads[4];
    int numbers[4] = {1, 2, 3, 4};
    for (int k = 0; k < 4; k++)
        assert_int_equal(pthread_create(&threads[k], NULL, run_one, &numbers[k]), 0);
    for (int k = 0; k < 4; k++) {
        void *result;
        pthread_join(threads[k], &result);
        assert_ptr_equal(result, &numbers[k]);
    }
}

int main(int count, char **arguments)
{
    if (count == 3)
        return work(arguments);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_come_back_whole),
        cmocka_unit_test(any_end_is_an_error),
        cmocka_unit_test(signals_have_their_default_actions),
#if !IS_SANITIZED
        cmocka_unit_test(memory_is_limited),
#endif
        cmocka_unit_test(cancelling_ends_it),
        cmocka_unit_test_setup_teardown(cancelling_ends_its_children, make_folder, remove_folder),
        cmocka_unit_test(nothing_is_done_for_a_caller_that_is_gone),
        cmocka_unit_test(a_program_that_is_not_there_is_an_error),
        cmocka_unit_test(descriptors_stay_here),
        cmocka_unit_test(threads_may_have_one_each),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

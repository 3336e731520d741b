/* test_claim_owners.c: entries of a file's table: who has one, whose claims live, and what becomes of an entry that was
 * left. What waits for claims, and takes them over, is in test_photon_file.c. Threads: one. */
#define _GNU_SOURCE
#include "claim_owners.h"

#include "fixtures/temporary_folder.h"

#include <fcntl.h>
#include <unistd.h>

/* Descriptions of their own, as processes have them, of one file with a byte for each entry. */
static int open_file(void)
{
    int file = open(in_folder("f"), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    assert_true(file >= 0);
    assert_int_equal(ftruncate(file, CLAIM_OWNERS_MAX), 0);
    return file;
}

static uint32_t claimer_of(const claim_owners *owners) { return load_relaxed_u32(&owners->claimer); }

static void claims_live_as_long_as_their_owner(void **state)
{
    (void)state;
    claim_owner table[CLAIM_OWNERS_MAX] = {0};
    claim_owners a, b, c;
    int file_a = open_file(), file_b = open_file();
    assert_true(claim_owners_join(file_a, table, &a));
    assert_true(claim_owners_join(file_b, table, &b));
    uint32_t of_a = claimer_of(&a), of_b = claimer_of(&b);
    assert_true(of_a != 0 && of_b != 0 && of_a != of_b && of_a <= IRRADIANCE_VALUE_MASK);
    assert_true(claim_owners_is_alive(&a, of_a) && claim_owners_is_alive(&a, of_b));
    assert_true(claim_owners_is_alive(&b, of_a) && claim_owners_is_alive(&b, of_b));
    claim_owners_reset(&a);
    close(file_a);
    assert_false(claim_owners_is_alive(&b, of_a));
    assert_true(claim_owners_is_alive(&b, of_b));

    /* the entry is taken again, under another number: the dead one's claims stay dead */
    int file_c = open_file();
    assert_true(claim_owners_join(file_c, table, &c));
    assert_int_equal(claimer_of(&c) & (CLAIM_OWNERS_MAX - 1), of_a & (CLAIM_OWNERS_MAX - 1));
    assert_true(claimer_of(&c) != of_a);
    assert_false(claim_owners_is_alive(&b, of_a));
    assert_true(claim_owners_is_alive(&b, claimer_of(&c)));
    claim_owners_reset(&b);
    claim_owners_reset(&c);
    close(file_b);
    close(file_c);
}

static void a_new_number_once(void **state)
{
    (void)state;
    claim_owner table[CLAIM_OWNERS_MAX] = {0};
    claim_owners a, b;
    int file_a = open_file(), file_b = open_file();
    assert_true(claim_owners_join(file_a, table, &a));
    assert_true(claim_owners_join(file_b, table, &b));
    uint32_t before = claimer_of(&a);
    claim_owners_renew(&a, before);
    uint32_t after = claimer_of(&a);
    assert_true(after != before);
    claim_owners_renew(&a, before); /* another thread of ours, which lost a claim of the same number */
    assert_int_equal(claimer_of(&a), after);
    assert_false(claim_owners_is_alive(&b, before));
    assert_true(claim_owners_is_alive(&b, after));
    claim_owners_reset(&a);
    claim_owners_reset(&b);
    close(file_a);
    close(file_b);
}

static void no_more_than_the_table_holds(void **state)
{
    (void)state;
    static claim_owner table[CLAIM_OWNERS_MAX];
    static claim_owners owners[CLAIM_OWNERS_MAX];
    static int files[CLAIM_OWNERS_MAX + 1];
    bool is_taken[CLAIM_OWNERS_MAX] = {false};
    for (int i = 0; i < CLAIM_OWNERS_MAX; i++) {
        files[i] = open_file();
        assert_true(claim_owners_join(files[i], table, &owners[i]));
        uint32_t index = claimer_of(&owners[i]) & (CLAIM_OWNERS_MAX - 1);
        assert_false(is_taken[index]);
        is_taken[index] = true;
    }
    claim_owners one_more;
    files[CLAIM_OWNERS_MAX] = open_file();
    assert_false(claim_owners_join(files[CLAIM_OWNERS_MAX], table, &one_more));
    claim_owners_reset(&owners[17]);
    close(files[17]);
    assert_true(claim_owners_join(files[CLAIM_OWNERS_MAX], table, &one_more));
    claim_owners_reset(&one_more);
    for (int i = 0; i <= CLAIM_OWNERS_MAX; i++)
        if (i != 17) {
            if (i < CLAIM_OWNERS_MAX)
                claim_owners_reset(&owners[i]);
            close(files[i]);
        }
}

/* A claim that nobody has made may be taken over at once, and a word that is no claim is not waited for. */
static void what_need_not_be_waited_for(void **state)
{
    (void)state;
    claim_owner table[CLAIM_OWNERS_MAX] = {0};
    claim_owners a;
    int file = open_file();
    assert_true(claim_owners_join(file, table, &a));
    claim_wait wait = {0};
    assert_true(claim_owners_wait(&a, &wait, irradiance_word(IRRADIANCE_EMPTY, 0)));
    uint32_t nobody = irradiance_word(IRRADIANCE_CLAIMED, (claimer_of(&a) + 1) & IRRADIANCE_VALUE_MASK);
    wait = (claim_wait){0};
    int rounds = 0;
    while (!claim_owners_wait(&a, &wait, nobody))
        assert_true(++rounds < 100000);
    claim_owners_reset(&a);
    close(file);
}

/* A file that is overwritten by a copy of itself may hold a claim of ours that no thread holds any more. It may be
 * taken over once we have another number, which other processes can see. */
static void a_claim_of_ours_that_nobody_holds(void **state)
{
    (void)state;
    claim_owner table[CLAIM_OWNERS_MAX] = {0};
    claim_owners a, b;
    int file_a = open_file(), file_b = open_file();
    assert_true(claim_owners_join(file_a, table, &a));
    assert_true(claim_owners_join(file_b, table, &b));
    const uint32_t before = claimer_of(&a), word = irradiance_word(IRRADIANCE_CLAIMED, before);
    claim_wait wait = {0};
    int rounds = 0;
    while (!claim_owners_wait(&a, &wait, word))
        assert_true(++rounds < 100000);
    assert_true(rounds > 1000); /* a thread of ours that held it would have had time to finish */
    assert_true(claimer_of(&a) != before);
    assert_false(claim_owners_is_alive(&a, before));
    assert_false(claim_owners_is_alive(&b, before));
    assert_true(claim_owners_is_alive(&b, claimer_of(&a)));
    claim_owners_reset(&a);
    claim_owners_reset(&b);
    close(file_a);
    close(file_b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(claims_live_as_long_as_their_owner),
                                       TEST_IN_FOLDER(a_new_number_once), TEST_IN_FOLDER(no_more_than_the_table_holds),
                                       TEST_IN_FOLDER(what_need_not_be_waited_for),
                                       TEST_IN_FOLDER(a_claim_of_ours_that_nobody_holds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

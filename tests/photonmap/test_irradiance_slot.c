/* test_irradiance_slot.c: a slot goes from EMPTY to CLAIMED to READY, once, whoever comes.
 * The protocol itself is looked at from every side by irradiance_slot.pml. Threads: 64 in the stress test. */
#define _POSIX_C_SOURCE 200809L
#include "irradiance_slot.h"

#include "fixtures/test_scene.h"

#include <pthread.h>
#include <sched.h>

static void zeroed_memory_is_empty(void **state)
{
    (void)state;
    irradiance_slot slot;
    memset(&slot, 0, sizeof slot);
    assert_int_equal(sizeof slot, 4);
    assert_int_equal(irradiance_word_state(irradiance_slot_read(&slot)), IRRADIANCE_EMPTY);
}

static void a_claim_is_published(void **state)
{
    (void)state;
    irradiance_slot slot;
    memset(&slot, 0, sizeof slot);
    uint32_t word;
    assert_true(irradiance_slot_try_claim(&slot, 5, &word));
    assert_int_equal(word, irradiance_word(IRRADIANCE_CLAIMED, 5));
    assert_int_equal(irradiance_slot_read(&slot), word);
    /* nobody else gets it, nor the claimer again */
    assert_false(irradiance_slot_try_claim(&slot, 6, &word));
    assert_int_equal(word, irradiance_word(IRRADIANCE_CLAIMED, 5));
    assert_false(irradiance_slot_try_claim(&slot, 5, &word));
    /* nobody else may publish */
    assert_false(irradiance_slot_publish(&slot, 6, irradiance_word(IRRADIANCE_READY, 77)));
    assert_int_equal(irradiance_slot_read(&slot), irradiance_word(IRRADIANCE_CLAIMED, 5));
    assert_true(irradiance_slot_publish(&slot, 5, irradiance_word(IRRADIANCE_READY, IRRADIANCE_VALUE_MASK)));
    assert_int_equal(irradiance_slot_read(&slot), irradiance_word(IRRADIANCE_READY, IRRADIANCE_VALUE_MASK));
    /* a ready word is final */
    assert_false(irradiance_slot_publish(&slot, 5, irradiance_word(IRRADIANCE_READY, 1)));
    assert_false(irradiance_slot_try_claim(&slot, 5, &word));
    assert_int_equal(word, irradiance_word(IRRADIANCE_READY, IRRADIANCE_VALUE_MASK));
    assert_int_equal(irradiance_word_state(word), IRRADIANCE_READY);
}

static void state_and_value_do_not_mix(void **state)
{
    (void)state;
    for (int s = IRRADIANCE_EMPTY; s <= IRRADIANCE_READY_IN_SIGHT; s++)
        for (uint32_t bit = 0; bit < 32; bit++) {
            uint32_t word = irradiance_word((irradiance_state)s, 1u << bit);
            assert_int_equal(irradiance_word_state(word), s);
            assert_int_equal(irradiance_word_is_ready(word), s >= IRRADIANCE_READY);
            assert_int_equal(word & IRRADIANCE_VALUE_MASK, bit < IRRADIANCE_STATE_SHIFT ? 1u << bit : 0);
        }
}

/* A claim that was taken back, and given to another, cannot be published over. */
static void publishing_a_stolen_claim_fails(void **state)
{
    (void)state;
    irradiance_slot slot;
    memset(&slot, 0, sizeof slot);
    uint32_t word;
    assert_true(irradiance_slot_try_claim(&slot, 1, &word));
    store_relaxed_u32(&slot, 0);
    assert_false(irradiance_slot_publish(&slot, 1, irradiance_word(IRRADIANCE_READY, 11)));
    assert_true(irradiance_slot_try_claim(&slot, 2, &word));
    assert_false(irradiance_slot_publish(&slot, 1, irradiance_word(IRRADIANCE_READY, 11)));
    assert_true(irradiance_slot_publish(&slot, 2, irradiance_word(IRRADIANCE_READY, 22)));
    assert_false(irradiance_slot_publish(&slot, 1, irradiance_word(IRRADIANCE_READY, 11)));
    assert_int_equal(irradiance_slot_read(&slot), irradiance_word(IRRADIANCE_READY, 22));
}

enum { THREADS = 64, SLOTS = 4, ROUNDS = 200 };

typedef struct crowd {
    irradiance_slot slots[ROUNDS][SLOTS];
    uint64_t payload[ROUNDS][SLOTS]; /* written by the claimer before it publishes, plainly: publish orders it */
    pthread_barrier_t gate;
} crowd;

typedef struct member {
    crowd *all;
    uint32_t number;
    uint32_t wins, lost_publishes, wrong_values;
} member;

static void *compete(void *user)
{
    member *m = user;
    pthread_barrier_wait(&m->all->gate);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        for (uint32_t i = 0; i < SLOTS; i++) {
            uint32_t at = (i + m->number) % SLOTS, word;
            irradiance_slot *slot = &m->all->slots[round][at];
            if (!irradiance_slot_try_claim(slot, m->number, &word))
                continue;
            m->wins++;
            m->all->payload[round][at] = m->number * 1000u + round;
            if (m->number % 3 == 0)
                sched_yield(); /* others meet the claim */
            m->lost_publishes +=
                !irradiance_slot_publish(slot, m->number, irradiance_word(IRRADIANCE_READY, m->number));
        }
        for (uint32_t at = 0; at < SLOTS; at++) {
            uint32_t word = irradiance_slot_read(&m->all->slots[round][at]);
            while (irradiance_word_state(word) != IRRADIANCE_READY) {
                sched_yield();
                word = irradiance_slot_read(&m->all->slots[round][at]);
            }
            m->wrong_values += m->all->payload[round][at] != (word & IRRADIANCE_VALUE_MASK) * 1000u + round;
        }
    }
    return NULL;
}

static void exactly_one_of_64_threads_wins_each_slot(void **state)
{
    (void)state;
    static crowd all;
    static member members[THREADS];
    pthread_t threads[THREADS];
    assert_int_equal(pthread_barrier_init(&all.gate, NULL, THREADS), 0);
    for (uint32_t i = 0; i < THREADS; i++) {
        members[i] = (member){.all = &all, .number = i};
        assert_int_equal(pthread_create(&threads[i], NULL, compete, &members[i]), 0);
    }
    uint32_t wins = 0;
    for (uint32_t i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        wins += members[i].wins;
        assert_int_equal(members[i].lost_publishes, 0);
        assert_int_equal(members[i].wrong_values, 0);
    }
    assert_int_equal(wins, ROUNDS * SLOTS);
    pthread_barrier_destroy(&all.gate);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zeroed_memory_is_empty),
        cmocka_unit_test(a_claim_is_published),
        cmocka_unit_test(state_and_value_do_not_mix),
        cmocka_unit_test(publishing_a_stolen_claim_fails),
        cmocka_unit_test(exactly_one_of_64_threads_wins_each_slot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Two that take turns: in the order in which they came, and only what is urgent makes the other hurry. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "view/turn.h"

struct guest {
    struct turner_turn *turn;
    bool urgent;
    int place, *served;
};

static void *wait_and_serve(void *user)
{
    struct guest *guest = user;
    turner_turn_take(guest->turn, guest->urgent);
    guest->place = ++*guest->served;
    turner_turn_give(guest->turn);
    return NULL;
}

/* Until so many have drawn a number. */
static void until_waiting(struct turner_turn *turn, unsigned numbers)
{
    for (;;) {
        pthread_mutex_lock(&turn->mutex);
        bool there = turn->next == numbers;
        pthread_mutex_unlock(&turn->mutex);
        if (there)
            return;
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
}

static void only_the_urgent_are_wanted(void **state)
{
    (void)state;
    struct turner_turn turn;
    int served = 0;
    struct guest guests[2] = {{&turn, false, 0, &served}, {&turn, true, 0, &served}};
    pthread_t threads[2];
    turner_turn_create(&turn);
    turner_turn_take(&turn, true);
    assert_false(turner_turn_wanted(&turn)); /* one who has it wants nothing more */
    for (unsigned i = 0; i < 2; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, wait_and_serve, &guests[i]), 0);
        until_waiting(&turn, 2 + i);
        assert_int_equal(turner_turn_wanted(&turn), guests[i].urgent);
    }
    assert_int_equal(served, 0);
    turner_turn_give(&turn);
    for (int i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    assert_int_equal(guests[0].place, 1);
    assert_int_equal(guests[1].place, 2);
    turner_turn_take(&turn, false);
    assert_false(turner_turn_wanted(&turn));
    turner_turn_give(&turn);
    turner_turn_destroy(&turn);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(only_the_urgent_are_wanted)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

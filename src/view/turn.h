/* Two painters work by turns: each then has the machine to itself, and its times mean something. */
#ifndef TURNER_VIEW_TURN_H
#define TURNER_VIEW_TURN_H

#include <pthread.h>
#include <stdbool.h>

struct turner_turn {
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    unsigned next, serving; /* numbers drawn, as in a shop */
    unsigned urgent;        /* of those who wait */
};

void turner_turn_create(struct turner_turn *turn);
void turner_turn_destroy(struct turner_turn *turn);

/* Waits until those who came before are done. */
void turner_turn_take(struct turner_turn *turn, bool urgent);
void turner_turn_give(struct turner_turn *turn);

/* Whether somebody waits with something urgent. */
bool turner_turn_wanted(struct turner_turn *turn);

#endif

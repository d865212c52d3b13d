#include "view/turn.h"

void turner_turn_create(struct turner_turn *turn)
{
    *turn = (struct turner_turn){0};
    pthread_mutex_init(&turn->mutex, NULL);
    pthread_cond_init(&turn->changed, NULL);
}

void turner_turn_destroy(struct turner_turn *turn)
{
    pthread_cond_destroy(&turn->changed);
    pthread_mutex_destroy(&turn->mutex);
}

void turner_turn_take(struct turner_turn *turn, bool urgent)
{
    pthread_mutex_lock(&turn->mutex);
    unsigned number = turn->next++;
    turn->urgent += urgent;
    while (turn->serving != number)
        pthread_cond_wait(&turn->changed, &turn->mutex);
    turn->urgent -= urgent;
    pthread_mutex_unlock(&turn->mutex);
}

void turner_turn_give(struct turner_turn *turn)
{
    pthread_mutex_lock(&turn->mutex);
    turn->serving++;
    pthread_cond_broadcast(&turn->changed);
    pthread_mutex_unlock(&turn->mutex);
}

bool turner_turn_wanted(struct turner_turn *turn)
{
    pthread_mutex_lock(&turn->mutex);
    bool wanted = turn->urgent > 0;
    pthread_mutex_unlock(&turn->mutex);
    return wanted;
}

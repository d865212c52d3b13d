#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define MOST_THREADS 256

struct loop {
    void (*run)(void *user, uint32_t i);
    void *user;
    uint32_t count;
    atomic_uint next;
};

static atomic_uint limit;

void turner_parallel_limit(unsigned threads)
{
    atomic_store(&limit, threads);
}

static unsigned thread_count(void)
{
    unsigned threads = atomic_load(&limit);
    if (!threads) {
        long cores = sysconf(_SC_NPROCESSORS_ONLN);
        threads = cores > 0 ? (unsigned)cores : 1;
    }
    return threads < MOST_THREADS ? threads : MOST_THREADS;
}

static void *work(void *argument)
{
    struct loop *loop = argument;
    for (;;) {
        uint32_t i = atomic_fetch_add_explicit(&loop->next, 1, memory_order_relaxed);
        if (i >= loop->count)
            return NULL;
        loop->run(loop->user, i);
    }
}

void turner_parallel_for(uint32_t count, void (*run)(void *user, uint32_t i), void *user)
{
    struct loop loop = {.run = run, .user = user, .count = count};
    unsigned threads = thread_count(), started = 0;
    if (threads > count)
        threads = count;
    pthread_t others[MOST_THREADS];
    while (started + 1 < threads && pthread_create(&others[started], NULL, work, &loop) == 0)
        started++;
    work(&loop);
    for (unsigned i = 0; i < started; i++)
        pthread_join(others[i], NULL);
}

/* SIGINT and its like, as an event among others: a thread waits for them. */
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "image/image.h"
#include "view/view.h"

static struct {
    pthread_t thread;
    bool runs;
    atomic_bool ending, caught;
    pthread_mutex_t mutex; /* of what follows */
    void (*wake)(void *user);
    void *user;
} signals = {.mutex = PTHREAD_MUTEX_INITIALIZER};

static sigset_t ends(void)
{
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    sigset_t set;
    sigemptyset(&set);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct sigaction action;
        if (sigaction(numbers[i], NULL, &action) == 0 && action.sa_handler != SIG_IGN)
            sigaddset(&set, numbers[i]);
    }
    sigaddset(&set, SIGUSR2); /* of turner_signals_stop */
    return set;
}

void turner_signals_block(void)
{
    sigset_t set = ends();
    pthread_sigmask(SIG_BLOCK, &set, NULL);
}

static void *take(void *unused)
{
    (void)unused;
    sigset_t set = ends();
    int number = 0;
    for (;;) {
        if (sigwait(&set, &number) != 0 || atomic_load(&signals.ending))
            return NULL;
        if (number == SIGUSR2)
            continue;
        pthread_mutex_lock(&signals.mutex);
        if (!signals.wake) {
            turner_image_abandon();
            _exit(128 + number);
        }
        atomic_store(&signals.caught, true);
        signals.wake(signals.user);
        pthread_mutex_unlock(&signals.mutex);
    }
}

enum turner_result turner_signals_start(void)
{
    int error = pthread_create(&signals.thread, NULL, take, NULL);
    signals.runs = error == 0;
    return signals.runs ? TURNER_OK
                        : turner_fail(TURNER_DEVICE, "no thread could be started: %s",
                                      strerror(error));
}

void turner_signals_to(void (*wake)(void *user), void *user)
{
    pthread_mutex_lock(&signals.mutex);
    signals.wake = wake;
    signals.user = user;
    pthread_mutex_unlock(&signals.mutex);
}

bool turner_signals_caught(void)
{
    return atomic_load(&signals.caught);
}

void turner_signals_stop(void)
{
    if (!signals.runs)
        return;
    atomic_store(&signals.ending, true);
    pthread_kill(signals.thread, SIGUSR2);
    pthread_join(signals.thread, NULL);
    signals.runs = false;
}

/* For tests that need a device: one for the whole program, with validation on. */
#ifndef TURNER_TESTS_GPU_TEST_H
#define TURNER_TESTS_GPU_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gpu/device.h"

#define SKIPPED 77

#define assert_ok(call)                                  \
    do {                                                 \
        if ((call) != TURNER_OK)                         \
            fail_msg("%s: %s", #call, turner_message()); \
    } while (0)

#define assert_message_has(part)                                                    \
    do {                                                                            \
        if (!strstr(turner_message(), (part)))                                      \
            fail_msg("\"%s\" is not in the message: %s", (part), turner_message()); \
    } while (0)

/* Whether this machine has a device that turner can use, else says that and why. A driver that is
 * there but fails is no reason to skip. */
static inline bool have_device(void)
{
    struct turner_gpu_info *infos;
    size_t count;
    bool usable = false;
    if (turner_gpu_list(&infos, &count) != TURNER_OK) {
        if (strstr(turner_message(), "no Vulkan driver found")) {
            fprintf(stderr, "skipped: %s\n", turner_message());
            return false;
        }
        return true;
    }
    for (size_t i = 0; i < count; i++)
        usable |= infos[i].usable;
    free(infos);
    if (!usable)
        fprintf(stderr, "skipped: no Vulkan device has what turner requires\n");
    return usable;
}

/* Opens the device with validation; exits with 77 when there is none. */
static inline void open_device(struct turner_gpu *gpu)
{
    if (!have_device())
        exit(SKIPPED);
    if (turner_gpu_create(gpu, NULL, true) != TURNER_OK) {
        fprintf(stderr, "%s\n", turner_message());
        exit(1);
    }
}

/* Closes it and makes validation messages a failure. */
static inline int close_device(struct turner_gpu *gpu, int failures)
{
    if (gpu->memory_used) {
        fprintf(stderr, "%llu bytes of buffers were not freed\n",
                (unsigned long long)gpu->memory_used);
        failures++;
    }
    turner_gpu_destroy(gpu);
    if (turner_gpu_validation_count()) {
        fprintf(stderr, "%u validation messages\n", turner_gpu_validation_count());
        failures++;
    }
    return failures;
}

#endif

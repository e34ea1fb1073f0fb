/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A one-word lock in memory shared by processes. Realtime functions may only try to take it, never wait. */
#ifndef RTAPI_MUTEX_H
#define RTAPI_MUTEX_H

#include <sched.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef unsigned long rtapi_mutex_t;

/* Releases the lock, which the caller must hold. */
static inline void rtapi_mutex_give(unsigned long *mutex) {
    __atomic_store_n(mutex, 0UL, __ATOMIC_RELEASE);
}

/* Takes the lock if it is free. Returns 0 when taken, 1 when another owner holds it. Realtime-safe. */
static inline int rtapi_mutex_try(unsigned long *mutex) {
    unsigned long free_word = 0UL;
    return !__atomic_compare_exchange_n(mutex, &free_word, 1UL, 0, __ATOMIC_ACQUIRE, __ATOMIC_RELAXED);
}

/* Waits until the lock is taken. Not for realtime functions. */
static inline void rtapi_mutex_get(unsigned long *mutex) {
    while (rtapi_mutex_try(mutex) != 0) {
        sched_yield();
    }
}

/* The same word as a lock for many readers or one writer: the functions above are for the writer, these for
 * readers. Bit 0 is the writer; each reader adds 2. */
static inline void rtapi_mutex_give_rd(unsigned long *mutex) {
    __atomic_fetch_sub(mutex, 2UL, __ATOMIC_RELEASE);
}

/* Returns 0 when taken, 1 when a writer holds the lock. Realtime-safe. */
static inline int rtapi_mutex_try_rd(unsigned long *mutex) {
    unsigned long seen = __atomic_load_n(mutex, __ATOMIC_RELAXED);
    while ((seen & 1UL) == 0UL) {
        if (__atomic_compare_exchange_n(mutex, &seen, seen + 2UL, 1, __ATOMIC_ACQUIRE, __ATOMIC_RELAXED)) {
            return 0;
        }
    }
    return 1;
}

static inline void rtapi_mutex_get_rd(unsigned long *mutex) {
    while (rtapi_mutex_try_rd(mutex) != 0) {
        sched_yield();
    }
}

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A one-word lock in memory that processes share. Realtime functions may only try, never wait. */
#ifndef RTAPI_MUTEX_H
#define RTAPI_MUTEX_H

#include <sched.h>

typedef unsigned long rtapi_mutex_t;

/* Releases the lock, which the caller must hold. */
static inline void rtapi_mutex_give(unsigned long *mutex) {
    __atomic_store_n(mutex, 0UL, __ATOMIC_RELEASE);
}

/* Takes the lock if it is free. Answers 0 when taken, 1 when another holds it. Realtime-safe. */
static inline int rtapi_mutex_try(unsigned long *mutex) {
    return __atomic_exchange_n(mutex, 1UL, __ATOMIC_ACQUIRE) != 0UL;
}

/* Waits until the lock is taken. Not for realtime functions. */
static inline void rtapi_mutex_get(unsigned long *mutex) {
    while (rtapi_mutex_try(mutex) != 0) {
        sched_yield();
    }
}

#endif

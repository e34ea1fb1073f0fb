/* SPDX-License-Identifier: GPL-2.0-or-later */
/* What Millwright offers to realtime modules beyond the common API. Keep to it sparingly: a module that
 * includes this runs under Millwright only. Nothing here is realtime-safe unless stated. */
#ifndef MILLWRIGHT_EXT_H
#define MILLWRIGHT_EXT_H

#include "hal.h"

RTAPI_BEGIN_DECLS

/* The address of a symbol that a loaded module of this instance exports (newest module first), or NULL. It
 * stays valid while that module is loaded; see mw_ext_use_module. */
extern void *mw_ext_find_symbol(const char *name);

/* Keeps the module that exports `symbol` loaded until component comp_id has ended. 0, or -ENOENT. */
extern int mw_ext_use_module(const char *symbol, int comp_id);

/* Calls function(arg, period_ns) every period below all HAL threads: for planners, which may take long but
 * must not block. Under the virtual clock it runs after the threads that are due at the same time. Runs
 * whether or not HAL threads are started. An id of at least 1, or a negated errno. */
extern int mw_ext_planner_new(const char *name, long long period_ns, void (*function)(void *, long long),
                              void *arg);
/* After it returns the function is not running and will not be called again. */
extern int mw_ext_planner_delete(int id);

/* Declares the value that the signal (or the pin itself) takes when the pin's owner dies without hal_exit.
 * Without a declaration that is 0. The pointer is to a value of the pin's type. */
extern int mw_ext_pin_safe_value(const char *pin_name, const void *value);

/* For the module that moves the machine. When the process that controls the instance dies, *is_gone becomes 1
 * within milliseconds; the module then stops the machine and sets *is_safe to 1, upon which the realtime
 * process ends (after 10 s anyway). Read and write both as atomics. They live until component comp_id ends.
 * Nothing happens under the virtual clock. */
extern int mw_ext_watch_controller(rtapi_u32 *is_gone, const rtapi_u32 *is_safe, int comp_id);

/* For the same module: *looks counts up every 50 ms, by a thread of ordinary priority. Where it stands still
 * the computer has no time for such threads, those of the controlling process among them. Atomic. */
extern int mw_ext_count_looks(rtapi_u32 *looks, int comp_id);

/* The period of a HAL thread [ns], 0 when there is none of that name. */
extern long long mw_ext_thread_period(const char *name);

/* Zeroed memory for what a realtime function looks at in every cycle, in pages of 2 MB where the kernel has
 * them; in the realtime process it is there from the start. NULL where there are not so many bytes. Give it
 * back with the same count, once nothing uses it any more. */
extern void *mw_ext_memory_new(unsigned long bytes);
extern void mw_ext_memory_delete(void *memory, unsigned long bytes);

/* Counts the links of pins that are made and removed in this instance. A component that writes a pin only
 * when its value changes writes it again when this count has changed. Read it as an atomic, also in realtime.
 * The address is valid while the module is loaded. NULL where there is no instance. */
extern const rtapi_u32 *mw_ext_links(void);

/* A driver adds 1 when positions that it has reported are no longer those of the machine: its board has lost
 * its counters, or the driver does not follow them. The module that moves the machine then switches it off,
 * and no joint is homed any more. The driver tells the operator the cause. Add and read it as an atomic, also
 * in realtime. The address is valid while the module is loaded. NULL where there is no instance. */
extern rtapi_u32 *mw_ext_lost_positions(void);

/* 1 under the virtual clock. */
extern int mw_ext_is_virtual(void);

RTAPI_END_DECLS

#endif

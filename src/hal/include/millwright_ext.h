/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Functions of Millwright for realtime modules, in addition to the common API. Use them sparingly: a module
 * that includes this header runs only under Millwright. No function is realtime-safe unless its comment
 * states it. */
#ifndef MILLWRIGHT_EXT_H
#define MILLWRIGHT_EXT_H

#include "hal.h"

RTAPI_BEGIN_DECLS

/* The address of a symbol that a loaded module of this instance exports (newest module first), or NULL. It is
 * valid while that module is loaded; see mw_ext_use_module. */
extern void *mw_ext_find_symbol(const char *name);

/* Keeps the module that exports `symbol` loaded until component comp_id has ended. Returns 0, or -ENOENT. */
extern int mw_ext_use_module(const char *symbol, int comp_id);

/* Calls function(arg, period_ns) every period with a priority below all HAL threads, for planners, which may
 * take long but must not block. Under the virtual clock it runs after the threads that are due at the same
 * time. Runs whether or not HAL threads are started. Returns an id of at least 1, or a negated errno. */
extern int mw_ext_planner_new(const char *name, long long period_ns, void (*function)(void *, long long),
                              void *arg);
/* After the call returns, the function does not run and is not called again. */
extern int mw_ext_planner_delete(int id);

/* Declares the value that the signal (or the unlinked pin) takes when the pin's owner dies without hal_exit.
 * Without a declaration the value is 0. The pointer is to a value of the pin's type. */
extern int mw_ext_pin_safe_value(const char *pin_name, const void *value);

/* For the module that moves the machine. When the process that controls the instance dies, *is_gone becomes 1
 * within milliseconds. The module then stops the machine and sets *is_safe to 1, and the realtime process
 * ends (after 10 s in any case). Read and write both as atomics. Their memory remains until component comp_id
 * ends. No effect under the virtual clock. */
extern int mw_ext_watch_controller(rtapi_u32 *is_gone, const rtapi_u32 *is_safe, int comp_id);

/* For the same module: a thread of ordinary priority increments *looks every 50 ms. If the count does not
 * change, the computer has no time for ordinary threads, including those of the controlling process. Atomic.
 */
extern int mw_ext_count_looks(rtapi_u32 *looks, int comp_id);

/* The period of a HAL thread [ns]; 0 when no thread has that name. */
extern long long mw_ext_thread_period(const char *name);

/* Zeroed memory for data that a realtime function accesses in every cycle, in pages of 2 MB if the kernel has
 * them; in the realtime process it is allocated at the start. NULL when less memory is free. Return it with
 * the same size when nothing uses it. */
extern void *mw_ext_memory_new(unsigned long bytes);
extern void mw_ext_memory_delete(void *memory, unsigned long bytes);

/* Number of links of pins made and removed in this instance. A component that writes a pin only when its
 * value changes must write it again when this number has changed. Read it as an atomic, also in realtime. The
 * address is valid while the module is loaded. NULL when there is no instance. */
extern const rtapi_u32 *mw_ext_links(void);

/* A driver adds 1 when the positions that it has reported are no longer those of the machine: its board has
 * lost its counters, or the driver does not follow them. The module that moves the machine then switches it
 * off, and all joints become unhomed. The driver reports the cause to the operator. Add and read it as an
 * atomic, also in realtime. The address is valid while the module is loaded. NULL when there is no instance.
 */
extern rtapi_u32 *mw_ext_lost_positions(void);

/* 1 under the virtual clock. */
extern int mw_ext_is_virtual(void);

RTAPI_END_DECLS

#endif

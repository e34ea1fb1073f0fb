/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The realtime layer as seen by components: messages, time, shared memory, module parameters. "realtime-safe"
 * marks functions that a realtime thread may call. */
#ifndef RTAPI_H
#define RTAPI_H

#include <spawn.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/types.h>

#include "rtapi_errno.h"
#include "rtapi_stdint.h"

#ifdef __cplusplus
#define RTAPI_BEGIN_DECLS extern "C" {
#define RTAPI_END_DECLS }
#else
#define RTAPI_BEGIN_DECLS
#define RTAPI_END_DECLS
#endif

#define RTAPI_NAME_LEN 31
#define RTAPI_NO_FP 0
#define RTAPI_USES_FP 1
#define RTAPI_STRINGIFY(x) #x
/* For declarations that other modules use, in modules that are compiled with hidden visibility. */
#define RTAPI_EXPORT __attribute__((__visibility__("default")))
/* Exports the symbol to other modules. halcompile exports these symbols and the entry points, and keeps all
 * others private to the module. Checks that the symbol exists. */
#define EXPORT_SYMBOL(x) RTAPI_EXPORT_NOTE_(x, __COUNTER__)
#define RTAPI_EXPORT_NOTE_(x, n) RTAPI_EXPORT_NOTE2_(x, n)
/* NOLINTBEGIN(bugprone-macro-parentheses): x is declared, not used */
#define RTAPI_EXPORT_NOTE2_(x, n)                                                                            \
    static const char rtapi_exported_##n[] __attribute__((__section__(".rtapi_export"), __used__)) = #x;     \
    extern __typeof__(x) x;
/* NOLINTEND(bugprone-macro-parentheses) */
#define EXPORT_SYMBOL_GPL(x) EXPORT_SYMBOL(x)
#define EXPORT_FUNCTION(x) EXPORT_SYMBOL(x)

RTAPI_BEGIN_DECLS

/* ---- modules ---- */

/* Registers a module or program with the realtime layer. Returns an id of at least 1, or a negated errno. */
extern int rtapi_init(const char *modname);
extern int rtapi_exit(int module_id);

typedef enum {
    REALTIME_TYPE_UNINITIALIZED = -1,
    REALTIME_TYPE_NONE = 0,
    REALTIME_TYPE_UNKNOWN,
    REALTIME_TYPE_PREEMPT_RT,
    REALTIME_TYPE_PREEMPT_DYNAMIC,
    REALTIME_TYPE_RTAI,
    REALTIME_TYPE_LXRT,
    REALTIME_TYPE_XENOMAI,
    REALTIME_TYPE_XENOMAI_EVL
} rtapi_realtime_type_t;

/* Scheduling of the threads of this instance; NONE under the virtual clock and without privileges. */
extern rtapi_realtime_type_t rtapi_get_realtime_type(void);
/* 1 when threads run with realtime priority, else 0. */
extern int rtapi_is_realtime(void);
/* Always 0: modules are shared objects of a process. */
extern int rtapi_is_kernelspace(void);

/* ---- messages ---- */

typedef enum {
    RTAPI_MSG_NONE = 0,
    RTAPI_MSG_ERR,
    RTAPI_MSG_WARN,
    RTAPI_MSG_INFO,
    RTAPI_MSG_DBG,
    RTAPI_MSG_ALL
} msg_level_t;

typedef void (*rtapi_msg_handler_t)(msg_level_t level, const char *fmt, va_list ap);

/* Formats as printf does (without positional arguments and wide characters), always with a decimal point, and
 * never allocates. Returns the length of the whole text; if it is >= size, the text was cut. Realtime-safe.
 */
extern int rtapi_snprintf(char *buf, unsigned long size, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));
extern int rtapi_vsnprintf(char *buf, unsigned long size, const char *fmt, va_list ap);

/* Writes a message to the log at any level. Cut at 240 characters. Realtime-safe. */
extern void rtapi_print(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
/* Writes a message to the log if `level` is within the current level (initially: errors only). Realtime-safe.
 */
extern void rtapi_print_msg(msg_level_t level, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
/* Returns -EINVAL for a level outside NONE..ALL. */
extern int rtapi_set_msg_level(int level);
extern int rtapi_get_msg_level(void);
/* Replaces the log by a function of the caller, called in the thread that prints; NULL restores the log. */
extern void rtapi_set_msg_handler(rtapi_msg_handler_t handler);
extern rtapi_msg_handler_t rtapi_get_msg_handler(void);

/* ---- time ---- */

/* Nanoseconds since an arbitrary start; virtual time under the virtual clock. Realtime-safe. */
extern long long int rtapi_get_time(void);
/* The processor's cycle counter; nanoseconds if there is none, and under the virtual clock. Realtime-safe. */
extern long long int rtapi_get_clocks(void);
/* Waits by spinning for nsec, at most rtapi_delay_max(); no wait under the virtual clock. Realtime-safe. */
extern void rtapi_delay(long int nsec);
extern long int rtapi_delay_max(void);
/* Returns the requested period: threads have exactly the periods with which they are created. */
extern long int rtapi_clock_set_period(long int nsecs);

/* A number as strtol reads it. Realtime-safe. */
extern long simple_strtol(const char *nptr, char **endptr, int base);

/* ---- tasks: a module's own threads, in addition to those of HAL ----
 * Only for the realtime clock (-ENOSYS under the virtual clock, which cannot control loops of other code).
 * Components use HAL functions instead. Ids are at least 1. */

/* Opaque priorities; a larger number is not a higher priority. */
extern int rtapi_prio_highest(void);
extern int rtapi_prio_lowest(void);
extern int rtapi_prio_next_higher(int prio);
extern int rtapi_prio_next_lower(int prio);

/* Creates a task that is not started. Returns an id, or a negated errno. */
extern int rtapi_task_new(void (*taskcode)(void *), void *arg, int prio, int owner,
                          unsigned long int stacksize, int uses_fp);
/* Ends the task in its next rtapi_wait. Returns -EBUSY when it does not call rtapi_wait within two seconds.
 */
extern int rtapi_task_delete(int task_id);
/* Starts the task with a period; it calls rtapi_wait at the end of each period. */
extern int rtapi_task_start(int task_id, unsigned long int period_nsec);
/* Runs the task without a period, or continues it after a pause. */
extern int rtapi_task_resume(int task_id);
/* Pauses the task in its next rtapi_wait until it is resumed. */
extern int rtapi_task_pause(int task_id);
/* The id of the calling task, or -EINVAL. Realtime-safe. */
extern int rtapi_task_self(void);
/* Waits for the next period of the calling task. */
extern int rtapi_wait(void);
#define rtapi_task_wait() ((void)rtapi_wait())
/* Drops the releases that the calling task has missed. */
extern void rtapi_task_self_resync(void);

/* The release time of the current period of the calling HAL thread [ns], 0 in other threads; and a correction
 * of its next releases [ns per period], at most one percent of the period. The correction returns -EINVAL
 * outside of HAL threads. With both a thread can follow a clock on a fieldbus. Realtime-safe. */
#define RTAPI_TASK_PLL_SUPPORT 1
extern long long rtapi_task_pll_get_reference(void);
extern int rtapi_task_pll_set_correction(long value);

/* ---- semaphores and queues of bytes by key, within the instance's realtime process ---- */

/* Creates a free semaphore. Returns an id, or a negated errno; every caller with this key gets the same id.
 */
extern int rtapi_sem_new(int key, int module_id);
extern int rtapi_sem_delete(int sem_id, int module_id);
/* Realtime-safe. */
extern int rtapi_sem_give(int sem_id);
/* Waits. Not for realtime functions. */
extern int rtapi_sem_take(int sem_id);
/* Returns 0 when taken, -EBUSY when not. Realtime-safe. */
extern int rtapi_sem_try(int sem_id);

/* A queue between one reader (mode 'R') and one writer ('W'), in all processes of the instance. */
extern int rtapi_fifo_new(int key, int module_id, unsigned long int size, char mode);
extern int rtapi_fifo_delete(int fifo_id, int module_id);
/* Transfer as many bytes as available (free), at most size. Return the number, or a negated errno.
 * Realtime-safe. */
extern int rtapi_fifo_read(int fifo_id, char *buf, unsigned long int size);
extern int rtapi_fifo_write(int fifo_id, char *buf, unsigned long int size);

/* ---- hardware ---- */

/* Interrupts do not reach user processes: these functions return -ENOSYS. */
extern int rtapi_irq_new(unsigned int irq_num, int owner, void (*handler)(void));
extern int rtapi_irq_delete(unsigned int irq_num);
extern int rtapi_enable_interrupt(unsigned int irq);
extern int rtapi_disable_interrupt(unsigned int irq);

/* Claims I/O ports for this process. Returns NULL with a message when the system rejects it (it requires the
 * capability CAP_SYS_RAWIO) or another module has the ports. */
extern void *rtapi_request_region(unsigned long base, unsigned long size, const char *name);
extern void rtapi_release_region(unsigned long base, unsigned long int size);

/* open(2) and posix_spawn(3) with root rights if the process can get them. They return a descriptor or a
 * negated errno; 0 or a negated errno. */
extern int rtapi_open_as_root(const char *filename, int mode);
extern int rtapi_spawn_as_root(pid_t *pid, const char *path, const posix_spawn_file_actions_t *file_actions,
                               const posix_spawnattr_t *attrp, char *const argv[], char *const envp[]);
extern int rtapi_spawnp_as_root(pid_t *pid, const char *path, const posix_spawn_file_actions_t *file_actions,
                                const posix_spawnattr_t *attrp, char *const argv[], char *const envp[]);

/* ---- shared memory of this instance ---- */

/* Opens the block with this key; a new block is zeroed. Returns an id, or a negated errno (-EINVAL: size 0,
 * or more than the existing block). Not realtime-safe. */
extern int rtapi_shmem_new(int key, int module_id, unsigned long int size);
/* The block's address in this process. Realtime-safe. */
extern int rtapi_shmem_getptr(int shmem_id, void **ptr);
/* Ends this use of the block. The block is removed after its last use. */
extern int rtapi_shmem_delete(int shmem_id, int module_id);

/* ---- module parameters: name=value words of loadrt, set before rtapi_app_main ---- */

enum rtapi_mp_type { RTAPI_MP_TYPE_INT = 1, RTAPI_MP_TYPE_LONG, RTAPI_MP_TYPE_STRING };

/* Members with names that no pin of a component has. */
struct rtapi_mp_info {
    const char *mp_name;
    const char *mp_description;
    int mp_type;  /* enum rtapi_mp_type */
    int mp_count; /* elements; 1 for a scalar */
    void *mp_address;
};

/* Called by the macros below while a module is loaded. */
extern void rtapi_mp_register(const struct rtapi_mp_info *info);

RTAPI_END_DECLS

/* Use these macros at file scope after the variable, with or without a semicolon. */
#define RTAPI_MP_DECLARE_(var, addr, kind, num, descr)                                                       \
    static struct rtapi_mp_info rtapi_mp_info_##var = {#var, (descr), (kind), (num), (void *)(addr)};        \
    static __attribute__((__constructor__)) void rtapi_mp_register_##var(void) {                             \
        rtapi_mp_register(&rtapi_mp_info_##var);                                                             \
    }

#define RTAPI_MP_INT(var, descr) RTAPI_MP_DECLARE_(var, &(var), RTAPI_MP_TYPE_INT, 1, descr)
#define RTAPI_MP_LONG(var, descr) RTAPI_MP_DECLARE_(var, &(var), RTAPI_MP_TYPE_LONG, 1, descr)
#define RTAPI_MP_STRING(var, descr) RTAPI_MP_DECLARE_(var, &(var), RTAPI_MP_TYPE_STRING, 1, descr)
#define RTAPI_MP_ARRAY_INT(var, num, descr) RTAPI_MP_DECLARE_(var, (var), RTAPI_MP_TYPE_INT, num, descr)
#define RTAPI_MP_ARRAY_LONG(var, num, descr) RTAPI_MP_DECLARE_(var, (var), RTAPI_MP_TYPE_LONG, num, descr)
#define RTAPI_MP_ARRAY_STRING(var, num, descr) RTAPI_MP_DECLARE_(var, (var), RTAPI_MP_TYPE_STRING, num, descr)
/* `type` as a letter in quotes: "i" int, "l" long, "s" string. */
#define RTAPI_MP_ARRAY(type, var, num, descr)                                                                \
    static struct rtapi_mp_info rtapi_mp_info_##var = {#var, (descr), 0, (num), (void *)(var)};              \
    static __attribute__((__constructor__)) void rtapi_mp_register_##var(void) {                             \
        rtapi_mp_info_##var.mp_type = (type)[0] == 's'   ? RTAPI_MP_TYPE_STRING                              \
                                      : (type)[0] == 'l' ? RTAPI_MP_TYPE_LONG                                \
                                                         : RTAPI_MP_TYPE_INT;                                \
        rtapi_mp_register(&rtapi_mp_info_##var);                                                             \
    }

/* Information about a module for people and tools; it is not in the object. */
#define MODULE_INFO(tag, text)
#define MODULE_INFO1(tag, a, text)
#define MODULE_INFO2(tag, a, b, text)
#define MODULE_INFO2x(tag, a, b, text)
#define MODULE_LICENSE(text)
#define MODULE_AUTHOR(text)
#define MODULE_DESCRIPTION(text)
#define MODULE_SUPPORTED_DEVICE(text)
#define MODULE_DEVICE_TABLE(bus, table)
#define MODULE_PARM(var, type)
#define MODULE_PARM_DESC(var, text)

#define KERNEL_VERSION(a, b, c) (((a) << 16) + ((b) << 8) + (c))
/* Modules are shared objects, so code for old kernels does not apply. */
#ifndef LINUX_VERSION_CODE
#define LINUX_VERSION_CODE KERNEL_VERSION(6, 1, 0)
#endif

#endif

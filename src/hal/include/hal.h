/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The hardware abstraction layer for components. A component calls hal_init, creates pins, parameters and
 * functions, then calls hal_ready. Names are unique per type within an instance. Functions return 0 (or an
 * id) on success and a negated errno on failure, with the reason in the log: -EINVAL invalid argument or name
 * too long, -EEXIST the name is in use, -ENOENT no such object, -EPERM locked or not allowed here, -ENOMEM
 * out of memory, -EBUSY in use. Functions are not realtime-safe unless their comment states it. */
#ifndef HAL_H
#define HAL_H

#include <signal.h>

#include "rtapi.h"

#ifdef __cplusplus
#define HAL_STATIC_ASSERT(expression, message) static_assert(expression, message)
#else
#define HAL_STATIC_ASSERT(expression, message) _Static_assert(expression, message)
#endif

RTAPI_BEGIN_DECLS

/* Maximum length of a name, without the zero at its end. A longer name is an error; names are not cut. */
#define HAL_NAME_LEN 127
#define HAL_PSEUDO_COMP_PREFIX "__"
#define HAL_STREAM_MAX_PINS 21
#define HAL_PORT_SIZE_MAX 65536

/* What a lock forbids (hal_set_lock). */
#define HAL_LOCK_NONE 0
#define HAL_LOCK_LOAD 1
#define HAL_LOCK_CONFIG 2
#define HAL_LOCK_PARAMS 4
#define HAL_LOCK_RUN 8
#define HAL_LOCK_TUNE (HAL_LOCK_LOAD | HAL_LOCK_CONFIG)
#define HAL_LOCK_ALL 255

typedef enum {
    HAL_TYPE_UNSPECIFIED = -1,
    HAL_TYPE_UNINITIALIZED = 0,
    HAL_BIT = 1,
    HAL_FLOAT = 2,
    HAL_S32 = 3,
    HAL_U32 = 4,
    HAL_PORT = 5,
    HAL_S64 = 6,
    HAL_U64 = 7,
    HAL_TYPE_MAX
} hal_type_t;
#define HAL_BOOL HAL_BIT
#define HAL_REAL HAL_FLOAT
#define HAL_SINT HAL_S64
#define HAL_UINT HAL_U64

/* Directions as seen by the component. RO and RW are for parameters, as seen from outside. */
typedef enum {
    HAL_DIR_UNSPECIFIED = -1,
    HAL_IN = 16,
    HAL_OUT = 32,
    HAL_IO = (HAL_IN | HAL_OUT),
    HAL_RO = 64,
    HAL_WO = 128,
    HAL_RW = (HAL_RO | HAL_WO)
} hal_pdir_t;
typedef hal_pdir_t hal_pin_dir_t;
typedef hal_pdir_t hal_param_dir_t;

static inline int hal_pdir_is_pin(hal_pdir_t v) {
    return v == HAL_IN || v == HAL_OUT || v == HAL_IO;
}
static inline int hal_pdir_is_param(hal_pdir_t v) {
    return v == HAL_RO || v == HAL_RW;
}
static inline int hal_pdir_is_neither(hal_pdir_t v) {
    return !hal_pdir_is_pin(v) && !hal_pdir_is_param(v);
}

typedef enum {
    HAL_COMP_TYPE_UNKNOWN = -1,
    HAL_COMP_TYPE_USER = 0,
    HAL_COMP_TYPE_REALTIME = 1,
    HAL_COMP_TYPE_OTHER = 2
} hal_comp_type_t;
#define COMPONENT_TYPE_UNKNOWN HAL_COMP_TYPE_UNKNOWN
#define COMPONENT_TYPE_USER HAL_COMP_TYPE_USER
#define COMPONENT_TYPE_REALTIME HAL_COMP_TYPE_REALTIME
#define COMPONENT_TYPE_OTHER HAL_COMP_TYPE_OTHER

typedef double real_t __attribute__((aligned(8)));
typedef rtapi_u64 ireal_t __attribute__((aligned(8)));

/* Values in HAL memory. Another thread or process may change a value between two reads. */
typedef volatile rtapi_bool hal_bit_t;
typedef volatile rtapi_u32 hal_u32_t;
typedef volatile rtapi_s32 hal_s32_t;
typedef volatile rtapi_u64 hal_u64_t;
typedef volatile rtapi_s64 hal_s64_t;
typedef volatile rtapi_port hal_port_t;
typedef volatile real_t hal_float_t;

typedef union {
    hal_bit_t b;
    hal_s32_t s;
    hal_u32_t u;
    hal_float_t f;
    hal_port_t p;
    hal_s64_t ls;
    hal_u64_t lu;
} hal_data_u;

/* References to a value, used only through the getters and setters below. The variable that contains a
 * reference must be in memory of hal_malloc, because linking a pin changes it. */
typedef struct hal_bool_ref *hal_bool_t;
typedef struct hal_real_ref *hal_real_t;
typedef struct hal_sint_ref *hal_sint_t;
typedef struct hal_uint_ref *hal_uint_t;
typedef union {
    hal_bool_t b;
    hal_real_t r;
    hal_sint_t s;
    hal_uint_t u;
    void *p;
} hal_refs_u;

/* ---- components ---- */

/* Creates a component. Returns its id, or a negated errno. Its type is REALTIME inside a loaded module, else
 * USER. */
extern int hal_init(const char *name);
/* Reports that all pins and functions exist. */
extern int hal_ready(int comp_id);
extern int hal_unready(int comp_id);
extern int hal_set_unready(int comp_id);
/* Ends a component and removes its pins, parameters and functions, also from threads. */
extern int hal_exit(int comp_id);
/* The name of a component, or NULL; valid until the component ends. */
extern char *hal_comp_name(int comp_id);
/* 1 when this process is attached to an instance. */
extern int hal_is_init(void);
/* Memory of the instance, 8-byte aligned and zeroed, or NULL when none is left. It lives as long as the
 * instance. */
extern void *hal_malloc(long int size);
extern const char *hal_strerror(int err);

/* Joins and leaves the instance without a component, for programs that only read. Returns 0, or a negated
 * errno. */
extern int hal_lib_init(void);
extern void hal_lib_exit(void);
/* Releases a lock that a dead process has left locked. While a running process holds the lock, it waits. */
extern int hal_mutex_force_release(void);

/* Creates further instances of a component after it was loaded: `prefix` is the beginning of their names,
 * `arg` is from the user. Returns 0, or a negated errno. */
typedef int (*hal_constructor_t)(const char *prefix, const char *arg);
typedef hal_constructor_t constructor;
extern int hal_set_constructor(int comp_id, constructor make);
/* Calls the constructor of a component, in the process that has it. Returns -EXDEV in another process,
 * -ENOSYS without a constructor. */
extern int hal_comp_invoke_make(const char *compname, const char *newname, const char *arg);
/* Stores the parameters with which a component was loaded, for list and save. */
extern int hal_comp_insmod_args(const char *compname, const char *args);

typedef rtapi_realtime_type_t hal_realtime_type_t;
extern hal_realtime_type_t hal_get_realtime_type(void);

/* Current content of the instance. */
typedef struct {
    int components, pins, params, signals, functs, threads, aliases;
    unsigned long memory_used; /* bytes */
    unsigned long memory_size; /* maximum size of the instance in bytes */
} hal_statistics_t;
extern int hal_statistics(hal_statistics_t *sts);

/* ---- pins ----
 * data_ptr_addr must be in memory of hal_malloc. After the call *data_ptr_addr points to the value: the pin's
 * own value while it is not linked, otherwise the value of the signal. Read the pointer again at each use. */
extern int hal_pin_new(const char *name, hal_type_t type, hal_pin_dir_t dir, void **data_ptr_addr,
                       int comp_id);
extern int hal_pin_bit_new(const char *name, hal_pin_dir_t dir, hal_bit_t **data_ptr_addr, int comp_id);
extern int hal_pin_bit_newf(hal_pin_dir_t dir, hal_bit_t **data_ptr_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_pin_float_new(const char *name, hal_pin_dir_t dir, hal_float_t **data_ptr_addr, int comp_id);
extern int hal_pin_float_newf(hal_pin_dir_t dir, hal_float_t **data_ptr_addr, int comp_id, const char *fmt,
                              ...) __attribute__((format(printf, 4, 5)));
extern int hal_pin_u32_new(const char *name, hal_pin_dir_t dir, hal_u32_t **data_ptr_addr, int comp_id);
extern int hal_pin_u32_newf(hal_pin_dir_t dir, hal_u32_t **data_ptr_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_pin_s32_new(const char *name, hal_pin_dir_t dir, hal_s32_t **data_ptr_addr, int comp_id);
extern int hal_pin_s32_newf(hal_pin_dir_t dir, hal_s32_t **data_ptr_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_pin_u64_new(const char *name, hal_pin_dir_t dir, hal_u64_t **data_ptr_addr, int comp_id);
extern int hal_pin_u64_newf(hal_pin_dir_t dir, hal_u64_t **data_ptr_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_pin_s64_new(const char *name, hal_pin_dir_t dir, hal_s64_t **data_ptr_addr, int comp_id);
extern int hal_pin_s64_newf(hal_pin_dir_t dir, hal_s64_t **data_ptr_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_pin_port_new(const char *name, hal_pin_dir_t dir, hal_port_t **data_ptr_addr, int comp_id);
extern int hal_pin_port_newf(hal_pin_dir_t dir, hal_port_t **data_ptr_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
/* Pins used through references, with their initial value. */
extern int hal_pin_new_bool(int compid, hal_pdir_t dir, hal_bool_t *ref, rtapi_bool def, const char *fmt, ...)
    __attribute__((format(printf, 5, 6)));
extern int hal_param_new_bool(int compid, hal_pdir_t dir, hal_bool_t *ref, rtapi_bool def, const char *fmt,
                              ...) __attribute__((format(printf, 5, 6)));
extern int hal_pin_new_real(int compid, hal_pdir_t dir, hal_real_t *ref, rtapi_real def, const char *fmt, ...)
    __attribute__((format(printf, 5, 6)));
extern int hal_param_new_real(int compid, hal_pdir_t dir, hal_real_t *ref, rtapi_real def, const char *fmt,
                              ...) __attribute__((format(printf, 5, 6)));
extern int hal_pin_new_sint(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_sint def, const char *fmt, ...)
    __attribute__((format(printf, 5, 6)));
extern int hal_param_new_sint(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_sint def, const char *fmt,
                              ...) __attribute__((format(printf, 5, 6)));
extern int hal_pin_new_uint(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_uint def, const char *fmt, ...)
    __attribute__((format(printf, 5, 6)));
extern int hal_param_new_uint(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_uint def, const char *fmt,
                              ...) __attribute__((format(printf, 5, 6)));
extern int hal_pin_new_si32(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_s32 def, const char *fmt, ...)
    __attribute__((format(printf, 5, 6)));
extern int hal_param_new_si32(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_s32 def, const char *fmt,
                              ...) __attribute__((format(printf, 5, 6)));
extern int hal_pin_new_ui32(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_u32 def, const char *fmt, ...)
    __attribute__((format(printf, 5, 6)));
extern int hal_param_new_ui32(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_u32 def, const char *fmt,
                              ...) __attribute__((format(printf, 5, 6)));
/* A port has no initial value. */
extern int hal_pin_new_port(int compid, hal_pin_dir_t dir, hal_sint_t *ref, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
/* Memory for one value that the getters read as a parameter. It has no name and is not listed. */
extern int hal_param_new_fake(int compid, hal_refs_u *refs);
/* Adds a second name to a pin; alias NULL removes it. The pin is found by both names; lists show the alias.
 */
extern int hal_pin_alias(const char *pin_name, const char *alias);
extern int hal_param_alias(const char *param_name, const char *alias);

/* ---- getters and setters ----
 * Each call is one aligned access and realtime-safe. */
static inline rtapi_bool hal_get_bool(const hal_bool_t ref) {
    return *(volatile rtapi_bool *)(void *)ref;
}
static inline rtapi_bool hal_set_bool(hal_bool_t ref, rtapi_bool val) {
    *(volatile rtapi_bool *)(void *)ref = val;
    return val;
}
static inline rtapi_real hal_get_real(const hal_real_t ref) {
    return *(volatile rtapi_real *)(void *)ref;
}
static inline rtapi_real hal_set_real(hal_real_t ref, rtapi_real val) {
    *(volatile rtapi_real *)(void *)ref = val;
    return val;
}
static inline rtapi_sint hal_get_sint(const hal_sint_t ref) {
    return *(volatile rtapi_sint *)(void *)ref;
}
static inline rtapi_sint hal_set_sint(hal_sint_t ref, rtapi_sint val) {
    *(volatile rtapi_sint *)(void *)ref = val;
    return val;
}
static inline rtapi_uint hal_get_uint(const hal_uint_t ref) {
    return *(volatile rtapi_uint *)(void *)ref;
}
static inline rtapi_uint hal_set_uint(hal_uint_t ref, rtapi_uint val) {
    *(volatile rtapi_uint *)(void *)ref = val;
    return val;
}
static inline rtapi_s32 hal_get_si32(const hal_sint_t ref) {
    return *(volatile rtapi_s32 *)(void *)ref;
}
static inline rtapi_s32 hal_set_si32(hal_sint_t ref, rtapi_s32 val) {
    *(volatile rtapi_s32 *)(void *)ref = val;
    return val;
}
static inline rtapi_u32 hal_get_ui32(const hal_uint_t ref) {
    return *(volatile rtapi_u32 *)(void *)ref;
}
static inline rtapi_u32 hal_set_ui32(hal_uint_t ref, rtapi_u32 val) {
    *(volatile rtapi_u32 *)(void *)ref = val;
    return val;
}
/* The value limited to the range of 32 bits. */
static inline rtapi_s32 hal_get_si32_clamped(const hal_sint_t ref) {
    const rtapi_sint v = hal_get_sint(ref);
    return v < RTAPI_INT32_MIN ? RTAPI_INT32_MIN : v > RTAPI_INT32_MAX ? RTAPI_INT32_MAX : (rtapi_s32)v;
}
static inline rtapi_u32 hal_get_ui32_clamped(const hal_uint_t ref) {
    const rtapi_uint v = hal_get_uint(ref);
    return v > RTAPI_UINT32_MAX ? RTAPI_UINT32_MAX : (rtapi_u32)v;
}

/* ---- parameters ----
 * The value is at data_addr, in memory of hal_malloc. */
extern int hal_param_new(const char *name, hal_type_t type, hal_param_dir_t dir, void *data_addr,
                         int comp_id);
extern int hal_param_set(const char *name, hal_type_t type, void *value_addr);
extern int hal_param_bit_new(const char *name, hal_param_dir_t dir, hal_bit_t *data_addr, int comp_id);
extern int hal_param_bit_newf(hal_param_dir_t dir, hal_bit_t *data_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_param_bit_set(const char *name, int value);
extern int hal_param_float_new(const char *name, hal_param_dir_t dir, hal_float_t *data_addr, int comp_id);
extern int hal_param_float_newf(hal_param_dir_t dir, hal_float_t *data_addr, int comp_id, const char *fmt,
                                ...) __attribute__((format(printf, 4, 5)));
extern int hal_param_float_set(const char *name, double value);
extern int hal_param_u32_new(const char *name, hal_param_dir_t dir, hal_u32_t *data_addr, int comp_id);
extern int hal_param_u32_newf(hal_param_dir_t dir, hal_u32_t *data_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_param_u32_set(const char *name, unsigned long value);
extern int hal_param_s32_new(const char *name, hal_param_dir_t dir, hal_s32_t *data_addr, int comp_id);
extern int hal_param_s32_newf(hal_param_dir_t dir, hal_s32_t *data_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_param_s32_set(const char *name, signed long value);
extern int hal_param_u64_new(const char *name, hal_param_dir_t dir, hal_u64_t *data_addr, int comp_id);
extern int hal_param_u64_newf(hal_param_dir_t dir, hal_u64_t *data_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_param_u64_set(const char *name, unsigned long value);
extern int hal_param_s64_new(const char *name, hal_param_dir_t dir, hal_s64_t *data_addr, int comp_id);
extern int hal_param_s64_newf(hal_param_dir_t dir, hal_s64_t *data_addr, int comp_id, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));
extern int hal_param_s64_set(const char *name, signed long value);

/* ---- signals ---- */
extern int hal_signal_new(const char *name, hal_type_t type);
/* Unlinks the pins of the signal and removes it. */
extern int hal_signal_delete(const char *name);
/* Links a pin to a signal of the same type. A signal has at most one OUT pin, and no OUT pin together with IO
 * pins. The signal takes the value of its first pin. */
extern int hal_link(const char *pin_name, const char *sig_name);
/* Unlinks a pin. The pin keeps the last value of the signal. */
extern int hal_unlink(const char *pin_name);

/* Type of the value of a pin, signal or parameter, and its address in this process. */
extern int hal_get_pin_value_by_name(const char *name, hal_type_t *type, hal_data_u **data, bool *connected);
extern int hal_get_signal_value_by_name(const char *name, hal_type_t *type, hal_data_u **data,
                                        bool *has_writers);
extern int hal_get_param_value_by_name(const char *name, hal_type_t *type, hal_data_u **data);

/* ---- functions and threads ---- */

/* Exports a function of a realtime component. Threads call it as funct(arg, period in ns). Adds the pin
 * NAME.time and the parameters NAME.tmax and NAME.tmax-increased (nanoseconds; 0 under the virtual clock). */
extern int hal_export_funct(const char *name, void (*funct)(void *, long), void *arg, int uses_fp,
                            int reentrant, int comp_id);
extern int hal_export_functf(void (*funct)(void *, long), void *arg, int uses_fp, int reentrant, int comp_id,
                             const char *fmt, ...) __attribute__((format(printf, 6, 7)));
/* Creates a thread with exactly this period. Returns 0, or a negated errno. Only in the realtime process. */
extern int hal_create_thread(const char *name, unsigned long period_nsec, int uses_fp);
extern int hal_thread_delete(const char *name);
/* Position 1 is the first, 2 the second; -1 is the last, -2 the last but one. 0 is an error. */
extern int hal_add_funct_to_thread(const char *funct_name, const char *thread_name, int position);
/* As above, but the function runs only once, in the thread's next period, before the other functions. */
extern int hal_init_funct_to_thread(const char *funct_name, const char *thread_name, int position);
extern int hal_del_funct_from_thread(const char *funct_name, const char *thread_name);
/* Threads run their functions only between start and stop. */
extern int hal_start_threads(void);
extern int hal_stop_threads(void);

/* Requires exact periods for threads created later. No effect here, because periods are always exact. */
extern void hal_enforce_exact_base_period(void);

extern int hal_set_lock(unsigned char lock_type);
extern unsigned char hal_get_lock(void);

/* Extends a counter of nbits that wraps: returns the value nearest to `old` whose low bits are `newlow`.
 * Realtime-safe. */
static inline rtapi_s64 hal_extend_counter(rtapi_s64 old, rtapi_s64 newlow, int nbits) {
    const int shift = 64 - nbits;
    const rtapi_u64 difference = ((rtapi_u64)newlow - (rtapi_u64)old) << shift;
    return (rtapi_s64)((rtapi_u64)old + (rtapi_u64)((rtapi_s64)difference >> shift));
}

/* ---- streams: a queue of records between one writer and one reader, in any processes ----
 * typestring has a letter for each field: b bit, f float, s s32, u u32, l s64, k u64; at most
 * HAL_STREAM_MAX_PINS. */
typedef union hal_stream_data {
    real_t f;
    bool b;
    rtapi_s32 s;
    rtapi_u32 u;
    rtapi_s64 l;
    rtapi_u64 k;
} hal_stream_data_u;

struct hal_stream_fifo;
/* NOLINTNEXTLINE(bugprone-reserved-identifier): existing code names the struct so */
typedef struct __hal_stream_t {
    int comp_id;
    int shmem_id;
    struct hal_stream_fifo *fifo;
} hal_stream_t;
typedef hal_stream_t *hal_stream_ptr_t;
typedef union {
    hal_stream_data_u *data;
    void *p;
} hal_stream_data_ptr_u;

extern int hal_stream_create(hal_stream_t *stream, int comp, int key, unsigned depth, const char *typestring);
extern void hal_stream_destroy(hal_stream_t *stream);
/* Opens an existing stream. typestring NULL accepts any type; a type that differs from the stream's is
 * -EINVAL. */
extern int hal_stream_attach(hal_stream_t *stream, int comp, int key, const char *typestring);
extern int hal_stream_detach(hal_stream_t *stream);
extern int hal_stream_element_count(hal_stream_t *stream);
extern hal_type_t hal_stream_element_type(hal_stream_t *stream, int idx);
/* Removes the oldest record. *sampleno (if not NULL) receives the number of the writer's attempt, so gaps
 * show lost records. An empty stream returns -ENOSPC and counts an underrun. [reader, realtime-safe] */
extern int hal_stream_read(hal_stream_t *stream, hal_stream_data_u *buf, unsigned *sampleno);
/* Appends a record. A full stream returns -ENOSPC and counts an overrun. [writer, realtime-safe] */
extern int hal_stream_write(hal_stream_t *stream, hal_stream_data_u *buf);
extern bool hal_stream_readable(hal_stream_t *stream);
extern bool hal_stream_writable(hal_stream_t *stream);
extern unsigned hal_stream_depth(hal_stream_t *stream);
extern unsigned hal_stream_maxdepth(hal_stream_t *stream);
extern int hal_stream_num_underruns(hal_stream_t *stream);
extern int hal_stream_num_overruns(hal_stream_t *stream);
/* Waits, with a check each millisecond, until the stream can be read (written) or *stop is not zero. */
extern void hal_stream_wait_readable(hal_stream_t *stream, sig_atomic_t *stop);
extern void hal_stream_wait_writable(hal_stream_t *stream, sig_atomic_t *stop);

/* ---- ports: a queue of bytes on a signal of type port, between its OUT pin and its reader ----
 * The queue exists after the size of the signal is set (sets SIGNAL N: it holds N-1 bytes, N is at most
 * HAL_PORT_SIZE_MAX). Before, and while the pin is not linked, there is nothing to read and no free space. A
 * read or write transfers all bytes or none. Realtime-safe except for the waits. */
extern bool hal_port_read(const hal_port_t *port, char *dest, unsigned count);
/* As hal_port_read, but leaves the bytes in the queue. */
extern bool hal_port_peek(const hal_port_t *port, char *dest, unsigned count);
/* Removes bytes that have been peeked. */
extern bool hal_port_peek_commit(const hal_port_t *port, unsigned count);
extern bool hal_port_write(const hal_port_t *port, const char *src, unsigned count);
/* Number of bytes that can be read (written) now. */
extern unsigned hal_port_readable(const hal_port_t *port);
extern unsigned hal_port_writable(const hal_port_t *port);
/* Size of the signal's buffer, as set. */
extern unsigned hal_port_buffer_size(const hal_port_t *port);
/* Removes the content; only for the reader. */
extern void hal_port_clear(const hal_port_t *port);
/* Wait, with a check each millisecond, until this number of bytes can be read (written) or *stop is not zero.
 */
extern void hal_port_wait_readable(hal_port_t **port, unsigned count, sig_atomic_t *stop);
extern void hal_port_wait_writable(hal_port_t **port, unsigned count, sig_atomic_t *stop);

RTAPI_END_DECLS

#ifndef __cplusplus
/* Some components pass the port's value instead of its address. Both are accepted, because the value of a
 * port is a handle. */
#define HAL_PORT_ARG_(port) ((__typeof__((port) + 0)[1]){(port)})
#define HAL_PORT_ARG(port) _Generic((port), int: HAL_PORT_ARG_(port), default: *HAL_PORT_ARG_(port))
#define hal_port_read(port, dest, count) hal_port_read(HAL_PORT_ARG(port), (dest), (count))
#define hal_port_peek(port, dest, count) hal_port_peek(HAL_PORT_ARG(port), (dest), (count))
#define hal_port_peek_commit(port, count) hal_port_peek_commit(HAL_PORT_ARG(port), (count))
#define hal_port_write(port, src, count) hal_port_write(HAL_PORT_ARG(port), (src), (count))
#define hal_port_readable(port) hal_port_readable(HAL_PORT_ARG(port))
#define hal_port_writable(port) hal_port_writable(HAL_PORT_ARG(port))
#define hal_port_buffer_size(port) hal_port_buffer_size(HAL_PORT_ARG(port))
#define hal_port_clear(port) hal_port_clear(HAL_PORT_ARG(port))
#endif

#include "hal_query.h"

#endif

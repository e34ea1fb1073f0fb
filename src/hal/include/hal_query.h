/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A part of hal.h: queries of the objects in the instance, and values by name. No function here is
 * realtime-safe. */
#ifndef HAL_QUERY_H
#define HAL_QUERY_H

#include "hal.h"

RTAPI_BEGIN_DECLS

/* ---- queries: the objects in the instance, and values by name ----
 * A query contains the criteria and receives the result. `qtype` and `name` select objects; ANY or NULL
 * selects all. For the list functions `name` may be a pattern with * ? [abc]. Texts in a query are valid
 * until the next query of this thread. Callbacks run without a lock and may call any function. */
typedef enum {
    HAL_QTYPE_ANY = 0,
    HAL_QTYPE_COMP,
    HAL_QTYPE_PIN,
    HAL_QTYPE_PARAM,
    HAL_QTYPE_SIGNAL,
    HAL_QTYPE_FUNCT,
    HAL_QTYPE_THREAD,
    HAL_QTYPE_THREAD_FUNCT
} hal_qtype_t;

/* A value. The type selects the member. */
typedef union {
    rtapi_bool b;  /* HAL_BIT */
    rtapi_real r;  /* HAL_FLOAT */
    rtapi_s32 s32; /* HAL_S32 */
    rtapi_u32 u32; /* HAL_U32 */
    rtapi_sint s;  /* HAL_S64 */
    rtapi_uint u;  /* HAL_U64 */
    rtapi_port p;  /* HAL_PORT */
} hal_query_value_u;

typedef struct {
    const char *name;  /* the alias if there is one, else the name */
    const char *alias; /* NULL if there is no alias */
    hal_type_t type;
    hal_pdir_t dir;
    int comp_id;
    const char *comp;   /* the owner's name */
    const char *signal; /* signal of a linked pin, else NULL */
    hal_query_value_u value;
    rtapi_intptr_t ref; /* set by hal_getref_p, for hal_reference_map */
} hal_query_pp_t;

typedef struct {
    const char *name;
    hal_type_t type;
    int readers, writers, bidirs;
    hal_query_value_u value;
    rtapi_intptr_t ref; /* set by hal_getref_s */
} hal_query_sig_t;

typedef struct {
    const char *name;
    int comp_id;
    hal_comp_type_t type;
    int pid;
    int ready;
    const char *insmod; /* the parameters from loadrt, or NULL */
} hal_query_comp_t;

typedef struct {
    const char *name;
    int comp_id;
    const char *comp;
    int users; /* number of uses in threads */
    int reentrant;
} hal_query_funct_t;

typedef struct {
    const char *name;
    int comp_id;
    long period_nsec;
    long time_nsec, tmax_nsec;
    const char *funct; /* with HAL_QTYPE_THREAD_FUNCT: one call for each function, in order of execution */
    int position;      /* position of that function, from 1 */
    int is_init;       /* 1 if the function runs only once */
} hal_query_thread_t;

typedef struct {
    hal_qtype_t qtype;
    const char *name;
    union {
        hal_query_pp_t pp;
        hal_query_sig_t sig;
        hal_query_comp_t comp;
        hal_query_funct_t funct;
        hal_query_thread_t thread;
    };
} hal_query_t;

/* Called for each object found. A return value other than 0 ends the list and becomes the result of the list
 * function. */
typedef int (*hal_query_cb)(hal_query_t *query, void *arg);

/* Finds one component by its id or name. Returns 0, or -ENOENT. */
extern int hal_comp_by_id(int comp_id, hal_query_t *q);
extern int hal_comp_by_name(const char *name, hal_query_t *q);
/* Lists, sorted by name (threads: shortest period first). q may be NULL for all objects. hal_list_p: pins and
 * parameters, or only one of them by qtype. hal_list_p_s: the pins of the signal q->name. hal_list_thread
 * with HAL_QTYPE_THREAD_FUNCT: the functions of each thread. */
extern int hal_list_comp(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_p(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_s(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_p_s(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_funct(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_thread(hal_query_t *q, hal_query_cb cb, void *arg);

/* Finds a pin or parameter (a signal) by query->name and fills the query. Then calls cb, if not NULL, and
 * returns its result. -ENOENT when there is no such object. */
extern int hal_get_p(hal_query_t *query, hal_query_cb cb, void *arg);
extern int hal_get_s(hal_query_t *query, hal_query_cb cb, void *arg);
/* Sets the object to query->pp.value (query->sig.value). If cb is not NULL, it is called first with the
 * current value and stores the new value in the query. If cb returns other than 0, nothing is set and this is
 * the result. Errors are as for setp and sets. */
extern int hal_set_p(hal_query_t *query, hal_query_cb cb, void *arg);
extern int hal_set_s(hal_query_t *query, hal_query_cb cb, void *arg);
/* As hal_get_p and hal_get_s, and stores in `ref` the current position of the value. Linking or unlinking a
 * pin changes the position of its value. */
extern int hal_getref_p(hal_query_t *query);
extern int hal_getref_s(hal_query_t *query);
/* The address of a reference in this process, or NULL. It is valid while the instance is joined. */
extern void *hal_reference_map(rtapi_intptr_t ref);
extern int hal_reference_unmap(const void *ref);

RTAPI_END_DECLS

#endif

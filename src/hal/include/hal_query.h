/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A part of hal.h: what is in the instance, and values by name. Nothing here is realtime-safe. */
#ifndef HAL_QUERY_H
#define HAL_QUERY_H

#include "hal.h"

RTAPI_BEGIN_DECLS

/* ---- queries: what is in the instance, and values by name ----
 * A query says what is looked for and receives what was found. `qtype` and `name` select: ANY, or NULL, is
 * everything; a name of the list functions may be a pattern with * ? [abc]. Texts in a query stay valid until
 * the next query of this thread. Callbacks run without any lock held: they may call anything. */
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

/* A value; the member is the one of its type. */
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
    const char *name;  /* the alias where there is one */
    const char *alias; /* NULL without one */
    hal_type_t type;
    hal_pdir_t dir;
    int comp_id;
    const char *comp;   /* the owner's name */
    const char *signal; /* of a linked pin, else NULL */
    hal_query_value_u value;
    rtapi_intptr_t ref; /* by hal_getref_p: for hal_reference_map */
} hal_query_pp_t;

typedef struct {
    const char *name;
    hal_type_t type;
    int readers, writers, bidirs;
    hal_query_value_u value;
    rtapi_intptr_t ref; /* by hal_getref_s */
} hal_query_sig_t;

typedef struct {
    const char *name;
    int comp_id;
    hal_comp_type_t type;
    int pid;
    int ready;
    const char *insmod; /* the words of loadrt, or NULL */
} hal_query_comp_t;

typedef struct {
    const char *name;
    int comp_id;
    const char *comp;
    int users; /* places in threads */
    int reentrant;
} hal_query_funct_t;

typedef struct {
    const char *name;
    int comp_id;
    long period_nsec;
    long time_nsec, tmax_nsec;
    const char *funct; /* with HAL_QTYPE_THREAD_FUNCT: one call for each function, in order */
    int position;      /* of that function, from 1 */
    int is_init;       /* it runs once */
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

/* Called with each thing found; other than 0 ends the list and is what the list function answers. */
typedef int (*hal_query_cb)(hal_query_t *query, void *arg);

/* One component by its id or name: 0, or -ENOENT. */
extern int hal_comp_by_id(int comp_id, hal_query_t *q);
extern int hal_comp_by_name(const char *name, hal_query_t *q);
/* Lists, sorted by name (threads: fastest first). q may be NULL: everything. hal_list_p: pins and parameters,
 * either kind alone with its qtype. hal_list_p_s: the pins of the signal q->name. hal_list_thread with
 * HAL_QTYPE_THREAD_FUNCT: the functions of each thread. */
extern int hal_list_comp(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_p(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_s(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_p_s(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_funct(hal_query_t *q, hal_query_cb cb, void *arg);
extern int hal_list_thread(hal_query_t *q, hal_query_cb cb, void *arg);

/* Looks up a pin or parameter (a signal) by query->name and fills the query in; then calls cb, if given,
 * whose answer is the result. -ENOENT when there is none. */
extern int hal_get_p(hal_query_t *query, hal_query_cb cb, void *arg);
extern int hal_get_s(hal_query_t *query, hal_query_cb cb, void *arg);
/* Sets it to query->pp.value (query->sig.value). A cb is called first with what is there now and puts the new
 * value in; when it answers other than 0, nothing is set and that is the result. Errors are those of setp and
 * sets.
 */
extern int hal_set_p(hal_query_t *query, hal_query_cb cb, void *arg);
extern int hal_set_s(hal_query_t *query, hal_query_cb cb, void *arg);
/* As hal_get_p and hal_get_s, and gives in `ref` where the value lies now. A pin's place moves when it is
 * linked or unlinked. */
extern int hal_getref_p(hal_query_t *query);
extern int hal_getref_s(hal_query_t *query);
/* The address of a reference in this process, or NULL; it stays valid as long as the instance is joined. */
extern void *hal_reference_map(rtapi_intptr_t ref);
extern int hal_reference_unmap(const void *ref);

RTAPI_END_DECLS

#endif

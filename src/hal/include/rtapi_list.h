/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Circular doubly linked lists whose links are members of the elements. The head of an empty list points to
 * itself. */
#ifndef RTAPI_LIST_H
#define RTAPI_LIST_H

#include <stddef.h>

struct rtapi_list_head {
    struct rtapi_list_head *next;
    struct rtapi_list_head *prev;
};

static inline void RTAPI_INIT_LIST_HEAD(struct rtapi_list_head *list) {
    list->prev = list;
    list->next = list;
}

/* Inserts new_ between two neighbours. */
static inline void rtapi__list_add(struct rtapi_list_head *new_, struct rtapi_list_head *prev,
                                   struct rtapi_list_head *next) {
    new_->prev = prev;
    new_->next = next;
    prev->next = new_;
    next->prev = new_;
}

/* Links two elements, which removes the elements between them. */
static inline void rtapi__list_del(struct rtapi_list_head *prev, struct rtapi_list_head *next) {
    prev->next = next;
    next->prev = prev;
}

static inline void rtapi_list_add(struct rtapi_list_head *new_, struct rtapi_list_head *head) {
    rtapi__list_add(new_, head, head->next);
}

static inline void rtapi_list_add_tail(struct rtapi_list_head *new_, struct rtapi_list_head *head) {
    rtapi__list_add(new_, head->prev, head);
}

/* Clears the element's own links, so that a second removal faults instead of corrupting the list. */
static inline void rtapi_list_del(struct rtapi_list_head *entry) {
    rtapi__list_del(entry->prev, entry->next);
    entry->next = NULL;
    entry->prev = NULL;
}

#define rtapi_container_of(ptr, type, member) ((type *)(void *)((char *)(ptr) - offsetof(type, member)))
#define rtapi_list_entry(ptr, type, member) rtapi_container_of(ptr, type, member)
/* The element at pos must not be removed inside the loop. */
#define rtapi_list_for_each(pos, head) for (pos = (head)->next; pos != (head); pos = pos->next)

#endif

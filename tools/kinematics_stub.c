/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A HAL of one process for kinematics modules: sufficient to load one, list and set its pins, and call its
 * exported functions (tools/compare_kinematics.py). */
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_PINS 512
typedef union {
    double f;
    int32_t s;
    uint32_t u;
    uint8_t b;
    uint64_t whole;
} value_t;
typedef struct {
    char name[128];
    int type, dir;
    int is_pin;
    value_t *value;
} pin_t;
static pin_t pins[MAX_PINS];
static int count;

int stub_count(void) {
    return count;
}
const char *stub_name(int i) {
    return pins[i].name;
}
int stub_type(int i) {
    return pins[i].type;
}
int stub_dir(int i) {
    return pins[i].dir;
}
int stub_is_pin(int i) {
    return pins[i].is_pin;
}
double stub_get(int i) {
    value_t *v = pins[i].value;
    switch (pins[i].type) {
    case 1: return v->b;
    case 2: return v->f;
    case 3: return v->s;
    default: return v->u;
    }
}
void stub_set(int i, double x) {
    value_t *v = pins[i].value;
    switch (pins[i].type) {
    case 1: v->b = x != 0; break;
    case 2: v->f = x; break;
    case 3: v->s = (int32_t)x; break;
    default: v->u = (uint32_t)x; break;
    }
}
static int add(const char *name, int type, int dir, int is_pin, value_t *value) {
    if (count == MAX_PINS) {
        return -12;
    }
    snprintf(pins[count].name, sizeof pins[count].name, "%s", name);
    pins[count].type = type;
    pins[count].dir = dir;
    pins[count].is_pin = is_pin;
    pins[count].value = value;
    ++count;
    return 0;
}
int hal_init(const char *name) {
    (void)name;
    return 1;
}
int hal_ready(int id) {
    (void)id;
    return 0;
}
int hal_unready(int id) {
    (void)id;
    return 0;
}
int hal_set_unready(int id) {
    (void)id;
    return 0;
}
int hal_exit(int id) {
    (void)id;
    return 0;
}
void *hal_malloc(long size) {
    return calloc(1, (size_t)size + 64);
}
int hal_pin_new(const char *name, int type, int dir, void **p, int id) {
    (void)id;
    value_t *v = calloc(1, sizeof *v);
    *p = v;
    return add(name, type, dir, 1, v);
}
int hal_param_new(const char *name, int type, int dir, void *p, int id) {
    (void)id;
    return add(name, type, dir, 0, p);
}
#define NEWF(kind, TYPE)                                                                                     \
    int hal_pin_##kind##_newf(int dir, void **p, int id, const char *fmt, ...) {                             \
        char name[128];                                                                                      \
        va_list a;                                                                                           \
        va_start(a, fmt);                                                                                    \
        vsnprintf(name, sizeof name, fmt, a);                                                                \
        va_end(a);                                                                                           \
        return hal_pin_new(name, TYPE, dir, p, id);                                                          \
    }                                                                                                        \
    int hal_pin_##kind##_new(const char *name, int dir, void **p, int id) {                                  \
        return hal_pin_new(name, TYPE, dir, p, id);                                                          \
    }                                                                                                        \
    int hal_param_##kind##_newf(int dir, void *p, int id, const char *fmt, ...) {                            \
        char name[128];                                                                                      \
        va_list a;                                                                                           \
        va_start(a, fmt);                                                                                    \
        vsnprintf(name, sizeof name, fmt, a);                                                                \
        va_end(a);                                                                                           \
        return hal_param_new(name, TYPE, dir, p, id);                                                        \
    }                                                                                                        \
    int hal_param_##kind##_new(const char *name, int dir, void *p, int id) {                                 \
        return hal_param_new(name, TYPE, dir, p, id);                                                        \
    }
NEWF(bit, 1)
NEWF(float, 2)
NEWF(s32, 3)
NEWF(u32, 4)
int hal_pin_alias(const char *a, const char *b) {
    (void)a;
    (void)b;
    return 0;
}
int hal_param_alias(const char *a, const char *b) {
    (void)a;
    (void)b;
    return 0;
}
int hal_export_funct(const char *n, void *f, void *a, int fp, int r, int id) {
    (void)n;
    (void)f;
    (void)a;
    (void)fp;
    (void)r;
    (void)id;
    return 0;
}
int hal_export_functf(void *f, void *a, int fp, int r, int id, const char *fmt, ...) {
    (void)f;
    (void)a;
    (void)fp;
    (void)r;
    (void)id;
    (void)fmt;
    return 0;
}
int hal_set_constructor(int id, void *f) {
    (void)id;
    (void)f;
    return 0;
}
void rtapi_print(const char *fmt, ...) {
    (void)fmt;
}
void rtapi_print_msg(int level, const char *fmt, ...) {
    if (level > 1) {
        return;
    }
    va_list a;
    va_start(a, fmt);
    vfprintf(stderr, fmt, a);
    va_end(a);
}
int rtapi_snprintf(char *b, unsigned long n, const char *fmt, ...) {
    va_list a;
    va_start(a, fmt);
    int r = vsnprintf(b, n, fmt, a);
    va_end(a);
    return r;
}
int rtapi_get_msg_level(void) {
    return 1;
}
int rtapi_set_msg_level(int l) {
    (void)l;
    return 0;
}
/* Load arguments; they keep their defaults. */
void rtapi_mp_register(const void *info) {
    (void)info;
}

/* Millwright's own function. No other module is loaded. */
void *mw_ext_find_symbol(const char *name) {
    (void)name;
    return NULL;
}

int mw_ext_use_module(const char *symbol, int comp_id) {
    (void)symbol;
    (void)comp_id;
    return 0;
}

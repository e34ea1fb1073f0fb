/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A component that crashes when its pin crasher.now becomes TRUE (loadrt crasher how=null|fpe|abort), or
 * while it is loaded (how=load). */
#include <stdlib.h>
#include <string.h>

#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"

MODULE_LICENSE("GPL");

static char *how = "null";
RTAPI_MP_STRING(how, "how to crash");

static int comp_id;
static hal_bit_t **now;
static volatile int *volatile nowhere;
static volatile int nothing;

static void crash(void) {
    if (strcmp(how, "fpe") == 0) {
        nothing = 7 / nothing;
    } else if (strcmp(how, "abort") == 0) {
        abort();
    } else {
        *nowhere = 1;
    }
}

static void update(void *arg, long period) {
    (void)arg;
    (void)period;
    if (**now) {
        crash();
    }
}

int rtapi_app_main(void) {
    comp_id = hal_init("crasher");
    if (comp_id < 0) {
        return comp_id;
    }
    now = hal_malloc(sizeof(*now));
    if (now == 0 || hal_pin_bit_new("crasher.now", HAL_IN, now, comp_id) < 0 ||
        hal_export_funct("crasher.update", update, 0, 0, 0, comp_id) < 0) {
        hal_exit(comp_id);
        return -1;
    }
    if (strcmp(how, "load") == 0) {
        crash();
    }
    return hal_ready(comp_id);
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}

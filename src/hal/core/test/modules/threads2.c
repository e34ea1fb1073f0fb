/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Makes a fast and a slow thread, and uses the functions of millwright_ext.h. */
#include "millwright_ext.h"
#include "rtapi_app.h"

static long fast = 1000000;
RTAPI_MP_LONG(fast, "period of the fast thread in ns");
static int leak = 0;
RTAPI_MP_INT(leak, "fail after the first thread");

static int comp_id;
static int planner;
static hal_u64_t **plans;

static void plan(void *arg, long long period) {
    (void)arg;
    (void)period;
    **plans += 1;
}

int rtapi_app_main(void) {
    int status;
    comp_id = hal_init("threads2");
    if (comp_id < 0) {
        return comp_id;
    }
    plans = hal_malloc(sizeof(*plans));
    hal_pin_u64_new("threads2.plans", HAL_OUT, plans, comp_id);
    status = hal_create_thread("fast", (unsigned long)fast, 1);
    if (status < 0 || leak) {
        return leak ? -ENODEV : status;
    }
    hal_create_thread("slow", (unsigned long)fast * 4, 1);
    planner = mw_ext_planner_new("plan", fast * 2, plan, 0);
    if (mw_ext_find_symbol("test_loads") != 0) {
        mw_ext_use_module("test_loads", comp_id);
    }
    return hal_ready(comp_id);
}

void rtapi_app_exit(void) {
    mw_ext_planner_delete(planner);
    hal_thread_delete("slow");
    hal_thread_delete("fast");
    hal_exit(comp_id);
}

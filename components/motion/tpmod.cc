// SPDX-License-Identifier: GPL-2.0-or-later
// Stands for motmod's built-in trajectory planner (src/traj), which existing start files load as a module of
// its own.
#include "hal/api/hal.h"
#include "hal/api/rtapi_app.h"

static int component = -1;

int rtapi_app_main(void) {
    component = hal_init("tpmod");
    return component < 0 ? component : hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

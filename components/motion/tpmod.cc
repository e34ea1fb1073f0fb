// SPDX-License-Identifier: GPL-2.0-or-later
// Existing start files load the trajectory planner as a separate module. This module represents the planner
// that motmod contains (src/trajectory), and reports whether a module that replaces it is a planner.
#include "hal/include/hal.h"
#include "hal/include/millwright_ext.h"
#include "hal/include/rtapi_app.h"

static char *replaced_by = nullptr;
RTAPI_MP_STRING(replaced_by, "the planner module that is loaded; it must have all functions");

static int component = -1;

int rtapi_app_main(void) {
    static constexpr const char *FUNCTIONS[] = {"mw_tp_init", "mw_tp_plan"};
    for (const char *name : FUNCTIONS) {
        if (replaced_by != nullptr && mw_ext_find_symbol(name) == nullptr) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s is no planner module, it lacks %s: see docs/developer/extending/planner.md\n",
                            replaced_by, name);
            return -8;  // ENOEXEC
        }
    }
    component = hal_init("tpmod");
    return component < 0 ? component : hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

// SPDX-License-Identifier: GPL-2.0-or-later
// Represents motmod's built-in homing (src/motion/homing), which existing start files load as a separate
// module, and reports whether a module loaded instead of it is a homing module.
#include <string.h>

#include "hal/include/hal.h"
#include "hal/include/millwright_ext.h"
#include "hal/include/rtapi_app.h"
#include "motion/interface/homing_functions.hh"

static char *replaced_by = nullptr;
RTAPI_MP_STRING(replaced_by, "the homing module that is loaded; it must have all functions");

static int component = -1;

static bool isReplaced() {
    char missing[600] = "";
    size_t length = 0;
    for (const char *name : mw::motion::HOMING_FUNCTIONS) {
        const bool is_missing = mw_ext_find_symbol(name) == nullptr;
        const bool room_left = length + strlen(name) + 3 < sizeof missing;
        if (is_missing && room_left) {
            rtapi_snprintf(missing + length, sizeof missing - length, "%s%s", length == 0 ? "" : ", ", name);
            length = strlen(missing);
        }
    }
    if (missing[0] != '\0') {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "%s is no homing module, it lacks %s: see docs/developer/extending/homing.md\n",
                        replaced_by, missing);
    }
    return missing[0] == '\0';
}

int rtapi_app_main(void) {
    if (replaced_by != nullptr && !isReplaced()) {
        return -8;  // ENOEXEC
    }
    component = hal_init("homemod");
    return component < 0 ? component : hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

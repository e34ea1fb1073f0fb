// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of CoreXY machines: joint 0 = X + Y, joint 1 = X - Y, joints 2 to 8 = Z A B C U V W.
#include "components/motion/kinematics_module.hh"
#include "kins/corexy.hh"

static const mw::kins::CoreXy model;
static int component = -1;

MW_KINEMATICS(model);

extern "C" KINEMATICS_TYPE kinematicsType(void) {
    return KINEMATICS_BOTH;
}

/// No hidden state: the planner may call these functions while the servo thread does.
extern "C" RTAPI_EXPORT int mw_kinematics_is_pure(void) {
    return 1;
}

int rtapi_app_main(void) {
    component = hal_init("corexykins");
    return component < 0 ? component : hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

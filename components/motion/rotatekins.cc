// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of machines whose X and Y turn with C (kins/rotate.hh).
#include "components/motion/kinematics_module.hh"
#include "kins/rotate.hh"

static const mw::kins::Rotate model;
static int component = -1;

MW_KINEMATICS(model);
MW_KINEMATICS_PURE;

int rtapi_app_main(void) {
    component = hal_init("rotatekins");
    return component < 0 ? component : hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

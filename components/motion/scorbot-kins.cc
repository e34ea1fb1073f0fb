// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of the Scorbot ER-III (kins/scorbot.hh).
#include "components/motion/kinematics_module.hh"
#include "kins/scorbot.hh"

static const mw::kins::Scorbot model;
static int component = -1;

MW_KINEMATICS(model);
MW_KINEMATICS_PURE;

int rtapi_app_main(void) {
    component = hal_init("scorbot-kins");
    return component < 0 ? component : hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

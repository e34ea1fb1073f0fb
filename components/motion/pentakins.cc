// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of pentapods (kins/pentapod.hh). Pins (out): pentakins.last-iterations of the forward side, and
// max-iterations, the most of a solution so far.
#include "components/motion/iterations.hh"
#include "kins/pentapod.hh"

namespace {

mw::components::IteratingModel<mw::kins::Pentapod> live;
int component = -1;

}  // namespace

MW_KINEMATICS(live);
MW_KINEMATICS_PURE;

int rtapi_app_main(void) {
    component = hal_init("pentakins");
    const int status = component < 0 ? component : live.declare(component, "pentakins");
    if (status < 0) {
        hal_exit(component);
        return status;
    }
    return hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

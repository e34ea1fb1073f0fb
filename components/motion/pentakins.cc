// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of pentapods (kinematics/pentapod.hh). Pins (out): pentakins.last-iterations of the forward
// kinematics, and max-iterations, the maximum of all solutions so far.
#include "components/motion/iterations.hh"
#include "kinematics/pentapod.hh"

namespace {

mw::components::IteratingModel<mw::kinematics::Pentapod> live;

int declare_pins(int comp_id) {
    return live.declare(comp_id, "pentakins");
}

}  // namespace

MW_KINEMATICS(live);
MW_KINEMATICS_PURE;
MW_KINEMATICS_MAIN("pentakins", declare_pins);

// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of CoreXY machines: joint 0 = X + Y, joint 1 = X - Y, joints 2 to 8 = Z A B C U V W.
#include "components/motion/kinematics_module.hh"
#include "kinematics/corexy.hh"

static const mw::kinematics::CoreXy model;

MW_KINEMATICS(model);
MW_KINEMATICS_PURE;
MW_KINEMATICS_MAIN("corexykins", mw::components::no_pins);

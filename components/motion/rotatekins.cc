// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of machines whose X and Y turn with C (kinematics/rotate.hh).
#include "components/motion/kinematics_module.hh"
#include "kinematics/rotate.hh"

static const mw::kinematics::Rotate model;

MW_KINEMATICS(model);
MW_KINEMATICS_PURE;
MW_KINEMATICS_MAIN("rotatekins", mw::components::no_pins);

// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of machines whose X and Y turn with C (kins/rotate.hh).
#include "components/motion/kinematics_module.hh"
#include "kins/rotate.hh"

static const mw::kins::Rotate model;

MW_KINEMATICS(model);
MW_KINEMATICS_PURE;
MW_KINEMATICS_MAIN("rotatekins", mw::components::no_pins);

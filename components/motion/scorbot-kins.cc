// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of the Scorbot ER-III (kinematics/scorbot.hh).
#include "components/motion/kinematics_module.hh"
#include "kinematics/scorbot.hh"

static const mw::kinematics::Scorbot model;

MW_KINEMATICS(model);
MW_KINEMATICS_PURE;
MW_KINEMATICS_MAIN("scorbot-kins", mw::components::no_pins);

// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a mill with a tilting head and a rotary table (kinematics/tilting_head.hh).
#include "components/motion/model_pins.hh"
#include "kinematics/tilting_head.hh"

MW_MODEL_MODULE(mw::kinematics::TiltingHead, "maxkins");

// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of deltas with rotating arms (kinematics/rotary_delta.hh).
#include "components/motion/model_pins.hh"
#include "kinematics/rotary_delta.hh"

MW_MODEL_MODULE(mw::kinematics::RotaryDelta, "rotarydeltakins");

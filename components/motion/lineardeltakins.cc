// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of deltas with linear carriages (kinematics/linear_delta.hh). Pins lineardeltakins.R, L.
#include "components/motion/model_pins.hh"
#include "kinematics/linear_delta.hh"

MW_MODEL_MODULE(mw::kinematics::LinearDelta, "lineardeltakins");

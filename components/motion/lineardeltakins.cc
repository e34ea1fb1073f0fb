// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of deltas with linear carriages (kins/linear_delta.hh). Pins lineardeltakins.R, L.
#include "components/motion/model_pins.hh"
#include "kins/linear_delta.hh"

MW_MODEL_MODULE(mw::kins::LinearDelta, "lineardeltakins");

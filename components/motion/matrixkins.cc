// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of machines whose axes were measured (kins/matrix.hh).
#include "components/motion/model_pins.hh"
#include "kins/matrix.hh"

MW_MODEL_MODULE(mw::kins::Matrix, "matrixkins");

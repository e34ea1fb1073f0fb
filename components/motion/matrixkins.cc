// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of machines whose axes were measured (kinematics/matrix.hh).
#include "components/motion/model_pins.hh"
#include "kinematics/matrix.hh"

MW_MODEL_MODULE(mw::kinematics::Matrix, "matrixkins");

// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a point at given distances from three others (kinematics/tripod.hh). Pins tripodkins.Bx, Cx,
// Cy.
#include "components/motion/model_pins.hh"
#include "kinematics/tripod.hh"

MW_MODEL_MODULE(mw::kinematics::Tripod, "tripodkins");

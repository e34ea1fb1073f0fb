// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a point held at three distances (kins/tripod.hh). Pins tripodkins.Bx, Cx, Cy.
#include "components/motion/model_pins.hh"
#include "kins/tripod.hh"

MW_MODEL_MODULE(mw::kins::Tripod, "tripodkins");

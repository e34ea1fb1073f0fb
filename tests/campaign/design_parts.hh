// SPDX-License-Identifier: GPL-2.0-or-later
// Building blocks of random machines.
#pragma once

#include "campaign/design.hh"

namespace mw::campaign {

double rounded(double x, double step);
/// Ten to the power of a random number.
double power(plants::Random &random, double low, double high);
JointDesign make_joint(plants::Random &random, bool isAngular, bool isJerkLimited);
/// A joint of a machine whose joints are not axes: travel from -reach to reach, homed at its position.
JointDesign make_plain(plants::Random &random, bool isAngular, double reach, bool isJerkLimited);
AxisDesign axis_of(int axis, const JointDesign &j);

}  // namespace mw::campaign

// SPDX-License-Identifier: GPL-2.0-or-later
// The offset profile of a lathe cycle: at least the distance D from the profile everywhere, also where a
// bottom or a step is narrower than D.
#pragma once

#include "gcode/interpreter/codes/lathe/lathe_profile.hh"

namespace mw::gcode::detail {

/// The upper edge of all circles with radius `by` (not negative) around points of the profile. It begins and
/// ends perpendicular to the profile's ends. If the profile falls from its first point, the circle of this
/// point ends on the profile, so that the approach does not cross the material. The first segment keeps its
/// start and ends at the edge. Nearly straight neighbours are joined without an arc if that changes the edge
/// by less than `tolerance`.
Profile offset_profile(const Profile &profile, double by, double tolerance);

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// The profile of a lathe cycle at a distance: as far from it as D says everywhere, so also where a bottom or
// a step is narrower than that.
#pragma once

#include "gcode/interpreter/codes/lathe/lathe_profile.hh"

namespace mw::gcode::detail {

/// The upper edge of all circles of the radius `by`, which is not negative, around points of the profile. It
/// begins and ends square to the profile's ends; where the profile falls from its first point, that point's
/// circle leads to it, so that the way to the beginning does not cross the material. The first segment keeps
/// its start and leads to the edge. Neighbours that are nearly straight meet without an arc between them
/// where that leaves the edge by less than `tolerance`.
Profile offset_profile(const Profile &profile, double by, double tolerance);

}  // namespace mw::gcode::detail

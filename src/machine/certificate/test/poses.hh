// SPDX-License-Identifier: GPL-2.0-or-later
// Poses for the tests of this folder.
#pragma once

#include "base/geometry/pose.hh"

namespace mw::machine {

inline geometry::Pose at(double x, double y, double z = 0, double a = 0) {
    geometry::Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    p[3] = a;
    return p;
}

}  // namespace mw::machine

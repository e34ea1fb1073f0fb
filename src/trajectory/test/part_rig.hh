// SPDX-License-Identifier: GPL-2.0-or-later
// Limits and moves for tests of single parts.
#pragma once

#include "trajectory/path/limits.hh"
#include "trajectory/path/move_request.hh"

namespace mw::trajectory::test {

inline constexpr double PERIOD = 1e-3;

inline Pose at(double x, double y = 0, double z = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

/// The same limits for every axis, none for the norm.
inline Limits even_limits(double v, double a) {
    Limits l;
    l.velocity.fill(v);
    l.acceleration.fill(a);
    l.jerk.fill(UNLIMITED);
    l.velocity[XYZ_NORM] = UNLIMITED;
    l.acceleration[XYZ_NORM] = UNLIMITED;
    return l;
}

inline Limits even_limits(double v, double a, double j) {
    Limits l = even_limits(v, a);
    l.jerk.fill(j);
    l.jerk[XYZ_NORM] = UNLIMITED;
    l.isJerkLimited = true;
    return l;
}

inline MoveRequest asking(double feed, geometry::PathMode join = geometry::PathMode::BLEND,
                          double tolerance = 0) {
    MoveRequest r;
    r.tag.requested_velocity = feed;
    r.join = join;
    r.tolerance = tolerance;
    return r;
}

}  // namespace mw::trajectory::test

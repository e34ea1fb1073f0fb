// SPDX-License-Identifier: GPL-2.0-or-later
// What tests of single parts begin with: plain limits, a path of lines, pieces and phases made by hand.
#pragma once

#include <memory>

#include "trajectory/path/path_builder.hh"
#include "trajectory/timing/speed_profile.hh"

namespace mw::trajectory::test {

inline constexpr double PERIOD = 1e-3;

inline Pose at(double x, double y = 0, double z = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

/// The same for every axis, none for the norm.
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

/// A path and its conditions, without a planner.
struct Parts {
    std::unique_ptr<PathStore> store = std::make_unique_for_overwrite<PathStore>();
    std::unique_ptr<PlannedPath> path = std::make_unique<PlannedPath>(*store);
    Conditions conditions{PERIOD};

    explicit Parts(const Limits &limits) { conditions.limits.set(limits); }
    PathView view() const { return {*path, conditions}; }

    /// A straight move along X from where the path ends, as one piece.
    Sequence add_straight(double length, double v_limit, double a, bool isStopBefore = false) {
        const double start = path->programmed_length();
        const Sequence n = path->append_move();
        path->primitive(n) = make_line(at(start), at(start + length));
        PlannedMove &m = path->move(n);
        m = {};
        m.start_s = start;
        Piece piece;
        piece.primitive = n;
        piece.move = n;
        piece.length = length;
        piece.isToEnd = true;
        piece.acceleration = AccelBound::constant(a);
        path->append_piece(piece, {v_limit, isStopBefore});
        return path->last_piece();
    }
};

}  // namespace mw::trajectory::test

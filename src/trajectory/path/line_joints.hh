// SPDX-License-Identifier: GPL-2.0-or-later
// What joints that are not axes do along a line that is driven to and fro, as a tap is. Planning side, pure.
#pragma once

#include "trajectory/path/limited_motion.hh"
#include "trajectory/path/workspace.hh"

namespace mw::trajectory {

/// Largest derivatives of each joint by the way along a line.
struct LineJoints {
    struct Row {
        double q1 = 0, q2 = 0, q3 = 0;
    };
    std::array<Row, MAX_JOINTS> rows{};
    bool isReachable = false;  ///< all of it

    /// Maximum speed along the line at which the joints still have an acceleration.
    double most_speed(const JointLimits &joints) const noexcept;
    /// Acceleration and jerk along the line that the joints can do in either direction at every speed up to
    /// `v`. Without jerk limits the jerk is UNLIMITED.
    MotionLimits limits_at(const JointLimits &joints, double v, bool has_jerk_limits) const noexcept;
};

/// On the part [from, to] of a line, which may extend past its ends. By differences of the inverse
/// kinematics.
LineJoints joints_along(const Workspace &workspace, const Primitive &line, double from, double to) noexcept;

}  // namespace mw::trajectory

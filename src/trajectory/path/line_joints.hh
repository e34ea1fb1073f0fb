// SPDX-License-Identifier: GPL-2.0-or-later
// Motion of joints that are not axes along a line that is traversed in both directions, as in a tap. For the
// planner; pure functions.
#pragma once

#include "trajectory/path/limited_motion.hh"
#include "trajectory/path/workspace.hh"

namespace mw::trajectory {

/// Maximum derivatives of each joint by the position along a line.
struct LineJoints {
    struct Row {
        double q1 = 0, q2 = 0, q3 = 0;
    };
    std::array<Row, MAX_JOINTS> rows{};
    bool isReachable = false;  ///< the joints can reach the whole line

    /// Maximum speed along the line at which the joints have acceleration and jerk left for changes of speed
    /// [unit/s].
    double most_speed(const JointLimits &joints) const noexcept;
    /// Acceleration and jerk along the line within the joint limits, in both directions, at every speed up to
    /// `v`. Without jerk limits the jerk is UNLIMITED.
    MotionLimits limits_at(const JointLimits &joints, double v, bool has_jerk_limits) const noexcept;
};

/// Evaluates the part [from, to] of a line, which may extend past its ends, by differences of the inverse
/// kinematics.
LineJoints joints_along(const Workspace &workspace, const Primitive &line, double from, double to) noexcept;

}  // namespace mw::trajectory

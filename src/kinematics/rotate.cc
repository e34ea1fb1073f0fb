// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/rotate.hh"

#include <algorithm>

#include "kinematics/frame.hh"

namespace mw::kinematics {

Status Rotate::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, geometry::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    std::copy_n(joints, geometry::AXIS_COUNT, pose.c.begin());
    set_place(pose, turned_z(place_of(pose), -joints[geometry::AXIS_C]));
    return Status::OK;
}

Status Rotate::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const Vector place = turned_z(place_of(pose), pose[geometry::AXIS_C]);
    std::copy(pose.c.begin(), pose.c.end(), joints);
    joints[0] = place.x;
    joints[1] = place.y;
    return Status::OK;
}

/// X and Y move joints 0 and 1, rotated by C; C also moves these joints.
LinearJoints Rotate::linear() const noexcept {
    LinearJoints out = joints_like_axes();
    constexpr std::uint32_t TURNED_JOINTS = 3;
    constexpr std::uint32_t TURNING_AXES =
        1U << geometry::AXIS_X | 1U << geometry::AXIS_Y | 1U << geometry::AXIS_C;
    out.joints &= ~TURNED_JOINTS;
    out.axes &= ~TURNING_AXES;
    out.slope[0] = out.slope[1] = {};
    return out;
}

}  // namespace mw::kinematics

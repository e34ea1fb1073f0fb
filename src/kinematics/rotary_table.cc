// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/rotary_table.hh"

#include <cmath>

#include "kinematics/frame.hh"

namespace mw::kinematics {

Status RotaryTable::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const double c = std::cos(pose[geometry::AXIS_C] * RADIANS);
    const double s = std::sin(pose[geometry::AXIS_C] * RADIANS);
    const double x = c * pose[0] + s * pose[1];
    const double y = c * pose[1] - s * pose[0] - tilt_y_;
    const double z = pose[2] - tilt_z_;
    const double ca = std::cos(pose[geometry::AXIS_A] * RADIANS);
    const double sa = std::sin(pose[geometry::AXIS_A] * RADIANS);
    joints[0] = x;
    joints[1] = tilt_y_ + ca * y + sa * z;
    joints[2] = tilt_z_ + ca * z - sa * y;
    joints[3] = pose[geometry::AXIS_A];
    joints[4] = pose[geometry::AXIS_C];
    return Status::OK;
}

Status RotaryTable::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, 5)) {
        return Status::UNREACHABLE;
    }
    const double ca = std::cos(joints[3] * RADIANS);
    const double sa = std::sin(joints[3] * RADIANS);
    const double y = joints[1] - tilt_y_;
    const double z = joints[2] - tilt_z_;
    const double x1 = joints[0];
    const double y1 = tilt_y_ + ca * y - sa * z;
    const double z1 = tilt_z_ + sa * y + ca * z;
    const double c = std::cos(joints[4] * RADIANS);
    const double s = std::sin(joints[4] * RADIANS);
    pose = {};
    pose[0] = c * x1 - s * y1;
    pose[1] = s * x1 + c * y1;
    pose[2] = z1;
    pose[geometry::AXIS_A] = joints[3];
    pose[geometry::AXIS_C] = joints[4];
    return Status::OK;
}

}  // namespace mw::kinematics

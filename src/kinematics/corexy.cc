// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/corexy.hh"

#include "kinematics/frame.hh"

namespace mw::kinematics {

Status CoreXy::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, geometry::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    pose[geometry::AXIS_X] = 0.5 * (joints[0] + joints[1]);
    pose[geometry::AXIS_Y] = 0.5 * (joints[0] - joints[1]);
    for (int i = geometry::AXIS_Z; i < geometry::AXIS_COUNT; ++i) {
        pose[i] = joints[i];
    }
    return Status::OK;
}

Status CoreXy::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    joints[0] = pose[geometry::AXIS_X] + pose[geometry::AXIS_Y];
    joints[1] = pose[geometry::AXIS_X] - pose[geometry::AXIS_Y];
    for (int i = geometry::AXIS_Z; i < geometry::AXIS_COUNT; ++i) {
        joints[i] = pose[i];
    }
    return Status::OK;
}

LinearJoints CoreXy::linear() const noexcept {
    LinearJoints out = joints_like_axes();
    out.slope[0][geometry::AXIS_Y] = 1;
    out.slope[1][geometry::AXIS_X] = 1;
    out.slope[1][geometry::AXIS_Y] = -1;
    return out;
}

}  // namespace mw::kinematics

// SPDX-License-Identifier: GPL-2.0-or-later
#include "kins/corexy.hh"

#include "kins/frame.hh"

namespace mw::kins {

Status CoreXy::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, geom::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    pose[geom::AXIS_X] = 0.5 * (joints[0] + joints[1]);
    pose[geom::AXIS_Y] = 0.5 * (joints[0] - joints[1]);
    for (int i = geom::AXIS_Z; i < geom::AXIS_COUNT; ++i) {
        pose[i] = joints[i];
    }
    return Status::OK;
}

Status CoreXy::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    joints[0] = pose[geom::AXIS_X] + pose[geom::AXIS_Y];
    joints[1] = pose[geom::AXIS_X] - pose[geom::AXIS_Y];
    for (int i = geom::AXIS_Z; i < geom::AXIS_COUNT; ++i) {
        joints[i] = pose[i];
    }
    return Status::OK;
}

LinearJoints CoreXy::linear() const noexcept {
    LinearJoints out = joints_like_axes();
    out.slope[0][geom::AXIS_Y] = 1;
    out.slope[1][geom::AXIS_X] = 1;
    out.slope[1][geom::AXIS_Y] = -1;
    return out;
}

}  // namespace mw::kins

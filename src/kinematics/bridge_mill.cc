// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/bridge_mill.hh"

namespace mw::kinematics {

/// Offset of the X, Y and Z joints from the tool tip.
Vector BridgeMill::lead(const Pose &pose) const noexcept {
    const double b = pose[geometry::AXIS_B];
    const double c = pose[geometry::AXIS_C];
    const double arm = get(0) + pose[geometry::AXIS_W];
    return {-arm * sine(b) * cosine(c), -arm * sine(b) * sine(c), arm * cosine(b) - get(0)};
}

Status BridgeMill::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, letters_.identity()->num_joints)) {
        return Status::UNREACHABLE;
    }
    Pose found = pose;
    letters_.forward(joints, found);
    set_place(found, place_of(found) - lead(found));
    if (!isFinite(found)) {
        return Status::UNREACHABLE;
    }
    pose = found;
    return Status::OK;
}

Status BridgeMill::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    Pose places = pose;
    set_place(places, place_of(pose) + lead(pose));
    return letters_.inverse(places, joints);
}

}  // namespace mw::kinematics

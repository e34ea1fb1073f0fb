// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/tilting_head.hh"

#include <algorithm>

namespace mw::kinematics {

/// Offset of the X, Y and Z joints from the point on the rotated table.
Vector TiltingHead::lead(double b, double u, double v, double w) const noexcept {
    const double s = sine(b);
    const double c = cosine(b);
    return {u * c - (get(0) + w) * s, v, u * s + w * c - get(0) * (1.0 - c)};
}

Status TiltingHead::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, geometry::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    std::copy_n(joints, geometry::AXIS_COUNT, pose.c.begin());
    const Vector ahead = lead(joints[geometry::AXIS_B], joints[geometry::AXIS_U], joints[geometry::AXIS_V],
                              joints[geometry::AXIS_W]);
    set_place(pose, turned_z(place_of(pose) - ahead, joints[geometry::AXIS_C]));
    return Status::OK;
}

Status TiltingHead::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const Vector ahead =
        lead(pose[geometry::AXIS_B], pose[geometry::AXIS_U], pose[geometry::AXIS_V], pose[geometry::AXIS_W]);
    const Vector place = turned_z(place_of(pose), -pose[geometry::AXIS_C]) + ahead;
    std::copy(pose.c.begin(), pose.c.end(), joints);
    joints[0] = place.x;
    joints[1] = place.y;
    joints[2] = place.z;
    return Status::OK;
}

}  // namespace mw::kinematics

// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/rose.hh"

#include "kinematics/frame.hh"

namespace mw::kinematics {

namespace {

constexpr double ON_AXIS = 1e-9;  ///< [machine units]

}  // namespace

Status Rose::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, 3) || joints[0] < 0) {
        return Status::UNREACHABLE;
    }
    set_place(pose, {joints[0] * cosine(joints[2]), joints[0] * sine(joints[2]), joints[1]});
    return joints[0] > ON_AXIS ? Status::OK : Status::SINGULAR;
}

Status Rose::inverse(const Pose &pose, double *joints) const noexcept {
    const Vector place = place_of(pose);
    if (!isFinite(place)) {
        return Status::UNREACHABLE;
    }
    const double radius = std::hypot(place.x, place.y);
    joints[0] = radius;
    joints[1] = place.z;
    if (!(radius > ON_AXIS)) {
        return Status::SINGULAR;
    }
    joints[2] = nearest_turn(arc_tangent(place.y, place.x), joints[2]);
    return Status::OK;
}

}  // namespace mw::kinematics

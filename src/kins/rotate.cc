// SPDX-License-Identifier: GPL-2.0-or-later
#include "kins/rotate.hh"

#include <algorithm>

#include "kins/frame.hh"

namespace mw::kins {

Status Rotate::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, geom::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    std::copy_n(joints, geom::AXIS_COUNT, pose.c.begin());
    set_place(pose, turned_z(place_of(pose), -joints[geom::AXIS_C]));
    return Status::OK;
}

Status Rotate::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const Vector place = turned_z(place_of(pose), pose[geom::AXIS_C]);
    std::copy(pose.c.begin(), pose.c.end(), joints);
    joints[0] = place.x;
    joints[1] = place.y;
    return Status::OK;
}

}  // namespace mw::kins

// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/trivial.hh"

#include <cstring>

namespace mw::kinematics {

bool Trivial::configure(const char *letters) noexcept {
    const std::size_t count = std::strlen(letters);
    if (count == 0 || count > static_cast<std::size_t>(MAX_JOINTS)) {
        return false;
    }
    IdentityMap map;
    map.axis_of_joint.fill(-1);
    for (std::size_t i = 0; i < count; ++i) {
        const int axis = geometry::axis_of_letter(letters[i]);
        if (axis < 0) {
            return false;
        }
        map.axis_of_joint[i] = static_cast<std::int8_t>(axis);
    }
    map.num_joints = static_cast<int>(count);
    map_ = map;
    return true;
}

Status Trivial::forward(const double *joints, Pose &pose) const noexcept {
    // The first joint of a gantry determines the axis; axes without a joint are not changed.
    for (int j = map_.num_joints - 1; j >= 0; --j) {
        pose[map_.axis_of_joint[static_cast<std::size_t>(j)]] = joints[j];
    }
    return Status::OK;
}

Status Trivial::inverse(const Pose &pose, double *joints) const noexcept {
    for (int j = 0; j < map_.num_joints; ++j) {
        joints[j] = pose[map_.axis_of_joint[static_cast<std::size_t>(j)]];
    }
    return Status::OK;
}

}  // namespace mw::kinematics

// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/tripod.hh"

#include "kinematics/spheres.hh"

namespace mw::kinematics {

/// In the plane of the motors the joints are the same for a step up and a step down.
Status Tripod::status_at(double z) const noexcept {
    const double size = std::abs(get(BX)) + std::abs(get(CX)) + std::abs(get(CY));
    return std::abs(z) > FLAT * size ? Status::OK : Status::SINGULAR;
}

Status Tripod::forward(const double *joints, Pose &pose) const noexcept {
    const std::array<Sphere, 3> spheres{Sphere{{}, joints[0]}, Sphere{{get(BX), 0, 0}, joints[1]},
                                        Sphere{{get(CX), get(CY), 0}, joints[2]}};
    const bool are_lengths = joints[0] >= 0 && joints[1] >= 0 && joints[2] >= 0;
    const auto meeting = meeting_of(spheres);
    if (!areFinite(joints, 3) || !are_lengths || !meeting.has_value()) {
        return Status::UNREACHABLE;
    }
    Vector place = meeting->above;
    place.z = pose[geometry::AXIS_Z] < 0 ? -meeting->height : meeting->height;
    set_place(pose, place);
    return status_at(place.z);
}

Status Tripod::inverse(const Pose &pose, double *joints) const noexcept {
    const Vector place = place_of(pose);
    if (!isFinite(place)) {
        return Status::UNREACHABLE;
    }
    joints[0] = length(place);
    joints[1] = length(place - Vector{get(BX), 0, 0});
    joints[2] = length(place - Vector{get(CX), get(CY), 0});
    return status_at(place.z);
}

int Tripod::side(const Pose &pose) const noexcept {
    const double z = pose[geometry::AXIS_Z];
    return (z > 0 ? 1 : 0) - (z < 0 ? 1 : 0);
}

}  // namespace mw::kinematics

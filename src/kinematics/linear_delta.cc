// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/linear_delta.hh"

#include <algorithm>

#include "kinematics/spheres.hh"

namespace mw::kinematics {

Vector LinearDelta::carriage(int index, double height) const noexcept {
    const double angle = 90.0 + 120.0 * index;
    return {get(R) * cosine(angle), get(R) * sine(angle), height};
}

Status LinearDelta::forward(const double *joints, Pose &pose) const noexcept {
    std::array<Sphere, 3> spheres;
    for (int i = 0; i < 3; ++i) {
        spheres[static_cast<std::size_t>(i)] = {carriage(i, joints[i]), get(L)};
    }
    const auto meeting = meeting_of(spheres);
    if (!areFinite(joints, geometry::AXIS_COUNT) || !meeting.has_value()) {
        return Status::UNREACHABLE;
    }
    // The carriages are numbered clockwise as seen from above, so the effector is on the other side. It hangs
    // from rods that point down, which is not possible with large height differences of the carriages.
    const Vector place = meeting->below;
    const bool hanging = place.z <= joints[0] && place.z <= joints[1] && place.z <= joints[2];
    if (!hanging) {
        return Status::UNREACHABLE;
    }
    std::copy_n(joints, geometry::AXIS_COUNT, pose.c.begin());
    set_place(pose, place);
    return meeting->height > FLAT * get(L) ? Status::OK : Status::SINGULAR;
}

Status LinearDelta::inverse(const Pose &pose, double *joints) const noexcept {
    const Vector place = place_of(pose);
    std::array<Vector, 3> rods;
    double least = 1;
    for (int i = 0; i < 3; ++i) {
        Vector rod = carriage(i, 0) - place;
        const double rise = square(get(L)) - square(rod.x) - square(rod.y);
        if (!(rise >= 0)) {
            return Status::UNREACHABLE;
        }
        rod.z = std::sqrt(rise);
        least = std::min(least, rod.z / get(L));
        rods[static_cast<std::size_t>(i)] = rod;
    }
    // With large height differences of the carriages the effector is above their plane. It reaches this pose
    // only through a singular pose with all rods in one plane, and forward() reports the other side.
    const double spread = spread_of(rods[0], rods[1], rods[2]);
    if (!isFinite(pose) || !(spread >= 0)) {
        return Status::UNREACHABLE;
    }
    std::copy(pose.c.begin(), pose.c.end(), joints);
    for (int i = 0; i < 3; ++i) {
        joints[i] = place.z + rods[static_cast<std::size_t>(i)].z;
    }
    return least > FLAT && spread > FLAT ? Status::OK : Status::SINGULAR;
}

}  // namespace mw::kinematics

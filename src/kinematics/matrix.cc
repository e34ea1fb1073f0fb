// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/matrix.hh"

#include <algorithm>

#include "kinematics/spheres.hh"

namespace mw::kinematics {

bool Matrix::isSound() const noexcept {
    return std::abs(spread_of(row(0), row(3), row(6))) > FLAT;
}

Status Matrix::forward(const double *joints, Pose &pose) const noexcept {
    if (!isSound() || !areFinite(joints, geometry::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    // By Cramer's rule, the cross products of the rows are the columns of the inverse.
    const Vector yz = cross(row(3), row(6));
    const Vector zx = cross(row(6), row(0));
    const Vector xy = cross(row(0), row(3));
    const double determinant = dot(row(0), yz);
    std::copy_n(joints, geometry::AXIS_COUNT, pose.c.begin());
    set_place(pose, (yz * joints[0] + zx * joints[1] + xy * joints[2]) * (1.0 / determinant));
    return Status::OK;
}

Status Matrix::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isSound() || !isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const Vector place = place_of(pose);
    std::copy(pose.c.begin(), pose.c.end(), joints);
    joints[0] = dot(row(0), place);
    joints[1] = dot(row(3), place);
    joints[2] = dot(row(6), place);
    return Status::OK;
}

LinearJoints Matrix::linear() const noexcept {
    LinearJoints out = joints_like_axes();
    bool are_numbers = true;
    for (int j = 0; j < 3; ++j) {
        const Vector c = row(3 * static_cast<std::size_t>(j));
        set_place(out.slope[static_cast<std::size_t>(j)], c);
        are_numbers = are_numbers && isFinite(c);
    }
    return are_numbers ? out : LinearJoints{};
}

}  // namespace mw::kinematics

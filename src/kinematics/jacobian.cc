// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/jacobian.hh"

#include <algorithm>

namespace mw::kinematics {

Status joints_by_pose(const Kinematics &model, const Pose &pose, const double *joints, unsigned axes,
                      double step, Jacobian &out) noexcept {
    out = {};
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (((axes >> axis) & 1U) == 0) {
            continue;
        }
        std::array<std::array<double, MAX_JOINTS>, 2> at{};
        for (std::size_t side = 0; side < 2; ++side) {
            Pose beside = pose;
            beside[axis] += side == 0 ? -step : step;
            std::copy_n(joints, MAX_JOINTS, at[side].begin());
            const Status status = model.inverse(beside, at[side].data());
            if (status != Status::OK) {
                return status;
            }
        }
        for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
            out.of[j][static_cast<std::size_t>(axis)] = (at[1][j] - at[0][j]) / (2.0 * step);
        }
    }
    return Status::OK;
}

Status pose_by_joints(const Kinematics &model, const double *joints, int count, const Pose &pose, double step,
                      Jacobian &out) noexcept {
    out = {};
    for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
        std::array<Pose, 2> at{pose, pose};
        for (std::size_t side = 0; side < 2; ++side) {
            std::array<double, MAX_JOINTS> beside{};
            std::copy_n(joints, MAX_JOINTS, beside.begin());
            beside[j] += side == 0 ? -step : step;
            const Status status = model.forward(beside.data(), at[side]);
            if (status != Status::OK) {
                return status;
            }
        }
        for (std::size_t axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            out.of[j][axis] = (at[1].c[axis] - at[0].c[axis]) / (2.0 * step);
        }
    }
    return Status::OK;
}

}  // namespace mw::kinematics

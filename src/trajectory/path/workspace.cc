// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/workspace.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

bool Workspace::holds(const Pose &pose) const noexcept {
    bool isInside = true;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        isInside = isInside && pose[i] >= low[i] && pose[i] <= high[i];
    }
    double at[MAX_JOINTS] = {};
    const bool isAsked = isInside && isMapped() && joint_room.joints != 0;
    isInside = isInside && (!isAsked || map->joints_at(pose, at));
    for (std::uint32_t left = isAsked ? joint_room.joints : 0; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        isInside = isInside && at[j] >= joint_room.low[j] && at[j] <= joint_room.high[j];
    }
    return isInside;
}

Pose Workspace::shift_within(const Pose &corner, const Pose &shift) const noexcept {
    Pose kept;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double least = std::min(low[i] - corner[i], 0.0);
        const double most = std::max(high[i] - corner[i], 0.0);
        kept[i] = std::clamp(shift[i], least, most);
    }
    double as_programmed[MAX_JOINTS] = {};
    double moved[MAX_JOINTS] = {};
    if (!isMapped() || !map->joints_at(corner, as_programmed)) {
        return kept;
    }
    bool isInside = map->joints_at(corner + kept, moved);
    for (int j = 0; j < joints.count && isInside; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const bool isKept = (joint_room.joints >> j & 1U) != 0;
        const double least = isKept ? joint_room.low[n] : joints.low[n];
        const double most = isKept ? joint_room.high[n] : joints.high[n];
        isInside =
            moved[j] >= std::min(least, as_programmed[j]) && moved[j] <= std::max(most, as_programmed[j]);
    }
    return isInside ? kept : Pose{};
}

namespace {

/// Where joints and their derivatives are taken along a piece.
int samples_of(const PathStore &store, const Piece &piece) noexcept {
    if (!piece.isAlong) {
        return JointTuning::SAMPLES;
    }
    const double turns =
        std::abs(store.primitive(piece.primitive).omega) * piece.length / PathTuning::ARC_CUT;
    return std::clamp(2 * static_cast<int>(std::ceil(turns)) + 1, JointTuning::SAMPLES,
                      JointTuning::MOST_SAMPLES);
}

}  // namespace

void sample_rows(const PathStore &store, const Piece &piece, const Workspace &workspace,
                 const double *curvatures, LimitRow *rows) noexcept {
    const int samples = samples_of(store, piece);
    const double h = std::min(JointTuning::STEP, 0.25 * piece.length);
    for (int n = 0; n < samples; ++n) {
        const double x = std::clamp(piece.length * n / (samples - 1), h, piece.length - h);
        double before[MAX_JOINTS] = {};
        double at[MAX_JOINTS] = {};
        double after[MAX_JOINTS] = {};
        const bool isFound = workspace.map->joints_at(position_at(store, piece, x - h), before) &&
                             workspace.map->joints_at(position_at(store, piece, x), at) &&
                             workspace.map->joints_at(position_at(store, piece, x + h), after);
        for (int j = 0; j < workspace.joints.count && isFound; ++j) {
            LimitRow &row = rows[j];
            const double q1 = std::abs(after[j] - before[j]) / (2.0 * h);
            const double q2 = std::abs(after[j] - 2.0 * at[j] + before[j]) / (h * h);
            const double noise = 4.0 * 0x1p-52 * std::abs(at[j]) / (h * h);
            const double k = curvatures != nullptr ? curvatures[j] : 0.0;
            row.q1 = std::max(row.q1, k > 0 ? std::hypot(q1, q2 / k) : q1);
            row.q2 = std::max(row.q2, q2 > JointTuning::JITTER + 4.0 * noise ? q2 : 0.0);
        }
    }
}

SpeedLimit limit_with_joints(const PathStore &store, const Piece &piece, const Workspace &workspace,
                             double filter_s, const SpeedLimit &limit) noexcept {
    const JointLimits &joints = workspace.joints;
    LimitRow rows[MAX_JOINTS];
    sample_rows(store, piece, workspace, nullptr, rows);
    int used = 0;
    for (int j = 0; j < joints.count; ++j) {
        LimitRow row = rows[j];
        if (row.q1 <= 0 && row.q2 <= 0) {
            continue;
        }
        const auto n = static_cast<std::size_t>(j);
        // The first derivative grows by the second from one sample to the next.
        row.q1 = row.q1 * JointTuning::SAMPLING_MARGIN +
                 row.q2 * piece.length / (2.0 * (JointTuning::SAMPLES - 1));
        row.q2 *= JointTuning::SAMPLING_MARGIN * JointTuning::SAMPLING_MARGIN;
        row.velocity = joints.velocity[n];
        row.acceleration = joints.acceleration[n];
        if (filter_s > 0) {
            row.acceleration = std::min(row.acceleration, joints.jerk[n] * filter_s);
        }
        rows[used++] = row;
    }
    const SpeedLimit lowered = limit_of_rows(rows, used, limit.v);
    return {lowered.v, AccelBound::least(limit.a, lowered.a, lowered.v)};
}

}  // namespace mw::trajectory

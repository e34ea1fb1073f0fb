// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/certificate/path_monitor.hh"

#include <algorithm>
#include <cmath>

#include "machine/certificate/path_pieces.hh"

namespace mw::machine {

using geometry::Pose;

void PathMonitor::on_move(const Pose &start, const motion::PathBody &body) {
    const auto piece = programmed_piece(start, body);
    if (!piece.has_value()) {
        return;
    }
    const double length = feed_length(*piece);
    if (piece->angle_rad == 0 && geometry::norm_linear(piece->end - piece->start) == 0.0) {
        (piece->isRapid ? figures_.rapid_angle_deg : figures_.cutting_angle_deg) += length;
    } else {
        (piece->isRapid ? figures_.rapid_length : figures_.cutting_length) += length;
    }
}

void PathMonitor::on_sample(const motion::TraceSample &sample, bool isRapid) {
    if (sample.pose_kind != pose_kind_) {
        // The kinematics has been switched, so the machine is stopped and has other coordinates.
        pose_kind_ = sample.pose_kind;
        history_ = {sample.carte_pos_cmd, sample.carte_pos_cmd};
    }
    const Pose &p = sample.carte_pos_cmd;
    const Pose velocity = (p - history_[0]) * (1.0 / period_s_);
    const Pose before = (history_[0] - history_[1]) * (1.0 / period_s_);
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        figures_.peak_velocity[i] = std::max(figures_.peak_velocity[i], std::fabs(velocity[axis]));
        const double acceleration = std::fabs(velocity[axis] - before[axis]) / period_s_;
        figures_.peak_acceleration[i] = std::max(figures_.peak_acceleration[i], acceleration);
    }
    history_[1] = history_[0];
    history_[0] = p;
    points_.add(p, isRapid);
}

}  // namespace mw::machine

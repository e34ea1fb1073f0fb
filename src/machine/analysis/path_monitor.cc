// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/analysis/path_monitor.hh"

#include <algorithm>
#include <cmath>

namespace mw::machine {
namespace {

constexpr double ROUNDING = 1e-9;

using geometry::Pose;

}  // namespace

void PathMonitor::start(const Pose &position) {
    last_end_ = position;
    history_ = {position, position};
}

void PathMonitor::on_move(motion::CommandId id, const motion::PathBody &body) {
    ProgrammedPiece piece;
    piece.start = last_end_;
    if (const auto *line = std::get_if<motion::Line>(&body)) {
        piece.end = line->end;
        piece.isRapid = line->terms.isRapid;
    } else if (const auto *arc = std::get_if<motion::Arc>(&body)) {
        piece.end = arc->end;
        piece.centre = arc->centre;
        piece.normal = arc->normal;
        piece.angle_rad = arc->angle_rad;
    } else if (const auto *probe = std::get_if<motion::Probe>(&body)) {
        piece.end = probe->end;
    } else {
        return;
    }
    last_end_ = piece.end;
    if (piece.angle_rad == 0 && piece.start == piece.end) {
        return;
    }
    const double length = feed_length(piece);
    if (piece.angle_rad == 0 && geometry::norm_linear(piece.end - piece.start) == 0.0) {
        (piece.isRapid ? figures_.rapid_angle_deg : figures_.cutting_angle_deg) += length;
    } else {
        (piece.isRapid ? figures_.rapid_length : figures_.cutting_length) += length;
    }
    pieces_.push_back({id, PieceShape(piece), length});
}

/// The kinematics has been switched: the machine is stopped and has other coordinates.
void PathMonitor::start_anew(const motion::TraceSample &sample) {
    pose_kind_ = sample.pose_kind;
    history_ = {sample.carte_pos_cmd, sample.carte_pos_cmd};
    while (!pieces_.empty() && pieces_.front().id <= current_id_) {
        pieces_.pop_front();
    }
    place_ = 0;
    last_end_ = pieces_.empty() ? sample.carte_pos_cmd : last_end_;
    in_rapid_ = true;
}

void PathMonitor::on_sample(const motion::TraceSample &sample) {
    if (sample.pose_kind != pose_kind_) {
        start_anew(sample);
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
    ++figures_.samples;
    follow(sample);
    points_.add(p, in_rapid_);
}

/// Searches the current position from the last one on. While a nearby position is not farther off than
/// previous ones, later pieces are not checked: a path may cross itself. Otherwise searches up to the
/// planner's reference, which may have joined many lines and be ahead of the commanded position; a blend
/// reaches into the next line by at most its own length.
void PathMonitor::follow(const motion::TraceSample &sample) {
    if (sample.path_id > current_id_) {
        group_length_ = 0;
        for (std::size_t i = place_; i < pieces_.size() && pieces_[i].id <= sample.path_id; ++i) {
            group_length_ += pieces_[i].id > current_id_ ? pieces_[i].length : 0.0;
        }
        current_id_ = sample.path_id;
    }
    if (pieces_.empty()) {
        return;
    }
    const double moved = geometry::norm(history_[0] - history_[1]);
    const double known = std::hypot(figures_.deviation_linear, figures_.deviation_angular) + ROUNDING;
    Nearest best = pieces_[place_].shape.nearest(sample.carte_pos_cmd);
    std::size_t place = place_;
    double way = 0;  // distance from the best position
    double beyond = 0;
    for (std::size_t i = place_ + 1; i < pieces_.size(); ++i) {
        const bool exceeded = pieces_[i].id > current_id_;
        if ((best.combined() <= known && way > LOCAL * moved) || (exceeded && beyond > group_length_)) {
            break;
        }
        beyond += exceeded ? pieces_[i].length : 0.0;
        way += pieces_[i].length;
        look_at(i, sample.carte_pos_cmd, best, place);
        way = place == i ? 0.0 : way;
    }
    // Backwards, as in a reverse run.
    way = 0;
    for (std::size_t i = place_; i > 0 && way <= LOCAL * moved; --i) {
        look_at(i - 1, sample.carte_pos_cmd, best, place);
        way += pieces_[i - 1].length;
    }
    in_rapid_ = pieces_[place].shape.piece().isRapid;
    figures_.deviation_linear = std::max(figures_.deviation_linear, best.linear);
    figures_.deviation_angular = std::max(figures_.deviation_angular, best.angular);
    place_ = place;
    for (; place_ > MOST_BEHIND; --place_) {
        pieces_.pop_front();
    }
}

void PathMonitor::look_at(std::size_t i, const Pose &p, Nearest &best, std::size_t &place) const {
    const Nearest other = pieces_[i].shape.nearest(p);
    if (other.combined() < best.combined()) {
        best = other;
        place = i;
    }
}

}  // namespace mw::machine

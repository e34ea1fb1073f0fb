// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/path_monitor.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mw::machine {
namespace {

constexpr double ROUNDING = 1e-9;

using geom::Pose;

constexpr double TURN = 2.0 * std::numbers::pi;

struct Vec3 {
    double x, y, z;
};

Vec3 xyz(const Pose &p) {
    return {p[0], p[1], p[2]};
}

Vec3 minus(const Vec3 &a, const Vec3 &b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

double dot3(const Vec3 &a, const Vec3 &b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vec3 cross(const Vec3 &a, const Vec3 &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vec3 in_plane(const Vec3 &v, const Vec3 &normal) {
    const double k = dot3(v, normal);
    return {v.x - k * normal.x, v.y - k * normal.y, v.z - k * normal.z};
}

Nearest distance_at(const ProgrammedPiece &piece, const Pose &p, double fraction) {
    const Pose d = p - point_at(piece, fraction);
    return {fraction, geom::norm_linear(d), geom::norm_abc(d)};
}

Nearest nearest_on_line(const ProgrammedPiece &piece, const Pose &p) {
    const Pose d = piece.end - piece.start;
    const double length2 = geom::dot(d, d);
    const double fraction = length2 > 0 ? geom::dot(p - piece.start, d) / length2 : 1.0;
    return distance_at(piece, p, std::clamp(fraction, 0.0, 1.0));
}

Nearest nearest_on_arc(const ProgrammedPiece &piece, const Pose &p) {
    const Vec3 n = xyz(piece.normal);
    const Vec3 from = in_plane(minus(xyz(piece.start), xyz(piece.centre)), n);
    const Vec3 here = in_plane(minus(xyz(p), xyz(piece.centre)), n);
    double angle = std::atan2(dot3(cross(from, here), n), dot3(from, here));
    const double sweep = std::fabs(piece.angle_rad);
    angle = piece.angle_rad < 0 ? -angle : angle;
    Nearest best = distance_at(piece, p, 0.0);
    const Nearest at_end = distance_at(piece, p, 1.0);
    best = at_end.combined() < best.combined() ? at_end : best;
    for (double a = angle - TURN; a <= sweep; a += TURN) {
        if (a > 0) {
            const Nearest candidate = distance_at(piece, p, a / sweep);
            best = candidate.combined() < best.combined() ? candidate : best;
        }
    }
    return best;
}

}  // namespace

geom::Pose point_at(const ProgrammedPiece &piece, double fraction) {
    Pose p = piece.start + (piece.end - piece.start) * fraction;
    if (piece.angle_rad == 0) {
        return p;
    }
    const Vec3 n = xyz(piece.normal);
    const Vec3 from_centre = minus(xyz(piece.start), xyz(piece.centre));
    const Vec3 radius = in_plane(from_centre, n);
    const Vec3 side = cross(n, radius);
    const Vec3 end_radius = in_plane(minus(xyz(piece.end), xyz(piece.centre)), n);
    // The radius may differ a little between start and end (rounded programs): it changes evenly.
    const double r0 = std::sqrt(dot3(radius, radius));
    const double r1 = std::sqrt(dot3(end_radius, end_radius));
    const double scale = r0 > 0 ? 1.0 + fraction * (r1 / r0 - 1.0) : 1.0;
    const double angle = piece.angle_rad * fraction;
    const double c = std::cos(angle) * scale, s = std::sin(angle) * scale;
    const double rise0 = dot3(from_centre, n);
    const double rise = rise0 + fraction * (dot3(minus(xyz(piece.end), xyz(piece.centre)), n) - rise0);
    p[0] = piece.centre[0] + c * radius.x + s * side.x + rise * n.x;
    p[1] = piece.centre[1] + c * radius.y + s * side.y + rise * n.y;
    p[2] = piece.centre[2] + c * radius.z + s * side.z + rise * n.z;
    return p;
}

Nearest nearest_point(const ProgrammedPiece &piece, const geom::Pose &p) {
    return piece.angle_rad == 0 ? nearest_on_line(piece, p) : nearest_on_arc(piece, p);
}

double feed_length(const ProgrammedPiece &piece) {
    const Pose d = piece.end - piece.start;
    if (piece.angle_rad != 0) {
        const Vec3 n = xyz(piece.normal);
        const Vec3 radius = in_plane(minus(xyz(piece.start), xyz(piece.centre)), n);
        const double arc = std::fabs(piece.angle_rad) * std::sqrt(dot3(radius, radius));
        return std::hypot(arc, dot3(xyz(d), n));
    }
    const double linear = geom::norm_xyz(d);
    if (linear > 0) {
        return linear;
    }
    const double second = geom::norm_uvw(d);
    return second > 0 ? second : geom::norm_abc(d);
}

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
    if (piece.angle_rad == 0 && geom::norm_linear(piece.end - piece.start) == 0.0) {
        (piece.isRapid ? figures_.rapid_angle_deg : figures_.cutting_angle_deg) += length;
    } else {
        (piece.isRapid ? figures_.rapid_length : figures_.cutting_length) += length;
    }
    pieces_.push_back({id, piece, length});
}

void PathMonitor::on_sample(const motion::TraceSample &sample) {
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
    points_.add(p, isInRapid_);
}

/// The present place is looked for from the last one on. As long as one near by is no farther off than any
/// before, nothing beyond is looked at: a path may cross itself. Else it is any up to where the planner's
/// leader is: it may have joined many lines and be ahead of the commanded mean, and a corner's blend reaches
/// into the next line by no more than the length of its own.
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
    const double moved = geom::norm(history_[0] - history_[1]);
    const double known = std::hypot(figures_.deviation_linear, figures_.deviation_angular) + ROUNDING;
    Nearest best = nearest_point(pieces_[place_].piece, sample.carte_pos_cmd);
    std::size_t place = place_;
    double way = 0;  // from the best place on
    double beyond = 0;
    for (std::size_t i = place_ + 1; i < pieces_.size(); ++i) {
        const bool isBeyond = pieces_[i].id > current_id_;
        if ((best.combined() <= known && way > LOCAL * moved) || (isBeyond && beyond > group_length_)) {
            break;
        }
        beyond += isBeyond ? pieces_[i].length : 0.0;
        way += pieces_[i].length;
        look_at(i, sample.carte_pos_cmd, best, place);
        way = place == i ? 0.0 : way;
    }
    // Back, as on a reverse run.
    way = 0;
    for (std::size_t i = place_; i > 0 && way <= LOCAL * moved; --i) {
        look_at(i - 1, sample.carte_pos_cmd, best, place);
        way += pieces_[i - 1].length;
    }
    isInRapid_ = pieces_[place].piece.isRapid;
    figures_.deviation_linear = std::max(figures_.deviation_linear, best.linear);
    figures_.deviation_angular = std::max(figures_.deviation_angular, best.angular);
    place_ = place;
    for (; place_ > MOST_BEHIND; --place_) {
        pieces_.pop_front();
    }
}

void PathMonitor::look_at(std::size_t i, const Pose &p, Nearest &best, std::size_t &place) const {
    const Nearest other = nearest_point(pieces_[i].piece, p);
    if (other.combined() < best.combined()) {
        best = other;
        place = i;
    }
}

}  // namespace mw::machine

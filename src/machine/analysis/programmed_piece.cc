// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/analysis/programmed_piece.hh"

#include <algorithm>
#include <numbers>

namespace mw::machine {
namespace {

using geometry::Pose;

constexpr double TURN = 2.0 * std::numbers::pi;

}  // namespace

PieceShape::Vec3 PieceShape::minus(const Pose &a, const Pose &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double PieceShape::dot(const Vec3 &a, const Vec3 &b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

PieceShape::Vec3 PieceShape::cross(const Vec3 &a, const Vec3 &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

PieceShape::Vec3 PieceShape::in_plane(const Vec3 &v, const Vec3 &normal) {
    const double k = dot(v, normal);
    return {v.x - k * normal.x, v.y - k * normal.y, v.z - k * normal.z};
}

PieceShape::PieceShape(const ProgrammedPiece &piece)
    : piece_(piece), along_(piece.end - piece.start), length2_(geometry::dot(along_, along_)),
      line_in_space_(piece.angle_rad == 0 &&
                     std::all_of(along_.c.begin() + 3, along_.c.end(), [](double d) { return d == 0; })) {
    if (piece.angle_rad == 0) {
        return;
    }
    normal_ = {piece.normal[0], piece.normal[1], piece.normal[2]};
    const Vec3 from_centre = minus(piece.start, piece.centre), to_end = minus(piece.end, piece.centre);
    const Vec3 end_radius = in_plane(to_end, normal_);
    radius_ = in_plane(from_centre, normal_);
    side_ = cross(normal_, radius_);
    // The radius may change slightly between start and end (rounded programs): it changes linearly.
    const double r0 = std::sqrt(dot(radius_, radius_));
    const double r1 = std::sqrt(dot(end_radius, end_radius));
    growth_ = r0 > 0 ? r1 / r0 - 1.0 : 0.0;
    first_rise_ = dot(from_centre, normal_);
    rise_ = dot(to_end, normal_) - first_rise_;
    first_ = point_at(0);
    last_ = point_at(1);
}

Pose PieceShape::point_at(double fraction) const {
    Pose p = piece_.start + along_ * fraction;
    if (piece_.angle_rad == 0) {
        return p;
    }
    const double scale = 1.0 + fraction * growth_;
    const double angle = piece_.angle_rad * fraction;
    const double c = std::cos(angle) * scale, s = std::sin(angle) * scale;
    const double rise = first_rise_ + fraction * rise_;
    p[0] = piece_.centre[0] + c * radius_.x + s * side_.x + rise * normal_.x;
    p[1] = piece_.centre[1] + c * radius_.y + s * side_.y + rise * normal_.y;
    p[2] = piece_.centre[2] + c * radius_.z + s * side_.z + rise * normal_.z;
    return p;
}

Nearest PieceShape::nearest(const Pose &p) const {
    if (piece_.angle_rad != 0) {
        return nearest_on_arc(p);
    }
    return isInSpace(p) ? nearest_in_space(p) : nearest_on_line(p);
}

bool PieceShape::isInSpace(const Pose &p) const {
    return line_in_space_ && std::equal(p.c.begin() + 3, p.c.end(), piece_.start.c.begin() + 3);
}

Nearest PieceShape::distance(const Pose &p, const Pose &at, double fraction) {
    const Pose d = p - at;
    return {fraction, geometry::norm_linear(d), geometry::norm_abc(d)};
}

/// As nearest_on_line() when all but the first three components are zero.
Nearest PieceShape::nearest_in_space(const Pose &p) const {
    const Vec3 along{along_[0], along_[1], along_[2]}, from_start = minus(p, piece_.start);
    const double fraction = length2_ > 0 ? std::clamp(dot(from_start, along) / length2_, 0.0, 1.0) : 1.0;
    const Vec3 d{p[0] - (piece_.start[0] + along.x * fraction), p[1] - (piece_.start[1] + along.y * fraction),
                 p[2] - (piece_.start[2] + along.z * fraction)};
    return {fraction, std::sqrt(dot(d, d)), 0};
}

Nearest PieceShape::nearest_on_line(const Pose &p) const {
    const double fraction = length2_ > 0 ? geometry::dot(p - piece_.start, along_) / length2_ : 1.0;
    const double inside = std::clamp(fraction, 0.0, 1.0);
    return distance(p, point_at(inside), inside);
}

Nearest PieceShape::nearest_on_arc(const Pose &p) const {
    const Vec3 here = in_plane(minus(p, piece_.centre), normal_);
    double angle = std::atan2(dot(cross(radius_, here), normal_), dot(radius_, here));
    const double sweep = std::fabs(piece_.angle_rad);
    angle = piece_.angle_rad < 0 ? -angle : angle;
    Nearest best = distance(p, first_, 0.0);
    const Nearest at_end = distance(p, last_, 1.0);
    best = at_end.combined() < best.combined() ? at_end : best;
    for (double a = angle - TURN; a <= sweep; a += TURN) {
        if (a > 0) {
            const Nearest candidate = distance(p, point_at(a / sweep), a / sweep);
            best = candidate.combined() < best.combined() ? candidate : best;
        }
    }
    return best;
}

double feed_length(const ProgrammedPiece &piece) {
    const Pose d = piece.end - piece.start;
    if (piece.angle_rad != 0) {
        double along_normal = 0, rise = 0;
        for (int axis = 0; axis < 3; ++axis) {
            along_normal += (piece.start[axis] - piece.centre[axis]) * piece.normal[axis];
            rise += d[axis] * piece.normal[axis];
        }
        Pose radius;
        for (int axis = 0; axis < 3; ++axis) {
            radius[axis] = piece.start[axis] - piece.centre[axis] - along_normal * piece.normal[axis];
        }
        return std::hypot(std::fabs(piece.angle_rad) * geometry::norm_xyz(radius), rise);
    }
    const double linear = geometry::norm_xyz(d);
    if (linear > 0) {
        return linear;
    }
    const double second = geometry::norm_uvw(d);
    return second > 0 ? second : geometry::norm_abc(d);
}

}  // namespace mw::machine

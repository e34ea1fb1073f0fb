// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/programmed_piece.hh"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace mw::gcode {
namespace {

using geometry::Pose;

constexpr int REFINEMENTS = 4;      ///< iterations for the nearest point on a helix; each squares the error
constexpr int HALVINGS = 40;        ///< bisections of the interval between the points that are nearest in
                                    ///< lengths and in angles
constexpr double CONVERGED = 1e-9;  ///< fraction of a piece; the error is of second order
constexpr double FLAT = 1e-12;      ///< relative growth and rise below which an arc is a circle

double linear_dot(const Pose &a, const Pose &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[6] * b[6] + a[7] * b[7] + a[8] * b[8];
}

double angular_dot(const Pose &a, const Pose &b) {
    return a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
}

}  // namespace

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

PieceShape::Vec3 PieceShape::arc_axes(const Pose &p) const {
    const int first = piece_.isInUvw ? geometry::AXIS_U : geometry::AXIS_X;
    return {p[first], p[first + 1], p[first + 2]};
}

void PieceShape::add_to_arc_axes(Pose &p, double along_radius, double along_side) const {
    const int first = piece_.isInUvw ? geometry::AXIS_U : geometry::AXIS_X;
    p[first] += along_radius * radius_.x + along_side * side_.x;
    p[first + 1] += along_radius * radius_.y + along_side * side_.y;
    p[first + 2] += along_radius * radius_.z + along_side * side_.z;
}

PieceShape::PieceShape(const ProgrammedPiece &piece) : piece_(piece), along_(piece.end - piece.start) {
    if (piece.angle_rad != 0) {
        normal_ = arc_axes(piece.normal);
        const double length = std::sqrt(dot(normal_, normal_));
        normal_ = {normal_.x / length, normal_.y / length, normal_.z / length};
        const Vec3 end_radius = in_plane(arc_axes(piece.end - piece.centre), normal_);
        radius_ = in_plane(arc_axes(piece.start - piece.centre), normal_);
        side_ = cross(normal_, radius_);
        // The radius may change slightly between start and end (rounded programs). It changes linearly, and
        // so does the distance that then remains to the end.
        const double r0 = std::sqrt(dot(radius_, radius_)), r1 = std::sqrt(dot(end_radius, end_radius));
        growth_ = r0 > 0 ? r1 / r0 - 1.0 : 0.0;
        const double scale = 1.0 + growth_;
        add_to_arc_axes(along_, 1.0 - scale * std::cos(piece.angle_rad), -scale * std::sin(piece.angle_rad));
        isCircle_ = std::abs(growth_) < FLAT && linear_dot(along_, along_) < FLAT * FLAT * r0 * r0;
    }
    linear_length2_ = linear_dot(along_, along_);
    angular_length2_ = angular_dot(along_, along_);
}

Pose PieceShape::point_at(double fraction) const {
    Pose p = piece_.start + along_ * fraction;
    if (piece_.angle_rad != 0) {
        const double scale = 1.0 + fraction * growth_, angle = piece_.angle_rad * fraction;
        add_to_arc_axes(p, scale * std::cos(angle) - 1.0, scale * std::sin(angle));
    }
    return p;
}

Pose PieceShape::derivative_at(double fraction) const {
    Pose d = along_;
    const double scale = 1.0 + fraction * growth_, angle = piece_.angle_rad * fraction;
    const double c = std::cos(angle), s = std::sin(angle);
    add_to_arc_axes(d, growth_ * c - scale * piece_.angle_rad * s,
                    growth_ * s + scale * piece_.angle_rad * c);
    return d;
}

ProgrammedPiece PieceShape::part_of(int index, int count) const {
    ProgrammedPiece part = piece_;
    part.start = index == 0 ? piece_.start : point_at(static_cast<double>(index) / count);
    part.end = index + 1 == count ? piece_.end : point_at(static_cast<double>(index + 1) / count);
    part.angle_rad = piece_.angle_rad / count;
    return part;
}

Nearest PieceShape::at(const Pose &p, double fraction, const Slack &slack) const {
    const Pose d = p - point_at(fraction);
    return {fraction, std::max(0.0, std::sqrt(linear_dot(d, d)) - slack.linear),
            std::max(0.0, std::sqrt(angular_dot(d, d)) - slack.angular)};
}

double PieceShape::arc_fraction(const Pose &p) const {
    const Vec3 here = in_plane(arc_axes(p - piece_.centre), normal_);
    double fraction = std::atan2(dot(cross(radius_, here), normal_), dot(radius_, here)) / piece_.angle_rad;
    for (int i = 0; i < REFINEMENTS && !isCircle_; ++i) {
        const double inside = std::clamp(fraction, 0.0, 1.0);
        const Pose d = derivative_at(inside);
        const double step = linear_dot(p - point_at(inside), d) / linear_dot(d, d);
        fraction = inside + step;
        if (std::abs(step) < CONVERGED) {
            break;
        }
    }
    return fraction;
}

double PieceShape::linear_fraction(const Pose &p) const {
    if (piece_.angle_rad != 0) {
        return arc_fraction(p);
    }
    return linear_dot(p - piece_.start, along_) / linear_length2_;
}

double PieceShape::angular_fraction(const Pose &p) const {
    return angular_dot(p - piece_.start, along_) / angular_length2_;
}

Nearest PieceShape::nearest(const Pose &p, double from, const Slack &slack) const {
    const bool hasLength = linear_length2_ > 0 || piece_.angle_rad != 0;
    if (!hasLength && angular_length2_ == 0) {
        return at(p, from, slack);
    }
    double low = std::clamp(hasLength ? linear_fraction(p) : angular_fraction(p), from, 1.0);
    const Nearest in_lengths = at(p, low, slack);
    if (!hasLength || angular_length2_ == 0 || in_lengths.linear >= in_lengths.angular) {
        return in_lengths;
    }
    double high = std::clamp(angular_fraction(p), from, 1.0);
    const Nearest in_angles = at(p, high, slack);
    if (in_angles.angular >= in_angles.linear) {
        return in_angles;
    }
    // Between the two points the distance in lengths increases and the distance in angles decreases. The
    // maximum of both is smallest where they are equal.
    Nearest best = in_angles;
    for (int i = 0; i < HALVINGS && low != high; ++i) {
        best = at(p, 0.5 * (low + high), slack);
        (best.linear < best.angular ? low : high) = best.fraction;
    }
    return best;
}

double feed_length(const ProgrammedPiece &piece) {
    const Pose d = piece.end - piece.start;
    if (piece.angle_rad != 0) {
        const int first = piece.isInUvw ? geometry::AXIS_U : geometry::AXIS_X;
        double along_normal = 0, rise = 0;
        for (int axis = first; axis < first + 3; ++axis) {
            along_normal += (piece.start[axis] - piece.centre[axis]) * piece.normal[axis];
            rise += d[axis] * piece.normal[axis];
        }
        double radius2 = 0;
        for (int axis = first; axis < first + 3; ++axis) {
            const double r = piece.start[axis] - piece.centre[axis] - along_normal * piece.normal[axis];
            radius2 += r * r;
        }
        return std::hypot(std::abs(piece.angle_rad) * std::sqrt(radius2), rise);
    }
    const double linear = geometry::norm_xyz(d);
    if (linear > 0) {
        return linear;
    }
    const double second = geometry::norm_uvw(d);
    return second > 0 ? second : geometry::norm_abc(d);
}

}  // namespace mw::gcode

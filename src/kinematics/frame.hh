// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors, rotations and angles that the models share. Angles in degrees. Header-only and realtime-safe.
#pragma once

#include <cmath>
#include <numbers>

#include "base/geometry/pose.hh"

namespace mw::kinematics {

inline constexpr double RADIANS = std::numbers::pi / 180.0;  ///< [rad/degree]
inline constexpr double DEGREES = 180.0 / std::numbers::pi;  ///< [degree/rad]

inline double sine(double degrees) noexcept {
    return std::sin(degrees * RADIANS);
}
inline double cosine(double degrees) noexcept {
    return std::cos(degrees * RADIANS);
}
/// [degrees]
inline double arc_tangent(double y, double x) noexcept {
    return std::atan2(y, x) * DEGREES;
}
/// `angle` plus the multiple of 360 degrees that makes it nearest to `near`.
inline double nearest_turn(double angle, double near) noexcept {
    return angle + 360.0 * std::round((near - angle) / 360.0);
}
constexpr double square(double x) noexcept {
    return x * x;
}

struct Vector {
    double x = 0, y = 0, z = 0;
};
constexpr Vector operator+(const Vector &a, const Vector &b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vector operator-(const Vector &a, const Vector &b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vector operator*(const Vector &a, double k) noexcept {
    return {a.x * k, a.y * k, a.z * k};
}
constexpr double dot(const Vector &a, const Vector &b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vector cross(const Vector &a, const Vector &b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vector &a) noexcept {
    return std::sqrt(dot(a, a));
}
/// Unit vector of `a`, which must not be zero.
inline Vector direction(const Vector &a) noexcept {
    return a * (1.0 / length(a));
}

inline Vector turned_x(const Vector &v, double degrees) noexcept {
    const double c = cosine(degrees);
    const double s = sine(degrees);
    return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
}
inline Vector turned_y(const Vector &v, double degrees) noexcept {
    const double c = cosine(degrees);
    const double s = sine(degrees);
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}
inline Vector turned_z(const Vector &v, double degrees) noexcept {
    const double c = cosine(degrees);
    const double s = sine(degrees);
    return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

/// A rotation matrix by columns: the rotated X, Y and Z axes.
struct Rotation {
    Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    constexpr Vector operator*(const Vector &v) const noexcept { return x * v.x + y * v.y + z * v.z; }
    constexpr Rotation operator*(const Rotation &r) const noexcept {
        return {*this * r.x, *this * r.y, *this * r.z};
    }
    constexpr Rotation inverse() const noexcept {
        return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
    }
};

/// Roll, pitch and yaw about fixed axes: A about X, then B about Y, then C about Z (Craig, Introduction to
/// Robotics, 2.8).
inline Rotation rotation_of(double a, double b, double c) noexcept {
    const auto turned = [&](const Vector &v) { return turned_z(turned_y(turned_x(v, a), b), c); };
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

/// The rotation about `v` by its length [rad] (Rodrigues).
inline Rotation rotation_about(const Vector &v) noexcept {
    const double angle = length(v);
    if (!(angle > 0)) {
        return {};
    }
    const Vector u = v * (1.0 / angle);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const auto turned = [&](const Vector &w) {
        return w * c + cross(u, w) * s + u * (dot(u, w) * (1.0 - c));
    };
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

struct Angles {
    double a = 0, b = 0, c = 0;
};
/// The angles of a rotation, B from -90 to 90, A and C in the revolution nearest to `near`. At B = +-90 only
/// A -+ C is determined: C is taken from `near`.
inline Angles angles_of(const Rotation &r, const Angles &near) noexcept {
    constexpr double POLE = 1e-10;
    const double level = std::hypot(r.x.x, r.x.y);
    Angles out;
    out.b = arc_tangent(-r.x.z, level);
    if (level < POLE) {
        out.c = near.c;
        out.a = r.x.z < 0 ? near.c + arc_tangent(r.y.x, r.y.y) : arc_tangent(-r.y.x, r.y.y) - near.c;
    } else {
        out.a = arc_tangent(r.y.z, r.z.z);
        out.c = nearest_turn(arc_tangent(r.x.y, r.x.x), near.c);
    }
    out.a = nearest_turn(out.a, near.a);
    return out;
}

inline Vector place_of(const geometry::Pose &pose) noexcept {
    return {pose[0], pose[1], pose[2]};
}
inline void set_place(geometry::Pose &pose, const Vector &v) noexcept {
    pose[geometry::AXIS_X] = v.x;
    pose[geometry::AXIS_Y] = v.y;
    pose[geometry::AXIS_Z] = v.z;
}
/// Orientation of a pose by roll, pitch and yaw.
inline Rotation rotation_of(const geometry::Pose &pose) noexcept {
    return rotation_of(pose[geometry::AXIS_A], pose[geometry::AXIS_B], pose[geometry::AXIS_C]);
}
/// `pose` holds the previous pose, which selects the revolution of the angles.
inline void set_rotation(geometry::Pose &pose, const Rotation &r) noexcept {
    const Angles angles =
        angles_of(r, {pose[geometry::AXIS_A], pose[geometry::AXIS_B], pose[geometry::AXIS_C]});
    pose[geometry::AXIS_A] = angles.a;
    pose[geometry::AXIS_B] = angles.b;
    pose[geometry::AXIS_C] = angles.c;
}
inline bool isFinite(const Vector &v) noexcept {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
/// True when the first `count` values are finite.
inline bool areFinite(const double *values, int count) noexcept {
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        sum += values[i] - values[i];
    }
    return sum == 0.0;
}
inline bool isFinite(const geometry::Pose &pose) noexcept {
    return areFinite(pose.c.data(), geometry::AXIS_COUNT);
}

}  // namespace mw::kinematics

// SPDX-License-Identifier: GPL-2.0-or-later
// A pose: nine coordinates, six lengths and three angles. Header-only and realtime-safe.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace mw::geometry {

/// The Cartesian letters, in the order of all tables and files. An axis is not a joint.
enum Axis : int { AXIS_X, AXIS_Y, AXIS_Z, AXIS_A, AXIS_B, AXIS_C, AXIS_U, AXIS_V, AXIS_W, AXIS_COUNT };

inline constexpr char AXIS_LETTERS[] = "XYZABCUVW";
inline constexpr char AXIS_LETTERS_LOWER[] = "xyzabcuvw";

/// True for A, B and C, whose unit is the degree.
constexpr bool isAngular(int axis) noexcept {
    return axis >= AXIS_A && axis <= AXIS_C;
}

/// Index of an upper or lower case letter, or -1.
constexpr int axis_of_letter(char letter) noexcept {
    for (int i = 0; i < AXIS_COUNT; ++i) {
        if (letter == AXIS_LETTERS[i] || letter == AXIS_LETTERS_LOWER[i]) {
            return i;
        }
    }
    return -1;
}

/// Nine coordinates X Y Z A B C U V W; lengths in machine units, angles in degrees, unless a name says
/// otherwise. Also for directions, velocities and offsets.
struct Pose {
    std::array<double, AXIS_COUNT> c{};

    constexpr double operator[](int axis) const noexcept { return c[static_cast<std::size_t>(axis)]; }
    constexpr double &operator[](int axis) noexcept { return c[static_cast<std::size_t>(axis)]; }
    constexpr double x() const noexcept { return c[AXIS_X]; }
    constexpr double y() const noexcept { return c[AXIS_Y]; }
    constexpr double z() const noexcept { return c[AXIS_Z]; }
    constexpr bool operator==(const Pose &) const noexcept = default;
};

// Sums are unrolled: in a servo cycle each loop costs two mispredicted branches.
constexpr Pose operator+(const Pose &p, const Pose &q) noexcept {
    Pose r;
#pragma GCC unroll 9
    for (int i = 0; i < AXIS_COUNT; ++i) {
        r[i] = p[i] + q[i];
    }
    return r;
}

constexpr Pose operator-(const Pose &p, const Pose &q) noexcept {
    Pose r;
#pragma GCC unroll 9
    for (int i = 0; i < AXIS_COUNT; ++i) {
        r[i] = p[i] - q[i];
    }
    return r;
}

constexpr Pose operator*(const Pose &p, double k) noexcept {
    Pose r;
    for (int i = 0; i < AXIS_COUNT; ++i) {
        r[i] = p[i] * k;
    }
    return r;
}

constexpr double dot(const Pose &p, const Pose &q) noexcept {
    double sum = 0.0;
    for (int i = 0; i < AXIS_COUNT; ++i) {
        sum += p[i] * q[i];
    }
    return sum;
}

/// Euclidean norm over all nine coordinates.
inline double norm(const Pose &p) noexcept {
    return std::sqrt(dot(p, p));
}

/// Euclidean norm over X Y Z. [machine units]
inline double norm_xyz(const Pose &p) noexcept {
    return std::sqrt(p[AXIS_X] * p[AXIS_X] + p[AXIS_Y] * p[AXIS_Y] + p[AXIS_Z] * p[AXIS_Z]);
}

/// Euclidean norm over U V W. [machine units]
inline double norm_uvw(const Pose &p) noexcept {
    return std::sqrt(p[AXIS_U] * p[AXIS_U] + p[AXIS_V] * p[AXIS_V] + p[AXIS_W] * p[AXIS_W]);
}

/// Euclidean norm over A B C. [degrees]
inline double norm_abc(const Pose &p) noexcept {
    return std::sqrt(p[AXIS_A] * p[AXIS_A] + p[AXIS_B] * p[AXIS_B] + p[AXIS_C] * p[AXIS_C]);
}

/// Euclidean norm over the six lengths. [machine units]
inline double norm_linear(const Pose &p) noexcept {
    return std::hypot(norm_xyz(p), norm_uvw(p));
}

}  // namespace mw::geometry

// SPDX-License-Identifier: GPL-2.0-or-later
// Speed and path acceleration of a stretch of path such that every axis keeps its limits. Planning side,
// pure. Formulas: docs/developer/planner.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "trajectory/path/primitive.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// Limits of the axes, joints already folded in; UNLIMITED where nothing limits.
struct Limits {
    PerLimited velocity{};      ///< [unit/s]; the last is the XYZ norm
    PerLimited acceleration{};  ///< [unit/s^2]
    PerLimited jerk{};          ///< [unit/s^3]; used when `isJerkLimited`
    bool isJerkLimited = false;
};
inline constexpr double UNLIMITED = 1e300;

/// Request that a path is made for, from its first move.
struct PathDemand {
    /// What drives it; by default either.
    enum class Drive : std::uint8_t {
        EITHER,
        BY_TIME,
        BY_ANGLE  ///< of a spindle: threads and taps
    };
    Drive drive = Drive::EITHER;
};

/// v: maximum speed along the parameter; a: path acceleration that may be used, by the speed squared.
struct SpeedLimit {
    double v = 0;
    AccelBound a;
};

/// Largest derivatives by the path's parameter of one limited coordinate on a stretch, and its limits.
struct LimitRow {
    double q1 = 0, q2 = 0;
    double velocity = UNLIMITED, acceleration = UNLIMITED;
    bool isRightAngled = false;  ///< q1 and q2 are lengths of vectors at right angles
};

/// Largest |dq/ds| and |d2q/ds2| per coordinate on the part [from, to] of a primitive; the last of each are
/// those of the XYZ norm.
void derivative_bounds(const Primitive &p, double from, double to, PerLimited &q1, PerLimited &q2) noexcept;

/// Speeds and accelerations for which q1 v <= velocity and q1 |a| + q2 v^2 <= acceleration in every row, up
/// to the requested speed `wish`.
SpeedLimit limit_of_rows(const LimitRow *rows, int count, double wish) noexcept;

/// The same on the part [from, to] of a primitive.
SpeedLimit limit_of(const Primitive &p, double from, double to, const Limits &limits, double wish) noexcept;

/// The same on the part [from, to] of the blend of `a` into `b` with parameter d.
struct BlendPart {
    double d = 0, from = 0, to = 0;
};
SpeedLimit limit_of_blend(const Primitive &a, const Primitive &b, const BlendPart &part, const Limits &limits,
                          double wish) noexcept;

/// Largest d for which the blend stays within `tolerance` of the corner path, in order (Frechet), separately
/// over the lengths and over the angles.
double blend_d_for_tolerance(const Primitive &a, const Primitive &b, double tolerance) noexcept;

/// The d at which the corner takes most of each axis's acceleration at the speed `v`; a larger blend gains
/// little.
double blend_d_for_speed(const Primitive &a, const Primitive &b, const Limits &limits, double v) noexcept;

/// Change of the tangent at the joint, per coordinate.
Pose tangent_step(const Primitive &a, const Primitive &b) noexcept;

}  // namespace mw::trajectory

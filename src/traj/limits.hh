// SPDX-License-Identifier: GPL-2.0-or-later
// Speed and path acceleration of a stretch of path such that every axis keeps its limits. Planning side,
// pure.
#pragma once

#include "traj/primitive.hh"

namespace mw::traj {

/// Limits of the axes, joints already folded in; UNLIMITED where nothing limits.
struct Limits {
    PerLimited velocity{};      ///< [unit/s]; the last is the XYZ norm
    PerLimited acceleration{};  ///< [unit/s^2]
};
inline constexpr double UNLIMITED = 1e300;

/// v: highest speed along the parameter; a: path acceleration that may be used at any speed up to min(v,
/// wish).
struct SpeedLimit {
    double v = 0;
    double a = 0;
};

/// For each axis |q'| a + |q''| v^2 <= acceleration and |q'| v <= velocity on the whole primitive. `wish`:
/// highest speed that will be asked for; more acceleration is left along the path where it is low.
SpeedLimit limit_of(const Primitive &p, const Limits &limits, double wish) noexcept;

/// The same on the blend of `a` into `b` with parameter d.
SpeedLimit limit_of_blend(const Primitive &a, const Primitive &b, double d, const Limits &limits,
                          double wish) noexcept;

/// Largest d for which the blend stays within `tolerance` of the corner path, in order (Frechet), separately
/// over the lengths and over the angles.
double blend_d_for_tolerance(const Primitive &a, const Primitive &b, double tolerance) noexcept;

/// The d at which the corner takes half of each axis's acceleration at the speed `v`; a larger blend gains
/// little.
double blend_d_for_speed(const Primitive &a, const Primitive &b, const Limits &limits, double v) noexcept;

/// Change of the tangent at the joint, per coordinate.
Pose tangent_step(const Primitive &a, const Primitive &b) noexcept;

}  // namespace mw::traj

// SPDX-License-Identifier: GPL-2.0-or-later
// The direct stop: the shortest stop along a curve from a speed and an acceleration, with one limit of
// acceleration and one of jerk. All rows allow these limits along the whole stop.
#pragma once

#include <array>

#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

using curve::TimeCell;

/// A position on the curve with the speed and the acceleration along it.
struct Motion {
    double s = 0, v = 0, a = 0;
};

/// The quintic between two motions.
TimeCell cell_of(const Motion &from, const Motion &to, double duration) noexcept;

/// Limits of braking along the curve.
struct Rates {
    double least = 0;  ///< braking with less exceeds a limit
    double acceleration = 0, jerk = 0;
    double spare_acceleration = 0, spare_jerk = 0;  ///< amounts by which a checked stop may exceed the limits
    double speed_share = 0;                         ///< 1 / maximum speed near caps and of joints
};

/// Jerk -J, then 0, then J: the acceleration changes to -peak, remains constant, and returns to 0.
struct DirectStop {
    static constexpr std::size_t PHASES = 3;
    double end_s = 0;
    std::array<TimeCell, PHASES> cells{};
    double duration() const noexcept { return cells[0].duration + cells[1].duration + cells[2].duration; }
    Motion at(double t) const noexcept;
    double jerk_at(double t) const noexcept;
};

/// False if the motion would reverse.
bool make_direct_stop(const Motion &from, const Rates &rates, DirectStop &stop) noexcept;
/// A direct stop that ends at `end_s`, with lower limits than `rates`. False if there is none.
bool make_direct_stop_at(const Motion &from, const Rates &rates, double end_s, DirectStop &stop) noexcept;

/// Limits of braking along the curve at a point, at the speed and acceleration of `at`: acceleration between
/// `least` and `acceleration`, and jerk. If the jerk is negative, no braking is within the limits.
Rates rates_at(const Run &run, const CurvePoint &point, const Motion &at) noexcept;

}  // namespace mw::trajectory::profile

// SPDX-License-Identifier: GPL-2.0-or-later
// The direct stop: least time from a speed and an acceleration along a curve to rest, with one limit of
// acceleration and one of jerk that all rows allow on the whole way.
#pragma once

#include <array>

#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

using curve::TimeCell;

/// A place on the curve with the speed and the acceleration along it.
struct Motion {
    double s = 0, v = 0, a = 0;
};

/// Quintic between two motions.
TimeCell cell_of(const Motion &from, const Motion &to, double duration) noexcept;

/// Limits of braking along the curve.
struct Rates {
    double least = 0;  ///< braking below it leaves a limit
    double acceleration = 0, jerk = 0;
    double spare_acceleration = 0, spare_jerk = 0;  ///< by which a check may exceed them
    double speed_share = 0;                         ///< inverse of the maximum speed near caps and of joints
};

/// Jerk -J, then none, then J: by which the acceleration goes to -peak, stays, and ends.
struct DirectStop {
    static constexpr std::size_t PHASES = 3;
    double end_s = 0;
    std::array<TimeCell, PHASES> cells{};
    double duration() const noexcept { return cells[0].duration + cells[1].duration + cells[2].duration; }
    Motion at(double t) const noexcept;
    double jerk_at(double t) const noexcept;
};

/// False if the motion would go back.
bool make_direct_stop(const Motion &from, const Rates &rates, DirectStop &stop) noexcept;
/// A direct stop that ends at `end_s`, with lower limits than `rates`. False if there is none.
bool make_direct_stop_at(const Motion &from, const Rates &rates, double end_s, DirectStop &stop) noexcept;

/// What the limits of the run leave along the curve at a place with the speed and the acceleration of `at`:
/// braking between `least` and `acceleration`, and this jerk, if it is not below 0.
Rates rates_at(const Run &run, const CurvePoint &point, const Motion &at) noexcept;

}  // namespace mw::trajectory::profile

// SPDX-License-Identifier: GPL-2.0-or-later
// The timing of a curve from stop to stop. It is planned in windows while the curve grows.
#pragma once

#include <cstdint>
#include <vector>

#include "trajectory/curve/span.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

using curve::TimeCell;

/// A stop: the first `kept` cells of the plan, then `cells`.
struct Stop {
    std::size_t kept = 0;
    std::vector<TimeCell> cells;
    double end_s = 0;
};

enum class StopEffort : std::uint8_t {
    QUICK,   ///< along the plan, then the first direct stop within all limits
    PROMPT,  ///< for the stops of every plan: QUICK if it takes little longer than the shortest stop
    SOONEST  ///< the slowest motion, then the direct stop that ends first
};

/// Use it in the planner thread only. Planned cells remain until they are dropped, so that another motion can
/// begin at the start of each.
class PathTiming {
  public:
    virtual ~PathTiming() = default;
    /// Begins a run at standstill at `s`.
    virtual void begin(double s) noexcept = 0;
    /// Plans a window of the run after the first `fixed` cells, which remain. Limits must not be lower than
    /// those of the last plan, and the end of the run must not be nearer. False if the motion from which it
    /// starts exceeds a limit by more than rounding. The previous plan then remains active with its stops.
    /// Planning may succeed with more of the curve or another start.
    virtual bool plan(const Run &run, std::size_t fixed) = 0;
    /// Like plan(), but speed limits may be lower, and the end of the run may be nearer, though not nearer
    /// than the soonest stop, or removed. The speed may exceed a lowered limit until maximum braking reaches
    /// it. Acceleration and jerk never exceed their limits. If the plan already brakes for a near end, this
    /// end remains, and begin() must continue the run. False as in plan(): the speed then remains unchanged.
    virtual bool replan(const Run &run, std::size_t fixed) = 0;
    /// Begins the stops of one plan within `run`. The last stop must be requested first.
    virtual void begin_stops(const Run &run) = 0;
    /// The soonest stop within every limit of `run` that does not begin before the start of cell `fixed`. The
    /// plan does not change.
    virtual Stop next_stop(const Run &run, std::size_t fixed, StopEffort effort) = 0;
    Stop stop(const Run &run, std::size_t fixed, StopEffort effort) {
        begin_stops(run);
        return next_stop(run, fixed, effort);
    }
    /// Time between the starts of two stops of a plan [s]. `stop_s`: time of the second stop [s].
    virtual double stops_apart_s(double stop_s) const noexcept = 0;
    /// Fraction of the time of a plan that may be committed. The rest is for the stop.
    virtual double committed_part() const noexcept = 0;
    /// Number of planned cells that are not dropped.
    virtual std::size_t cells() const noexcept = 0;
    virtual const TimeCell &cell(std::size_t k) const noexcept = 0;
    /// True if the last cell ends in a stop at `end_s`. It is the stop of the run, or an earlier one that is
    /// too near to be changed.
    virtual bool isComplete() const noexcept = 0;
    virtual double end_s() const noexcept = 0;
    /// Removes the first `count` cells, which are executed.
    virtual void drop(std::size_t count) = 0;
    /// From this s on, the kinematics has no solution or a joint jumps; the motion stops before it. 1e300: no
    /// such point on the known curve.
    virtual double drivable_s() const noexcept = 0;
};

}  // namespace mw::trajectory::profile

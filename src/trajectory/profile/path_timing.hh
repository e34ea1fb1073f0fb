// SPDX-License-Identifier: GPL-2.0-or-later
// The timing of a curve from stop to stop, planned in windows while the curve still grows.
#pragma once

#include <cstdint>
#include <vector>

#include "trajectory/curve/span.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

using curve::TimeCell;

/// A stop: the first `kept` cells of the plan, then these cells.
struct Stop {
    std::size_t kept = 0;
    std::vector<TimeCell> cells;
    double end_s = 0;
};

enum class StopEffort : std::uint8_t {
    QUICK,   ///< from the first place from which a direct stop keeps all limits
    PROMPT,  ///< for the stops of every plan: QUICK where that is little later than any stop could be
    SOONEST  ///< the motion before the direct stop is the slowest one, too
};

/// Planner thread. Cells that were planned stay in it until they are dropped, so that another motion can
/// begin at the start of each.
class PathTiming {
  public:
    virtual ~PathTiming() = default;
    /// A run begins, at rest at `s`.
    virtual void begin(double s) noexcept = 0;
    /// Plans a window of the run behind the first `fixed` cells, which stay. The limits are those of the last
    /// plan or higher, the end of the run the same or farther away. False if it is rejected: the plan that it
    /// would start from leaves a limit by more than rounding. Then the plan before stays, with its stops, and
    /// more of the curve or another place to start may help.
    virtual bool plan(const Run &run, std::size_t fixed) = 0;
    /// As plan(), after limits of speed were lowered, or the end of the run came nearer (not nearer than the
    /// soonest stop), or was taken away. The speed may be above a lowered limit as long as the soonest
    /// braking needs; acceleration and jerk never. An end that is so near that the plan brakes for it stays:
    /// the run resumes with begin(). False if it is rejected as in plan(): the speed stays as it was.
    virtual bool replan(const Run &run, std::size_t fixed) = 0;
    /// Begins the stops of one plan within `run`. The last stop is requested first.
    virtual void begin_stops(const Run &run) = 0;
    /// The soonest stop that keeps every limit of `run`, not before the start of cell `fixed`. The plan stays
    /// as it is.
    virtual Stop next_stop(const Run &run, std::size_t fixed, StopEffort effort) = 0;
    Stop stop(const Run &run, std::size_t fixed, StopEffort effort) {
        begin_stops(run);
        return next_stop(run, fixed, effort);
    }
    /// Time between the starts of two stops of a plan, the second of which takes `stop_s` [s].
    virtual double stops_apart_s(double stop_s) const noexcept = 0;
    /// Part of the time of a plan that may be committed. What is behind it is for the stop.
    virtual double committed_part() const noexcept = 0;
    /// Cells that are planned and not dropped.
    virtual std::size_t cells() const noexcept = 0;
    virtual const TimeCell &cell(std::size_t k) const noexcept = 0;
    /// The last cell ends in a stop, at `end_s`: that of the run, or one that was planned before and is too
    /// near to be changed.
    virtual bool isComplete() const noexcept = 0;
    virtual double end_s() const noexcept = 0;
    /// The first `count` cells are driven.
    virtual void drop(std::size_t count) = 0;
    /// From here on there are poses without joints, or joints that jump: the motion stops before. 1e300: not
    /// on the known curve.
    virtual double drivable_s() const noexcept = 0;
};

}  // namespace mw::trajectory::profile

// SPDX-License-Identifier: GPL-2.0-or-later
// The timing of a curve from stop to stop, planned in windows while the curve still grows.
//
// A window begins with the state at the end of the cells that stay and ends in a creep. The last plan,
// followed by a creep over what is new, keeps every limit: each plan starts from it, so a plan that is late
// or stopped early can be driven.
#pragma once

#include <vector>

#include "trajectory/profile/speed_plan.hh"
#include "trajectory/profile/stop_search.hh"
#include "trajectory/profile/time_law.hh"

namespace mw::trajectory::profile {

struct ProfileSettings {
    double window_s = 0.5;   ///< planned at once, and the time of a stop behind it
    double period_s = 1e-3;  ///< of the servo thread: limits hold for samples so far apart
};

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
class Profile {
  public:
    explicit Profile(const ProfileSettings &settings) : settings_(settings) {}

    /// A run begins, at rest at `s`.
    void begin(double s) noexcept;
    /// Plans a window of the run behind the first `fixed` cells, which stay. The limits are those of the last
    /// plan or higher, the end of the run the same or farther away. False if it is rejected: the plan that it
    /// would start from leaves a limit by more than rounding. Then the plan before stays, with its creep and
    /// its stops, and more of the curve or another place to start may help.
    bool plan(const Run &run, std::size_t fixed);
    /// The soonest stop that keeps every limit of `run`, not before the start of cell `fixed`. The plan stays
    /// as it is.
    Stop stop(const Run &run, std::size_t fixed, StopEffort effort) {
        begin_stops(run);
        return next_stop(run, fixed, effort);
    }
    /// The same for many stops of one plan within `run`, from the last one to the first: the slowest motion
    /// from a place, behind the plan up to there, is where that from an earlier place begins to be looked
    /// for, and direct stops are looked for once.
    void begin_stops(const Run &run);
    Stop next_stop(const Run &run, std::size_t fixed, StopEffort effort);
    /// As plan(), after limits of speed were lowered, or the end of the run came nearer (not nearer than the
    /// soonest stop), or was taken away. The speed may be above a lowered limit as long as the soonest
    /// braking needs; acceleration and jerk never. An end that is so near that the plan brakes for it stays:
    /// the run resumes with begin(). False if it is rejected as in plan(): the speed stays as it was.
    bool replan(const Run &run, std::size_t fixed);
    /// Cells that are planned and not dropped.
    std::size_t cells() const noexcept {
        return plan_.ends_early ? ending_at_ + ending_.size() : plan_.laid();
    }
    const TimeCell &cell(std::size_t k) const noexcept {
        return plan_.ends_early && k >= ending_at_ ? ending_[k - ending_at_] : plan_.time_cells[k];
    }
    /// The last cell ends in a stop, at `end_s`: that of the run, or one that was
    /// planned before and is too near to be changed.
    bool isComplete() const noexcept { return plan_.has_end || plan_.ends_early; }
    double end_s() const noexcept { return plan_.ends_early ? ending_s_ : planned_s(); }
    /// The first `count` cells are driven.
    void drop(std::size_t count);

    /// From here on there are poses without joints, or joints that jump: the motion stops before. 1e300: not
    /// on the known curve.
    double drivable_s() const noexcept { return joint_curve_.drivable_s(); }
    /// Largest row over its limit of the plan that the last one started from.
    double worst_start() const noexcept { return worst_start_; }
    /// Plans that were rejected, and the largest row over its limit that they would have started from.
    int rejected() const noexcept { return rejected_; }
    double worst_rejected() const noexcept { return worst_rejected_; }
    int steps() const noexcept { return steps_; }

  private:
    /// Part of a limit by which rounding may leave it.
    static constexpr double ROUNDING = 1e-6;
    void take_limits(const Run &run);
    void take_joints(const Run &run);
    void lay_cells(std::size_t fixed);
    void prepare(std::size_t fixed, std::size_t n);
    double make_room();
    bool isStart(double worst) noexcept;
    bool restore() noexcept;
    bool extend(const Run &run, std::size_t fixed);
    bool change(const Run &run, std::size_t fixed);
    bool make_slowest(std::size_t fixed, std::size_t n, const std::vector<double> &floors,
                      SolveSettings settings);
    void forget_slowest() noexcept { slowest_.end = 0; }
    void restart() noexcept;
    std::size_t split(const Run &run, std::size_t fixed, std::size_t n);
    int parts_of(const Run &run, const Course &course, std::size_t cell, double length) const;
    bool keepsRows(const Course &course, std::size_t cell, int parts);
    bool slow_down(const Run &run, std::size_t fixed);
    double time_of(const Stop &stop, std::size_t fixed) const;
    void stop_sooner(const Run &run, std::size_t fixed, double enough_s, Stop &out);
    void make_time_cells(std::size_t fixed);
    bool endsNear(const Run &run) const noexcept;
    bool end_early(const Run &run, std::size_t fixed);
    bool isInEnding() const noexcept { return plan_.ends_early && ending_.size() < ending_cells_; }
    double planned_s() const noexcept;

    ProfileSettings settings_;
    RoughProfile rough_;
    Run run_;  ///< its limits with the margins
    curve::JointCurve joint_curve_;
    Rows rows_;
    TimeLaw law_;
    SpeedPlan plan_, kept_;  ///< what is planned, and the plan before while another one is made
    std::vector<double> creep_, floors_, part_knots_;
    struct {
        std::vector<double> knots, c;
    } split_;
    /// The slowest motion of the present plan that was found last: its coefficients from a cell on, up to
    /// the end of another. No cells: none.
    struct {
        std::vector<double> c;
        std::size_t from = 0, end = 0;
    } slowest_;
    KnownStops known_stops_;  ///< of the plan, since begin_stops()
    double start_s_ = 0;
    double reach_ = 0;  ///< before the end of what is known: a seam there may lower limits so far
    // A direct stop before the end of the cells, from the start of one of them on.
    std::size_t ending_at_ = 0, ending_cells_ = 0;
    double ending_s_ = 0;
    std::vector<TimeCell> ending_;
    double worst_start_ = 0, worst_rejected_ = 0;
    int steps_ = 0, rejected_ = 0;
};

}  // namespace mw::trajectory::profile

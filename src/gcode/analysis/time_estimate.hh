// SPDX-License-Identifier: GPL-2.0-or-later
// Cycle time of a program, calculated before it runs: per tool and in total, with the positions where time is
// lost.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gcode/analysis/preview.hh"
#include "trajectory/estimator.hh"

namespace mw::gcode {

/// The limits of a machine, for times without kinematics: each joint is treated as the axis of its letter.
struct TimedMachine {
    trajectory::Limits limits;    ///< of paths
    geometry::Pose low, high;     ///< soft limits
    double corner_scale = 0;      ///< for moves that do not set it
    bool has_jerk_limit = false;  ///< G64 R can select planning with jerk limits
    double servo_period_s = 0;
};

struct SlowPlace {
    std::string file;
    int line = 0;
    double lost_s = 0;  ///< relative to the programmed feed
    std::string limit;  ///< "acceleration of X", "tolerance"...
};

struct TimeFigures {
    double total_s = 0, cutting_s = 0, rapid_s = 0, dwell_s = 0;
    bool isComplete = true;  ///< false: the planner could not complete the moves
    std::map<int, double> by_tool;
    std::vector<std::pair<std::string, double>> by_section;  ///< in the order of their start
    std::vector<SlowPlace> slowest;                          ///< at most SLOW_PLACES, worst first
};
inline constexpr std::size_t SLOW_PLACES = 5;

/// A move, several moves combined by the planner, or a dwell.
struct TimedMove {
    std::uint64_t id = 0;  ///< id of its last event, see TimeEstimate::take
    int line = 0;          ///< line of that event
    double seconds = 0;
    double top_velocity = 0;  ///< maximum velocity along the feed length; 0 for a dwell
};

/// Overrides set by an operator. [1: as programmed]
struct Overrides {
    double feed = 1, rapid = 1;
    double max_velocity = 0;  ///< maximum speed along the feed length, 0: not set
};

/// Receives the moves in order; one thread.
class TimeEstimate {
  public:
    /// `watch` is called for each complete move, in order; may be empty.
    using Watch = std::function<void(const TimedMove &)>;
    explicit TimeEstimate(const TimedMachine &machine, const Overrides &overrides = {}, Watch watch = {});

    /// See trajectory::Estimator::end_when. The estimate is then incomplete.
    void end_when(std::function<bool()> isToEnd) { estimator_->end_when(std::move(isToEnd)); }
    void start(const geometry::Pose &position);
    /// `section` is the name from Preview::section.
    void set_place(const std::string &file, int line, const std::string &section);
    /// An event of a preview; `id` is returned in TimedMove.
    void take(const PreviewEvent &event, std::uint64_t id = 0);
    void line(const geometry::Pose &end, const geometry::MoveSettings &settings);
    void arc(const ArcMove &move);
    void dwell(double seconds);
    /// Stops motion at this point: tool changes, stops, probes.
    void stop();
    void set_tool(int tool);
    /// G64 R: selects planning with or without jerk limits from now on.
    void set_smooth(bool smooth);
    /// Returns the figures, with a limited number of slow positions.
    const TimeFigures &finish(std::size_t slow_places = SLOW_PLACES);

  private:
    void count(const trajectory::MoveEstimate &move);
    trajectory::MoveRequest request_of(const geometry::MoveSettings &settings);

    Watch watch_;
    std::uint64_t id_ = 0;
    trajectory::Limits limits_;
    double corner_scale_;
    bool has_jerk_limit_;
    TimeFigures figures_;
    int tool_ = 0;
    std::vector<std::string> files_;
    std::uint32_t file_ = 0;
    std::size_t section_ = 0;
    int line_ = 0;
    geometry::Pose position_;
    std::unique_ptr<trajectory::Estimator> estimator_;
    std::map<std::pair<std::uint32_t, int>, SlowPlace> places_;
};

}  // namespace mw::gcode

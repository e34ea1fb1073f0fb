// SPDX-License-Identifier: GPL-2.0-or-later
// Cycle time of a program before it runs: per tool and in all, and where the time is lost.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gcode/analysis/preview.hh"
#include "machine/config/machine_config.hh"
#include "trajectory/estimator.hh"

namespace mw::machine {

struct SlowPlace {
    std::string file;
    int line = 0;
    double lost_s = 0;  ///< against the programmed feed
    std::string limit;  ///< "acceleration of X", "tolerance"...
};

struct TimeFigures {
    double total_s = 0, cutting_s = 0, rapid_s = 0, dwell_s = 0;
    bool isComplete = true;  ///< false: the planner could not drive all of it
    std::map<int, double> by_tool;
    std::vector<std::pair<std::string, double>> by_section;  ///< in the order in which they begin
    std::vector<SlowPlace> slowest;                          ///< at most SLOW_PLACES, the worst first
};
inline constexpr std::size_t SLOW_PLACES = 5;

/// A move, or moves that the planner has made one, or a dwell.
struct TimedMove {
    std::uint64_t id = 0;  ///< of the last event in it, see TimeEstimate::take
    int line = 0;          ///< of that
    double seconds = 0;
    double top_velocity = 0;  ///< along the feed length; 0 for a dwell
};

/// What an operator has set. [1: as programmed]
struct Overrides {
    double feed = 1, rapid = 1;
    double max_velocity = 0;  ///< highest speed along the feed length, 0: none is set
};

/// Fed with the moves in order; one thread.
class TimeEstimate {
  public:
    /// `watch` hears of each move in order, when the planner has driven it; may be empty.
    using Watch = std::function<void(const TimedMove &)>;
    explicit TimeEstimate(const MachineConfig &machine, const Overrides &overrides = {}, Watch watch = {});

    /// See trajectory::Estimator::end_when. The estimate is not complete then.
    void end_when(std::function<bool()> isToEnd) { estimator_->end_when(std::move(isToEnd)); }
    void start(const geometry::Pose &position);
    /// `section` as Preview::section names it.
    void set_place(const std::string &file, int line, const std::string &section);
    /// What a preview tells; `id` comes back in TimedMove.
    void take(const gcode::PreviewEvent &event, std::uint64_t id = 0);
    void line(const geometry::Pose &end, const geometry::MoveSettings &settings);
    void arc(const gcode::ArcMove &move);
    void dwell(double seconds);
    /// Motion stands here: tool changes, stops, probes.
    void stop();
    void set_tool(int tool);
    /// G64 R: with jerk limits from here on, or without.
    void set_smooth(bool isSmooth);
    /// With at most so many slow places.
    const TimeFigures &finish(std::size_t slow_places = SLOW_PLACES);

  private:
    void count(const trajectory::MoveEstimate &move);
    trajectory::MoveRequest request_of(const geometry::MoveSettings &settings);

    Watch watch_;
    std::uint64_t id_ = 0;
    motion::Settings settings_;
    trajectory::Limits limits_;
    double corner_scale_;  ///< of moves that name none
    bool isMergeAdded_;
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

}  // namespace mw::machine

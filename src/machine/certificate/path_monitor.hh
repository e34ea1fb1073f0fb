// SPDX-License-Identifier: GPL-2.0-or-later
// Monitors a run: lengths of the programmed moves, maxima of the commanded motion, points for a picture.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/geometry/pose.hh"
#include "base/limits.hh"
#include "gcode/analysis/path_points.hh"
#include "motion/interface/channels.hh"
#include "motion/interface/path_command.hh"

namespace mw::machine {

struct RunFigures {
    double cutting_length = 0, rapid_length = 0;                        ///< [machine units]
    double cutting_angle_deg = 0, rapid_angle_deg = 0;                  ///< for moves of only A, B and C
    std::array<double, MAX_AXES> peak_velocity{}, peak_acceleration{};  ///< [units/s], [units/s2]
};

/// All calls come from one thread. Moves arrive in the order of the planner, samples in the order of time.
class PathMonitor {
  public:
    explicit PathMonitor(std::int64_t period_ns) : period_s_(static_cast<double>(period_ns) * 1e-9) {}

    void start(const geometry::Pose &position) { history_ = {position, position}; }
    void on_move(const geometry::Pose &start, const motion::PathBody &body);
    /// `isRapid`: the move at the sample is a rapid.
    void on_sample(const motion::TraceSample &sample, bool isRapid);

    const RunFigures &figures() const { return figures_; }
    const std::vector<gcode::PathPoint> &points() const { return points_.all(); }

  private:
    double period_s_;
    RunFigures figures_;
    std::uint8_t pose_kind_ = 0;
    std::array<geometry::Pose, 2> history_{};  ///< the two previous samples
    gcode::PathPoints points_;
};

}  // namespace mw::machine

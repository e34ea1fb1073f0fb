// SPDX-License-Identifier: GPL-2.0-or-later
// Watches a run: distance between the programmed path and the commanded one, peaks, lengths, points for a
// picture.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "base/geometry/pose.hh"
#include "machine/analysis/path_points.hh"
#include "machine/analysis/programmed_piece.hh"
#include "motion/interface/channels.hh"
#include "motion/interface/path_command.hh"

namespace mw::machine {

struct RunFigures {
    double cutting_length = 0, rapid_length = 0;                        ///< [machine units]
    double cutting_angle_deg = 0, rapid_angle_deg = 0;                  ///< for moves of A, B and C alone
    std::array<double, MAX_AXES> peak_velocity{}, peak_acceleration{};  ///< [units/s], [units/s2]
    double deviation_linear = 0, deviation_angular = 0;  ///< maximum [machine units], [degrees]
    std::uint64_t samples = 0;
};

/// One thread. Moves arrive in the order of the planner, samples in the order of time.
class PathMonitor {
  public:
    explicit PathMonitor(std::int64_t period_ns) : period_s_(static_cast<double>(period_ns) * 1e-9) {}

    void start(const geometry::Pose &position);
    void on_move(motion::CommandId id, const motion::PathBody &body);
    void on_sample(const motion::TraceSample &sample);

    const RunFigures &figures() const { return figures_; }
    const std::vector<PathPoint> &points() const { return points_.all(); }

  private:
    void follow(const motion::TraceSample &sample);
    void start_anew(const motion::TraceSample &sample);
    void look_at(std::size_t i, const geometry::Pose &p, Nearest &best, std::size_t &place) const;

    double period_s_;
    RunFigures figures_;
    struct NumberedPiece {
        motion::CommandId id;
        PieceShape shape;
        double length;
    };
    static constexpr std::size_t MOST_BEHIND = 4096;
    static constexpr double LOCAL =
        3;  ///< nearby positions are within this number of steps of the last sample
    std::deque<NumberedPiece> pieces_;
    std::size_t place_ = 0;             ///< index of the last sample in pieces_
    motion::CommandId current_id_ = 0;  ///< the move being executed, which may replace several earlier ones
    double group_length_ = 0;           ///< length of the moves that it replaces
    bool in_rapid_ = false;
    geometry::Pose last_end_{};
    std::uint8_t pose_kind_ = 0;
    std::array<geometry::Pose, 2> history_{};  ///< the two previous samples
    PathPoints points_;
};

}  // namespace mw::machine

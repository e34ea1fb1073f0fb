// SPDX-License-Identifier: GPL-2.0-or-later
// Speed limits of the moves on a curve, from feeds, overrides, spindles and planner modules.
#pragma once

#include <vector>

#include "trajectory/path/conditions.hh"
#include "trajectory/path/planned_path.hh"
#include "trajectory/path/speed_choice.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::plan {

/// Use it in the planner thread only. It contains the consecutive moves that are not dropped.
class MoveFeeds {
  public:
    explicit MoveFeeds(PlannedPath &moves) : moves_(moves) {}

    void begin(Sequence first_move);
    /// Adds the newest move. Its tag must be complete.
    void add(const Conditions &conditions, Sequence move);
    void drop_before(Sequence move);
    struct Change {
        bool is_any = false, is_lower = false;
    };
    /// Updates the limits for changed overrides. Returns whether a limit changed, and whether one became
    /// lower.
    Change update(const Conditions &conditions);

    const std::vector<profile::FeedLimit> &limits() const noexcept { return feeds_; }
    Sequence first_move() const noexcept { return first_move_; }
    /// The move at `s`. At the end of a move it is the next one.
    Sequence move_at(double s) const noexcept;
    /// True if a move follows the speed of a spindle.
    bool isSynched() const noexcept { return last_synched_ >= first_move_; }
    /// The limit that a planner module exceeded. The move then has no speed.
    const Overreach &overreach() const noexcept { return overreach_; }

  private:
    profile::FeedLimit feed_of(const Conditions &conditions, Sequence move) noexcept;
    double chosen_feed(const Conditions &conditions, Sequence move, double velocity) noexcept;

    PlannedPath &moves_;
    std::vector<profile::FeedLimit> feeds_;
    Sequence first_move_ = 1;
    Sequence last_synched_ = 0;
    Overreach overreach_;
};

}  // namespace mw::trajectory::plan

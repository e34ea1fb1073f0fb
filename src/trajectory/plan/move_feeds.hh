// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of speed of the moves on a curve: by feed, overrides, spindles and planner modules.
#pragma once

#include <vector>

#include "trajectory/path/conditions.hh"
#include "trajectory/path/planned_path.hh"
#include "trajectory/path/speed_choice.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::plan {

/// Planner thread. Of moves in succession, those that are not dropped.
class MoveFeeds {
  public:
    explicit MoveFeeds(PlannedPath &moves) : moves_(moves) {}

    void begin(Sequence first_move);
    /// The newest move; its tag is complete.
    void add(const Conditions &conditions, Sequence move);
    void drop_before(Sequence move);
    struct Change {
        bool is_any = false, is_lower = false;
    };
    /// For other overrides: whether a limit changed, and became lower.
    Change update(const Conditions &conditions);

    const std::vector<profile::FeedLimit> &limits() const noexcept { return feeds_; }
    Sequence first_move() const noexcept { return first_move_; }
    /// The move at `s`; where two meet, the second one.
    Sequence move_at(double s) const noexcept;
    /// A move follows the speed of a spindle.
    bool isSynched() const noexcept { return last_synched_ >= first_move_; }
    /// The limit that a planner module exceeded. The move has no speed.
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

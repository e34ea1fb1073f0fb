// SPDX-License-Identifier: GPL-2.0-or-later
// What was handed to the planner and is not done: it can be taken back and begun again from where the machine
// stands.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/task/sequencer/items.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// One thread.
class SentMoves {
  public:
    /// `item` went on as path command `id`; `position` is where the machine stands if none is under way.
    void note(motion::CommandId id, const Item &item, const geometry::Pose &position);
    /// Forgets what motion has done.
    void follow(const motion::Status &status);
    /// Source line of the move under way, or of the last that was under way; 0 for none since clear_line().
    int line() const { return line_; }
    void clear_line() { line_ = 0; }
    void clear() { sent_.clear(); }
    /// The first that is not done when those up to `id` are; null for none.
    const Item *oldest_after(motion::CommandId id) const;

    /// Why the move under way cannot be begun again from `place`, in its middle; empty: it can.
    std::string why_not(const motion::Status &status, const geometry::Pose &place) const;
    /// All that is not done, in its order; the move under way from `place` on.
    std::vector<Item> rest(const motion::Status &status, const geometry::Pose &place) const;

  private:
    struct Sent {
        motion::CommandId id = 0;
        Item item;
        geometry::Pose start;
    };
    std::deque<Sent>::const_iterator under_way(const motion::Status &status) const;

    std::deque<Sent> sent_;
    geometry::Pose end_;  ///< of the last move that was noted
    int line_ = 0;
};

/// The rest of an arc that began at `start`, of which `to_go` is left [machine units], from `place` on:
/// itself, with a short line to it before where `place` lies beside it (in a rounded corner).
std::vector<gcode::MachineCall> rest_of_arc(const gcode::ArcMove &arc, const geometry::Pose &start,
                                            const geometry::Pose &place, double to_go);

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// The moves that were sent to the planner and are not done. They can be taken back and restarted from the
// position of the machine.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/task/sequencer/items.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// All calls come from one thread.
class SentMoves {
  public:
    /// `item` was sent as path command `id`; `position` is that of the machine, for a move that begins there.
    /// Returns the position at which the item begins.
    geometry::Pose note(motion::CommandId id, const Item &item, const geometry::Pose &position);
    /// Drops completed moves.
    void follow(const motion::Status &status);
    /// Source line of the current move, or of the last one; 0 for none since clear_line().
    int line() const { return line_; }
    void clear_line() { line_ = 0; }
    void clear() { sent_.clear(); }
    /// The first move that is not done after the moves up to `id`; null: none.
    const Item *oldest_after(motion::CommandId id) const;

    /// The reason why the current move cannot be restarted from `place`, in its middle; empty: it can.
    std::string why_not(const motion::Status &status, const geometry::Pose &place) const;
    /// All moves that are not done, in order; the current move begins at `place`.
    std::vector<Item> rest(const motion::Status &status, const geometry::Pose &place) const;

  private:
    struct Sent {
        motion::CommandId id = 0;
        Item item;
        geometry::Pose start;
    };
    std::deque<Sent>::const_iterator under_way(const motion::Status &status) const;

    std::deque<Sent> sent_;
    geometry::Pose end_;         ///< end of the last move
    bool isEndUnknown_ = false;  ///< a probe, so later moves wait for it
    int line_ = 0;
};

/// The rest of an arc that began at `start`, with `to_go` left [machine units], beginning at `place`: the
/// arc, preceded by a short line if `place` is beside it (in a rounded corner).
std::vector<gcode::MachineCall> rest_of_arc(const gcode::ArcMove &arc, const geometry::Pose &start,
                                            const geometry::Pose &place, double to_go);

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// The approach to the position where a program continues: first to the safe height, then above the position,
// then down at feed. It is shown to a person, who confirms it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/result.hh"
#include "machine/task/run/search_machine.hh"
#include "machine/task/sequencer/items.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// Speed of the last move if the program has set none. [mm/s]
inline constexpr double DEFAULT_APPROACH_FEED_MM_S = 5.0;

/// From `from` to `to`, with Z at `safe_z` in between; moves without length are omitted.
std::vector<ApproachMove> approach_moves(const geometry::Pose &from, const geometry::Pose &to, double safe_z);

/// Target state and current state.
struct ApproachPlan {
    ApproachTo to = ApproachTo::NOTHING;
    int line = 0;
    FoundModes modes;
    int tool_now = 0;
    double feed = 0;      ///< feed of the last move [machine units/s]
    geometry::Pose from;  ///< current position
    /// Moves of M6 before the changer starts; none if it does not move.
    std::vector<geometry::Pose> change_moves;
    std::vector<ApproachMove> moves;

    bool mustChangeTool() const { return modes.tool != tool_now; }
    /// Calculates the moves. A tool change ends at `changed_at`, and the path goes up before it and again
    /// after it.
    void find_way(double safe_z, const geometry::Pose &changed_at);
    /// True if the approach has steps that a person must confirm.
    bool isNeeded() const;
    /// The steps in order: up, tool, settings, spindles, above the position, coolant, down.
    std::vector<gcode::MachineCall> calls() const;
};

/// At most one proposal. All calls come from one thread.
class Approach {
  public:
    /// Its number differs from all earlier ones.
    void propose(ApproachPlan plan, std::int64_t now_ns);
    /// Discards the proposal.
    void forget() { plan_.reset(); }
    bool isOpen() const { return plan_.has_value(); }
    /// `number` 0: a client that does not use numbers. It is accepted only when a person has had time to see
    /// the proposal.
    Result<> check(std::uint64_t number, std::int64_t now_ns) const;
    const ApproachPlan &plan() const { return *plan_; }
    /// Shows the proposal to clients; `offsets` and `codes` are those at the line.
    void show(ApproachStatus &status, const OffsetsStatus &offsets, const CodesStatus &codes) const;

  private:
    std::optional<ApproachPlan> plan_;
    std::uint64_t number_ = 0;
    std::int64_t since_ns_ = 0;
};

/// "rapid to Z25, rapid to X10 Y20, feed to Z-1".
std::string approach_text(const ApproachPlan &plan);

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// The way to where a program goes on: safe height first, then over the place, then down at feed. Shown to a
// person, who confirms it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/result.hh"
#include "machine/task/run/search_machine.hh"
#include "machine/task/sequencer/items.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// Speed of the last move where the program has set none. [mm/s]
inline constexpr double DEFAULT_APPROACH_FEED_MM_S = 5.0;

/// From `from` to `to`, Z at `safe_z` in between; no move where it is not needed.
std::vector<ApproachMove> approach_moves(const geometry::Pose &from, const geometry::Pose &to, double safe_z);

/// What is to be there, and what is.
struct ApproachPlan {
    ApproachTo to = ApproachTo::NOTHING;
    int line = 0;
    FoundModes modes;
    int tool_now = 0;
    double feed = 0;      ///< of the last move [machine units/s]
    geometry::Pose from;  ///< where the machine stands
    /// Where M6 goes before the changer begins; none where it stays.
    std::vector<geometry::Pose> change_moves;
    std::vector<ApproachMove> moves;

    bool mustChangeTool() const { return modes.tool != tool_now; }
    /// Fills in the moves: with a tool change, which ends at `changed_at`, up before it and again after it.
    void find_way(double safe_z, const geometry::Pose &changed_at);
    /// Something has to be done that a person must know of.
    bool isNeeded() const;
    /// What is done, in its order: up, tool, settings, spindles, over the place, coolant, down.
    std::vector<gcode::MachineCall> calls() const;
};

/// One proposal or none. One thread.
class Approach {
  public:
    /// Another number than all before it.
    void propose(ApproachPlan plan, std::int64_t now_ns);
    /// It is not open any more.
    void forget() { plan_.reset(); }
    bool isOpen() const { return plan_.has_value(); }
    /// `number` 0: of a client that does not know about numbers; it is taken only when a person has had time
    /// to see the proposal.
    Result<> check(std::uint64_t number, std::int64_t now_ns) const;
    const ApproachPlan &plan() const { return *plan_; }
    /// As clients are shown it; `offsets` and `codes` are those in force there.
    void show(ApproachStatus &status, const OffsetsStatus &offsets, const CodesStatus &codes) const;

  private:
    std::optional<ApproachPlan> plan_;
    std::uint64_t number_ = 0;
    std::int64_t since_ns_ = 0;
};

/// "rapid to Z25, rapid to X10 Y20, feed to Z-1".
std::string approach_text(const ApproachPlan &plan);

}  // namespace mw::task

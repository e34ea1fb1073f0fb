// SPDX-License-Identifier: GPL-2.0-or-later
// The state at the pause of a program. An operator may stop the spindle, jog and change the tool before it
// resumes.
#pragma once

#include <cstdint>
#include <optional>

#include "machine/task/control/run_parts.hh"
#include "machine/task/run/approach.hh"

namespace mw::task {

/// Exists from the pause of a run to its resume or end. It includes changes that the program itself makes in
/// this time. All calls come from one thread.
class PausedState {
  public:
    explicit PausedState(const RunParts &parts) : parts_(parts) {}

    /// Called after each command and in each cycle. Later changes by an operator are restored at the resume.
    void watch();
    /// True if a spindle or coolant that the program had switched on is off, or another tool is in the
    /// spindle.
    bool isSomethingOff() const;
    /// True if the tool table has changed since the pause.
    bool areToolsChanged() const;
    /// Returns moves that the planner has not done to the queue; motion stops and drops them.
    Result<> take_path_back();
    /// The block at which the program continues, and the state of the machine there.
    RunPlace place() const;
    /// The approach from the current state.
    ApproachPlan plan_back() const;

  private:
    struct State {
        geometry::Pose position;  ///< position of the machine when the axes were released
        int line = 0;
        int tool = 0;             ///< tool in the spindle
        std::uint64_t tools = 0;  ///< checksum of the tool table
        std::uint64_t tools_version = 0;
        ProgramSpindles spindles;
        bool mist = false, flood = false;
    };
    void note_tools(State &state) const;

    const RunParts &parts_;
    std::optional<State> paused_;
};

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// Starts of programs that are not at their first line.
#pragma once

#include <string>

#include "machine/task/task.hh"

namespace mw::task {

/// Works on task; has no state.
struct Task::ProgramResume {
    Task &task;

    /// Starts calculating the state before the line.
    void begin();
    /// As begin(), for the interrupted program.
    Result<> open_recovery();
    void begin_recovery();
    void prepare_journal();
    void begin_journal(std::uint32_t first_block);
    void show_journal();
    void note_place();
    void note_doubt();
    /// Once a cycle while active.
    void step();
    /// A person has confirmed; `number` as in Approach::check().
    Result<Progress> confirm(std::uint64_t number);
    /// Ends the search or the proposal.
    void drop();

    void watch_hold();
    /// Releases the axes of a paused program for jogging.
    Result<Progress> release(mailbox::Serial command);
    /// A resume requires an approach or a calculation first.
    bool isReturnNeeded() const {
        return task.run_.hold() == Hold::AWAY || (task.left_.has_value() && isSomethingOff());
    }
    Result<Progress> come_back();
    /// The tool table has changed since the program was paused.
    bool areToolsChanged() const;

  private:
    Result<> check_recovery() const;
    /// Blocks read ahead used other tool data: calculates the program again up to the current block.
    Result<Progress> calculate_again();
    void begin_with_tools_now();
    bool isOldOffsetKept() const;
    void begin_block_search(Result<StartRecord> record, std::optional<std::uint64_t> calls);
    void propose_line();
    void propose_recovery();
    /// What of it is the same for all: the way, the feed; then it is shown.
    void propose(ApproachPlan plan);
    void complete(ApproachPlan &plan) const;
    /// Tool change position when the machine comes from `at`.
    geometry::Pose find_change_place(geometry::Pose at, ApproachPlan &plan) const;
    void go_on(const ApproachPlan &plan);
    void restore_switches(const StartRecord &record);
    ApproachPlan plan_back() const;
    Result<> take_path_back();
    bool isSomethingOff() const;
    void give_up(std::string reason);
    double safe_height() const;
};

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// Starts of programs that are not at their first line.
#pragma once

#include <string>

#include "machine/task/task.hh"

namespace mw::task {

/// Works on task; has nothing of its own.
struct Task::ProgramResume {
    Task &task;

    /// What comes before the line is calculated from here on.
    void begin();
    /// The same for the program that was cut short.
    Result<> open_recovery();
    void begin_recovery();
    void prepare_journal();
    void begin_journal(std::uint32_t first_block);
    void show_journal();
    void note_place();
    void note_doubt();
    /// Once a cycle while it is.
    void step();
    /// A person has agreed; `number` as in Approach::check().
    Result<Progress> confirm(std::uint64_t number);
    /// Nothing is searched or proposed any more.
    void drop();

    void watch_hold();
    /// Lets the axes of a held program be jogged.
    Result<Progress> release(mailbox::Serial command);
    /// A resume has to bring something about first.
    bool isReturnNeeded() const {
        return task.run_.hold() == Hold::AWAY || (task.left_.has_value() && isSomethingOff());
    }
    Result<Progress> come_back();
    /// Another tool table than when the program was held.
    bool areToolsChanged() const;

  private:
    Result<> check_recovery() const;
    /// What was read ahead has other tools: the program is calculated again up to the block under way.
    Result<Progress> calculate_again();
    void begin_with_tools_now();
    bool isOldOffsetKept() const;
    void begin_block_search(Result<StartRecord> record, std::optional<std::uint64_t> calls);
    void propose_line();
    void propose_recovery();
    /// What of it is the same for all: the way, the feed; then it is shown.
    void propose(ApproachPlan plan);
    void complete(ApproachPlan &plan) const;
    /// Where a tool is changed when the machine comes from `at`.
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

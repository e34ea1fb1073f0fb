// SPDX-License-Identifier: GPL-2.0-or-later
// Starts of programs that are not at their first line.
#pragma once

#include <string>

#include "task/task.hh"

namespace mw::task {

/// Works on task; has nothing of its own.
struct Task::Start {
    Task &task;

    /// What comes before the line is calculated from here on.
    void begin();
    /// Once a cycle while it is.
    void step();
    /// A person has agreed; `number` as in Approach::check().
    Result<Progress> confirm(std::uint64_t number);
    /// Nothing is searched or proposed any more.
    void drop();

  private:
    void propose();
    void go_on(const ApproachPlan &plan);
    void give_up(const std::string &reason);
    double safe_height() const;
};

}  // namespace mw::task

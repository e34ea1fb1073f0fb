// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the programs of a queue one after another, as a client of the machine.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "clients/rsh/commander.hh"
#include "clients/schedule/queue.hh"

namespace mw::schedule {

enum class QueueMode { STOP, RUN, PAUSE, ERROR };

/// One thread. A program leaves the queue once it has ended well. One that fails or is aborted stays, and
/// the queue stays in ERROR until it is stopped or run again: no program follows one that failed.
class Scheduler {
  public:
    /// `folder`: of programs whose name is no path.
    Scheduler(rsh::Joining joining, std::string folder)
        : commander_(std::move(joining)), folder_(std::move(folder)) {}

    Queue &queue() { return queue_; }
    const Queue &queue() const { return queue_; }
    QueueMode mode() const { return mode_; }
    /// Why it is in ERROR.
    const std::string &error() const { return error_; }

    /// Begins with the first program; a machine that is not ready for one is an error. Goes back to STOP when
    /// no program is left.
    Result<> run(const messages::MachineStatus &status);
    /// Holds the program that runs; without one, none is begun.
    Result<> pause();
    Result<> resume();
    /// Aborts the program that runs. It stays in the queue.
    Result<> stop();
    /// Rejected for the running program.
    Result<> remove(int tag);

    /// Looks for what has ended, and at most every `poll_s` for the next program.
    void step(const messages::MachineStatus &status, double now_s);
    double poll_s = 1.0;

  private:
    /// What is still to be done for the program in front, one after another.
    struct Work {
        int tag = 0;
        std::deque<messages::Command> ahead;
        std::optional<client::Serial> under_way;
    };

    void begin(const Job &job, const messages::MachineStatus &status);
    void look_at_work();
    void post_next();
    void fall_into_error(const std::string &why);

    rsh::Commander commander_;
    std::string folder_;
    Queue queue_;
    QueueMode mode_ = QueueMode::STOP;
    std::optional<Work> work_;
    std::string error_;
    double looked_s_ = -1e9;
};

/// What is asked of the machine for a program, in order; its last command runs it.
std::deque<messages::Command> commands_for(const Job &job, const std::string &folder,
                                           const messages::MachineStatus &status);

}  // namespace mw::schedule

// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the programs of a queue one after the other, as a client of the machine.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "clients/rsh/commander.hh"
#include "clients/schedule/queue.hh"

namespace mw::schedule {

enum class QueueMode { STOP, RUN, PAUSE, ERROR };

/// All calls come from one thread. A program is removed from the queue after it has ended without error. If
/// it fails or is aborted it remains, and the queue is in ERROR until it is stopped or run again. So no
/// program follows a failed one.
class Scheduler {
  public:
    /// `folder` is for programs whose name is not a path.
    Scheduler(rsh::Joining joining, std::string folder)
        : commander_(std::move(joining)), folder_(std::move(folder)) {}

    Queue &queue() { return queue_; }
    const Queue &queue() const { return queue_; }
    QueueMode mode() const { return mode_; }
    /// The reason of the state ERROR.
    const std::string &error() const { return error_; }

    /// Starts with the first program; an error if the machine is not ready for a program. Returns to STOP
    /// when no program is left.
    Result<> run(const messages::MachineStatus &status);
    /// Pauses the running program; if none runs, none is started.
    Result<> pause();
    Result<> resume();
    /// Aborts the running program, which remains in the queue.
    Result<> stop();
    /// Rejected for the running program.
    Result<> remove(int tag);

    /// Checks for the end of commands, and at most every `poll_s` starts the next program.
    void step(const messages::MachineStatus &status, double now_s);
    double poll_s = 1.0;

  private:
    /// Remaining work for the first program, in order.
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

/// Commands to the machine for a program, in order; the last command runs it.
std::deque<messages::Command> commands_for(const Job &job, const std::string &folder,
                                           const messages::MachineStatus &status);

}  // namespace mw::schedule

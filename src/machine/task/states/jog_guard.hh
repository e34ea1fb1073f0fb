// SPDX-License-Identifier: GPL-2.0-or-later
// Guards continuous jogs of clients in other processes. They end when their client's process ends or does not
// run.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "machine/task/command.hh"
#include "messages/mailbox/process_watch.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// One thread; does not block.
class JogGuard {
  public:
    using State = mailbox::ProcessWatch::State;
    /// Functions `state_of` and `forget` for the process of a client (mailbox::ProcessWatch).
    struct Watch {
        std::function<State(std::uint64_t owner)> state_of;
        std::function<void(std::uint64_t owner)> forget;
    };
    struct Left {
        Command stop;
        std::string text;  ///< message for the operator; empty: the jog has already stopped
    };
    explicit JogGuard(Watch watch) : watch_(std::move(watch)) {}

    /// Stores an executed command. `owner` is the client's process; 0 if its jogs are not guarded, as for
    /// task's own process and halui's pins.
    void note(const Command &command, std::uint64_t owner);
    /// Called once in each cycle. Returns jogs to be stopped.
    std::vector<Left> step(const motion::Status &motion);

  private:
    /// A joint or an axis; nothing: the vector of SetTeleopVector.
    using Target = std::optional<std::pair<bool, int>>;
    struct Jog {
        std::uint64_t owner = 0;
        bool moved = false;
    };
    void begin(const Target &target, std::uint64_t owner);
    void end(const Target &target);
    void end_all();
    void forget_unused(std::uint64_t owner);

    Watch watch_;
    std::map<Target, Jog> jogs_;
};

}  // namespace mw::task

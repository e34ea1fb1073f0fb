// SPDX-License-Identifier: GPL-2.0-or-later
// Reads immediate commands from their channel, passes each to its part, and answers it.
#pragma once

#include "motion/servo/parts.hh"
#include "motion/servo/safety_monitor.hh"

namespace mw::motion {

/// Every command gets one answer: done, rejected with a reason, or stale if its epoch has ended.
class CommandDispatcher {
  public:
    /// Takes up to MAX_COMMANDS_PER_CYCLE commands.
    [[gnu::hot]] void handle_commands(ControllerParts &parts, SafetyMonitor &safety,
                                      const Inputs &in) noexcept;
    Epoch epoch() const noexcept { return epoch_; }
    /// The last command that was answered.
    CommandId last_id() const noexcept { return last_id_; }

    static constexpr int MAX_COMMANDS_PER_CYCLE = 64;

  private:
    [[gnu::cold]] Answer answer_to(const Command &command, ControllerParts &parts, SafetyMonitor &safety,
                                   const Inputs &in) noexcept;

    Epoch epoch_ = 0;  ///< older commands are stale
    CommandId last_id_ = 0;
};

}  // namespace mw::motion

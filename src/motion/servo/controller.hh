// SPDX-License-Identifier: GPL-2.0-or-later
// The motion controller: takes commands and calculates the position of each joint in every servo cycle. Pure:
// no HAL, no clock, no allocation. Runs in the servo thread.
#pragma once

#include "motion/servo/command_dispatcher.hh"
#include "motion/servo/controller_config.hh"
#include "motion/servo/parts.hh"
#include "motion/servo/safety_monitor.hh"

namespace mw::motion {

/// Owns the parts of the machine and runs the stages of a servo cycle. Its size is some megabytes, so it is
/// never on a stack.
class Controller {
  public:
    Controller(const ControllerConfig &config, const kinematics::Kinematics &kinematics, Channels &channels,
               PathLink &link) noexcept;
    /// Continues the state of `other` on separate channels; `link` is a copy of the link of `other`.
    Controller(const Controller &other, Channels &channels, PathLink &link) noexcept;
    Controller(const Controller &) = delete;
    Controller &operator=(const Controller &) = delete;

    /// Takes immediate commands and answers each (function motion-command-handler).
    [[gnu::hot]] void handle_commands(const Inputs &in) noexcept;
    /// One servo cycle (function motion-controller).
    [[gnu::hot]] void step(const Inputs &in, Outputs &out) noexcept;

  private:
    /// Commands the joints while the machine is on.
    [[gnu::hot]] void command_joints(const Inputs &in) noexcept;

    ControllerParts parts_;
    SafetyMonitor safety_;
    CommandDispatcher dispatcher_;
};

}  // namespace mw::motion

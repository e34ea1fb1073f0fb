// SPDX-License-Identifier: GPL-2.0-or-later
// Commands that concern several parts of the controller.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

CommandResult take(ControllerParts &parts, const Enable &command, const Inputs &in) noexcept;
CommandResult take(ControllerParts &parts, const SetMode &command) noexcept;
CommandResult take(ControllerParts &parts, const SetParameter &command) noexcept;
/// A joint that is taken out of use is unhomed when it is used again; its position is then its motor
/// position.
CommandResult take(ControllerParts &parts, const SetNumJoints &command, const Inputs &in) noexcept;
CommandResult take(ControllerParts &parts, const SetJointActive &command) noexcept;
CommandResult take(ControllerParts &parts, const Home &command, const Inputs &in) noexcept;
CommandResult take(ControllerParts &parts, const Unhome &command) noexcept;
/// The dispatcher changes the epoch.
CommandResult take(ControllerParts &parts, const Abort &command) noexcept;

}  // namespace mw::motion

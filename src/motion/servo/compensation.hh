// SPDX-License-Identifier: GPL-2.0-or-later
// Stages after the mode: extra joints follow their pins, motor positions get screw compensation, backlash
// and offsets, and spindles get their speed.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Inputs of the extra joints.
ExtraJointInputs extra_inputs(const ControllerParts &parts, const Inputs &in) noexcept;
/// In each mode while the machine is on: homed extra joints follow their pins.
[[gnu::cold]] void command_extra_joints(ControllerParts &parts, const Inputs &in) noexcept;
/// Motor positions. While the machine is off, all commands follow the feedback.
[[gnu::hot]] void command_motors(ControllerParts &parts) noexcept;
[[gnu::hot]] void command_spindles(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion

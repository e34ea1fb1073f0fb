// SPDX-License-Identifier: GPL-2.0-or-later
// Every pin of halui, declared once: what is made in HAL, which command a button is, which part of the status
// a lamp shows, and the pins of halui(1) follow from here.
#pragma once

#include "hal/sdk/pin_table.hh"
#include "msgs/command.hh"
#include "msgs/status.hh"

namespace mw::ui::pins {

using sdk::out, sdk::pin_table;
using namespace msgs;

/// An input that gives a command on its rising edge: `command(number)` makes it.
template <class Make>
constexpr auto button(const char *name, const char *doc, Make command) {
    return sdk::PinRow<bool, HAL_IN, Make, sdk::Unused>{name, "", doc, command, {}};
}

// clang-format off
inline constexpr auto BUTTONS = pin_table("halui",
    button("machine.on", "switches the machine on", [](int) { return SetState{State::ON}; }),
    button("machine.off", "switches it off", [](int) { return SetState{State::OFF}; }),
    button("estop.activate", "emergency stop", [](int) { return SetState{State::ESTOP}; }),
    button("estop.reset", "resets it", [](int) { return SetState{State::ESTOP_RESET}; }),
    button("mode.auto", "mode of programs", [](int) { return SetMode{Mode::AUTO}; }),
    button("mode.manual", "mode of jogs and homing", [](int) { return SetMode{Mode::MANUAL}; }),
    button("mode.mdi", "mode of single lines", [](int) { return SetMode{Mode::MDI}; }),
    button("mode.joint", "jogs move joints", [](int) { return SetTeleop{false}; }),
    button("mode.teleop", "jogs move axes", [](int) { return SetTeleop{true}; }),
    button("home-all", "homes all joints in their sequence", [](int) { return HomeJoint{-1}; }),
    button("abort", "stops whatever moves, along its path, and spindles and coolant", [](int) { return AbortAll{}; }),
    button("program.run", "runs the open program", [](int) { return RunProgram{}; }),
    button("program.step", "runs one block of it", [](int) { return StepProgram{}; }),
    button("program.pause", "holds it", [](int) { return PauseProgram{}; }),
    button("program.resume", "goes on", [](int) { return ResumeProgram{}; }),
    button("program.stop", "as abort", [](int) { return AbortAll{}; }),
    button("program.optional-stop.on", "M1 stops", [](int) { return SetOptionalStop{true}; }),
    button("program.optional-stop.off", "M1 does not", [](int) { return SetOptionalStop{false}; }),
    button("program.block-delete.on", "lines that begin with / are left out", [](int) { return SetBlockDelete{true}; }),
    button("program.block-delete.off", "they are not", [](int) { return SetBlockDelete{false}; }),
    button("flood.on", "M8", [](int) { return FloodOn{}; }),
    button("flood.off", "flood off", [](int) { return FloodOff{}; }),
    button("mist.on", "M7", [](int) { return MistOn{}; }),
    button("mist.off", "mist off", [](int) { return MistOff{}; }));

inline constexpr auto JOINT_BUTTONS = pin_table("halui.joint.#",
    button("home", "homes the joint", [](int joint) { return HomeJoint{joint}; }),
    button("unhome", "forgets its homing", [](int joint) { return UnhomeJoint{joint}; }));

inline constexpr auto LAMPS = pin_table("halui",
    out<bool>("machine.is-on", "", "the machine is on", [](const MachineStatus &s) { return s.task.state == State::ON; }),
    out<bool>("estop.is-activated", "", "emergency stop", [](const MachineStatus &s) { return s.task.state == State::ESTOP; }),
    out<bool>("mode.is-auto", "", "mode of programs", [](const MachineStatus &s) { return s.task.mode == Mode::AUTO; }),
    out<bool>("mode.is-manual", "", "mode of jogs and homing", [](const MachineStatus &s) { return s.task.mode == Mode::MANUAL; }),
    out<bool>("mode.is-mdi", "", "mode of single lines", [](const MachineStatus &s) { return s.task.mode == Mode::MDI; }),
    out<bool>("mode.is-joint", "", "jogs move joints", [](const MachineStatus &s) { return s.trajectory.mode == MotionMode::FREE; }),
    out<bool>("mode.is-teleop", "", "jogs move axes", [](const MachineStatus &s) { return s.trajectory.mode == MotionMode::TELEOP; }),
    out<bool>("program.is-idle", "", "no program runs", [](const MachineStatus &s) { return s.task.interp_state == InterpState::IDLE; }),
    out<bool>("program.is-running", "", "a program runs and is not held", [](const MachineStatus &s) { return s.task.interp_state != InterpState::IDLE && s.task.interp_state != InterpState::PAUSED; }),
    out<bool>("program.is-paused", "", "a program is held", [](const MachineStatus &s) { return s.task.interp_state == InterpState::PAUSED; }));

inline constexpr auto JOINT_LAMPS = pin_table("halui.joint.#",
    out<bool>("is-homed", "", "the joint is homed", [](const JointStatus &s) { return s.isHomed; }));
// clang-format on

/// Calls `show(scope, row)` for every pin.
template <class Show>
void for_each(Show &&show) {
    sdk::for_each_pin(BUTTONS, show);
    sdk::for_each_pin(JOINT_BUTTONS, show);
    sdk::for_each_pin(LAMPS, show);
    sdk::for_each_pin(JOINT_LAMPS, show);
}

}  // namespace mw::ui::pins

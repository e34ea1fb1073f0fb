// SPDX-License-Identifier: GPL-2.0-or-later
// All pins of halui, declared once. The tables generate the pins in HAL, the commands of buttons, the reading
// of inputs, the writing of outputs, and the list of pins in halui(1).
#pragma once

#include "hal/sdk/pin_table.hh"
#include "messages/declarations/command.hh"
#include "messages/legacy/status_table.hh"

namespace mw::halui {

/// The operator's selection, and values that are not in the status.
struct Shown {
    const messages::MachineStatus &status;
    int joint = 0, axis = 0;  ///< selected
    double tool_diameter = 0;
    double units_per_mm = 1;
    bool isRefused = false;  ///< the last command has failed
    std::uint32_t refusals = 0;
};
struct JointShown {
    legacy::Joint joint;
    bool selected = false;
};
struct AxisShown {
    double commanded = 0, feedback = 0, relative = 0;
    bool selected = false;
};

/// The inputs that jog a joint or an axis.
struct JogInputs {
    bool is_select = false;
    bool is_plus = false, is_minus = false;
    bool is_increment_plus = false, is_increment_minus = false;
    double increment = 0;
    double analog = 0;
};
/// Settings for all joints, or all axes.
struct JogSettings {
    double speed_per_min = 0;
    double deadband = 0;
};
/// A wheel and its buttons.
struct DialInputs {
    bool count_enabled = true, direct = false;
    bool is_increase = false, is_decrease = false, isReset = false;
    std::int32_t counts = 0;
    double scale = 0;
};
struct SpindleInputs {
    bool is_start = false, isForward = false, isReverse = false;
    bool is_increase = false, is_decrease = false;
};
struct MdiInput {
    bool isOn = false;
};

}  // namespace mw::halui

namespace mw::halui::pins {

using sdk::in, sdk::out, sdk::pin_table;
using namespace messages;

/// An input that posts a command on its rising edge; `command(number)` creates it.
template <class Make>
constexpr auto button(const char *name, const char *doc, Make command) {
    return sdk::PinRow<bool, HAL_IN, Make, sdk::Unused>{name, "", doc, command, {}};
}

/// Outputs that show rows of messages/legacy/status_table.hh.
template <legacy::RowName NAME>
struct Value {
    auto operator()(const Shown &s) const { return legacy::value<legacy::STATUS, NAME>(s.status); }
    auto operator()(const JointShown &s) const { return legacy::value<legacy::JOINT_STATUS, NAME>(s.joint); }
    auto operator()(const SpindleStatus &s) const { return legacy::value<legacy::SPINDLE_STATUS, NAME>(s); }
};
template <legacy::RowName NAME>
inline constexpr Value<NAME> value{};

using Count = std::int32_t;
using Index = std::uint32_t;

// clang-format off
inline constexpr auto BUTTONS = pin_table("halui",
    button("machine.on", "switches the machine on", [](int) { return SetState{State::ON}; }),
    button("machine.off", "switches the machine off", [](int) { return SetState{State::OFF}; }),
    button("estop.activate", "activates the emergency stop", [](int) { return SetState{State::ESTOP}; }),
    button("estop.reset", "resets the emergency stop", [](int) { return SetState{State::ESTOP_RESET}; }),
    button("mode.auto", "auto mode", [](int) { return SetMode{Mode::AUTO}; }),
    button("mode.manual", "manual mode", [](int) { return SetMode{Mode::MANUAL}; }),
    button("mode.mdi", "MDI mode", [](int) { return SetMode{Mode::MDI}; }),
    button("mode.joint", "joint mode: jogs move joints", [](int) { return SetTeleop{false}; }),
    button("mode.teleop", "teleop mode: jogs move axes", [](int) { return SetTeleop{true}; }),
    button("home-all", "homes all joints in their sequence", [](int) { return HomeJoint{-1}; }),
    button("abort", "stops all motion along its path, spindles and coolant", [](int) { return AbortAll{}; }),
    button("program.run", "runs the open program", [](int) { return RunProgram{}; }),
    button("program.step", "runs one block of the open program", [](int) { return StepProgram{}; }),
    button("program.pause", "pauses the program", [](int) { return PauseProgram{}; }),
    button("program.resume", "resumes a paused program", [](int) { return ResumeProgram{}; }),
    button("program.stop", "same as abort", [](int) { return AbortAll{}; }),
    button("program.optional-stop.on", "M1 pauses the program", [](int) { return SetOptionalStop{true}; }),
    button("program.optional-stop.off", "M1 does not pause the program", [](int) { return SetOptionalStop{false}; }),
    button("program.block-delete.on", "skips lines that begin with /", [](int) { return SetBlockDelete{true}; }),
    button("program.block-delete.off", "runs lines that begin with /", [](int) { return SetBlockDelete{false}; }),
    button("flood.on", "flood on", [](int) { return FloodOn{}; }),
    button("flood.off", "flood off", [](int) { return FloodOff{}; }),
    button("mist.on", "mist on", [](int) { return MistOn{}; }),
    button("mist.off", "mist off", [](int) { return MistOff{}; }),
    button("lube.on", "lubrication on", [](int) { return LubeOn{}; }),
    button("lube.off", "lubrication off", [](int) { return LubeOff{}; }));

inline constexpr auto JOINT_BUTTONS = pin_table("halui.joint.#",
    button("home", "homes the joint", [](int joint) { return HomeJoint{joint}; }),
    button("unhome", "marks the joint as not homed", [](int joint) { return UnhomeJoint{joint}; }));

inline constexpr auto SELECTED_BUTTONS = pin_table("halui.joint.selected",
    button("home", "homes the selected joint", [](int joint) { return HomeJoint{joint}; }),
    button("unhome", "marks the selected joint as not homed", [](int joint) { return UnhomeJoint{joint}; }));

inline constexpr auto SPINDLE_BUTTONS = pin_table("halui.spindle.#",
    button("stop", "stops the spindle", [](int spindle) { return SpindleOff{spindle}; }),
    button("brake-on", "engages the spindle brake", [](int spindle) { return EngageBrake{spindle}; }),
    button("brake-off", "releases the spindle brake", [](int spindle) { return ReleaseBrake{spindle}; }));

inline constexpr auto SPINDLE_SPEED = pin_table("halui.spindle.#",
    in<bool>("start", "", "starts the spindle clockwise, at the last speed set by S, else 1 rev/min", [](SpindleInputs &p, bool v) { p.is_start = v; }),
    in<bool>("forward", "", "same as start", [](SpindleInputs &p, bool v) { p.isForward = v; }),
    in<bool>("reverse", "", "starts the spindle counterclockwise", [](SpindleInputs &p, bool v) { p.isReverse = v; }),
    in<bool>("increase", "", "increases the speed of a running spindle by 100 rev/min", [](SpindleInputs &p, bool v) { p.is_increase = v; }),
    in<bool>("decrease", "", "decreases the speed by 100 rev/min, not below 1", [](SpindleInputs &p, bool v) { p.is_decrease = v; }));

inline constexpr auto JOINT_JOGS = pin_table("halui.joint.#",
    in<bool>("select", "", "selects the joint", [](JogInputs &p, bool v) { p.is_select = v; }),
    in<bool>("plus", "", "jogs in the positive direction while TRUE", [](JogInputs &p, bool v) { p.is_plus = v; }),
    in<bool>("minus", "", "jogs in the negative direction while TRUE", [](JogInputs &p, bool v) { p.is_minus = v; }),
    in<double>("increment", "unit", "distance of increment-plus and increment-minus", [](JogInputs &p, double v) { p.increment = v; }),
    in<bool>("increment-plus", "", "jogs by the increment in the positive direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_plus = v; }),
    in<bool>("increment-minus", "", "jogs by the increment in the negative direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_minus = v; }),
    in<double>("analog", "", "jogs at this fraction of the jog speed, -1 to 1, outside the deadband", [](JogInputs &p, double v) { p.analog = v; }));

inline constexpr auto SELECTED_JOINT_JOGS = pin_table("halui.joint.selected",
    in<bool>("plus", "", "jogs in the positive direction while TRUE", [](JogInputs &p, bool v) { p.is_plus = v; }),
    in<bool>("minus", "", "jogs in the negative direction while TRUE", [](JogInputs &p, bool v) { p.is_minus = v; }),
    in<double>("increment", "unit", "distance of increment-plus and increment-minus", [](JogInputs &p, double v) { p.increment = v; }),
    in<bool>("increment-plus", "", "jogs by the increment in the positive direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_plus = v; }),
    in<bool>("increment-minus", "", "jogs by the increment in the negative direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_minus = v; }));

inline constexpr auto AXIS_JOGS = pin_table("halui.axis.@",
    in<bool>("select", "", "selects the axis", [](JogInputs &p, bool v) { p.is_select = v; }),
    in<bool>("plus", "", "jogs in the positive direction while TRUE", [](JogInputs &p, bool v) { p.is_plus = v; }),
    in<bool>("minus", "", "jogs in the negative direction while TRUE", [](JogInputs &p, bool v) { p.is_minus = v; }),
    in<double>("increment", "unit", "distance of increment-plus and increment-minus", [](JogInputs &p, double v) { p.increment = v; }),
    in<bool>("increment-plus", "", "jogs by the increment in the positive direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_plus = v; }),
    in<bool>("increment-minus", "", "jogs by the increment in the negative direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_minus = v; }),
    in<double>("analog", "", "jogs at this fraction of the jog speed, -1 to 1, outside the deadband", [](JogInputs &p, double v) { p.analog = v; }));

inline constexpr auto SELECTED_AXIS_JOGS = pin_table("halui.axis.selected",
    in<bool>("plus", "", "jogs in the positive direction while TRUE", [](JogInputs &p, bool v) { p.is_plus = v; }),
    in<bool>("minus", "", "jogs in the negative direction while TRUE", [](JogInputs &p, bool v) { p.is_minus = v; }),
    in<double>("increment", "unit", "distance of increment-plus and increment-minus", [](JogInputs &p, double v) { p.increment = v; }),
    in<bool>("increment-plus", "", "jogs by the increment in the positive direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_plus = v; }),
    in<bool>("increment-minus", "", "jogs by the increment in the negative direction on a rising edge", [](JogInputs &p, bool v) { p.is_increment_minus = v; }));

inline constexpr auto JOINT_JOG_SETTINGS = pin_table("halui.joint",
    in<double>("jog-speed", "unit/min", "jog speed of joints", [](JogSettings &p, double v) { p.speed_per_min = v; }),
    in<double>("jog-deadband", "", "analog inputs up to this value count as 0", [](JogSettings &p, double v) { p.deadband = v; }, 0.2));

inline constexpr auto AXIS_JOG_SETTINGS = pin_table("halui.axis",
    in<double>("jog-speed", "unit/min", "jog speed of axes", [](JogSettings &p, double v) { p.speed_per_min = v; }),
    in<double>("jog-deadband", "", "analog inputs up to this value count as 0", [](JogSettings &p, double v) { p.deadband = v; }, 0.2));

inline constexpr auto FEED_DIAL = pin_table("halui.feed-override",
    in<bool>("count-enable", "", "counts change the feed override", [](DialInputs &p, bool v) { p.count_enabled = v; }, true),
    in<Count>("counts", "", "counts of a jog wheel or encoder", [](DialInputs &p, Count v) { p.counts = v; }),
    in<double>("scale", "", "change per count, increase or decrease", [](DialInputs &p, double v) { p.scale = v; }, 0.1),
    in<bool>("direct-value", "", "TRUE: the value is counts times scale; FALSE: changes of counts change the value", [](DialInputs &p, bool v) { p.direct = v; }),
    in<bool>("increase", "", "increases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_increase = v; }),
    in<bool>("decrease", "", "decreases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_decrease = v; }),
    in<bool>("reset", "", "sets the value to 1 on a rising edge", [](DialInputs &p, bool v) { p.isReset = v; }),
    out<double>("value", "", "current feed override", [](double value) { return value; }));

inline constexpr auto RAPID_DIAL = pin_table("halui.rapid-override",
    in<bool>("count-enable", "", "counts change the rapid override", [](DialInputs &p, bool v) { p.count_enabled = v; }, true),
    in<Count>("counts", "", "counts of a jog wheel or encoder", [](DialInputs &p, Count v) { p.counts = v; }),
    in<double>("scale", "", "change per count, increase or decrease", [](DialInputs &p, double v) { p.scale = v; }, 0.1),
    in<bool>("direct-value", "", "TRUE: the value is counts times scale; FALSE: changes of counts change the value", [](DialInputs &p, bool v) { p.direct = v; }),
    in<bool>("increase", "", "increases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_increase = v; }),
    in<bool>("decrease", "", "decreases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_decrease = v; }),
    in<bool>("reset", "", "sets the value to 1 on a rising edge", [](DialInputs &p, bool v) { p.isReset = v; }),
    out<double>("value", "", "current rapid override", [](double value) { return value; }));

inline constexpr auto VELOCITY_DIAL = pin_table("halui.max-velocity",
    in<bool>("count-enable", "", "counts change the maximum speed", [](DialInputs &p, bool v) { p.count_enabled = v; }, true),
    in<Count>("counts", "", "counts of a jog wheel or encoder", [](DialInputs &p, Count v) { p.counts = v; }),
    in<double>("scale", "unit/s", "change per count, increase or decrease", [](DialInputs &p, double v) { p.scale = v; }, 0.1),
    in<bool>("direct-value", "", "TRUE: the value is counts times scale; FALSE: changes of counts change the value", [](DialInputs &p, bool v) { p.direct = v; }),
    in<bool>("increase", "", "increases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_increase = v; }),
    in<bool>("decrease", "", "decreases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_decrease = v; }),
    out<double>("value", "unit/s", "current maximum speed", [](double value) { return value; }));

inline constexpr auto SPINDLE_DIAL = pin_table("halui.spindle.#.override",
    in<bool>("count-enable", "", "counts change the override of the spindle", [](DialInputs &p, bool v) { p.count_enabled = v; }, true),
    in<Count>("counts", "", "counts of a jog wheel or encoder", [](DialInputs &p, Count v) { p.counts = v; }),
    in<double>("scale", "", "change per count, increase or decrease", [](DialInputs &p, double v) { p.scale = v; }, 0.1),
    in<bool>("direct-value", "", "TRUE: the value is counts times scale; FALSE: changes of counts change the value", [](DialInputs &p, bool v) { p.direct = v; }),
    in<bool>("increase", "", "increases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_increase = v; }),
    in<bool>("decrease", "", "decreases the value by scale on a rising edge", [](DialInputs &p, bool v) { p.is_decrease = v; }),
    in<bool>("reset", "", "sets the value to 1 on a rising edge", [](DialInputs &p, bool v) { p.isReset = v; }),
    out<double>("value", "", "current spindle override", [](double value) { return value; }));

inline constexpr auto MDI_BUTTONS = pin_table("halui",
    in<bool>("mdi-command-##", "", "runs [HALUI]MDI_COMMAND of this number in MDI mode, then restores the mode", [](MdiInput &p, bool v) { p.isOn = v; }));

inline constexpr auto LAMPS = pin_table("halui",
    out<bool>("machine.is-on", "", "the machine is on", value<"MACHINE">),
    out<bool>("estop.is-activated", "", "emergency stop is active", value<"estop">),
    out<bool>("mode.is-auto", "", "auto mode", [](const Shown &s) { return s.status.task.mode == Mode::AUTO; }),
    out<bool>("mode.is-manual", "", "manual mode", [](const Shown &s) { return s.status.task.mode == Mode::MANUAL; }),
    out<bool>("mode.is-mdi", "", "MDI mode", [](const Shown &s) { return s.status.task.mode == Mode::MDI; }),
    out<bool>("mode.is-joint", "", "joint mode: jogs move joints", [](const Shown &s) { return s.status.trajectory.mode == MotionMode::FREE; }),
    out<bool>("mode.is-teleop", "", "teleop mode: jogs move axes", value<"TELEOP_ENABLE">),
    out<bool>("program.is-idle", "", "no program is running", [](const Shown &s) { return s.status.task.interp_state == InterpState::IDLE; }),
    out<bool>("program.is-running", "", "a program runs and is not paused", [](const Shown &s) { return s.status.task.interp_state != InterpState::IDLE && s.status.task.interp_state != InterpState::PAUSED; }),
    out<bool>("program.is-paused", "", "a program is paused", [](const Shown &s) { return s.status.task.interp_state == InterpState::PAUSED; }),
    out<double>("machine.units-per-mm", "", "[TRAJ]LINEAR_UNITS: 1, or 1/25.4 for inches", [](const Shown &s) { return s.units_per_mm; }),
    out<bool>("program.optional-stop.is-on", "", "M1 pauses the program", value<"optional_stop">),
    out<bool>("program.block-delete.is-on", "", "lines that begin with / are skipped", value<"block_delete">),
    out<bool>("flood.is-on", "", "flood is on", value<"flood">),
    out<bool>("mist.is-on", "", "mist is on", value<"mist">),
    out<bool>("lube.is-on", "", "lubrication is on", value<"lube">),
    out<Index>("tool.number", "", "number of the tool in the spindle; 0: none", value<"tool_in_spindle">),
    out<double>("tool.diameter", "unit", "diameter of the tool in the spindle", [](const Shown &s) { return s.tool_diameter; }),
    out<double>("tool.length_offset.x", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[0]; }),
    out<double>("tool.length_offset.y", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[1]; }),
    out<double>("tool.length_offset.z", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[2]; }),
    out<double>("tool.length_offset.a", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[3]; }),
    out<double>("tool.length_offset.b", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[4]; }),
    out<double>("tool.length_offset.c", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[5]; }),
    out<double>("tool.length_offset.u", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[6]; }),
    out<double>("tool.length_offset.v", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[7]; }),
    out<double>("tool.length_offset.w", "unit", "active tool offset", [](const Shown &s) { return s.status.offsets.tool[8]; }),
    out<Index>("joint.selected", "", "number of the selected joint", [](const Shown &s) { return s.joint; }),
    out<Index>("axis.selected", "", "number of the selected axis: 0 X ... 8 W", [](const Shown &s) { return s.axis; }),
    out<bool>("outcome.is-refused", "", "the last command of these pins was rejected or failed", [](const Shown &s) { return s.isRefused; }),
    out<Index>("outcome.refusals", "", "number of rejected or failed commands since the start", [](const Shown &s) { return s.refusals; }));

inline constexpr auto JOINT_LAMPS = pin_table("halui.joint.#",
    out<bool>("is-homed", "", "the joint is homed", value<"homed">),
    out<bool>("has-fault", "", "the amplifier of the joint reports a fault", value<"fault">),
    out<bool>("override-limits", "", "limits are overridden until the next jog", value<"override_limits">),
    out<bool>("on-hard-min-limit", "", "the lower limit switch is active", value<"min_hard_limit">),
    out<bool>("on-hard-max-limit", "", "the upper limit switch is active", value<"max_hard_limit">),
    out<bool>("on-soft-min-limit", "", "the joint is at its lower soft limit", value<"min_soft_limit">),
    out<bool>("on-soft-max-limit", "", "the joint is at its upper soft limit", value<"max_soft_limit">),
    out<bool>("is-selected", "", "selected", [](const JointShown &s) { return s.selected; }));

inline constexpr auto SELECTED_LAMPS = pin_table("halui.joint.selected",
    out<bool>("is-homed", "", "the joint is homed", value<"homed">),
    out<bool>("has-fault", "", "the amplifier of the joint reports a fault", value<"fault">),
    out<bool>("override-limits", "", "limits are overridden until the next jog", value<"override_limits">),
    out<bool>("on-hard-min-limit", "", "the lower limit switch is active", value<"min_hard_limit">),
    out<bool>("on-hard-max-limit", "", "the upper limit switch is active", value<"max_hard_limit">),
    out<bool>("on-soft-min-limit", "", "the joint is at its lower soft limit", value<"min_soft_limit">),
    out<bool>("on-soft-max-limit", "", "the joint is at its upper soft limit", value<"max_soft_limit">));

inline constexpr auto AXIS_LAMPS = pin_table("halui.axis.@",
    out<bool>("is-selected", "", "selected", [](const AxisShown &s) { return s.selected; }),
    out<double>("pos-commanded", "unit", "commanded position, machine coordinates", [](const AxisShown &s) { return s.commanded; }),
    out<double>("pos-feedback", "unit", "position by feedback, machine coordinates", [](const AxisShown &s) { return s.feedback; }),
    out<double>("pos-relative", "unit", "commanded position, program coordinates", [](const AxisShown &s) { return s.relative; }));

inline constexpr auto SPINDLE_LAMPS = pin_table("halui.spindle.#",
    out<bool>("is-on", "", "the spindle is switched on", value<"enabled">),
    out<bool>("runs-forward", "", "the spindle is on, clockwise", [](const SpindleStatus &s) { return s.isOn && s.direction > 0; }),
    out<bool>("runs-backward", "", "the spindle is on, counterclockwise", [](const SpindleStatus &s) { return s.isOn && s.direction < 0; }),
    out<bool>("brake-is-on", "", "the brake is engaged", value<"brake">));
// clang-format on

/// Calls `show(scope, row)` for every pin.
template <class Show>
void for_each(Show &&show) {
    const auto each = [&show](const auto &...tables) { (sdk::for_each_pin(tables, show), ...); };
    each(BUTTONS, LAMPS, FEED_DIAL, RAPID_DIAL, VELOCITY_DIAL, MDI_BUTTONS);
    each(JOINT_BUTTONS, JOINT_JOG_SETTINGS, JOINT_JOGS, JOINT_LAMPS, SELECTED_BUTTONS, SELECTED_JOINT_JOGS,
         SELECTED_LAMPS);
    each(AXIS_JOG_SETTINGS, AXIS_JOGS, AXIS_LAMPS, SELECTED_AXIS_JOGS);
    each(SPINDLE_BUTTONS, SPINDLE_SPEED, SPINDLE_DIAL, SPINDLE_LAMPS);
}

}  // namespace mw::halui::pins

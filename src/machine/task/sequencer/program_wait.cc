// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/program_wait.hh"

#include <cmath>

#include <fmt/format.h>

#include "base/duration.hh"

namespace mw::task {

void ProgramWait::begin_dwell(double seconds, std::int64_t now_ns) {
    for_ = For::DWELL;
    deadline_ns_ = now_ns + to_ns(seconds);
}

void ProgramWait::begin_input(const gcode::WaitInput &input, std::int64_t now_ns) {
    awaited_input_ = input;
    for_ = For::INPUT;
    deadline_ns_ = now_ns + to_ns(input.timeout_s);
    last_input_ = std::nan("");
    is_input_timed_out_ = false;
}

void ProgramWait::begin_orient(const gcode::WaitOrientComplete &orient, std::int64_t now_ns) {
    for_ = For::ORIENT;
    orient_.spindle = orient.spindle;
    orient_.timeout_s = orient.timeout_s;
    deadline_ns_ = now_ns + to_ns(orient.timeout_s);
    orient_.isTold = false;
}

bool ProgramWait::isOver(std::int64_t now_ns, const UserCodeResult &user_code_result, Result<> &failure) {
    bool ended = true;
    failure = {};
    switch (for_) {
    case For::NONE: break;
    case For::DWELL: ended = now_ns >= deadline_ns_; break;
    case For::INPUT: ended = isInputOver(now_ns); break;
    case For::TOOL: ended = io_.action() == io::ToolAction::IDLE; break;
    case For::TOOL_DATA: {
        const std::optional<Result<>> result = tools_.reload_result();
        ended = result.has_value();
        failure = result.value_or(Result<>{});
        break;
    }
    case For::LOG: {
        const std::optional<Result<>> result = logs_.opened();
        ended = result.has_value();
        failure = result.value_or(Result<>{});
        break;
    }
    case For::ORIENT: ended = isOrientOver(now_ns, failure); break;
    case For::SETTING: ended = motion_.isAnswered(awaited_setting_) && io_.isToolOffsetShown(); break;
    case For::USER_CODE: {
        const std::optional<Result<>> result = user_code_result();
        ended = result.has_value();
        if (ended && !result->has_value()) {
            failure = fail(result->error().str());
        }
        break;
    }
    }
    return ended;
}

bool ProgramWait::isOrientOver(std::int64_t now_ns, Result<> &failure) {
    constexpr int IN_PROGRESS = 1;
    const bool reported = orient_.isTold;
    orient_.isTold = orient_.command == 0 || motion_.isAnswered(orient_.command);
    if (!reported) {  // the status may still belong to an earlier command
        return false;
    }
    const motion::SpindleStatus &spindle =
        motion_.status().spindle[static_cast<std::size_t>(orient_.spindle)];
    if (spindle.orient_fault != 0) {
        failure =
            fail(fmt::format("spindle {} reports orient fault {}", orient_.spindle, spindle.orient_fault));
        return true;
    }
    if (spindle.orient_state == IN_PROGRESS && now_ns >= deadline_ns_) {
        failure =
            fail(fmt::format("spindle {0} is not oriented within {1:g} seconds: pin spindle.{0}.is-oriented",
                             orient_.spindle, orient_.timeout_s));
        return true;
    }
    return spindle.orient_state != IN_PROGRESS;
}

bool ProgramWait::isInputOver(std::int64_t now_ns) {
    const motion::Status &status = motion_.status();
    const auto index = static_cast<std::size_t>(awaited_input_.index);
    const double value = awaited_input_.isAnalog ? status.analog_in[index]
                                                 : static_cast<double>((status.digital_in >> index) & 1U);
    const bool first = std::isnan(last_input_);
    bool met = false;
    switch (awaited_input_.kind) {
    case gcode::WaitKind::IMMEDIATE: met = true; break;
    case gcode::WaitKind::RISE: met = !first && last_input_ == 0 && value != 0; break;
    case gcode::WaitKind::FALL: met = !first && last_input_ != 0 && value == 0; break;
    case gcode::WaitKind::HIGH: met = value != 0; break;
    case gcode::WaitKind::LOW: met = value == 0; break;
    }
    last_input_ = value;
    is_input_timed_out_ = !met && now_ns >= deadline_ns_;
    if (met || is_input_timed_out_) {
        input_value_ = is_input_timed_out_ ? -1.0 : value;
    }
    return met || is_input_timed_out_;
}

double ProgramWait::dwell_left_s(std::int64_t now_ns) const {
    constexpr double NS_PER_S = 1e9;
    const bool dwelling = for_ == For::DWELL && deadline_ns_ > now_ns;
    return dwelling ? static_cast<double>(deadline_ns_ - now_ns) / NS_PER_S : 0.0;
}

ExecState ProgramWait::exec_state(ExecState blocked) const {
    switch (for_) {
    case For::NONE: return blocked;
    case For::DWELL:
    case For::INPUT: return ExecState::WAITING_FOR_DELAY;
    case For::TOOL:
    case For::TOOL_DATA:
    case For::LOG: return ExecState::WAITING_FOR_IO;
    case For::ORIENT: return ExecState::WAITING_FOR_SPINDLE_ORIENTED;
    case For::SETTING: return ExecState::WAITING_FOR_MOTION;
    case For::USER_CODE: return ExecState::WAITING_FOR_SYSTEM_CMD;
    }
    return ExecState::DONE;
}

Waiting ProgramWait::waiting_for() const {
    switch (for_) {
    case For::DWELL: return {WaitFor::DWELL, -1};
    case For::INPUT:
        return {awaited_input_.isAnalog ? WaitFor::ANALOG_INPUT : WaitFor::DIGITAL_INPUT,
                awaited_input_.index};
    case For::TOOL_DATA: return {WaitFor::TOOL_DATA, -1};
    case For::ORIENT: return {WaitFor::SPINDLE_ORIENTED, orient_.spindle};
    case For::SETTING: return {WaitFor::SETTING, -1};
    case For::USER_CODE: return {WaitFor::USER_CODE, -1};
    case For::NONE:
    case For::TOOL:
    case For::LOG: break;
    }
    return {io_.waiting_for(), -1};
}

}  // namespace mw::task

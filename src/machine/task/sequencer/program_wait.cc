// SPDX-License-Identifier: GPL-2.0-or-later
// The waits of the sequencer: dwells, inputs, handshakes.
#include <cmath>

#include <fmt/format.h>

#include "machine/task/sequencer/sequencer.hh"

namespace mw::task {

bool Sequencer::isWaitOver(std::int64_t now_ns) {
    bool ended = true;
    switch (wait_) {
    case Wait::NONE: break;
    case Wait::DWELL: ended = now_ns >= deadline_ns_; break;
    case Wait::INPUT: ended = isInputWaitOver(now_ns); break;
    case Wait::TOOL: ended = io_.action() == io::ToolAction::IDLE; break;
    case Wait::TOOL_DATA: {
        const std::optional<Result<>> result = tools_.reload_result();
        ended = result.has_value();
        check(result.value_or(Result<>{}));
        break;
    }
    case Wait::LOG: {
        const std::optional<Result<>> result = logs_.opened();
        ended = result.has_value();
        check(result.value_or(Result<>{}));
        break;
    }
    case Wait::ORIENT: ended = isOrientWaitOver(now_ns); break;
    case Wait::SETTING: ended = motion_.isAnswered(awaited_setting_) && io_.isToolOffsetShown(); break;
    case Wait::USER_CODE: {
        const std::optional<Result<>> result = events_.user_code_result();
        ended = result.has_value();
        if (ended && !result->has_value()) {
            check(fail(result->error().str()));
        }
        break;
    }
    }
    if (ended) {
        wait_ = Wait::NONE;
    }
    return ended && !failed_;
}

bool Sequencer::isOrientWaitOver(std::int64_t now_ns) {
    constexpr int IN_PROGRESS = 1;
    const bool reported = orient_.isTold;
    orient_.isTold = orient_.command == 0 || motion_.isAnswered(orient_.command);
    if (!reported) {  // the status may still belong to an earlier command
        return false;
    }
    const motion::SpindleStatus &spindle =
        motion_.status().spindle[static_cast<std::size_t>(orient_.spindle)];
    if (spindle.orient_fault != 0) {
        check(fail(fmt::format("spindle {} reports orient fault {}", orient_.spindle, spindle.orient_fault)));
        return true;
    }
    if (spindle.orient_state == IN_PROGRESS && now_ns >= deadline_ns_) {
        check(
            fail(fmt::format("spindle {0} is not oriented within {1:g} seconds: pin spindle.{0}.is-oriented",
                             orient_.spindle, orient_.timeout_s)));
        return true;
    }
    return spindle.orient_state != IN_PROGRESS;
}

bool Sequencer::isInputWaitOver(std::int64_t now_ns) {
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

double Sequencer::dwell_left_s(std::int64_t now_ns) const {
    constexpr double NS_PER_S = 1e9;
    const bool dwelling = wait_ == Wait::DWELL && deadline_ns_ > now_ns;
    return dwelling ? static_cast<double>(deadline_ns_ - now_ns) / NS_PER_S : 0.0;
}

ExecState Sequencer::exec_state() const {
    switch (wait_) {
    case Wait::NONE: return blocked_;
    case Wait::DWELL:
    case Wait::INPUT: return ExecState::WAITING_FOR_DELAY;
    case Wait::TOOL:
    case Wait::TOOL_DATA:
    case Wait::LOG: return ExecState::WAITING_FOR_IO;
    case Wait::ORIENT: return ExecState::WAITING_FOR_SPINDLE_ORIENTED;
    case Wait::SETTING: return ExecState::WAITING_FOR_MOTION;
    case Wait::USER_CODE: return ExecState::WAITING_FOR_SYSTEM_CMD;
    }
    return ExecState::DONE;
}

Waiting Sequencer::waiting_for() const {
    switch (wait_) {
    case Wait::DWELL: return {WaitFor::DWELL, -1};
    case Wait::INPUT:
        return {awaited_input_.isAnalog ? WaitFor::ANALOG_INPUT : WaitFor::DIGITAL_INPUT,
                awaited_input_.index};
    case Wait::TOOL_DATA: return {WaitFor::TOOL_DATA, -1};
    case Wait::ORIENT: return {WaitFor::SPINDLE_ORIENTED, orient_.spindle};
    case Wait::SETTING: return {WaitFor::SETTING, -1};
    case Wait::USER_CODE: return {WaitFor::USER_CODE, -1};
    case Wait::NONE:
    case Wait::TOOL:
    case Wait::LOG: break;
    }
    return {io_.waiting_for(), -1};
}

}  // namespace mw::task

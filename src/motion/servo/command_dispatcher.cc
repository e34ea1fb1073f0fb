// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/command_dispatcher.hh"

#include <algorithm>
#include <cmath>

#include "base/overloaded.hh"
#include "motion/servo/jog_stage.hh"
#include "motion/servo/machine_commands.hh"

namespace mw::motion {
namespace {

/// Epochs are compared across their overflow.
bool isOlder(Epoch epoch, Epoch other) noexcept {
    return static_cast<std::int32_t>(epoch - other) < 0;
}

/// Reverse run ends at a stop, and at a position where the spindle changed direction, stopped or got another
/// tool.
void limit_reverse_run(Retracing &retracing, const CommandBody &body) noexcept {
    const bool isChange =
        std::holds_alternative<SpindleOn>(body) || std::holds_alternative<SpindleOff>(body) ||
        std::holds_alternative<SpindleOrient>(body) || std::holds_alternative<SpindleBrake>(body) ||
        std::holds_alternative<SetToolOffset>(body) || std::holds_alternative<Abort>(body);
    if (isChange && !retracing.isAway()) {
        retracing.clear();
    }
}

CommandResult check(const SetToolOffset &command) noexcept {
    const bool isFinite = std::ranges::all_of(command.offset.c, [](double x) { return std::isfinite(x); });
    return {isFinite ? Reason::NONE : Reason::NOT_A_NUMBER};
}

CommandResult take(ControllerParts &parts, const SetTeleopVector &command, const Inputs &in) noexcept {
    std::array<JogSituation, MAX_AXES> situations;
    for (int i = 0; i < MAX_AXES; ++i) {
        situations[static_cast<std::size_t>(i)] = jog_situation(parts, in, {false, i});
    }
    return parts.jogs.take(command, situations.data());
}

/// Every command must have a handler here; otherwise it does not compile.
[[gnu::cold]] CommandResult dispatch(ControllerParts &parts, SafetyMonitor &safety, const Inputs &in,
                                     const CommandBody &body) noexcept {
    const bool isEnabled = parts.power.isEnabled();
    const Overloaded handlers{
        [&](const OneOf<Abort, SetMode, SetParameter, SetJointActive, Unhome> auto &c) {
            return take(parts, c);
        },
        [&](const OneOf<Enable, SetNumJoints, Home> auto &c) { return take(parts, c, in); },
        [&](const Disable &) {
            parts.switch_off();
            return CommandResult{};
        },
        [&](const OneOf<SetWatchdog, Heartbeat> auto &c) { return safety.take(c); },
        [&](const OneOf<SetAmplifier, LoadCompensation> auto &c) { return parts.joints.take(c, isEnabled); },
        [&](const OneOf<Pause, Resume, StepOnce, SetMaxVelocity> auto &c) { return parts.holds.take(c); },
        [&](const SetReverse &c) {
            const bool isPathRecorded = parts.power.mode() == Mode::COORD && parts.retracing.hasPath();
            return parts.holds.take(c, isPathRecorded);
        },
        [&](const SetScale &c) {
            const double max_feed_scale = parts.model.settings().get(Parameter::MAX_FEED_SCALE);
            return c.what == Scale::SPINDLE ? parts.spindles.take(c) : parts.holds.take(c, max_feed_scale);
        },
        [&](const SetSwitch &c) {
            return c.what == Switch::SPINDLE_OVERRIDE ? parts.spindles.take(c) : parts.holds.take(c);
        },
        [&](const OneOf<JogContinuous, JogIncremental, JogAbsolute> auto &c) {
            return parts.jogs.take(c, jog_situation(parts, in, c.target));
        },
        [&](const OneOf<JogStop, OverrideLimits> auto &c) { return parts.jogs.take(c); },
        [&](const SetTeleopVector &c) { return take(parts, c, in); },
        [&](const OneOf<SpindleOn, SpindleOrient> auto &c) { return parts.spindles.take(c, isEnabled); },
        [&](const OneOf<SpindleOff, SpindleBrake> auto &c) { return parts.spindles.take(c); },
        [&](const OneOf<SetDigitalOutput, SetAnalogOutput> auto &c) { return parts.outputs.take(c); },
        [](const SetToolOffset &c) { return check(c); },  // only limits reverse run
        [&](const ClearProbeFlag &c) { return parts.probe.take(c); },
    };
    return std::visit(handlers, body);
}

}  // namespace

void CommandDispatcher::handle_commands(ControllerParts &parts, SafetyMonitor &safety,
                                        const Inputs &in) noexcept {
    Channels &channels = *parts.channels;
    for (int n = 0; n < MAX_COMMANDS_PER_CYCLE; ++n) {
        // A command is read only if its answer fits into the queue.
        const bool isRoom = channels.servo_answers.size() < channels.servo_answers.capacity();
        const Command *command = isRoom ? channels.immediate.front() : nullptr;
        if (command == nullptr) {
            return;
        }
        const Answer answer = answer_to(*command, parts, safety, in);
        channels.servo_answers.push(answer);
        last_id_ = answer.id;
        channels.immediate.drop();
    }
}

Answer CommandDispatcher::answer_to(const Command &command, ControllerParts &parts, SafetyMonitor &safety,
                                    const Inputs &in) noexcept {
    Answer answer;
    answer.id = command.id;
    const Abort *abort = std::get_if<Abort>(&command.body);
    if (isOlder(command.epoch, epoch_) && abort == nullptr) {
        answer.kind = AnswerKind::STALE;
        return answer;
    }
    if (abort != nullptr && isOlder(epoch_, abort->new_epoch)) {
        epoch_ = abort->new_epoch;
    }
    limit_reverse_run(parts.retracing, command.body);
    const CommandResult result = dispatch(parts, safety, in, command.body);
    answer.kind = result.reason == Reason::NONE ? AnswerKind::DONE : AnswerKind::REFUSED;
    answer.reason = result.reason;
    answer.index = result.index;
    return answer;
}

}  // namespace mw::motion

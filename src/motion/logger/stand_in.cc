// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/logger/stand_in.hh"

#include <optional>

#include "base/overloaded.hh"

namespace mw::motion {
namespace {

void answer(auto &answers, CommandId id, bool isStale, bool isPath) {
    Answer answer;
    answer.id = id;
    answer.kind = isStale ? AnswerKind::STALE : AnswerKind::DONE;
    answer.isPath = isPath;
    answers.push(answer);
}

/// Applies a command to the visible status.
void follow(const CommandBody &body, Status &status) {
    const auto set_homed = [&status](int joint, bool isHomed) {
        for (int j = 0; j < status.num_joints; ++j) {
            if (joint < 0 || joint == j) {
                status.joint[static_cast<std::size_t>(j)].isHomed = isHomed;
            }
        }
        status.isAllHomed = isHomed && joint < 0;
    };
    std::visit(
        Overloaded{
            [&](const Enable &) { status.isEnabled = true; },
            [&](const Disable &) { status.isEnabled = false; },
            [&](const SetMode &c) { status.mode = c.mode; },
            [&](const SetNumJoints &c) { status.num_joints = c.count; },
            [&](const Home &c) { set_homed(c.joint, true); },
            [&](const Unhome &c) { set_homed(c.joint, false); },
            [&](const Pause &) { status.isPaused = true; },
            [&](const Resume &) { status.isPaused = false; },
            [&](const SpindleOn &c) {
                SpindleStatus &spindle = status.spindle[static_cast<std::size_t>(c.spindle)];
                spindle.speed_cmd_rpm = c.speed_rpm;
                spindle.direction = c.speed_rpm < 0 ? -1 : 1;
                spindle.isOn = spindle.isAtSpeed = true;
            },
            [&](const SpindleOff &c) { status.spindle[static_cast<std::size_t>(c.spindle)] = {}; },
            [&](const SetDigitalOutput &c) {
                const std::uint64_t bit = std::uint64_t{1} << c.index;
                status.digital_out = c.isOn ? status.digital_out | bit : status.digital_out & ~bit;
            },
            [&](const SetAnalogOutput &c) { status.analog_out[static_cast<std::size_t>(c.index)] = c.value; },
            // Commands without an entry in the log, and move requests that the logger does not execute.
            [](const OneOf<Abort, SetAmplifier, SetJointActive, OverrideLimits, SetWatchdog, Heartbeat,
                           StepOnce, SetReverse, SetScale, SetSwitch, SetMaxVelocity, JogContinuous,
                           JogIncremental, JogAbsolute, JogStop, SetTeleopVector, SpindleOrient, SpindleBrake,
                           ClearProbeFlag, SetParameter, SetToolOffset, LoadCompensation> auto &) {},
        },
        body);
}

}  // namespace

StandIn::StandIn(Channels &channels, Say say) : channels_(channels), say_(std::move(say)) {
    status_.num_spindles = 1;
    status_.isCartePosValid = true;
    publish(0);
}

void StandIn::take(const Command &command) {
    if (const auto *abort = std::get_if<Abort>(&command.body)) {
        status_.epoch = abort->new_epoch;
        status_.isPaused = false;
    }
    const bool isStale = command.epoch < status_.epoch && !std::holds_alternative<Abort>(command.body);
    if (!isStale) {
        for (const std::string &line : text_.of(command)) {
            say_(line);
        }
        follow(command.body, status_);
    }
    status_.last_immediate_id = command.id;
    answer(channels_.servo_answers, command.id, isStale, false);
}

void StandIn::take(const PathCommand &command) {
    const bool isStale = command.epoch != status_.epoch;
    if (!isStale) {
        for (const std::string &line : text_.of(command)) {
            say_(line);
        }
        status_.carte_pos_cmd = status_.carte_pos_fb = text_.position();
        status_.last_path_id = command.id;
    }
    answer(channels_.planner_answers, command.id, isStale, true);
}

void StandIn::step(std::int64_t time_ns) {
    std::optional<Command> immediate;
    std::optional<PathCommand> path;
    const auto fetch = [](auto &ring, auto &into) {
        typename std::remove_reference_t<decltype(into)>::value_type one;
        if (!into.has_value() && ring.pop(one)) {
            into = one;
        }
        return into.has_value();
    };
    while (true) {
        // A stop is sent after the moves that it cancels, so the path is read first if both wait.
        const bool hasPath = fetch(channels_.path, path), hasCommand = fetch(channels_.immediate, immediate);
        if (hasPath && (!hasCommand || path->id < immediate->id)) {
            take(*path);
            path.reset();
        } else if (hasCommand) {
            take(*immediate);
            immediate.reset();
        } else {
            break;
        }
    }
    publish(time_ns);
}

void StandIn::publish(std::int64_t time_ns) {
    ++status_.cycle;
    status_.time_ns = time_ns;
    for (int j = 0; j < status_.num_joints; ++j) {
        JointStatus &joint = status_.joint[static_cast<std::size_t>(j)];
        joint.isActive = true;
        joint.isEnabled = status_.isEnabled;
        joint.pos_cmd = joint.pos_fb = j < geometry::AXIS_COUNT ? status_.carte_pos_cmd[j] : 0.0;
    }
    channels_.status.write(status_);
}

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Handlers of the operator's commands for joints, axes, spindles and tools (C5).
#include <cmath>

#include <fmt/format.h>

#include "machine/task/task_handler.hh"
#include "motion/interface/screw_file.hh"

namespace mw::task {
namespace {

static_assert(SHORTEST_JOG_LEASE_MS / 1e3 == motion::SHORTEST_JOG_LEASE_S &&
              LONGEST_JOG_LEASE_MS / 1e3 == motion::LONGEST_JOG_LEASE_S);

}  // namespace

using Outcome = Result<Progress>;

Outcome Task::Handler::operator()(const HomeJoint &command) {
    if (task.homing_.isUnderWay()) {
        return task.homing_.wait(command.joint, id);
    }
    if (task.motion_.status().mode == motion::Mode::TELEOP) {
        return fail("must be in joint mode to home", {}, "switch to joint mode first");
    }
    task.motion_.send(motion::SetMode{motion::Mode::FREE});
    task.homing_.begin(command.joint, id, task.motion_.send(motion::Home{command.joint}));
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const UnhomeJoint &command) {
    return order(motion::Unhome{command.joint});
}

Outcome Task::Handler::operator()(const JogContinuous &command) {
    if (command.lease_ms != 0 && command.lease_ms < SHORTEST_JOG_LEASE_MS) {
        return fail(fmt::format("a jog cannot have a lease of {} ms: it is 0 (none) or from {} to {} ms",
                                command.lease_ms, SHORTEST_JOG_LEASE_MS, LONGEST_JOG_LEASE_MS));
    }
    task.mode_.note_jog();
    return order(
        motion::JogContinuous{
            {command.isJoint, command.index}, command.velocity, command.lease_ms / 1e3, command.isRenewal},
        reader_of_refusal(command));
}

Outcome Task::Handler::operator()(const JogIncrement &command) {
    task.mode_.note_jog();
    return order(motion::JogIncremental{
        {command.isJoint, command.index}, std::fabs(command.velocity), command.distance});
}

Outcome Task::Handler::operator()(const JogAbsolute &command) {
    task.mode_.note_jog();
    return order(
        motion::JogAbsolute{{command.isJoint, command.index}, std::fabs(command.velocity), command.position});
}

Outcome Task::Handler::operator()(const JogStop &command) {
    task.desk_.refuse(task.inbox_.drop_jogs_before(id, command), OVERTAKEN);
    task.mode_.note_stop(task.now_ns_);
    return send(motion::JogStop{{command.isJoint, command.index}});
}

/// Done when the file has been read and sent to motion.
Outcome Task::Handler::operator()(const LoadCompensation &command) {
    const auto allowed = Meanwhile{task}.beside([&] { return task.senders_.check_file(command.path); });
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    if (command.joint >= task.settings_.num_joints) {
        return fail(fmt::format("there is no joint {}", command.joint));
    }
    const auto type = static_cast<motion::ScrewFileType>(command.kind);
    const auto points =
        Meanwhile{task}.beside([&] { return motion::read_screw_file(command.path, command.joint, type); });
    if (!points.has_value()) {
        return std::unexpected(points.error());
    }
    task.motion_.send_table(*points);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const SpindleOn &command) {
    const auto allowed = need_spindle(command.spindle);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    task.sequencer_.command_spindle(command.spindle, command.speed_rpm, false);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const LoadToolTable &) {
    if (task.reload_command_ != 0) {
        return fail("the tool table is being read already");
    }
    const auto begun = task.parts_.tools.reload();
    if (!begun.has_value()) {
        return std::unexpected(begun.error());
    }
    task.reload_command_ = id;
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const ConfirmToolChange &) {
    if (!task.parts_.io_port.isPersonAsked()) {
        return fail("no tool change was requested");
    }
    task.parts_.io_port.confirm_tool_change();
    return Progress::DONE;
}

}  // namespace mw::task

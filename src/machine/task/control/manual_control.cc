// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/manual_control.hh"

#include <cmath>

#include <fmt/format.h>

namespace mw::task {

static_assert(SHORTEST_JOG_LEASE_MS / 1e3 == motion::SHORTEST_JOG_LEASE_S &&
              LONGEST_JOG_LEASE_MS / 1e3 == motion::LONGEST_JOG_LEASE_S);

Result<Progress> ManualControl::home(mailbox::Serial command, int joint) {
    if (homing_.isUnderWay()) {
        return homing_.wait(joint, command);
    }
    if (port_.motion().mode == motion::Mode::TELEOP) {
        return fail("must be in joint mode to home", {}, "switch to joint mode first");
    }
    port_.send(motion::SetMode{motion::Mode::FREE});
    homing_.begin(joint, command, port_.send(motion::Home{joint}));
    return Progress::STARTED;
}

Result<Progress> ManualControl::jog(mailbox::Serial command, const JogContinuous &jog) {
    if (jog.lease_ms != 0 && jog.lease_ms < SHORTEST_JOG_LEASE_MS) {
        return fail(fmt::format("a jog cannot have a lease of {} ms: it is 0 (none) or from {} to {} ms",
                                jog.lease_ms, SHORTEST_JOG_LEASE_MS, LONGEST_JOG_LEASE_MS));
    }
    modes_.note_jog();
    return port_.order(
        command,
        motion::JogContinuous{{jog.isJoint, jog.index}, jog.velocity, jog.lease_ms / 1e3, jog.isRenewal},
        reader_of_refusal(jog));
}

Result<Progress> ManualControl::jog(mailbox::Serial command, const JogIncrement &jog) {
    modes_.note_jog();
    return port_.order(
        command, motion::JogIncremental{{jog.isJoint, jog.index}, std::fabs(jog.velocity), jog.distance});
}

Result<Progress> ManualControl::jog(mailbox::Serial command, const JogAbsolute &jog) {
    modes_.note_jog();
    return port_.order(command,
                       motion::JogAbsolute{{jog.isJoint, jog.index}, std::fabs(jog.velocity), jog.position});
}

Result<Progress> ManualControl::stop_jog(const JogStop &jog) {
    modes_.note_stop();
    port_.send(motion::JogStop{{jog.isJoint, jog.index}});
    return Progress::DONE;
}

Result<> ManualControl::check_spindle(int spindle) const {
    return spindle < num_spindles_ ? Result<>{} : fail("there is no spindle " + std::to_string(spindle));
}

Result<Progress> ManualControl::set_spindle(int spindle, double speed_rpm) {
    const auto allowed = check_spindle(spindle);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    sequencer_.command_spindle(spindle, speed_rpm, false);
    return Progress::DONE;
}

Result<Progress> ManualControl::change_spindle_speed(int spindle, double step_rpm) {
    const auto allowed = check_spindle(spindle);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto rpm = sequencer_.spindles().stepped_rpm(spindle, step_rpm);
    return rpm.has_value() ? set_spindle(spindle, *rpm) : std::unexpected(rpm.error());
}

void ManualControl::step() {
    const auto ended = homing_.step(port_.isAnswered(homing_.order()), port_.motion());
    port_.tell(ended);
    const bool failed = ended.has_value() && ended->progress != Progress::DONE;
    if (failed || modes_.state() != State::ON || modes_.mode() != Mode::MANUAL) {
        port_.refuse(homing_.drop(),
                     "the previous joint was not homed, or the machine is no longer in manual mode");
    }
    if (const auto turn = homing_.take_turn()) {
        homing_.begin(turn->joint, turn->command, port_.send(motion::Home{turn->joint}));
    } else if (ended.has_value() && modes_.mode() == Mode::MANUAL && !modes_.isModeChanging() &&
               port_.motion().isAllHomed) {
        port_.send(motion::SetMode{motion::Mode::TELEOP});  // from now on axes can be jogged
    }
}

void ManualControl::refuse(motion::CommandId order, const std::string &reason) {
    if (const auto refused = homing_.refuse(order, reason)) {
        port_.tell(refused);
        port_.refuse(homing_.drop(), "the previous joint was not homed");
    }
}

void ManualControl::abort() {
    port_.tell(homing_.give_up("aborted"));
    port_.refuse(homing_.drop(), OVERTAKEN);
}

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/motion_orders.hh"

#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/rsh/machine_orders.hh"
#include "messages/legacy/units.hh"

namespace mw::rsh {
namespace {

/// Maximum time until a requested homing begins.
constexpr double PATIENCE_S = 2;

Result<int> joint_at(const Ordered &o, std::size_t place) {
    return index_of(word(o, place), "joint", o.settings.num_joints);
}

/// The letter of an axis in teleop mode, else the number of a joint.
Result<JogTarget> target_of(const Ordered &o) {
    const std::string name = word(o, 0);
    if (o.status().trajectory.mode == messages::MotionMode::TELEOP) {
        const int axis = name.size() == 1 ? geometry::axis_of_letter(name[0]) : -1;
        return axis >= 0 ? Result<JogTarget>({false, axis})
                         : fail(fmt::format("Invalid axis '{}', teleop mode has letters", printable(name)));
    }
    const auto joint = parse_int(name);
    // If the machine does not have the joint, LinuxCNC 2.9 lets the machine report it.
    const int count = o.settings.isOld() ? MAX_JOINTS : o.settings.num_joints;
    if (!joint.has_value() || *joint < 0 || *joint >= count) {
        return fail(fmt::format("Invalid joint '{}', valid range [0,{}]", printable(name),
                                o.settings.num_joints - 1));
    }
    return JogTarget{true, static_cast<int>(*joint)};
}

/// True if jogging is not possible now. Clients expect a positive answer, so a message to the operator
/// reports that nothing moves.
bool isNoTimeToJog(const Ordered &o) {
    const messages::TaskStatus &task = o.status().task;
    if (task.mode == messages::Mode::MANUAL || task.isAway) {
        return false;
    }
    static_cast<void>(o.commander.post(messages::OperatorText{"a jog was not made: it needs manual mode"}));
    return true;
}

}  // namespace

Result<Waiting> home(const Ordered &o) {
    const auto joint = joint_at(o, 0);
    return joint.has_value() ? ask(o, messages::HomeJoint{*joint}, Until::TAKEN)
                             : std::unexpected(joint.error());
}

Result<Waiting> unhome(const Ordered &o) {
    const auto joint = joint_at(o, 0);
    return joint.has_value() ? ask(o, messages::UnhomeJoint{*joint}) : std::unexpected(joint.error());
}

Result<Waiting> wait_homed(const Ordered &o) {
    const auto joint = joint_at(o, 0);
    if (!joint.has_value()) {
        return std::unexpected(joint.error());
    }
    Waiting waiting;
    waiting.isOver = [joint = *joint, count = o.settings.num_joints,
                      patience = static_cast<std::uint64_t>(PATIENCE_S / o.settings.task_period_s),
                      settled = std::uint64_t{0}, idle = std::uint64_t{0}](
                         const messages::MachineStatus &status) mutable -> Result<bool> {
        // Cycles after the homing of the last joint until motion has changed its mode.
        constexpr std::uint64_t CYCLES_TO_FOLLOW = 2;
        bool isHomed = true, isHoming = false;
        for (int i = 0; i < count; ++i) {
            if (joint == -1 || joint == i) {
                const messages::JointStatus &one = status.joints[static_cast<std::size_t>(i)];
                isHomed = isHomed && one.isHomed && !one.isHoming;
                isHoming = isHoming || one.isHoming;
            }
        }
        if (isHoming || status.trajectory.isHoming) {
            idle = settled = 0;
            return false;
        }
        if (!isHomed) {
            idle = idle == 0 ? status.cycle + patience : idle;
            return status.cycle < idle ? Result<bool>(false) : fail("nothing is being homed");
        }
        settled = settled == 0 ? status.cycle + CYCLES_TO_FOLLOW : settled;
        return status.cycle >= settled;
    };
    return waiting;
}

Result<Waiting> jog(const Ordered &o) {
    const auto target = target_of(o);
    const auto speed = number(word(o, 1), "speed");
    if (!target.has_value() || !speed.has_value()) {
        return std::unexpected(target.has_value() ? speed.error() : target.error());
    }
    if (isNoTimeToJog(o)) {
        return Waiting{};
    }
    const auto serial = o.commander.jog(*target, legacy::per_second(*speed));
    return serial.has_value() ? Result<Waiting>(Waiting{Until::TAKEN, {*serial}, {}, false})
                              : std::unexpected(serial.error());
}

Result<Waiting> jog_increment(const Ordered &o) {
    const auto target = target_of(o);
    const auto speed = number(word(o, 1), "speed"), distance = number(word(o, 2), "distance");
    if (!target.has_value() || !speed.has_value() || !distance.has_value()) {
        return std::unexpected(!target.has_value()  ? target.error()
                               : !speed.has_value() ? speed.error()
                                                    : distance.error());
    }
    if (isNoTimeToJog(o)) {
        return Waiting{};
    }
    const double velocity = legacy::per_second(*speed);
    return ask(o,
               messages::JogIncrement{target->isJoint, target->index, std::abs(velocity),
                                      velocity < 0 ? -*distance : *distance},
               Until::TAKEN);
}

Result<Waiting> jog_stop(const Ordered &o) {
    const auto target = target_of(o);
    if (!target.has_value()) {
        return std::unexpected(target.error());
    }
    const auto serial = o.commander.stop_jog(*target);
    return serial.has_value() ? Result<Waiting>(Waiting{Until::TAKEN, {*serial}, {}, false})
                              : std::unexpected(serial.error());
}

Result<Waiting> set_teleop(const Ordered &o) {
    const auto isOn = on_or_off(word(o, 0));
    if (!isOn.has_value()) {
        return std::unexpected(isOn.error());
    }
    // Teleop mode exists only in manual mode.
    if (!*isOn && o.status().task.mode != messages::Mode::MANUAL) {
        return Waiting{};
    }
    return ask(o, messages::SetTeleop{*isOn});
}

Result<Waiting> set_feed_override(const Ordered &o) {
    const auto percent = number(word(o, 0), "percentage");
    return percent.has_value() ? ask(o, messages::SetFeedOverride{legacy::factor(*percent)})
                               : std::unexpected(percent.error());
}

Result<Waiting> override_limits(const Ordered &o) {
    const auto isOn = on_or_off(word(o, 0));
    if (!isOn.has_value()) {
        return std::unexpected(isOn.error());
    }
    if (o.status().task.mode != messages::Mode::MANUAL) {
        tell_wrong_mode(o, messages::DECLARATION<messages::OverrideLimits>);
        return o.settings.isOld() ? Result<Waiting>(Waiting{}) : fail("");
    }
    if (*isOn) {
        return ask(o, messages::OverrideLimits{});
    }
    return o.status().joints[0].isOverridingLimits
               ? fail("the override ends by itself with the next jog and cannot be taken back")
               : Result<Waiting>(Waiting{});
}

Result<Waiting> probe(const Ordered &o) {
    std::string line = "G38.2";
    for (std::size_t i = 0; i < 3; ++i) {
        const auto place = number(word(o, i), "coordinate");
        if (!place.has_value()) {
            return std::unexpected(place.error());
        }
        line += fmt::format(" {}{}", geometry::AXIS_LETTERS[i], to_text(*place));
    }
    auto asked = ask(o, messages::Mdi{line});
    if (asked.has_value()) {
        asked->isProbe = true;
    }
    return asked;
}

Result<Waiting> clear_probe(const Ordered &o) {
    return ask(o, messages::ClearProbe{});
}

}  // namespace mw::rsh

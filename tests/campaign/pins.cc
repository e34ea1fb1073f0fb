// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/pins.hh"

#include <fmt/format.h>

#include "base/geometry/pose.hh"

namespace mw::campaign {

std::string MachinePins::bind(hal::Instance &hal, std::size_t num_joints) {
    std::string missing;
    const auto find = [&](const std::string &name, hal::Type type) -> volatile void * {
        const auto address = hal.values().address_of(name, type);
        missing = address ? missing : name;
        return address ? *address : nullptr;
    };
    const auto bit = [&](const std::string &name) {
        return static_cast<volatile bool *>(find(name, hal::Type::BIT));
    };
    const auto number = [&](const std::string &name) {
        return static_cast<volatile double *>(find(name, hal::Type::FLOAT));
    };
    const auto wheel = [&](const std::string &owner) {
        return WheelPins{static_cast<volatile std::int32_t *>(find(owner + "jog-counts", hal::Type::S32)),
                         bit(owner + "jog-enable"), bit(owner + "jog-vel-mode"), number(owner + "jog-scale"),
                         number(owner + "jog-accel-fraction")};
    };
    for (std::size_t j = 0; j < num_joints; ++j) {
        const std::string joint = fmt::format("joint.{}.", j);
        joint_wheels.push_back(wheel(joint));
        joints.push_back(
            {number(joint + "pos-cmd"), number(joint + "pos-fb"), number(joint + "motor-pos-cmd"),
             number(joint + "motor-pos-fb"), bit(joint + "amp-enable-out"), bit(joint + "homed"),
             bit(joint + "homing"), bit(joint + "index-enable"), bit(joint + "home-sw-in"),
             bit(joint + "pos-lim-sw-in"), bit(joint + "neg-lim-sw-in"), bit(joint + "amp-fault-in")});
    }
    for (const char c : std::string(geometry::AXIS_LETTERS_LOWER)) {
        axis_wheels.push_back(wheel(fmt::format("axis.{}.", c)));
        const std::string offset = fmt::format("axis.{}.eoffset", c);
        offsets.push_back({static_cast<volatile std::int32_t *>(find(offset + "-counts", hal::Type::S32)),
                           bit(offset + "-enable"), bit(offset + "-clear"), number(offset + "-scale"),
                           number(offset), number(offset + "-request")});
        axes.push_back(number(fmt::format("axis.{}.pos-cmd", c)));
    }
    is_offset_limited = bit("motion.eoffset-limited");
    input = bit("motion.digital-in-00");
    in_position = bit("motion.in-position");
    is_coord = bit("motion.coord-mode");
    is_teleop = bit("motion.teleop-mode");
    are_all_homed = bit("motion.is-all-homed");
    enable = bit("motion.enable");
    probe = bit("motion.probe-input");
    inhibit = bit("motion.feed-inhibit");
    adaptive_feed = number("motion.adaptive-feed");
    chain = bit("chain");
    user_enable = bit("iocontrol.0.user-enable-out");
    spindle = {bit("spindle.0.on"),           bit("spindle.0.amp-fault-in"), bit("spindle.0.at-speed"),
               number("spindle.0.speed-out"), number("spindle.0.revs"),      number("spindle.0.speed-in")};
    for (const char *name :
         {"motion.digital-out-00", "motion.digital-out-01", "motion.digital-out-02", "motion.digital-out-03",
          "iocontrol.0.coolant-flood", "iocontrol.0.coolant-mist"}) {
        outputs.push_back(bit(name));
    }
    return missing;
}

}  // namespace mw::campaign

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/axis_answers.hh"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "clients/rsh/units.hh"

namespace mw::rsh {
namespace {

/// 2.9 reports so many axes and joints on each machine.
constexpr int OLD_COUNT = 6;

/// "NAME a b c", or "NAME 1 b" of the one that is asked for.
template <class Each>
Answer list(const std::string &name, int count, std::optional<int> one, const char *blank, const Each &each) {
    if (one.has_value()) {
        return std::vector{fmt::format("{} {}{}{}", name, *one, blank, each(*one))};
    }
    std::string text = name;
    for (int i = 0; i < count; ++i) {
        text += ' ' + each(i);
    }
    return std::vector{text};
}

template <class Each>
Answer of_axes(const Asked &asked, const char *name, const Each &each) {
    std::optional<int> one;
    if (!asked.words.empty()) {
        const auto axis = axis_of(asked.words[0]);
        if (!axis.has_value()) {
            return std::unexpected(axis.error());
        }
        one = *axis;
    }
    return list(name, asked.settings.isOld() ? OLD_COUNT : geometry::AXIS_COUNT, one, " ", each);
}

template <class Each>
Answer of_joints(const Asked &asked, const char *name, const char *blank, const Each &each) {
    const bool isOld = asked.settings.isOld();
    std::optional<int> one;
    if (!asked.words.empty()) {
        const auto joint = index_of(asked.words[0], "joint", isOld ? MAX_JOINTS : asked.settings.num_joints);
        if (!joint.has_value()) {
            return std::unexpected(joint.error());
        }
        one = *joint >= 0 ? std::optional(*joint) : std::nullopt;
    }
    return list(name, isOld ? OLD_COUNT : asked.settings.num_joints, one, isOld ? blank : " ", [&](int i) {
        const auto place = static_cast<std::size_t>(i);
        return std::string(each(asked.status.joints[place], asked.status.settings.joints[place]));
    });
}

/// 2.9 tells machine units whatever conversion was set.
double factor(const Asked &asked, bool isAngular) {
    return asked.settings.isOld() ? 1
           : isAngular            ? angle_factor(asked.own, asked.status)
                                  : length_factor(asked.own, asked.status);
}

double factor_of_axis(const Asked &asked, int axis) {
    return factor(asked, geometry::isAngular(axis));
}

Answer pose(const Asked &asked, const char *name, const geometry::Pose &pose) {
    return of_axes(asked, name,
                   [&](int axis) { return fmt::format("{:f}", pose[axis] * factor_of_axis(asked, axis)); });
}

/// Of the program: without the offsets that are in force.
geometry::Pose relative(const Asked &asked, const geometry::Pose &absolute) {
    const messages::OffsetsStatus &offsets = asked.status.offsets;
    geometry::Pose pose = absolute - offsets.g5x - offsets.tool;
    const double angle = -offsets.rotation_xy_deg * std::numbers::pi / 180;
    const double x = pose.x(), y = pose.y();
    pose[geometry::AXIS_X] = x * std::cos(angle) - y * std::sin(angle);
    pose[geometry::AXIS_Y] = x * std::sin(angle) + y * std::cos(angle);
    return pose - offsets.g92;
}

double factor_of_joint(const Asked &asked, const messages::JointSettings &set) {
    return factor(asked, set.kind == messages::JointKind::ANGULAR);
}

}  // namespace

Answer absolute_actual(const Asked &asked) {
    return pose(asked, "ABS_ACT_POS", asked.status.trajectory.position_fb);
}
Answer absolute_commanded(const Asked &asked) {
    return pose(asked, "ABS_CMD_POS", asked.status.trajectory.position_cmd);
}
Answer relative_actual(const Asked &asked) {
    return pose(asked, "REL_ACT_POS", relative(asked, asked.status.trajectory.position_fb));
}
Answer relative_commanded(const Asked &asked) {
    return pose(asked, "REL_CMD_POS", relative(asked, asked.status.trajectory.position_cmd));
}

Answer axis_velocity(const Asked &asked) {
    return of_axes(asked, "AXIS_VELOCITY", [&](int axis) {
        const double velocity = asked.status.axes[static_cast<std::size_t>(axis)].velocity;
        return fmt::format("{:f}", velocity * factor_of_axis(asked, axis));
    });
}

Answer position_offset(const Asked &asked) {
    const geometry::Pose offset = asked.status.offsets.g5x + asked.status.offsets.g92;
    if (asked.words.empty()) {
        return pose(asked, "POS_OFFSET", offset);
    }
    // R, P and W as the manual has them: roll, pitch, yaw, where there are no U, V and W.
    const std::string &word = asked.words[0];
    const int axis = word == "R" || word == "r"   ? geometry::AXIS_A
                     : word == "P" || word == "p" ? geometry::AXIS_B
                     : word.size() == 1           ? geometry::axis_of_letter(word[0])
                                                  : -1;
    if (axis < 0) {
        return no_such_value(word, "X Y Z A B C U V W R P");
    }
    return std::vector{fmt::format("POS_OFFSET {}{}{:f}", geometry::AXIS_LETTERS[axis],
                                   asked.settings.isOld() ? "  " : " ",
                                   offset[axis] * factor_of_axis(asked, axis))};
}

Answer joint_fault(const Asked &asked) {
    return of_joints(asked, "JOINT_FAULT", " ", [](const messages::JointStatus &joint, const auto &) {
        return joint.isFaulted || joint.isFerrorTripped ? "FAULT" : "OK";
    });
}

Answer joint_homed(const Asked &asked) {
    return of_joints(asked, "JOINT_HOMED", " ", [](const messages::JointStatus &joint, const auto &) {
        return joint.isHomed ? "YES" : "NO";
    });
}

Answer joint_limit(const Asked &asked) {
    return of_joints(asked, "JOINT_LIMIT", " ", [](const messages::JointStatus &joint, const auto &) {
        return joint.isOnNegHardLimit   ? "MINHARD"
               : joint.isOnNegSoftLimit ? "MINSOFT"
               : joint.isOnPosSoftLimit ? "MAXSOFT"
               : joint.isOnPosHardLimit ? "MAXHARD"
                                        : "OK";
    });
}

Answer joint_position(const Asked &asked) {
    return of_joints(asked, "JOINT_POS", " ",
                     [&](const messages::JointStatus &joint, const messages::JointSettings &set) {
                         return fmt::format("{:f}", joint.pos_fb * factor_of_joint(asked, set));
                     });
}

Answer joint_type(const Asked &asked) {
    return of_joints(asked, "JOINT_TYPE", "  ", [](const auto &, const messages::JointSettings &set) {
        return set.kind == messages::JointKind::ANGULAR ? "ANGULAR" : "LINEAR";
    });
}

Answer joint_units(const Asked &asked) {
    return of_joints(asked, "JOINT_UNITS", "  ",
                     [](const messages::JointStatus &joint, const messages::JointSettings &set) {
                         const double units = joint.isPresent ? set.units : 1.0;
                         return set.kind == messages::JointKind::ANGULAR ? name_of_angle(units)
                                                                         : name_of_length(units);
                     });
}

Answer joint_velocity(const Asked &asked) {
    return of_joints(asked, "JOINT_VELOCITY", " ",
                     [&](const messages::JointStatus &joint, const messages::JointSettings &set) {
                         return fmt::format("{:f}", joint.vel_cmd * factor_of_joint(asked, set));
                     });
}

}  // namespace mw::rsh

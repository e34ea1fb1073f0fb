// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/axis_answers.hh"

#include <utility>

#include <fmt/format.h>

#include "clients/rsh/units.hh"

namespace mw::rsh {
namespace {

/// LinuxCNC 2.9 reports this number of axes and joints for each machine.
constexpr int OLD_COUNT = 6;

/// "NAME a b c", or "NAME 1 b" for the requested one.
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
        return each(legacy::Joint{asked.status.joints[place], asked.status.settings.joints[place]});
    });
}

/// LinuxCNC 2.9 always reports machine units, also if the client has selected other units.
double factor(const Asked &asked, bool isAngular) {
    return asked.settings.isOld() ? 1
           : isAngular            ? angle_factor(asked.own.angle_unit, asked.status)
                                  : length_factor(asked.own.length_unit, asked.status);
}

double factor_of_axis(const Asked &asked, int axis) {
    return factor(asked, geometry::isAngular(axis));
}

/// Answers from a row of the joint table.
template <std::size_t I>
Answer joint_answer(const Asked &asked) {
    using legacy::Form;
    constexpr const auto &ROW = std::get<I>(legacy::JOINT_STATUS);
    const char *const blank = ROW.form == Form::TYPE ? "  " : " ";
    return of_joints(asked, ROW.names.rsh, blank, [&](const legacy::Joint &joint) {
        if constexpr (ROW.form == Form::LENGTH) {
            return fmt::format("{:f}", ROW.get(joint) * factor(asked, joint.isAngular()));
        } else {
            return legacy::text(ROW.form, dialect(asked), ROW.get(joint));
        }
    });
}

constexpr auto JOINT_ANSWERS =
    legacy::from_rows<legacy::JOINT_STATUS, &legacy::Names::rsh>([]<std::size_t I>() {
        return NamedAnswer{std::get<I>(legacy::JOINT_STATUS).names.rsh, joint_answer<I>};
    });

}  // namespace

Answer pose(const Asked &asked, const char *name, const geometry::Pose &pose) {
    return of_axes(asked, name,
                   [&](int axis) { return fmt::format("{:f}", pose[axis] * factor_of_axis(asked, axis)); });
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
    // R, P and W as in the manual: roll, pitch, yaw, if there are no U, V and W.
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

Answer joint_velocity(const Asked &asked) {
    return of_joints(asked, "JOINT_VELOCITY", " ", [&](const legacy::Joint &joint) {
        return fmt::format("{:f}", joint.now.vel_cmd * factor(asked, joint.isAngular()));
    });
}

std::span<const NamedAnswer> joint_answers() {
    return JOINT_ANSWERS;
}

}  // namespace mw::rsh

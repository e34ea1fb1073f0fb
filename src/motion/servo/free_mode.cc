// SPDX-License-Identifier: GPL-2.0-or-later
// Free mode: each joint follows its own jog or homing move.
#include "motion/servo/motion_mode.hh"
#include "motion/servo/probe_stage.hh"

namespace mw::motion {

CommandResult FreeMode::enter(ControllerParts &parts) const noexcept {
    parts.alignment.cancel();
    return {};
}

void FreeMode::step(ControllerParts &parts, const Inputs &in) const noexcept {
    check_probe(parts, in);
    parts.executor.step(parts.cycle);
    const FoldedLimits &limits = parts.model.limits();
    const double period_s = parts.model.period_s();
    const std::uint32_t locked = parts.indexers.held();
    for (int j = 0; j < parts.model.num_joints(); ++j) {
        const auto n = static_cast<std::size_t>(j);
        if (parts.extra.isCommanding(j)) {
            continue;
        }
        Jog &jog = parts.jogs.at({true, j});
        if ((locked & 1U << j) == 0) {
            jog.step_joint(limits.joints.velocity[n], parts.holds.jog_scale(), period_s);
        }
        parts.joints.follow(j, jog.motion().position, period_s);
    }
    parts.offsets.step({in.axis_offset, limits, {}, false, period_s});
    const kinematics::Kinematics &kinematics = parts.model.kinematics();
    const bool isKnown = kinematics.kind() == kinematics::Kind::BOTH && parts.homing.isAllHomed();
    parts.position.follow_joints(kinematics, parts.joints.commanded().data(), isKnown);
}

bool FreeMode::isJogging(const ControllerParts &parts) const noexcept {
    return !parts.jogs.areJointsAtRest();
}

JogGroup FreeMode::jog_group(const ControllerParts &parts) const noexcept {
    return {true, parts.model.num_joints()};
}

std::uint32_t FreeMode::locks_wanted(const ControllerParts &parts) const noexcept {
    std::uint32_t wanted = 0;
    for (int j = 0; j < parts.model.num_joints(); ++j) {
        wanted |= parts.jogs.at({true, j}).isAtRest() ? 0U : 1U << j;
    }
    return wanted;
}

}  // namespace mw::motion

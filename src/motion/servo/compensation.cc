// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/compensation.hh"

#include <bit>

namespace mw::motion {

ExtraJointInputs extra_inputs(const ControllerParts &parts, const Inputs &in) noexcept {
    const FoldedLimits &limits = parts.model.limits();
    return {in.joint, parts.joints.commanded(), limits, limits.homed.joints & ~parts.joints.inactive(),
            parts.model.period_s()};
}

void command_extra_joints(ControllerParts &parts, const Inputs &in) noexcept {
    const ExtraJointEvents events = parts.extra.step(extra_inputs(parts, in));
    for (int j = parts.extra.first(); j < parts.model.num_joints(); ++j) {
        if (parts.extra.isCommanding(j)) {
            parts.joints.follow(j, parts.extra.position(j), parts.model.period_s());
            parts.jogs.at({true, j}).reset(parts.extra.position(j));
        }
    }
    for (std::uint32_t beyond = events.beyond; beyond != 0; beyond &= beyond - 1) {
        const int j = std::countr_zero(beyond);
        parts.raise(FaultKind::EXTRA_JOINT_LIMIT, j, in.joint[static_cast<std::size_t>(j)].posthome_cmd);
    }
    if (events.lost != 0) {
        parts.stop_category_1(FaultKind::EXTRA_JOINT_LOST, std::countr_zero(events.lost));
    }
}

void command_motors(ControllerParts &parts) noexcept {
    const bool isEnabled = parts.power.isEnabled();
    for (std::uint32_t off = parts.joints.output(parts.model.settings(), isEnabled, parts.model.period_s());
         off != 0; off &= off - 1) {
        const int j = std::countr_zero(off);
        parts.jogs.at({true, j}).reset(parts.joints[j].pos_fb);
    }
    if (isEnabled) [[likely]] {
        return;
    }
    parts.position.follow_joints(parts.model.kinematics(), parts.joints.commanded().data(),
                                 parts.position.isFbValid());
    const geometry::Pose pose = parts.programmed_pose();
    parts.executor.set_position(pose);
    parts.jogs.reset_axes(pose);
}

void command_spindles(ControllerParts &parts, const Inputs &in) noexcept {
    const trajectory::Executor &executor = parts.executor;
    const trajectory::TapDemand &tap = executor.output().tap;
    SpindleCycle cycle{
        parts.position.cmd()[geometry::AXIS_X], {tap.spindle, tap.factor}, parts.model.period_s()};
    for (int n = 0; n < parts.model.num_spindles(); ++n) {
        const trajectory::SpindleTrack &track = executor.spindle(n).track;
        cycle.counted[static_cast<std::size_t>(n)] = {track.turns_per_s(), track.step()};
    }
    for (std::uint32_t failed = parts.spindles.step(in, parts.model.settings(), cycle); failed != 0;
         failed &= failed - 1) {
        const int n = std::countr_zero(failed);
        parts.raise(FaultKind::SPINDLE_FAULT, n, parts.spindles[n].orient_fault);
    }
}

}  // namespace mw::motion

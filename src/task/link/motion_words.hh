// SPDX-License-Identifier: GPL-2.0-or-later
// Operators' commands that motion carries out by itself, in its words. What each needs motion decides.
#pragma once

#include "motion/api/command.hh"
#include "msgs/command.hh"

namespace mw::task {

inline motion::CommandBody in_motion_words(const msgs::SetFeedOverride &c) {
    return motion::SetScale{motion::Scale::FEED, 0, c.factor};
}
inline motion::CommandBody in_motion_words(const msgs::SetRapidOverride &c) {
    return motion::SetScale{motion::Scale::RAPID, 0, c.factor};
}
inline motion::CommandBody in_motion_words(const msgs::SetSpindleOverride &c) {
    return motion::SetScale{motion::Scale::SPINDLE, c.spindle, c.factor};
}
inline motion::CommandBody in_motion_words(const msgs::SetMaxVelocity &c) {
    return motion::SetMaxVelocity{c.velocity};
}
inline motion::CommandBody in_motion_words(const msgs::EnableFeedOverride &c) {
    return motion::SetSwitch{motion::Switch::FEED_OVERRIDE, 0, c.isOn};
}
inline motion::CommandBody in_motion_words(const msgs::EnableSpindleOverride &c) {
    return motion::SetSwitch{motion::Switch::SPINDLE_OVERRIDE, c.spindle, c.isOn};
}
inline motion::CommandBody in_motion_words(const msgs::EnableFeedHold &c) {
    return motion::SetSwitch{motion::Switch::FEED_HOLD, 0, c.isOn};
}
inline motion::CommandBody in_motion_words(const msgs::EnableAdaptiveFeed &c) {
    return motion::SetSwitch{motion::Switch::ADAPTIVE_FEED, 0, c.isOn};
}
inline motion::CommandBody in_motion_words(const msgs::OverrideLimits &) {
    return motion::OverrideLimits{true};
}
inline motion::CommandBody in_motion_words(const msgs::EnableJoint &c) {
    return motion::SetAmplifier{c.joint, true};
}
inline motion::CommandBody in_motion_words(const msgs::DisableJoint &c) {
    return motion::SetAmplifier{c.joint, false};
}
inline motion::CommandBody in_motion_words(const msgs::ActivateJoint &c) {
    return motion::SetJointActive{c.joint, true};
}
inline motion::CommandBody in_motion_words(const msgs::DeactivateJoint &c) {
    return motion::SetJointActive{c.joint, false};
}
inline motion::CommandBody in_motion_words(const msgs::ClearProbe &) {
    return motion::ClearProbeFlag{};
}
inline motion::CommandBody in_motion_words(const msgs::SetDigitalOutput &c) {
    return motion::SetDigitalOutput{c.index, c.isOn};
}
inline motion::CommandBody in_motion_words(const msgs::SetAnalogOutput &c) {
    return motion::SetAnalogOutput{c.index, c.value};
}
inline motion::CommandBody in_motion_words(const msgs::EngageBrake &c) {
    return motion::SpindleBrake{c.spindle, true};
}
inline motion::CommandBody in_motion_words(const msgs::ReleaseBrake &c) {
    return motion::SpindleBrake{c.spindle, false};
}

}  // namespace mw::task

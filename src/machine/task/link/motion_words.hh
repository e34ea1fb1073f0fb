// SPDX-License-Identifier: GPL-2.0-or-later
// Converts operators' commands that motion executes by itself to motion commands. Motion decides whether each
// one is possible.
#pragma once

#include "messages/declarations/command.hh"
#include "motion/interface/command.hh"

namespace mw::task {

inline motion::CommandBody in_motion_words(const messages::SetFeedOverride &c) {
    return motion::SetScale{motion::Scale::FEED, 0, c.factor};
}
inline motion::CommandBody in_motion_words(const messages::SetRapidOverride &c) {
    return motion::SetScale{motion::Scale::RAPID, 0, c.factor};
}
inline motion::CommandBody in_motion_words(const messages::SetSpindleOverride &c) {
    return motion::SetScale{motion::Scale::SPINDLE, c.spindle, c.factor};
}
inline motion::CommandBody in_motion_words(const messages::UnhomeJoint &c) {
    return motion::Unhome{c.joint};
}
inline motion::CommandBody in_motion_words(const messages::SetTeleopVector &c) {
    return motion::SetTeleopVector{c.velocity};
}
inline motion::CommandBody in_motion_words(const messages::ReverseProgram &) {
    return motion::SetReverse{true};
}
inline motion::CommandBody in_motion_words(const messages::ForwardProgram &) {
    return motion::SetReverse{false};
}
inline motion::CommandBody in_motion_words(const messages::SetMaxVelocity &c) {
    return motion::SetMaxVelocity{c.velocity};
}
inline motion::CommandBody in_motion_words(const messages::EnableFeedOverride &c) {
    return motion::SetSwitch{motion::Switch::FEED_OVERRIDE, 0, c.isOn};
}
inline motion::CommandBody in_motion_words(const messages::EnableSpindleOverride &c) {
    return motion::SetSwitch{motion::Switch::SPINDLE_OVERRIDE, c.spindle, c.isOn};
}
inline motion::CommandBody in_motion_words(const messages::EnableFeedHold &c) {
    return motion::SetSwitch{motion::Switch::FEED_HOLD, 0, c.isOn};
}
inline motion::CommandBody in_motion_words(const messages::EnableAdaptiveFeed &c) {
    return motion::SetSwitch{motion::Switch::ADAPTIVE_FEED, 0, c.isOn};
}
inline motion::CommandBody in_motion_words(const messages::OverrideLimits &) {
    return motion::OverrideLimits{true};
}
inline motion::CommandBody in_motion_words(const messages::EnableJoint &c) {
    return motion::SetAmplifier{c.joint, true};
}
inline motion::CommandBody in_motion_words(const messages::DisableJoint &c) {
    return motion::SetAmplifier{c.joint, false};
}
inline motion::CommandBody in_motion_words(const messages::ActivateJoint &c) {
    return motion::SetJointActive{c.joint, true};
}
inline motion::CommandBody in_motion_words(const messages::DeactivateJoint &c) {
    return motion::SetJointActive{c.joint, false};
}
inline motion::CommandBody in_motion_words(const messages::ClearProbe &) {
    return motion::ClearProbeFlag{};
}
inline motion::CommandBody in_motion_words(const messages::SetDigitalOutput &c) {
    return motion::SetDigitalOutput{c.index, c.isOn};
}
inline motion::CommandBody in_motion_words(const messages::SetAnalogOutput &c) {
    return motion::SetAnalogOutput{c.index, c.value};
}
inline motion::CommandBody in_motion_words(const messages::EngageBrake &c) {
    return motion::SpindleBrake{c.spindle, true};
}
inline motion::CommandBody in_motion_words(const messages::ReleaseBrake &c) {
    return motion::SpindleBrake{c.spindle, false};
}

}  // namespace mw::task

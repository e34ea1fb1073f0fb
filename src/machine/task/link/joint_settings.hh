// SPDX-License-Identifier: GPL-2.0-or-later
// Clients' commands that change the settings of a joint while the machine runs.
#pragma once

#include <vector>

#include "base/result.hh"
#include "messages/declarations/command.hh"
#include "motion/interface/settings.hh"

namespace mw::task {

std::vector<motion::SetParameter> joint_settings(const messages::SetJointMinLimit &c);
std::vector<motion::SetParameter> joint_settings(const messages::SetJointMaxLimit &c);
std::vector<motion::SetParameter> joint_settings(const messages::SetJointFerror &c);
std::vector<motion::SetParameter> joint_settings(const messages::SetJointMinFerror &c);
std::vector<motion::SetParameter> joint_settings(const messages::SetJointBacklash &c);
std::vector<motion::SetParameter> joint_settings(const messages::SetJointHoming &c);

struct JointsNow {
    int count = 0;
    bool homing = false;
};

/// Checks whether motion accepts all of `changes` and the limits of each joint leave a range. Called before
/// the first change is sent, so that a command changes all of its settings or none.
Result<> check_settings(const std::vector<motion::SetParameter> &changes, const motion::Settings &current,
                        const JointsNow &joints);

}  // namespace mw::task

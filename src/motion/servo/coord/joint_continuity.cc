// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/coord/joint_continuity.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

bool isWithinOneStep(const kinematics::Kinematics &kinematics, const geometry::Pose &pose,
                     const JointValues &here, const JointStepLimit &stride) noexcept {
    constexpr double ROUNDING = 1e-4;  // of models that iterate [machine units, degrees]
    JointValues led = here;
    bool isKnown = isAnswered(kinematics.inverse(pose, led.data()));
    for (int j = 0; j < stride.num_joints && isKnown; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const double most = std::max(stride.velocity[j] * stride.period_s, ROUNDING);
        isKnown = std::abs(led[n] - here[n]) <= most;
    }
    return isKnown;
}

int joint_that_jumps(const JointValues &positions, const JointValues &here,
                     const JointStepLimit &stride) noexcept {
    constexpr double MARGIN = 2;
    constexpr double ROUNDING = 1e-3;  // of models that iterate [machine units, degrees]
    for (int j = 0; j < stride.num_joints; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const double most = MARGIN * stride.velocity[j] * stride.period_s + ROUNDING;
        if (!(std::abs(positions[n] - here[n]) <= most)) {
            return j;
        }
    }
    return -1;
}

bool hasDropped(JointStart &standing, const trajectory::Snapshot &now) noexcept {
    if (now.drops == standing.drops || now.isDropping) {
        return false;
    }
    standing.drops = now.drops;
    return true;
}

}  // namespace mw::motion

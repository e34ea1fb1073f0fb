// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/coord/joint_continuity.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

bool isWithinOneStep(const kinematics::Kinematics &kinematics, const geometry::Pose &pose,
                     const JointValues &here, const JointStepLimit &limit) noexcept {
    constexpr double ROUNDING = 1e-4;  // of models that iterate [machine units, degrees]
    JointValues positions = here;
    bool isKnown = isAnswered(kinematics.inverse(pose, positions.data()));
    for (int j = 0; j < limit.num_joints && isKnown; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const double most = std::max(limit.velocity[j] * limit.period_s, ROUNDING);
        isKnown = std::abs(positions[n] - here[n]) <= most;
    }
    return isKnown;
}

int joint_that_jumps(const JointValues &positions, const JointValues &here,
                     const JointStepLimit &limit) noexcept {
    constexpr double MARGIN = 2;
    constexpr double ROUNDING = 1e-3;  // of models that iterate [machine units, degrees]
    for (int j = 0; j < limit.num_joints; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const double most = MARGIN * limit.velocity[j] * limit.period_s + ROUNDING;
        if (!(std::abs(positions[n] - here[n]) <= most)) {
            return j;
        }
    }
    return -1;
}

bool JointStart::hasDropped(const trajectory::Snapshot &now) noexcept {
    if (now.drops == drops_ || now.isDropping) {
        return false;
    }
    drops_ = now.drops;
    return true;
}

}  // namespace mw::motion

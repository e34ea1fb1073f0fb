// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/indexer_stage.hh"

#include "motion/servo/motion_mode.hh"

namespace mw::motion {

void step_indexers(ControllerParts &parts, const Inputs &in) noexcept {
    const HomingDrive &homing = parts.homing;
    IndexerInputs now;
    now.period_s = parts.model.period_s();
    now.unlocked = unlocked_pins(in);
    now.wanted = motion_mode(parts.power.mode()).locks_wanted(parts);
    for (int j = 0; j < parts.model.num_joints(); ++j) {
        const bool isHoming = homing.isHoming(j) || homing.isUnlockWanted(j);
        now.homing |= isHoming ? 1U << j : 0U;
        now.moving |= parts.joints[j].vel_cmd != 0.0 ? 1U << j : 0U;
    }
    const IndexerEvent event = parts.indexers.step(now);
    switch (event.fault) {
    case LockFault::NONE: return;
    case LockFault::LOCKED_IN_MOVE:
        parts.stop_category_0(FaultKind::INDEXER_LOCKED_IN_MOVE, event.joint);
        return;
    case LockFault::NOT_LOCKED: parts.raise(FaultKind::INDEXER_NOT_LOCKED, event.joint); break;
    case LockFault::NOT_UNLOCKED: parts.raise(FaultKind::INDEXER_NOT_UNLOCKED, event.joint); break;
    }
    parts.executor.drop();
    parts.jogs.stop();
    parts.coord_error = true;
}

}  // namespace mw::motion

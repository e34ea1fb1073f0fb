// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/probe_stage.hh"

#include "motion/servo/motion_mode.hh"

namespace mw::motion {

void check_probe(ControllerParts &parts, const Inputs &in) noexcept {
    trajectory::Executor &executor = parts.executor;
    const bool isOnPath = parts.power.mode() == Mode::COORD;
    const trajectory::ExecutorOutput &path = executor.output();
    const bool isProbing = isOnPath && path.isOnProbe && path.isMoving;
    ProbeInputs probe;
    probe.isClosed = in.isProbeClosed;
    if (isProbing) [[unlikely]] {
        probe.probing_move = path.move;
        probe.isAway = parts.link->store.move(path.move).isProbeAway;
    } else if (in.isProbeClosed && !parts.probe.wasClosed()) [[unlikely]] {
        const Parameter ignored = parts.homing.isActive() ? Parameter::TRAJ_NO_PROBE_HOME_ERROR
                                                          : Parameter::TRAJ_NO_PROBE_JOG_ERROR;
        const bool isIgnored = !isOnPath && parts.model.settings().isSet(ignored);
        probe.isMoving = !isIgnored && !parts.power.isStopping() && isAnythingMoving(parts);
        probe.isDropping = executor.snapshot().isDropping;
    }
    switch (parts.probe.step(probe, parts.offsets.remove_from(parts.position.fb()))) {
    case ProbeEvent::NONE: break;
    case ProbeEvent::FOUND: executor.drop(); break;
    case ProbeEvent::TOUCHED:
        parts.raise(FaultKind::PROBE_TRIPPED_IN_MOVE, -1, 0, isOnPath ? 0 : 1);
        parts.homing.abort(homing::event::ABORT);
        executor.drop();
        parts.jogs.stop();
        parts.coord_error = true;
        break;
    }
}

}  // namespace mw::motion

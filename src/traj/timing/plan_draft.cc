// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/timing/plan_draft.hh"

namespace mw::traj {

void PlanDraft::append(PathStore &store, double length, double v1) noexcept {
    const double sum = at.v + v1;
    if (length > 0 && sum > 0) {
        const double dt = 2.0 * length / sum;
        store.phase(end) = {at.piece, dt, at.x, at.v, (v1 - at.v) / dt, 0};
        ++end;
        seconds += dt;
        at.x += length;
        at.coasting.pass(v1 - at.v, dt);
    }
    at.v = v1;
}

void PlanDraft::wait(PathStore &store, double duration) noexcept {
    store.phase(end++) = {at.piece, duration, at.x, 0, 0, 0};
    seconds += duration;
    at.coasting.pass(0, duration);
}

bool PlanDraft::isStopPassed(const PlannedPath &path, Sequence begin) const noexcept {
    for (Sequence n = begin; n < end; ++n) {
        const Phase &p = path.store().phase(n);
        if (p.x0 <= 0 && p.v0 > 0 && path.plan(p.piece).isStopBefore) {
            return true;
        }
    }
    return false;
}

}  // namespace mw::traj

// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/plan_draft.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory {

int PlanDraft::choose(const TimingView &view, double cap, double out2, std::span<ChosenPhase> out) noexcept {
    const Piece &p = view.path().piece(at.piece);
    SpeedStretch stretch;
    stretch.length = p.length - at.x;
    stretch.speed = at.v;
    stretch.cap = cap;
    stretch.out = std::min(cap, std::sqrt(out2));
    stretch.at_rest = p.acceleration.at(0);
    stretch.at_cap = p.acceleration.at(cap * cap);
    stretch.line = view.path().store().move(p.move).line;
    stretch.isEnd = at.piece == view.path().last_piece();
    const int count = view.on.conditions.chooser->choose(stretch, out);
    const bool isFit = count > 0 && count <= static_cast<int>(out.size());
    overreach =
        check_choice(stretch, p.acceleration, out.first(isFit ? static_cast<std::size_t>(count) : 0U));
    overreach.move = p.move;
    if (overreach.kind != Overreach::Kind::NONE) {
        return 0;
    }
    ChosenPhase &last = out[static_cast<std::size_t>(count - 1)];
    last.speed = std::min(last.speed, stretch.out);
    return count;
}

void PlanDraft::append(PathStore &store, double length, double v1) noexcept {
    const double sum = at.v + v1;
    if (length > 0 && sum > 0) {
        const double dt = 2.0 * length / sum;
        store.phase(end) = {at.piece, dt, at.x, at.v, (v1 - at.v) / dt, 0};
        ++end;
        seconds += dt;
        at.x += length;
    }
    at.v = v1;
}

void PlanDraft::wait(PathStore &store, double duration) noexcept {
    store.phase(end++) = {at.piece, duration, at.x, 0, 0, 0};
    seconds += duration;
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

}  // namespace mw::trajectory

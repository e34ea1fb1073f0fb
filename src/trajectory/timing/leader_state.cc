// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/leader_state.hh"

#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

std::optional<LeaderState> start_state(const PlannedPath &path, const Snapshot &now) noexcept {
    LeaderState state = now.piece < path.first_piece() ? LeaderState{path.first_piece(), 0, 0}
                                                       : LeaderState{now.piece, now.x, 0};
    if (state.piece > path.last_piece()) {
        return std::nullopt;
    }
    if (state.x >= path.piece(state.piece).length) {
        if (state.piece == path.last_piece()) {
            return std::nullopt;
        }
        state = {state.piece + 1, 0, 0};
    }
    return state;
}

std::optional<LeaderState> predict(const PlannedPath &path, const Snapshot &now,
                                   const Outlook &outlook) noexcept {
    const PathStore &store = path.store();
    LeaderState state;
    Sequence n = now.phase;
    double t = now.time_in_phase;
    bool isOver = false;
    for (std::uint64_t c = 0; c < outlook.latency && !isOver; ++c) {
        double dt = outlook.period_s;
        while (!isOver && dt >= store.phase(n).duration - t) {
            dt -= store.phase(n).duration - t;
            isOver = n + 1 >= outlook.phases_end;
            n += isOver ? 0 : 1;
            t = 0;
        }
        if (!isOver) {
            t += dt;
        }
    }
    const Phase &p = store.phase(n);
    if (isOver) {
        t = p.duration;
    }
    state.piece = p.piece;
    state.x = p.x0 + t * (p.v0 + t * (0.5 * p.a + t * p.j * (1.0 / 6.0)));
    state.v = std::max(0.0, p.v0 + t * (p.a + 0.5 * t * p.j));
    if (!isOver) {
        return state;
    }
    const bool isStop = p.isStop(outlook.period_s);
    state.v = 0;
    const double length = path.piece(p.piece).length;
    const bool isAtEnd = std::abs(state.x - length) <= ExecutorTuning::ARRIVED * (1.0 + length);
    if (isAtEnd && p.piece < path.last_piece()) {
        state = {p.piece + 1, 0, 0};
    }
    const bool isPathOver = isAtEnd && p.piece == path.last_piece();
    return isStop && !isPathOver ? std::optional(state) : std::nullopt;
}

}  // namespace mw::trajectory

// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/acceleration_limited.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// Up from the planned speed, at most to `cap`, and down again to `out2` (squared) where that is in reach.
void append_hill(PlanDraft &draft, PathStore &store, const AccelBound &bound, double left, double cap,
                 double out2) noexcept {
    const double v2 = draft.at.v * draft.at.v;
    // The highest squared speed with an acceleration that holds there: 2 b - v2 - end2 = 2 left a(b).
    const double reach2 = bound.highest_before(v2, left);
    const double end2 = std::min(out2, reach2);
    const double peak2 =
        std::min(cap * cap, std::max(end2, bound.highest_before(0.5 * (v2 + end2), 0.5 * left)));
    const double a = bound.at(peak2);
    const double up = peak2 > v2 ? std::min(left, (peak2 - v2) / (2.0 * a)) : 0.0;
    const double down = peak2 > end2 ? std::min(left - up, (peak2 - end2) / (2.0 * a)) : 0.0;
    const double peak = std::sqrt(peak2);
    draft.append(store, up, peak);
    draft.append(store, left - up - down, peak);
    draft.append(store, down, std::sqrt(end2));
}

/// Phases of the user's speed chooser; false when they exceed a limit.
bool append_chosen(PlanDraft &draft, PathStore &store, const TimingView &view, double cap,
                   double out2) noexcept {
    std::array<ChosenPhase, CHOSEN_PHASES> phases;
    const int count = draft.choose(view, cap, out2, phases);
    for (int n = 0; n < count; ++n) {
        const ChosenPhase &phase = phases[static_cast<std::size_t>(n)];
        draft.append(store, phase.length, phase.speed);
    }
    return count > 0;
}

/// One piece from the planned state on; false when the plan ends here for now.
bool append_piece(PlanDraft &draft, PathStore &store, const TimingView &view) noexcept {
    LeaderState &s = draft.at;
    const Piece &p = view.path().piece(s.piece);
    const bool isLast = s.piece == view.path().last_piece();
    draft.reached = isLast && s.x >= p.length ? s.piece : 0;
    if (s.x >= p.length) {
        if (isLast || (s.v <= 0 && isBarrier(view.on, s.piece + 1))) {
            return false;
        }
        draft.enter_next_piece();
        return true;
    }
    const double cap = speed_cap(view.on, s.piece);
    const bool isChosen = view.on.conditions.chooser != nullptr;
    const bool isRoom =
        draft.hasRoom(view.oldest_phase, isChosen ? CHOSEN_PHASES : TimingTuning::PHASES_PER_PIECE);
    if (draft.overreach.kind != Overreach::Kind::NONE || !isRoom || (s.v <= 0 && cap <= 0)) {
        return false;
    }
    const double out2 = view.profile.out2(view.path(), s.piece);
    double left = p.length - s.x;
    double a = p.acceleration.at(s.v * s.v);
    if (s.v > cap) {
        // Too fast after an override came down: as hard as the limits allow, until it fits.
        const double excess = s.v * s.v - cap * cap;
        if (excess < 2.0 * a * left) {
            draft.append(store, excess / (2.0 * a), cap);
            left = p.length - s.x;
            if (cap <= 0) {
                return true;
            }
            a = p.acceleration.at(s.v * s.v);
        }
    }
    const double v2 = s.v * s.v;
    const double slowest2 = v2 - 2.0 * a * left;
    if (slowest2 >= out2 || s.v > cap) {
        const bool isFit = slowest2 <= out2 + TimingTuning::STOP_FIT * v2;
        draft.append(store, left, std::sqrt(isFit ? std::min(out2, v2) : slowest2));
    } else if (isChosen) {
        if (!append_chosen(draft, store, view, cap, out2)) {
            return false;
        }
    } else {
        append_hill(draft, store, p.acceleration, left, cap, out2);
    }
    s.x = p.length;
    return true;
}

}  // namespace

void append_accelerated(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept {
    while (draft.seconds < until_s && append_piece(draft, store, view)) {
    }
}

}  // namespace mw::trajectory

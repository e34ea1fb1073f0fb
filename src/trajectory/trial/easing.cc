// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/trial/easing.hh"

#include "trajectory/tuning.hh"

namespace mw::trajectory {

void Easing::ease(PlannedPath &path, Sequence piece, double speed, double acceleration) noexcept {
    Eased &of = eased_[piece % PIECE_CAPACITY];
    if (of.piece != piece || of.planning != planning_) {
        of = {piece, planning_, 1, 1};
    }
    of.speed *= speed;
    of.acceleration *= acceleration;
    path.scale(piece, speed, acceleration);
}

Cause Easing::take_back(PlannedPath &path) noexcept {
    Cause changed;
    for (Sequence k = path.oldest_piece(); k <= path.last_piece(); ++k) {
        Eased &of = eased_[k % PIECE_CAPACITY];
        if (of.piece == k && of.planning == planning_) {
            path.scale(k, 1.0 / of.speed, 1.0 / of.acceleration);
            of.planning = 0;
            changed.low = changed.low == 0 ? k : changed.low;
            changed.high = k;
        }
    }
    return changed;
}

void Easing::slow_down(PlannedPath &path, const Cause &cause) noexcept {
    last_ = cause;
    for (Sequence k = cause.low; k <= cause.high; ++k) {
        ease(path, k, EasingTuning::SLOWER, EasingTuning::GENTLER);
    }
}

void Easing::undo(PlannedPath &path) noexcept {
    for (Sequence k = last_.low; k <= last_.high; ++k) {
        ease(path, k, 1.0 / EasingTuning::SLOWER, 1.0 / EasingTuning::GENTLER);
    }
}

}  // namespace mw::trajectory

// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/planned_path.hh"

namespace mw::trajectory {

void PlannedPath::append_piece(const Piece &piece, const PlannedPiece &plan_of_it) noexcept {
    const Sequence k = last_piece_ + 1;
    store_.piece(k) = piece;
    plan(k) = plan_of_it;
    last_piece_ = k;
    // Release: the executor that sees the number (acquire) sees the piece and its primitives filled.
    store_.last_piece.store(k, std::memory_order_release);
}

void PlannedPath::scale(Sequence piece, double speed, double acceleration) noexcept {
    plan(piece).v_limit *= speed;
    Piece &p = store_.piece(piece);
    for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
        p.acceleration.alpha[i] *= acceleration;
        p.acceleration.beta[i] *= acceleration;
    }
    for (Braking::Part &part : p.braking.parts) {
        for (float &left : part) {
            left *= static_cast<float>(acceleration);
        }
    }
}

}  // namespace mw::trajectory

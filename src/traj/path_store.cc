// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/path_store.hh"

#include <algorithm>
#include <cmath>

#include "traj/tuning.hh"

namespace mw::traj {

Piece::BrakeLeg Piece::brake_leg(double x, double b) const noexcept {
    BrakeLeg leg{brake_at(x, b), x < braking.from ? braking.from : length};
    const double slower = BrakingTuning::LOOK_AGAIN * b;
    if (leg.a > 0 && brake_at(x, slower) > BrakingTuning::LOOK_GAIN * leg.a) {
        const double way = std::max(0.5 * (b - slower) / leg.a, BrakingTuning::SHORT_S * std::sqrt(b));
        leg.end = std::min(leg.end, x + way);
    }
    return leg;
}

Pose position_at(const PathStore &store, const Piece &piece, double x) noexcept {
    const Primitive &a = store.primitive(piece.primitive);
    if (!(piece.blend_d > 0)) {
        return piece.isToEnd && x >= piece.length ? a.end : position_at(a, piece.offset + x);
    }
    const Primitive &b = store.primitive(piece.primitive + 1);
    const double z = piece.offset + x;
    const double y = z * z / (4.0 * piece.blend_d);
    return position_at(a, a.length - piece.blend_d + z - y) + (position_at(b, y) - b.start);
}

Pose derivative_at(const PathStore &store, const Piece &piece, double x) noexcept {
    const Primitive &a = store.primitive(piece.primitive);
    if (!(piece.blend_d > 0)) {
        return derivative_at(a, piece.offset + x);
    }
    const Primitive &b = store.primitive(piece.primitive + 1);
    const double z = piece.offset + x;
    const double part = z / (2.0 * piece.blend_d);
    const double y = part * part * piece.blend_d;
    return derivative_at(a, a.length - piece.blend_d + z - y) * (1.0 - part) + derivative_at(b, y) * part;
}

}  // namespace mw::traj

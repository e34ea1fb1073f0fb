// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/path_store.hh"

namespace mw::traj {

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

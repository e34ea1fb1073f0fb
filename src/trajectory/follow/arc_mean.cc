// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/arc_mean.hh"

namespace mw::trajectory {

std::optional<Pose> ArcMean::follow(const PathStore &store, const Piece *piece, double x, std::uint64_t tick,
                                    std::uint64_t filter) noexcept {
    const bool isOn = piece != nullptr && piece->isAlong && filter > 1;
    // Of the arc, not of its piece: it may stand where two of them meet.
    const double s = isOn ? piece->offset + x : 0.0;
    const double from = isOn && piece->primitive == seen_ ? seen_s_ : 0.0;
    const double length = isOn ? store.primitive(piece->primitive).length : 0.0;
    const bool isWithin = isOn && s > on_along(length) && s < length;
    const bool isMoving = isWithin && s != from;
    if (isMoving && primitive_ != piece->primitive) {
        primitive_ = piece->primitive;
        first_ = tick;
        before_ = from;
    }
    seen_ = isOn ? piece->primitive : 0;
    seen_s_ = s;
    if (primitive_ == 0) [[likely]] {
        return std::nullopt;
    }
    const Primitive &arc = store.primitive(primitive_);
    const bool isOnThis = isOn && piece->primitive == primitive_;
    places_[tick % HISTORY_CAPACITY] = isOnThis ? s : arc.length;
    last_ = isOnThis && isMoving ? tick : last_;
    // Where it has stood for the time of the mean it may also leave the arc.
    if (tick >= last_ + filter) {
        primitive_ = 0;
        return std::nullopt;
    }
    double sum = 0;
    for (std::uint64_t i = 0; i < filter; ++i) {
        sum += tick - i >= first_ ? places_[(tick - i) % HISTORY_CAPACITY] : before_;
    }
    return position_at(arc, sum / static_cast<double>(filter));
}

}  // namespace mw::trajectory

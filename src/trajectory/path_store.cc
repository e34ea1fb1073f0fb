// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path_store.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

static_assert(std::size(BrakingTuning::CHORDS) == Braking::MOST_NODES);

std::span<const double> Braking::nodes() const noexcept {
    return BrakingTuning::CHORDS;
}

double Braking::at(std::size_t part, double b) const noexcept {
    const Part &left = parts[part];
    const std::span<const double> shares = nodes();
    const double share = std::min(1.0, b / top);
    std::size_t k = 1;
    while (k + 1 < shares.size() && share > shares[k]) {
        ++k;
    }
    const double before = shares[k - 1];
    const double t = (share - before) / (shares[k] - before);
    return left[k - 1] + t * (left[k] - left[k - 1]);
}

std::size_t Braking::part_at(double x, double length) noexcept {
    const double n = length > 0 ? x / length * PARTS : 0.0;
    const auto part = static_cast<std::size_t>(std::clamp(n, 0.0, PARTS - 1.0));
    // The end of a part belongs to the next one, regardless of rounding.
    const bool isOver = part + 1 < PARTS && x >= length * static_cast<double>(part + 1) / PARTS;
    return isOver ? part + 1 : part;
}

double Braking::end_of(std::size_t part, double length) const noexcept {
    std::size_t next = part + 1;
    while (next < PARTS && parts[next] == parts[part]) {
        ++next;
    }
    return next < PARTS ? length * static_cast<double>(next) / PARTS : length;
}

bool Phase::isStop(double period_s) const noexcept {
    return v_at(duration) <= ExecutorTuning::STOPPED * std::abs(a) * (duration + period_s);
}

double Piece::brake_at(double x, double b) const noexcept {
    const double planned = acceleration.at(b);
    return braking.top > 0 ? std::max(planned, braking.at(Braking::part_at(x, length), b)) : planned;
}

Piece::BrakeLeg Piece::brake_leg(double x, double b) const noexcept {
    const bool isPlanned = !(braking.top > 0);
    BrakeLeg leg{brake_at(x, b), isPlanned ? length : braking.end_of(Braking::part_at(x, length), length)};
    using Looks = std::span<const BrakingTuning::Look>;
    const Looks looks = isPlanned ? Looks(BrakingTuning::LOOKS) : Looks(BrakingTuning::DENSE_LOOKS);
    for (const BrakingTuning::Look &look : looks) {
        const double slower = look.slower * b;
        if (leg.a > 0 && brake_at(x, slower) > look.gain * leg.a) {
            const double way = std::max(0.5 * (b - slower) / leg.a, BrakingTuning::SHORT_S * std::sqrt(b));
            leg.end = std::min(leg.end, x + way);
            break;
        }
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

}  // namespace mw::trajectory

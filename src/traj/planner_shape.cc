// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits the mean runs inside of dense curves. Their corners are therefore moved outwards, within
// the tolerance, by a part of what the mean takes (docs/motion/planner.md).
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

/// How far the corner between two lines is to be moved, by its curvature alone; false where there is no
/// curve.
bool Planner::wanted_shift(Sequence nb, Sequence nc, Pose &shift, ShiftRoom &room) const noexcept {
    const Primitive &b = store_.primitive(nb);
    const Primitive &c = store_.primitive(nc);
    const MovePlan &mb = move_plan(nb);
    const MovePlan &mc = move_plan(nc);
    const auto isPlain = [](const Primitive &p, const MoveRequest &r) {
        return !p.isArc && r.join == Join::BLEND && !r.isGated && !r.tag.isProbe && r.tolerance > 0;
    };
    if (!isFiltered() || isStepping_ || !isPlain(b, mb.request) || !isPlain(c, mc.request)) {
        return false;
    }
    const Pose step = c.lin - b.lin;
    const double turn = geom::norm(step);
    const double spacing = 0.5 * (b.length + c.length);
    double v2 = std::min(wish_of(mb), wish_of(mc));
    v2 *= v2;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        const double bend = std::abs(step[i]) / spacing;
        const double speed = limits_.velocity[static_cast<std::size_t>(i)];
        const double along = std::max(std::abs(b.lin[i]), std::abs(c.lin[i]));
        v2 = bend > 0 ? std::min(v2, limits_.acceleration[static_cast<std::size_t>(i)] / bend) : v2;
        v2 = along > 0 ? std::min(v2, speed * speed / (along * along)) : v2;
    }
    const double tau = filter_s();
    const double reach = std::sqrt(v2) * tau;
    room = {reach, 0};
    if (turn > ShapeTuning::MOST_TURN || reach < CornerTuning::DENSE * spacing) {
        return false;
    }
    const double tolerance = std::min(tolerance_of(mb), tolerance_of(mc));
    room.most = ShapeTuning::MOST_SHARE * tolerance;
    const double size = std::max(geom::norm_linear(step), geom::norm_abc(step));
    const double inside = size / spacing * reach * reach / 24.0;
    const double out = std::clamp(inside - ShapeTuning::FREE_SHARE * tolerance, 0.0, room.most);
    shift = size > 0 ? step * (-out / size) : Pose{};
    return true;
}

void Planner::set_room(const Pose &low, const Pose &high) noexcept {
    room_low_ = low;
    room_high_ = high;
}

/// What of `shift` leaves the moved corner within the soft limits. The commanded path runs inside of the
/// corners, so it keeps them as well.
Pose Planner::within_room(const Pose &corner, const Pose &shift) const noexcept {
    Pose kept;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        const double low = std::min(room_low_[i] - corner[i], 0.0);
        const double high = std::max(room_high_[i] - corner[i], 0.0);
        kept[i] = std::clamp(shift[i], low, high);
    }
    double as_programmed[MAX_JOINTS] = {};
    double moved[MAX_JOINTS] = {};
    if (joint_map_ == nullptr || !joint_map_->joints_at(corner, as_programmed)) {
        return kept;
    }
    bool isInside = joint_map_->joints_at(corner + kept, moved);
    for (int j = 0; j < joint_limits_.count && isInside; ++j) {
        const auto n = static_cast<std::size_t>(j);
        isInside = moved[j] >= std::min(joint_limits_.low[n], as_programmed[j]) &&
                   moved[j] <= std::max(joint_limits_.high[n], as_programmed[j]);
    }
    return isInside ? kept : Pose{};
}

/// Moves the corner between the newest whole line and the one that has come.
void Planner::shape_corner(Sequence nb, Sequence nc) noexcept {
    if (nb == 0) {
        shift_ = {};
        shift_drive_ = {};
        return;
    }
    Pose wanted;
    ShiftRoom room;
    if (!wanted_shift(nb, nc, wanted, room)) {
        shift_ = {};
        shift_drive_ = {};
        return;
    }
    // Two lags in a row, by length: what the shift adds to the curvature stays small.
    const double way = store_.primitive(nb).length;
    const double part = 1.0 - std::exp(-way / (ShapeTuning::FOLLOWING * room.reach));
    shift_drive_ = shift_drive_ + (wanted - shift_drive_) * part;
    shift_ = shift_ + (shift_drive_ - shift_) * part;
    // What corners before were moved by may be more than this one's tolerance.
    const double size = std::max(geom::norm_linear(shift_), geom::norm_abc(shift_));
    shift_ = size > room.most ? shift_ * (room.most / size) : shift_;
    if (geom::norm(shift_) < ShapeTuning::SMALLEST_SHIFT) {
        return;
    }
    MovePlan &mb = move_plan(nb);
    MovePlan &mc = move_plan(nc);
    const Pose shift = within_room(store_.primitive(nb).end, shift_);
    mb.shift_out = shift;
    mc.shift_in = shift;
    reshape(nb, {}, shift);
    mc.start_s = mb.start_s + store_.primitive(nb).length;
    reshape(nc, shift, {});
}

/// The line with its ends moved; what is told of it stays as programmed.
void Planner::reshape(Sequence n, const Pose &in, const Pose &out) noexcept {
    Primitive &p = store_.primitive(n);
    MovePlan &m = move_plan(n);
    const double before = p.length;
    p = make_line(p.start + in, p.end + out);
    const double longer = p.length / before;
    m.feed *= longer;
    m.request.tag.feed_ratio *= longer;
    store_.move(n).feed_ratio = m.request.tag.feed_ratio;
    programmed_s_ = m.start_s + p.length;
}

/// The programmed place that answers to `s` on a move.
Pose Planner::programmed_at(Sequence n, double s) const noexcept {
    const Primitive &p = store_.primitive(n);
    const MovePlan &m = move_plan(n);
    const double part = p.length > 0 ? std::clamp(s / p.length, 0.0, 1.0) : 0.0;
    return position_at(p, s) - m.shift_in * (1.0 - part) - m.shift_out * part;
}

}  // namespace mw::traj

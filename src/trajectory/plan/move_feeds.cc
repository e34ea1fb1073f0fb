// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/plan/move_feeds.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/plan/chosen_speed.hh"

namespace mw::trajectory::plan {

namespace {

profile::FeedLimit::Along along_of(const Primitive &p) noexcept {
    const auto moves = [&](int first) {
        const bool is_arc = p.isArc && p.space == first;
        return is_arc || p.lin[first] != 0 || p.lin[first + 1] != 0 || p.lin[first + 2] != 0;
    };
    using Along = profile::FeedLimit::Along;
    return moves(geometry::AXIS_X) ? Along::XYZ : moves(geometry::AXIS_U) ? Along::UVW : Along::LENGTH;
}

}  // namespace

void MoveFeeds::begin(Sequence first_move) {
    feeds_.clear();
    overreach_ = {};
    first_move_ = first_move;
}

void MoveFeeds::add(const Conditions &conditions, Sequence move) {
    feeds_.push_back(feed_of(conditions, move));
    last_synched_ = moves_.move(move).request.isSynched() ? move : last_synched_;
}

void MoveFeeds::drop_before(Sequence move) {
    feeds_.erase(feeds_.begin(), feeds_.begin() + static_cast<long>(move - first_move_));
    first_move_ = move;
}

Sequence MoveFeeds::move_at(double s) const noexcept {
    const auto at = std::partition_point(feeds_.begin(), feeds_.end(), [&](const profile::FeedLimit &feed) {
        return feed.end_s <= s + curve::SAME_PLACE;
    });
    return first_move_ + static_cast<Sequence>(at - feeds_.begin());
}

profile::FeedLimit MoveFeeds::feed_of(const Conditions &conditions, Sequence n) noexcept {
    const PlannedMove &m = moves_.move(n);
    const Scales &scales = conditions.scales;
    profile::FeedLimit feed;
    feed.curve_share = std::clamp(m.request.corner_scale, profile::FeedLimit::LEAST_CURVE_SHARE, 1.0);
    feed.end_s = m.request.tag.end_s;
    feed.along = along_of(moves_.primitive(n));
    const double ratio = feed.along == profile::FeedLimit::Along::LENGTH ? m.request.tag.feed_ratio : 1.0;
    double v = UNLIMITED;
    if (m.request.isRapid) {
        feed.limit_share = scales.rapid;
    } else if (m.request.isSynched()) {
        v = turning_speed(m.request, scales) / m.request.tag.feed_ratio;
    } else if (m.request.tag.requested_velocity > 0) {
        v = m.request.tag.requested_velocity * (m.request.isOverridable ? scales.feed : 1.0);
    }
    v = m.request.isAngular ? v : std::min(v, scales.max_velocity);
    if (conditions.chooser != nullptr) {
        v = std::min(v, chosen_feed(conditions, n, v));
    }
    feed.velocity = v < UNLIMITED ? v * ratio : UNLIMITED;
    return feed;
}

/// The speed along the feed length that the planner module chooses, at most `velocity`.
double MoveFeeds::chosen_feed(const Conditions &conditions, Sequence n, double velocity) noexcept {
    PlannedMove &m = moves_.move(n);
    const double ratio = m.request.tag.feed_ratio;
    const double before = n > moves_.first_move() ? moves_.move(n - 1).chosen_speed : 0.0;
    const ChosenSpeed chosen =
        choose_speed(*conditions.chooser,
                     {n, moves_.primitive(n), m.request.tag, before,
                      velocity < UNLIMITED ? velocity * ratio : UNLIMITED, n == moves_.last_move()},
                     conditions.limits.wanted());
    m.chosen_speed = chosen.most;
    overreach_ = overreach_.kind == Overreach::Kind::NONE ? chosen.overreach : overreach_;
    return chosen.most / ratio;
}

MoveFeeds::Change MoveFeeds::update(const Conditions &conditions) {
    // Relative rounding error of a speed that follows a spindle.
    constexpr double ROUNDING = 1e-9;
    Change change;
    const auto compare = [&](double now, double before) {
        change.is_lower = change.is_lower || now < (1 - ROUNDING) * before;
        change.is_any = change.is_any || std::abs(now - before) > ROUNDING * before;
    };
    for (std::size_t k = 0; k < feeds_.size(); ++k) {
        const profile::FeedLimit feed = feed_of(conditions, first_move_ + k);
        compare(feed.velocity, feeds_[k].velocity);
        compare(feed.limit_share, feeds_[k].limit_share);
        feeds_[k] = feed;
    }
    return change;
}

}  // namespace mw::trajectory::plan

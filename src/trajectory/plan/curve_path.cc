// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/plan/curve_path.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::plan {

namespace {

/// Maximum knot spacing and span length [machine units]. Larger values bring no gain.
constexpr double WIDEST = 3.0;
/// Below this fraction of the tolerance, the move is followed exactly.
constexpr double LEAST_TOLERANCE = 0.1;
/// Maximum numbers of spans and moves that are known and not yet executed. They limit the memory.
constexpr std::size_t MOST_SPANS = SPAN_CAPACITY / 2;
constexpr Sequence MOST_MOVES = PRIMITIVE_CAPACITY - 64;

profile::CurveLimits curve_limits(const Limits &limits) noexcept {
    profile::CurveLimits out;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        out.axes[i] = {limits.velocity[i], limits.acceleration[i], limits.jerk[i]};
    }
    out.xyz = {limits.velocity[XYZ_NORM], limits.acceleration[XYZ_NORM], limits.jerk[XYZ_NORM]};
    out.has_jerk = limits.isJerkLimited;
    return out;
}

/// Soft limits of the axes and of joints in proportion to them. The kinematics must have a solution at
/// `start`.
curve::Room room_at(const Workspace &workspace, const Pose &start) noexcept {
    curve::Room room{workspace.low, workspace.high, {}};
    std::array<double, MAX_JOINTS> at{};
    if (!workspace.isMapped() || !workspace.map->joints_at(start, at.data())) {
        return room;
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(workspace.joints.count); ++j) {
        if ((workspace.linear.joints >> j & 1U) != 0) {
            const Pose &slope = workspace.linear.slope[j];
            const double origin = at[j] - geometry::dot(slope, start);
            room.rows.push_back({slope, workspace.low_of(j) - origin, workspace.high_of(j) - origin});
        }
    }
    return room;
}

/// A move of a pass at the current spindle speed.
PassMove pass_move(const PlannedMove &move, const Primitive &primitive,
                   const Conditions &conditions) noexcept {
    const MoveRequest &request = move.request;
    return {primitive, request.feed_per_revolution * request.tag.feed_ratio,
            turning_speed(request, conditions.scales)};
}

}  // namespace

CurvePath::CurvePath(PathStore &store, PlannedPath &moves)
    : store_(store), moves_(moves), feeds_(moves), fitted_(WIDEST), exact_(WIDEST), passes_(WIDEST) {}

void CurvePath::begin(const Pose &start, const Conditions &conditions) {
    limits_ = curve_limits(conditions.limits.wanted());
    is_jerk_limited_ = conditions.limits.wanted().isJerkLimited;
    map_ = conditions.workspace.map;
    joints_ = conditions.workspace.joints;
    end_ = start;
    programmed_s_ = 0;
    is_open_ = false;
    first_span_ += spans_.size();
    spans_.clear();
    coming_.clear();
    caps_.clear();
    feeds_.begin(moves_.first_move());
    legs_.clear();
    stops_.clear();
}

bool CurvePath::isMadeFor(const Conditions &conditions) const noexcept {
    const Limits &limits = conditions.limits.wanted();
    const JointLimits &joints = conditions.workspace.joints;
    const auto is_same = [&](const profile::Bounds &b, std::size_t i) {
        return b.velocity == limits.velocity[i] && b.acceleration == limits.acceleration[i] &&
               b.jerk == limits.jerk[i];
    };
    bool is_made = limits.isJerkLimited == is_jerk_limited_ && is_same(limits_.xyz, XYZ_NORM);
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        is_made = is_made && is_same(limits_.axes[i], i);
    }
    const bool is_map_made =
        map_ == conditions.workspace.map &&
        (map_ == nullptr || (joints_.count == joints.count && joints_.velocity == joints.velocity &&
                             joints_.acceleration == joints.acceleration && joints_.jerk == joints.jerk));
    return is_made && is_map_made;
}

double CurvePath::tolerance_of(const Conditions &conditions, const Primitive &primitive,
                               const MoveRequest &request) const noexcept {
    if (request.join != geometry::PathMode::BLEND) {
        return 0;
    }
    const double wanted =
        request.tolerance > 0
            ? request.tolerance
            : conditions.limits.free_tolerance(primitive, request.tag.requested_velocity * primitive.length /
                                                              feed_length(primitive).length);
    const double kept = conditions.workspace.tolerance_within(primitive, wanted);
    return kept < LEAST_TOLERANCE * wanted ? 0.0 : kept;
}

Sequence CurvePath::add(const Conditions &conditions, const Primitive &primitive,
                        const MoveRequest &request) {
    const Sequence before = moves_.end_move();
    const Sequence n = moves_.append_move();
    PlannedMove &m = moves_.move(n);
    m = {};
    m.start_s = programmed_s_;
    m.request = request;
    const FeedLength feed = feed_length(primitive);
    m.request.isAngular = feed.isAngular;
    m.request.tag.feed_ratio = primitive.length / feed.length;
    m.request.tag.end = primitive.end;
    m.feed = request.tag.requested_velocity * m.request.tag.feed_ratio;
    store_.primitive(n) = primitive;

    const double tolerance = tolerance_of(conditions, primitive, request);
    const Rule rule = rule_of(conditions, request, tolerance);
    const PlannedMove *last = before != 0 ? &moves_.move(before) : nullptr;
    const bool is_stop = last != nullptr && isStopBefore(conditions, *last, m, rule);
    if (is_open_ && (is_stop || rule != rule_)) {
        finish_part(conditions);
    }
    if (is_stop) {
        add_stop(programmed_s_);
    }
    if (!is_open_) {
        rule_ = rule;
        is_open_ = true;
        is_part_seamed_ = before == 0;
        fitted_.set_room(room_at(conditions.workspace, primitive.start));
        begin_part();
    }
    programmed_s_ += append(conditions, m, primitive, tolerance);
    m.request.tag.end_s = programmed_s_;
    store_.move(n) = m.request.tag;
    end_ = primitive.end;
    feeds_.add(conditions, n);
    store_.last_move.store(n, std::memory_order_release);
    return n;
}

/// A pass stops at its ends and at corners that need a stop. It passes other corners in any path mode,
/// because a thread cannot wait.
bool CurvePath::isStopBefore(const Conditions &conditions, const PlannedMove &last, const PlannedMove &move,
                             Rule rule) const noexcept {
    if (isStopBetween(last.request, move.request) ||
        (conditions.blocks.isOn && last.request.tag.block != move.request.tag.block)) {
        return true;
    }
    if (rule != Rule::LOCKED && rule_ != Rule::LOCKED) {
        return last.request.join == geometry::PathMode::EXACT_STOP;
    }
    return rule != rule_ || last.request.spindle != move.request.spindle ||
           !passes_.continues(pass_move(move, moves_.primitive(moves_.last_move()), conditions));
}

CurvePath::Rule CurvePath::rule_of(const Conditions &conditions, const MoveRequest &request,
                                   double tolerance) const noexcept {
    return conditions.isLocked(request) ? Rule::LOCKED : tolerance > 0 ? Rule::FITTED : Rule::EXACT;
}

void CurvePath::begin_part() {
    switch (rule_) {
    case Rule::FITTED: fitted_.begin(programmed_s_); break;
    case Rule::EXACT: exact_.begin(programmed_s_); break;
    case Rule::LOCKED: passes_.begin(programmed_s_); break;
    }
}

/// Adds a move to the open part. Returns its length along the curve.
double CurvePath::append(const Conditions &conditions, const PlannedMove &move, const Primitive &primitive,
                         double tolerance) {
    switch (rule_) {
    case Rule::FITTED: fitted_.add(primitive, tolerance); break;
    case Rule::EXACT: exact_.add(primitive); break;
    case Rule::LOCKED: return passes_.add(pass_move(move, primitive, conditions), conditions);
    }
    return primitive.length;
}

/// All moves of the pass that begins at `s` are known.
bool CurvePath::isPassKnown(double s) const noexcept {
    return !is_open_ || rule_ != Rule::LOCKED || stop_behind(s) <= known_s();
}

CurvePath::KnownPass CurvePath::pass_at(double s) const {
    KnownPass pass;
    const double end = std::min(stop_behind(s), programmed_s_);
    pass.limits = {UNLIMITED, UNLIMITED, UNLIMITED};
    pass.end_s = end;
    for (const LimitedLeg &known : legs_) {
        const PassLeg &leg = known.leg;
        const double middle = leg.start_s + 0.5 * leg.length;
        if (middle > s && middle < end) {
            pass.legs.push_back(leg);
            pass.limits.acceleration = std::min(pass.limits.acceleration, known.acceleration);
            pass.limits.jerk = std::min(pass.limits.jerk, known.jerk);
        }
    }
    limit_leg_ends(pass.legs, pass.limits);
    return pass;
}

void CurvePath::finish_part(const Conditions &conditions) {
    if (rule_ == Rule::FITTED) {
        fitted_.extend(true);
    } else if (rule_ == Rule::LOCKED) {
        passes_.finish(conditions.limits.wanted());
    }
    take_spans(conditions);
    is_open_ = false;
}

void CurvePath::release_end(const Conditions &conditions) {
    if (is_open_) {
        finish_part(conditions);
    }
}

void CurvePath::extend(const Conditions &conditions) {
    if (!is_open_) {
        publish();
        return;
    }
    if (rule_ == Rule::FITTED) {
        fitted_.extend(false);
    }
    take_spans(conditions);
}

void CurvePath::take_spans(const Conditions &conditions) {
    const std::size_t old = coming_.size();
    switch (rule_) {
    case Rule::FITTED: fitted_.move_spans(coming_); break;
    case Rule::EXACT: exact_.move_spans(coming_, seams_); break;
    case Rule::LOCKED: passes_.move_parts(coming_, legs_); break;
    }
    if (coming_.size() > old) {
        if (!is_part_seamed_ && rule_ != Rule::LOCKED) {
            take_seam(conditions, curve::seam_between(newest_, coming_[old]));
        }
        is_part_seamed_ = true;
        newest_ = coming_.back();
    }
    for (const curve::Seam &seam : seams_) {
        take_seam(conditions, seam);
    }
    seams_.clear();
    publish();
}

/// Copies spans to the store. Spans that are not yet executed are not overwritten.
void CurvePath::publish() {
    const std::size_t count = std::min(coming_.size(), SPAN_CAPACITY - 1 - spans_.size());
    for (std::size_t k = 0; k < count; ++k) {
        store_.span(first_span_ + spans_.size()) = coming_[k];
        spans_.push_back(coming_[k]);
    }
    coming_.erase(coming_.begin(), coming_.begin() + static_cast<long>(count));
}

void CurvePath::take_seam(const Conditions &conditions, const curve::Seam &seam) {
    const profile::SpeedCap cap = profile::cap_of(seam, limits_, map_, joints_, conditions.limits.period_s());
    const bool is_needed =
        map_ != nullptr ? profile::isNeeded(cap, limits_, joints_) : profile::isNeeded(cap, limits_);
    if (cap.is_stop) {
        add_stop(cap.s);
    } else if (is_needed && !std::binary_search(stops_.begin(), stops_.end(), cap.s)) {
        caps_.push_back(cap);
    }
}

void CurvePath::add_stop(double s) {
    const auto at = std::lower_bound(stops_.begin(), stops_.end(), s - SAME_PLACE);
    if (at == stops_.end() || *at > s + SAME_PLACE) {
        stops_.insert(at, s);
    }
    std::erase_if(caps_, [&](const profile::SpeedCap &cap) { return std::abs(cap.s - s) <= SAME_PLACE; });
}

void CurvePath::drop_before(double s) {
    // Spans and moves are dropped separately, because a span may contain many moves. The last move remains.
    const Sequence last = first_move() + std::max<std::size_t>(feeds().size(), 1) - 1;
    feeds_.drop_before(std::min(move_at(s), last));
    const auto driven = static_cast<std::size_t>(
        std::partition_point(spans_.begin(), spans_.end(), [&](const auto &x) { return x.end_s() < s; }) -
        spans_.begin());
    if (4 * driven <= spans_.size()) {
        return;  // dropping fewer spans is not worth moving the rest
    }
    const std::size_t spans = std::min(driven, spans_.size() - 1);
    spans_.erase(spans_.begin(), spans_.begin() + static_cast<long>(spans));
    first_span_ += spans;
    const double from = spans_.front().start_s;
    std::erase_if(legs_, [&](const LimitedLeg &leg) { return leg.leg.start_s + leg.leg.length < from; });
    std::erase_if(caps_, [&](const profile::SpeedCap &cap) { return cap.s + cap.reach < from; });
    while (!stops_.empty() && stops_.front() < from) {
        stops_.pop_front();
    }
}

bool CurvePath::hasRoom() const noexcept {
    return spans_.size() < MOST_SPANS && feeds().size() < MOST_MOVES;
}

double CurvePath::stop_behind(double s) const noexcept {
    const auto at = std::upper_bound(stops_.begin(), stops_.end(), s + SAME_PLACE);
    return at != stops_.end() ? *at : 1e300;
}

Sequence CurvePath::span_at(double s) const noexcept {
    return first_span_ + profile::span_at(spans_, s);
}

double CurvePath::on_span_end(double s) const noexcept {
    if (spans_.empty()) {
        return s;
    }
    const curve::Span &span = spans_[profile::span_at(spans_, s + SAME_PLACE)];
    return std::abs(span.start_s - s) <= SAME_PLACE   ? span.start_s
           : std::abs(span.end_s() - s) <= SAME_PLACE ? span.end_s()
                                                      : s;
}

}  // namespace mw::trajectory::plan

// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/estimator.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mw::trajectory {

namespace {

constexpr std::uint64_t PLANNER_CYCLES = 5;
constexpr double LONGEST_STAND_S = 5, LONGEST_MOVE_S = 50 * Estimator::DRIVEN_S;
/// A limit counts as binding if the motion uses at least this fraction of it.
constexpr double NEAR = 0.93;
/// A move counts as limited by its feed if it takes at most this factor of the time at its feed.
constexpr double AT_FEED = 1.02;

/// Length of a primitive along which its feed counts.
double feed_length_of(const Primitive &p) {
    const double length = feed_length(p).length;
    return length > 0 ? length : p.length;
}

/// Returns the last part of a primitive, with the given length.
Primitive tail_of(const Primitive &p, double length) {
    const double from = p.length - length;
    Primitive tail = p;
    tail.start = position_at(p, from);
    tail.base = p.base + p.lin * from;
    tail.radius = p.radius + p.dradius * from;
    tail.length = length;
    const double c = std::cos(p.omega * from), s = std::sin(p.omega * from);
    for (std::size_t i = 0; i < p.u.size(); ++i) {
        tail.u[i] = p.u[i] * c + p.v[i] * s;
        tail.v[i] = p.v[i] * c - p.u[i] * s;
    }
    return tail;
}

}  // namespace

Estimator::Estimator(const Limits &limits, double period_s, Listener listener)
    : limits_(limits), period_s_(period_s),
      period_power_{period_s, period_s * period_s, period_s * period_s * period_s},
      listener_(std::move(listener)), store_(std::make_unique_for_overwrite<PathStore>()),
      executor_(std::make_unique<Executor>(*store_, period_s)),
      planner_(
          std::make_unique<Planner>(*store_, PlannerSettings{.period_s = period_s, .is_estimate = true})) {
    planner_->set_limits(limits);
}

void Estimator::set_limits(const Limits &limits) {
    limits_ = limits;
    planner_->set_limits(limits);
}

void Estimator::set_machine(const Scales &scales, const Pose &low, const Pose &high) {
    scales_ = scales;
    planner_->set_scales(scales);
    planner_->set_room(low, high);
}

void Estimator::begin(const Pose &pose) {
    executor_->set_position(pose);
    executor_->step(++cycle_);
    planner_->begin(pose, executor_->snapshot());
    last_.fill(pose);
    kept_ = last_.size();
}

void Estimator::add(const Primitive &primitive, const MoveRequest &request) {
    if (isEnded_ || !(primitive.length > 1e-12)) {
        return;
    }
    const Primitive driven = skip_to_end(primitive, request);
    if (!(driven.length > 1e-12)) {
        return;
    }
    while (!planner_->hasRoom()) {
        if (!step()) {
            return;
        }
    }
    MoveRequest plain = request;
    plain.isGated = false;
    planner_->add(driven, plain);
}

/// Maximum speed along the parameter of a primitive within its feed, the velocity limits and the curvature.
double Estimator::speed_bound(const Primitive &p, const MoveRequest &request) const {
    const double feed_length = feed_length_of(p);
    const double feed = request.isRapid ? UNLIMITED : scales_.feed * request.tag.requested_velocity;
    double speed =
        std::min(feed, request.isAngular ? UNLIMITED : scales_.max_velocity) * p.length / feed_length;
    const double part = request.isRapid ? scales_.rapid : 1.0;
    const PerLimited bend = second_derivative_bound(p);
    constexpr int SAMPLES = 8;
    for (int sample = 0; sample <= SAMPLES; ++sample) {
        const Pose d = derivative_at(p, p.length * sample / SAMPLES);
        for (int i = 0; i < LIMITED_COUNT; ++i) {
            const auto n = static_cast<std::size_t>(i);
            const double slope = i == XYZ_NORM ? std::hypot(d[0], d[1], d[2]) : std::abs(d[i]);
            speed = slope > 0 ? std::min(speed, part * limits_.velocity[n] / slope) : speed;
            speed = bend[n] > 0 ? std::min(speed, std::sqrt(limits_.acceleration[n] / bend[n])) : speed;
        }
    }
    return speed;
}

/// Returns the part of a move that is simulated: the whole move, or its end if the move takes longer than
/// DRIVEN_S.
Primitive Estimator::skip_to_end(const Primitive &primitive, const MoveRequest &request) {
    const double speed = speed_bound(primitive, request);
    if (!(speed > 0) || primitive.length <= DRIVEN_S * speed) {
        return primitive;
    }
    finish();
    // A shorter move is not simulated, because positions have too few digits for it.
    const double least = 1e-6 * (1.0 + geometry::norm(primitive.end));
    const double length = DRIVEN_S * speed >= least ? DRIVEN_S * speed : 0.0;
    const Primitive tail = tail_of(primitive, length);
    begin(tail.start);
    skipped_ = primitive.length - length;
    if (length == 0.0) {
        MoveEstimate e;
        e.tag = request.tag;
        e.seconds = std::exchange(skipped_, 0.0) / speed;
        e.seconds_at_feed = request.isRapid ? 0.0 : e.seconds;
        e.top_velocity = speed * feed_length_of(primitive) / primitive.length;
        skipped_s_ += e.seconds;
        listener_(e);
    }
    return tail;
}

void Estimator::finish() {
    planner_->release_end();
    while (executor_->snapshot().done_move < planner_->last_move() || !executor_->isAtRest()) {
        if (!step()) {
            break;
        }
    }
    close_move();
}

bool Estimator::step() {
    isEnded_ = isEnded_ || (cycle_ % CHECK_CYCLES == 0 && isToEnd_ && isToEnd_());
    if (isEnded_) {
        isComplete_ = false;
        return false;
    }
    if (cycle_ % PLANNER_CYCLES == 0) {
        planner_->update(executor_->snapshot());
    }
    const ExecutorOutput &out = executor_->step(++cycle_);
    count(out);
    standing_cycles_ = executor_->isAtRest() ? standing_cycles_ + 1 : 0;
    const bool isStuck = static_cast<double>(standing_cycles_) * period_s_ > LONGEST_STAND_S ||
                         static_cast<double>(move_cycles_) * period_s_ > LONGEST_MOVE_S;
    isComplete_ = isComplete_ && !isStuck;
    return !isStuck;
}

/// Returns |n-th difference of the positions| divided by its limit. `order`: 0 velocity, 1 acceleration, 2
/// jerk.
double Estimator::ratio(int i, int order) const {
    const auto along = [&](int axis) {
        const double v = last_[0][axis] - last_[1][axis];
        const double before = last_[1][axis] - last_[2][axis];
        const double oldest = last_[2][axis] - last_[3][axis];
        return order == 0 ? v : order == 1 ? v - before : v - 2.0 * before + oldest;
    };
    const auto n = static_cast<std::size_t>(i);
    const double value = i == XYZ_NORM ? std::hypot(along(0), along(1), along(2)) : std::abs(along(i));
    const double limit = order == 0   ? limits_.velocity[n]
                         : order == 1 ? limits_.acceleration[n]
                                      : limits_.jerk[n];
    return value / (period_power_[static_cast<std::size_t>(order)] * limit);
}

/// Evaluates every cycle of a short move, and some cycles of a long one.
void Estimator::count(const ExecutorOutput &out) {
    if (out.move != 0 && out.move != move_) {
        close_move();
        move_ = out.move;
    }
    ++move_cycles_;
    move_top_ = std::max(move_top_, std::abs(out.velocity));
    const bool is_first_half = out.distance_to_go >= 0.5 * store_->primitive(move_).length;
    move_middle_ = is_first_half ? std::abs(out.velocity) : move_middle_;
    constexpr std::uint64_t EACH = 64, EVERY = 8;
    const bool isShort = move_cycles_ <= EACH;
    const std::uint64_t phase = move_cycles_ % EVERY;
    const bool isDue = isShort || phase == 0;
    if (!isDue && phase <= EVERY - last_.size()) {
        kept_ = 0;
        return;
    }
    last_ = {out.position, last_[0], last_[1], last_[2]};
    kept_ = std::min(kept_ + 1, last_.size());
    if (!isDue || kept_ < last_.size()) {
        return;
    }
    const std::uint64_t weight = isShort ? 1 : EVERY;
    const int orders = limits_.isJerkLimited ? 3 : 2;
    for (int order = 0; order < orders; ++order) {
        for (int i = 0; i < LIMITED_COUNT; ++i) {
            bound_[static_cast<std::size_t>(order)][static_cast<std::size_t>(i)] +=
                ratio(i, order) > NEAR ? weight : 0;
        }
    }
}

void Estimator::close_move() {
    if (move_ == 0 || move_cycles_ == 0) {
        return;
    }
    MoveEstimate e;
    e.tag = store_->move(move_);
    e.seconds = static_cast<double>(move_cycles_) * period_s_;
    if (skipped_ > 0 && move_middle_ > 0) {
        skipped_s_ += skipped_ / move_middle_;
        e.seconds += skipped_ / move_middle_;
    }
    const double length =
        (store_->primitive(move_).length + std::exchange(skipped_, 0.0)) / std::max(e.tag.feed_ratio, 1e-300);
    const double feed = scales_.feed * e.tag.requested_velocity;
    e.seconds_at_feed = feed > 0 ? length / feed : 0.0;
    e.top_velocity = move_top_ / std::max(e.tag.feed_ratio, 1e-300);
    const bool isAtFeed = e.tag.requested_velocity > 0 && e.seconds <= AT_FEED * e.seconds_at_feed;
    if (!isAtFeed) {
        e.binding = Binding::TOLERANCE;
        std::uint64_t most = 0;
        for (std::size_t order = 0; order < bound_.size(); ++order) {
            for (std::size_t i = 0; i < bound_[order].size(); ++i) {
                if (bound_[order][i] > most) {
                    most = bound_[order][i];
                    e.binding = static_cast<Binding>(static_cast<std::size_t>(Binding::VELOCITY) + order);
                    e.axis = static_cast<int>(i);
                }
            }
        }
    }
    bound_ = {};
    move_cycles_ = 0;
    move_top_ = move_middle_ = 0;
    listener_(e);
}

}  // namespace mw::trajectory

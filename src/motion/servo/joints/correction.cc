// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/joints/correction.hh"

#include <algorithm>
#include <cmath>

#include "motion/interface/limits.hh"

namespace mw::motion {

namespace {

/// Part of the joint's speed, acceleration and jerk that corrections may use in addition to its motion.
constexpr double SHARE = 0.5;
static_assert(STEEPEST_SCREW < SHARE);
/// A change of the mode may move a joint by this much (`sides`); it is not a commanded move.
constexpr double MODE_ROUNDING = 2e-6;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Position of the slide within the backlash when the motor moves to `motor`.
double pushed_slide(const Correction &c, double motor, double backlash) noexcept {
    return std::clamp(c.slide, motor - 0.5 * backlash, motor + 0.5 * backlash);
}

/// The motor pushes the slide to its position, in the direction of travel. Where the joint reverses before
/// the backlash is compensated, the slide has stayed behind.
void choose_side(Correction &c, double position, double backlash) noexcept {
    const double missing = position - pushed_slide(c, position + c.position, backlash);
    if (std::abs(missing) > TURN_ROUNDING * (1.0 + std::abs(position))) {
        c.side = missing > 0 ? 1 : -1;
    }
}

/// Acceleration and averaging time of corrections.
struct Means {
    double acceleration = 0;
    std::uint32_t samples = 1;  ///< samples of the moving average that limits the jerk; 1: no limit
};

/// The averaging time that covers a distance `d`, or a speed change `dv`, soonest with the jerk j: the
/// reference gets the acceleration j tau / 2 and takes 2 sqrt(2 d / (j tau)) or 2 dv / (j tau); the average
/// adds tau.
double mean_for(double d, double dv, double jerk) noexcept {
    return std::max(std::cbrt(2.0 * d / jerk), std::sqrt(2.0 * dv / jerk));
}

Means means_of(const Correction &c, const Settings &settings, int joint, double period_s) noexcept {
    Means means{SHARE * settings.get(Parameter::JOINT_MAX_ACCELERATION, joint)};
    double jerk = settings.get(Parameter::JOINT_MAX_JERK, joint);
    if (!settings.isSet(Parameter::JOINT_IS_ANGULAR, joint)) {
        jerk = std::min(jerk, settings.get(Parameter::TRAJ_MAX_JERK));
    }
    if (!isJerkLimited(settings) || !(jerk < NO_JERK_LIMIT) || !(jerk > 0)) {
        return means;
    }
    constexpr double MOST = MovingMean::MOST_SAMPLES;
    const bool hasTable = c.table.count > 0;
    const double way = hasTable ? c.table.widest : settings.get(Parameter::JOINT_BACKLASH, joint);
    const double bend = hasTable ? c.table.steepest * settings.get(Parameter::JOINT_MAX_VELOCITY, joint) : 0;
    const double most_s = 2.0 * means.acceleration / (SHARE * jerk);
    const double mean_s = std::min(most_s, mean_for(std::abs(way), 2.0 * bend, SHARE * jerk));
    const double samples = std::ceil(mean_s / period_s - 1e-9);
    means.samples = c.mean.length(static_cast<std::uint32_t>(std::clamp(samples, 2.0, MOST)));
    means.acceleration = std::min(means.acceleration, 0.5 * SHARE * jerk * means.samples * period_s);
    return means;
}

/// The correction of the table changes with the joint; the missing part is added within the remaining limits.
void follow_table(Correction &c, double position, double period_s) noexcept {
    const double before = look_up(c.table, c.side, c.last_position);
    c.raw = look_up(c.table, c.side, position);
    const double velocity = (c.raw - before) / period_s;
    c.follower.position = c.followed - before;
    c.follower.velocity = c.followed_velocity - velocity;
    c.follower.target = 0;
    c.follower.step(period_s);
    c.followed = c.raw + c.follower.position;
    c.followed_velocity = velocity + c.follower.velocity;
}

}  // namespace

Reason take(ScrewTable &table, const LoadCompensation &point) noexcept {
    if (point.index == 0 || point.count == 0) {
        table.count = 0;
        table.filled = 0;
        table.steepest = 0;
        table.widest = 0;
    }
    if (point.count == 0) {
        return Reason::NONE;
    }
    const bool isNext = point.count > 0 && point.count <= MAX_SCREW_POINTS && table.count == 0 &&
                        point.index == table.filled && point.index < point.count;
    if (!isNext) {
        return Reason::OUT_OF_RANGE;
    }
    if (!std::isfinite(point.nominal) || !std::isfinite(point.forward) || !std::isfinite(point.reverse)) {
        table.filled = 0;
        return Reason::NOT_A_NUMBER;
    }
    const std::size_t n = at(point.index);
    if (point.index > 0) {
        const double way = point.nominal - table.nominal[n - 1];
        const double rise = std::max(std::abs(point.forward - table.forward[n - 1]),
                                     std::abs(point.reverse - table.reverse[n - 1]));
        if (!(way > 0) || !(rise <= STEEPEST_SCREW * way)) {
            table.filled = 0;
            return Reason::OUT_OF_RANGE;
        }
        table.steepest = std::max(table.steepest, rise / way);
    }
    table.widest = std::max(table.widest, std::abs(point.forward - point.reverse));
    table.nominal[n] = point.nominal;
    table.forward[n] = point.forward;
    table.reverse[n] = point.reverse;
    ++table.filled;
    table.count = table.filled == point.count ? point.count : 0;
    return Reason::NONE;
}

double look_up(const ScrewTable &table, int side, double position) noexcept {
    if (side == 0 || table.count == 0) {
        return 0;
    }
    const auto &curve = side > 0 ? table.forward : table.reverse;
    const double *const first = table.nominal.data();
    const double *const end = first + table.count;
    const auto above = static_cast<std::size_t>(std::upper_bound(first, end, position) - first);
    if (above == 0) {
        return curve[0];
    }
    if (above == at(table.count)) {
        return curve[above - 1];
    }
    const double part =
        (position - table.nominal[above - 1]) / (table.nominal[above] - table.nominal[above - 1]);
    return curve[above - 1] + part * (curve[above] - curve[above - 1]);
}

/// Adds without loss of the digits that a double cannot hold (two-sum).
void MovingMean::add(double x) noexcept {
    const double s = sum_ + x;
    const double back = s - sum_;
    rest_ += (sum_ - (s - back)) + (x - back);
    sum_ = s;
}

void MovingMean::reset(double x) noexcept {
    way_.fill(0.0);
    origin_ = x;
    last_ = x;
    sum_ = 0;
    rest_ = 0;
    next_ = 0;
    standing_ = MOST_SAMPLES;
}

double MovingMean::step(double x, std::uint32_t length) noexcept {
    if (length != length_ && standing_ >= length_) {
        length_ = length;
        reset(last_);
    }
    standing_ = x == last_ ? std::min(standing_ + 1, MOST_SAMPLES) : 0;
    last_ = x;
    if (length_ <= 1) {
        return x;
    }
    const double way = x - origin_;
    add(way);
    add(-way_[next_]);
    way_[next_] = way;
    next_ = next_ + 1 == length_ ? 0 : next_ + 1;
    return isAtRest() ? x : origin_ + (sum_ + rest_) / length_;
}

void step(Correction &c, const Settings &settings, int joint, double position, double period_s) noexcept {
    c.isHeld = c.isHeld && std::abs(position - c.extreme) <= MODE_ROUNDING;
    if (c.isHeld) {
        return;
    }
    const double backlash = settings.get(Parameter::JOINT_BACKLASH, joint);
    if (isIdle(c, backlash)) {
        follow_idle(c, position);
        return;
    }
    follow_side(c, position);
    const double velocity = settings.get(Parameter::JOINT_MAX_VELOCITY, joint);
    const Means means = means_of(c, settings, joint, period_s);
    c.follower.max_acceleration = means.acceleration;
    if (c.table.count > 0) {
        c.follower.max_velocity = (SHARE - c.table.steepest) * velocity;
        follow_table(c, position, period_s);
    } else {
        if (c.isSlideKnown) {
            choose_side(c, position, backlash);
        }
        c.raw = 0.5 * backlash * c.side;
        c.follower.target = c.raw;
        c.follower.max_velocity = SHARE * velocity;
        c.follower.step(period_s);
        c.followed = c.follower.position;
        c.followed_velocity = c.follower.velocity;
    }
    const double before = c.position;
    c.position = c.mean.step(c.followed, means.samples);
    c.slide = c.isSlideKnown ? pushed_slide(c, position + c.position, backlash) : c.slide;
    c.velocity = means.samples > 1 ? (c.position - before) / period_s : c.followed_velocity;
    const bool isTakenUp = c.side != 0 && c.table.count == 0 && c.position == c.raw;
    if (isTakenUp && !c.isSlideKnown) {
        c.slide = position;
        c.isSlideKnown = true;
    }
    c.last_position = position;
}

double renumber(Correction &c, double position) noexcept {
    const double by = c.table.count > 0 ? look_up(c.table, c.side, position) - c.raw : 0.0;
    c.raw += by;
    c.followed += by;
    c.position += by;
    c.mean.shift(by);
    c.last_position = position;
    c.extreme = position;
    c.isSlideKnown = false;
    return by;
}

void follow(Correction &c, double position) noexcept {
    renumber(c, position);
    c.isHeld = true;
    if (!c.isAtRest()) {  // it stops here, and continues with the joint's next move
        c.followed = c.position;
        c.follower.position = c.table.count > 0 ? c.position - c.raw : c.position;
        c.follower.velocity = 0;
        c.followed_velocity = 0;
        c.velocity = 0;
        c.mean.reset(c.position);
    }
}

double clear(Correction &c) noexcept {
    const double was = c.position;
    c.isHeld = false;
    c.isSlideKnown = false;
    c.raw = 0;
    c.side = 0;
    c.follower = {};
    c.followed = 0;
    c.followed_velocity = 0;
    c.position = 0;
    c.velocity = 0;
    c.mean.reset(0);
    return was;
}

}  // namespace mw::motion

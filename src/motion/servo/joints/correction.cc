// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/joints/correction.hh"

#include <algorithm>
#include <cmath>

#include "motion/interface/limits.hh"

namespace mw::motion {

namespace {

/// Fraction of the joint's speed, acceleration and jerk that corrections may use in addition.
constexpr double SHARE = 0.5;
static_assert(STEEPEST_SCREW < SHARE);
/// A mode change may move a joint by this much (`sides`), which is not a commanded move.
constexpr double MODE_ROUNDING = 2e-6;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Position of the slide within the backlash after the motor moves to `motor`.
double pushed_slide(const Correction &c, double motor, double backlash) noexcept {
    return std::clamp(c.slide, motor - 0.5 * backlash, motor + 0.5 * backlash);
}

/// The motor pushes the slide in the direction of travel. If the joint reverses before the backlash is
/// compensated, the slide has stayed behind.
void choose_side(Correction &c, double position, double backlash) noexcept {
    const double missing = position - pushed_slide(c, position + c.position, backlash);
    if (std::abs(missing) > TURN_ROUNDING * (1.0 + std::abs(position))) {
        c.side = missing > 0 ? 1 : -1;
    }
}

/// The fraction of the joint's limits for corrections.
trajectory::FollowLimits limits_of(const Settings &settings, int joint) noexcept {
    double jerk = settings.get(Parameter::JOINT_MAX_JERK, joint);
    if (!settings.isSet(Parameter::JOINT_IS_ANGULAR, joint)) {
        jerk = std::min(jerk, settings.get(Parameter::TRAJ_MAX_JERK));
    }
    const bool hasJerk = isJerkLimited(settings) && jerk < NO_JERK_LIMIT && jerk > 0;
    return {SHARE * settings.get(Parameter::JOINT_MAX_VELOCITY, joint),
            SHARE * settings.get(Parameter::JOINT_MAX_ACCELERATION, joint), hasJerk ? SHARE * jerk : 0.0,
            -UNBOUNDED, UNBOUNDED};
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
    if (c.table.count > 0) {
        c.raw = look_up(c.table, c.side, position);
    } else {
        if (c.isSlideKnown) {
            choose_side(c, position, backlash);
        }
        c.raw = 0.5 * backlash * c.side;
    }
    c.follower.follow(c.raw, limits_of(settings, joint), period_s);
    c.position = c.follower.position();
    c.velocity = c.follower.velocity();
    c.slide = c.isSlideKnown ? pushed_slide(c, position + c.position, backlash) : c.slide;
    const bool isTakenUp = c.side != 0 && c.table.count == 0 && c.position == c.raw;
    if (isTakenUp && !c.isSlideKnown) {
        c.slide = position;
        c.isSlideKnown = true;
    }
}

double renumber(Correction &c, double position) noexcept {
    const double by = c.table.count > 0 ? look_up(c.table, c.side, position) - c.raw : 0.0;
    c.raw += by;
    c.position += by;
    c.follower.shift(by);
    c.extreme = position;
    c.isSlideKnown = false;
    return by;
}

void follow(Correction &c, double position) noexcept {
    renumber(c, position);
    c.isHeld = true;
    if (!c.isAtRest()) {  // the correction stops here and continues with the joint's next move
        c.follower.reset(c.position);
        c.velocity = 0;
    }
}

double clear(Correction &c) noexcept {
    const double was = c.position;
    c.isHeld = false;
    c.isSlideKnown = false;
    c.raw = 0;
    c.side = 0;
    c.follower.reset(0);
    c.position = 0;
    c.velocity = 0;
    return was;
}

}  // namespace mw::motion

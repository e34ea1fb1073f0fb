// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/judge.hh"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace mw::campaign {
namespace {

/// Rounding errors of positions and of their differences [units, relative].
constexpr double PLACE_ROUNDING = 2e-6, RATE_ROUNDING = 1e-5;
/// Corrections of the motor position are added to the motion of the joint.
constexpr double WITH_BACKLASH = 1.5;
/// Permitted duration of a stop: a factor of the minimum, plus the transfer time of commands.
constexpr double STOP_FACTOR = 1.3, STOP_SLACK_S = 0.01;
/// Interval of the checks during a stop [cycles].
constexpr int LOOK_EVERY = 16;
/// Time until commands in transfer at the stop are discarded [cycles].
constexpr int IN_FLIGHT = 6;
constexpr double MOVED = 1e-9;
constexpr double COUNTS_AT_INDEX = 2.1;

testing::LimitChecker checker_of(const JointDesign &j, bool isJerk, double period_s) {
    const double more = j.isCorrected() ? WITH_BACKLASH : 1.0;
    testing::AxisLimit limit;
    limit.velocity = j.velocity * more;
    limit.acceleration = j.acceleration * more;
    if (isJerk && j.jerk > 0) {
        limit.jerk = j.jerk * more;
    }
    return {{limit}, period_s, RATE_ROUNDING};
}

/// Position of an axis: the jogged or programmed position plus its external offset.
double axis_place(const Sample &s, int axis) {
    return s.axes[axis] + s.offsets[axis];
}

}  // namespace

Judge::Judge(const Design &design, double period_s) : design_(design), period_(period_s) {
    for (const JointDesign &j : design.joints) {
        joints_.push_back({checker_of(j, false, period_s), checker_of(j, design.isJerkLimited, period_s)});
    }
    stop_.path.motors.resize(design.joints.size());
    build_up_s_ = build_up_s();
    velocity_.assign(design.joints.size(), 0);
    before_.assign(design.joints.size(), 0);
}

void Judge::fail(const std::string &rule, const std::string &text) {
    if (known.contains(rule)) {
        ++broken_known_[rule];
    } else if (report_.empty()) {
        report_ = fmt::format("{}: cycle {}: {}", rule, last_.cycle, text);
    }
}

void Judge::allow(Leave leave) {
    allowed_.isSwitchingOn = allowed_.isSwitchingOn || leave == Leave::SWITCH_ON;
    allowed_.isMotion = allowed_.isMotion || leave != Leave::SWITCH_ON;
    allowed_.isWork = allowed_.isWork || leave == Leave::WORK;
}

void Judge::stop(Stop how, int delay) {
    const bool isWorse = stop_.isAwaited && stop_.how > how;
    if (isWorse) {
        return;
    }
    const bool isSame = stop_.isAwaited && how == Stop::ALONG_THE_PATH;
    if (!isSame) {
        stop_.delay = delay;
        stop_.since = 0;
        begin_stop();
    }
    stop_.how = how;
    stop_.isAwaited = true;
    restless_ = delay + IN_FLIGHT;
    allowed_.isSwitchingOn = allowed_.isMotion = allowed_.isWork = false;
}

/// The path begins with the samples that define the initial speed.
void Judge::begin_stop() {
    constexpr std::size_t KEPT = 3;
    AwaitedStop::Path &path = stop_.path;
    const std::size_t old = path.axes.size() - std::min(path.axes.size(), KEPT);
    const auto forget = [old](auto &samples) {
        samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(old));
    };
    forget(path.axes);
    for (std::vector<double> &motor : path.motors) {
        forget(motor);
    }
    path.areAxesKnown = last_.areAxesKnown;
}

/// Time in which corrections stop. They are independent of the motion to which they are added.
double Judge::time_to_correct() const {
    double most = 0;
    for (const JointDesign &d : design_.joints) {
        const double way = d.isCorrected() ? d.play + 2 * d.screw_error : 0;
        const bool isOfPath = !d.isAngular && design_.jerk > 0 && (d.jerk <= 0 || design_.jerk < d.jerk);
        const double jerk = isOfPath ? design_.jerk : d.jerk;
        const bool hasJerk = design_.isJerkLimited && jerk > 0 && way > 0;
        // Corrections may use half of the limits.
        most = std::max(most, 2 * std::sqrt(2 * way / d.acceleration) + 2 * way / d.velocity +
                                  (hasJerk ? 2.5 * d.acceleration / jerk : 0));
    }
    return most;
}

double Judge::time_to_brake() const {
    double most = 0;
    for (const JointDesign &d : design_.joints) {
        most = std::max(most, d.velocity / d.acceleration);
    }
    for (const AxisDesign &a : design_.axes) {
        most = std::max(most, a.velocity / a.acceleration);
    }
    return most + 3 * design_.rise_s();
}

double Judge::time_to_be_sure() const {
    return 2 * design_.rise_s() + (design_.hasOffsets() ? time_to_brake() : 0);
}

/// Minimum stopping time from the accelerations of joints and axes along the path since the stop, plus the
/// time to build up the accelerations if jerk is limited.
LeastStop Judge::time_to_stop() const {
    std::vector<StoppingGroup> groups;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointDesign &d = design_.joints[j];
        groups.push_back({{stop_.path.motors[j]}, built_up(d.isAngular, d.acceleration, d.jerk)});
    }
    StoppingGroup linear{{}, design_.acceleration};
    double least_s = 0;
    for (const AxisDesign &a : design_.axes) {
        std::vector<double> places;
        for (const geometry::Pose &pose : stop_.path.axes) {
            places.push_back(pose[a.axis]);
        }
        if (!stop_.path.areAxesKnown) {
            continue;
        }
        const double jerk = design_.isJerkLimited ? a.jerk : 0;
        least_s = std::max(least_s, least_stop_with_jerk(places, jerk, period_));
        groups.push_back({{places}, built_up(geometry::isAngular(a.axis), a.acceleration_of_path(), a.jerk)});
        if (!geometry::isAngular(a.axis)) {
            linear.places.push_back(places);
        }
    }
    if (!linear.places.empty()) {
        groups.push_back(linear);
    }
    LeastStop stop = least_stop(groups, period_);
    stop.seconds = std::max(stop.seconds + time_of_jerk(), least_s);
    return stop;
}

/// The longest time in which a linear axis or joint builds up its acceleration. It also applies to angular
/// axes: docs/developer/planner.md, "Known limits".
double Judge::build_up_s() const {
    double most = 0;
    const auto look = [&](bool isAngular, double acceleration, double jerk) {
        most = !isAngular && jerk > 0 ? std::max(most, acceleration / jerk) : most;
    };
    for (const JointDesign &d : design_.joints) {
        look(d.isAngular, d.acceleration, d.jerk);
    }
    for (const AxisDesign &a : design_.axes) {
        look(geometry::isAngular(a.axis), a.acceleration, a.jerk);
    }
    return most;
}

double Judge::built_up(bool isAngular, double acceleration, double jerk) const {
    const bool isShort = design_.isJerkLimited && isAngular && jerk > 0 && build_up_s_ > 0;
    return isShort ? std::min(acceleration, jerk * build_up_s_) : acceleration;
}

/// Time to build up the acceleration of the axes and joints that move when a stop begins or while its command
/// is in transfer.
double Judge::time_of_jerk() const {
    constexpr double UP_AND_DOWN = 2.5;
    double most = 0;
    for (std::size_t j = 0; j < joints_.size() && design_.isJerkLimited && stop_.path.axes.size() > 1; ++j) {
        const JointDesign &d = design_.joints[j];
        const std::vector<double> &motor = stop_.path.motors[j];
        const std::size_t soon = std::min(motor.size() - 1, static_cast<std::size_t>(IN_FLIGHT));
        const bool isMoving = std::abs(motor[soon] - motor[0]) > MOVED;
        if (!isMoving) {
            continue;
        }
        double a = d.acceleration;
        double jerk = d.jerk;
        // A single joint that moves alone uses its own limits.
        const double least =
            !d.isAngular && design_.jerk > 0 && (jerk <= 0 || design_.jerk < jerk) ? design_.jerk : jerk;
        most = least > 0 ? std::max(most, built_up(d.isAngular, a, least) / least) : most;
        for (const AxisDesign &x : design_.axes) {
            // The limit of an axis may limit any joint.
            a = std::min(a, x.acceleration);
            jerk = x.jerk > 0 ? (jerk > 0 ? std::min(jerk, x.jerk) : x.jerk) : jerk;
        }
        a = d.isAngular ? a : std::min(a, design_.acceleration);
        jerk = design_.jerk > 0 ? (jerk > 0 ? std::min(jerk, design_.jerk) : design_.jerk) : jerk;
        most = jerk > 0 ? std::max(most, a / jerk) : most;
    }
    return UP_AND_DOWN * most;
}

void Judge::sample(const Sample &s) {
    const bool isFirst = count_++ == 0;
    if (isFirst) {
        last_ = s;
    }
    check_numbers(s);
    check_amplifiers(s);
    check_limits(s);
    check_room(s);
    check_homes(s);
    check_outputs(s);
    take_for_stop(s);
    check_rest(s);
    check_places(s);
    restless_ = std::max(0, restless_ - 1);
    last_ = s;
}

/// Keeps only the last samples until a stop begins.
void Judge::take_for_stop(const Sample &s) {
    stop_.path.axes.push_back(s.axes);
    stop_.path.areAxesKnown = stop_.path.areAxesKnown && s.areAxesKnown;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        stop_.path.motors[j].push_back(s.joints[j].motor_place());
    }
    if (!stop_.isAwaited) {
        begin_stop();
    }
}

void Judge::check_numbers(const Sample &s) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        if (q.isAmpOn && !(std::isfinite(q.pos_cmd) && std::isfinite(q.motor_cmd))) {
            fail("number", fmt::format("joint {} is commanded to {} with its amplifier on", j, q.motor_cmd));
        }
        if (q.isAmpOn && !std::isfinite(q.motor_fb)) {
            fail("amp", fmt::format("joint {} is on with a feedback of {}", j, q.motor_fb));
        }
    }
    if (!std::isfinite(s.spindle_rpm)) {
        fail("number", "speed of the spindle");
    }
}

void Judge::check_amplifiers(const Sample &s) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        const JointSample &before = last_.joints[j];
        const JointDesign &d = design_.joints[j];
        if (q.isAmpOn && !(s.isChainClosed && s.isEnableOn)) {
            fail("amp", fmt::format("joint {} is on in an e-stop", j));
        }
        if (q.isAmpOn && q.isAmpFaulted) {
            fail("amp", fmt::format("joint {} is on with an amplifier fault", j));
        }
        const double lag = std::abs(q.pos_cmd - q.pos_fb);
        const double v = std::max(std::abs(q.pos_cmd - before.pos_cmd) / period_, std::abs(before_[j]));
        // Motion reads the feedback before it calculates the next command, which is one cycle of travel
        // ahead.
        const double most = std::max(d.ferror * v / d.velocity, d.min_ferror) + v * period_;
        if (q.isAmpOn && before.isAmpOn && !q.isHoming && lag > 1.01 * most + PLACE_ROUNDING) {
            fail("amp", fmt::format("joint {} is on with a following error of {:.6g}, {:.6g} allowed", j, lag,
                                    most));
        }
        const bool isRise = q.isAmpOn && !before.isAmpOn;
        if (isRise && q.offset != 0) {
            fail("offset",
                 fmt::format("joint {} is switched on with an external offset of {:.6g}", j, q.offset));
        }
        if (isRise && !allowed_.isSwitchingOn) {
            fail("energise", fmt::format("amplifier of joint {} comes on by itself", j));
        }
        // For a joint that is moved from outside, the feedback of the previous cycle counts, which motion has
        // read.
        const double step =
            std::min(std::abs(q.motor_cmd - q.motor_fb), std::abs(q.motor_cmd - before.motor_fb));
        if (isRise && step > d.velocity * period_ + PLACE_ROUNDING) {
            fail("step", fmt::format("joint {} is switched on {:.6g} from where its motor is", j, step));
        }
    }
    const bool isStopped = !(s.isChainClosed && s.isEnableOn);
    if (isStopped && (s.isSpindleOn || s.spindle_rpm != 0)) {
        fail("spindle", fmt::format("turns at {} in an e-stop", s.spindle_rpm));
    }
}

void Judge::check_limits(const Sample &s) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        JointJudge &judge = joints_[j];
        if (!q.isAmpOn) {
            judge.speed.restart();
            judge.jerk.restart();
            velocity_[j] = before_[j] = 0;
            continue;
        }
        const double place = q.motor_cmd + q.turned;
        velocity_[j] = last_.joints[j].isAmpOn
                           ? (place - last_.joints[j].motor_cmd - last_.joints[j].turned) / period_
                           : 0;
        const bool isIndex = q.resets != last_.joints[j].resets && last_.joints[j].isAmpOn;
        if (isIndex) {
            // The command continues with the accuracy of the encoder counts.
            const double counts = COUNTS_AT_INDEX / design_.joints[j].counts_per_unit;
            const double most = counts + design_.joints[j].acceleration * period_ * period_;
            const double step = (velocity_[j] - before_[j]) * period_;
            // After wrong encoder counts the slide may be at any position within the travel of a cycle.
            if (last_.joints[j].isTruthKnown && std::abs(step) > most) {
                fail("step", fmt::format("joint {} deviates by {:.6g} from its path at the index", j, step));
            }
            judge.speed.restart();
            velocity_[j] = before_[j];
        }
        before_[j] = velocity_[j];
        judge.speed.sample(&place);
        // Moves of homing may stop without a jerk limit, also when homing is aborted.
        const bool isHoming = q.isHoming || last_.joints[j].isHoming;
        judge.isUnjerked = isHoming || (judge.isUnjerked && std::abs(velocity_[j]) > MOVED);
        if (judge.isUnjerked) {
            judge.jerk.restart();
        } else {
            judge.jerk.sample(&place);
        }
        for (testing::LimitChecker *c : {&judge.speed, &judge.jerk}) {
            if (!c->isWithin()) {
                const std::string first = c->report().substr(0, c->report().find('\n'));
                const std::string what = first.substr(first.find(':') + 2);
                fail(what.starts_with('j') ? "jerk" : "limit", fmt::format("joint {}: {}", j, what));
                *c = checker_of(design_.joints[j], c == &judge.jerk && design_.isJerkLimited, period_);
            }
        }
    }
}

/// Soft limits: a joint within the limits stays within them; a joint outside them does not move farther out.
void Judge::check_room(const Sample &s) {
    const auto leaves = [](double before, double now, double low, double high) {
        return (now > high + PLACE_ROUNDING && now > before + MOVED) ||
               (now < low - PLACE_ROUNDING && now < before - MOVED);
    };
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        const JointSample &before = last_.joints[j];
        const JointDesign &d = design_.joints[j];
        const bool isJudged = q.isAmpOn && before.isAmpOn && q.isHomed && before.isHomed;
        const double back = back_to ? back_to->joints[j].pos_cmd : d.low;
        double low = std::min(d.low, back);
        double high = std::max(d.high, back);
        for (std::size_t k = 0; design_.isTrivial && k < joints_.size(); ++k) {
            // Gantry sides that coasted outside a limit align at the position of one of them.
            const bool isSide = design_.coordinates[k] == design_.coordinates[j];
            low = isSide ? std::min(low, last_.joints[k].pos_cmd) : low;
            high = isSide ? std::max(high, last_.joints[k].pos_cmd) : high;
        }
        if (isJudged && leaves(before.pos_cmd, q.pos_cmd, low, high)) {
            fail("room", fmt::format("joint {} goes to {:.9g}", j, q.pos_cmd));
        }
    }
    const bool areOn = s.joints[0].isAmpOn && last_.joints[0].isAmpOn;
    for (const AxisDesign &a : design_.axes) {
        const bool isJudged = areOn && s.areAxesKnown && last_.areAxesKnown;
        const double back = back_to ? axis_place(*back_to, a.axis) : a.low;
        const double now = axis_place(s, a.axis);
        if (isJudged &&
            leaves(axis_place(last_, a.axis), now, std::min(a.low, back), std::max(a.high, back))) {
            fail("room", fmt::format("axis {} goes to {:.9g}", geometry::AXIS_LETTERS[a.axis], now));
        }
    }
}

void Judge::check_outputs(const Sample &s) {
    const bool isRising = (s.isSpindleOn && !last_.isSpindleOn) ||
                          (s.spindle_rpm != 0 && last_.spindle_rpm == 0) || (s.outputs & ~last_.outputs) != 0;
    if (isRising && !allowed_.isWork && restless_ == 0) {
        fail("energise",
             fmt::format("spindle at {}, outputs {:x} come on by themselves", s.spindle_rpm, s.outputs));
    }
}

void Judge::check_rest(const Sample &s) {
    bool isMoving = false, isOffsetMoving = false;
    bool isOn = false, wasOn = false;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        isOn = isOn || q.isAmpOn;
        wasOn = wasOn || last_.joints[j].isAmpOn;
        isOffsetMoving = isOffsetMoving || q.offset != last_.joints[j].offset;
        isMoving = isMoving || (q.isAmpOn && last_.joints[j].isAmpOn &&
                                std::abs(q.motor_place() - last_.joints[j].motor_place()) > MOVED);
    }
    if (wasOn && !isOn) {
        allowed_.isSwitchingOn = allowed_.isMotion = allowed_.isWork = false;
        restless_ = std::max(restless_, IN_FLIGHT);
    }
    offsets_standing_ = isOffsetMoving ? 0 : offsets_standing_ + 1;
    const bool wasAtRest = isAtRest();
    standing_ = isMoving ? 0 : standing_ + 1;
    check_stale(s, wasAtRest);
    if (!stop_.isAwaited) {
        return;
    }
    watch_stop(isMoving, isOn);
}

void Judge::watch_stop(bool isMoving, bool isOn) {
    ++stop_.since;
    if (stop_.since <= stop_.delay) {
        begin_stop();  // motion has not received the stop
        return;
    }
    const int cycles = stop_.since - stop_.delay;
    if (stop_.how == Stop::AT_ONCE) {
        if (isOn) {
            fail("stop", "amplifiers are on in the cycle of what must switch them off");
        }
        stop_.isAwaited = false;
        return;
    }
    const bool isStanding = standing_ >= 3 && cycles >= 3;
    if (isStanding || !isOn || cycles % LOOK_EVERY == 0) {
        check_stop(isMoving && isOn, (cycles - standing_) * period_);
    }
    if (isStanding || !isOn) {
        const int off_within = 10 + static_cast<int>(time_to_be_sure() / period_);
        const bool mustBeOff = stop_.how == Stop::ALONG_THEN_OFF;
        const int since = std::min(standing_, cycles);  // it may have stopped long before
        if (mustBeOff && isOn && since > off_within) {
            fail("stop", "the machine is stopped, and its amplifiers stay on");
        }
        stop_.isAwaited = mustBeOff && isOn && since <= off_within;
    }
}

void Judge::check_stop(bool isMoving, double took_s) {
    const LeastStop least = time_to_stop();
    if (isMoving && !least.isOver) {
        return;  // the path since the stop is too short for any stop
    }
    const double corrections_s = time_to_correct() + stops_later_s;
    if (took_s > std::max(STOP_FACTOR * least.seconds, least.seconds + STOP_SLACK_S) + corrections_s) {
        fail("stop", fmt::format("{} {:.3f} s after the stop; its limits need {:.3f} s",
                                 isMoving ? "still moves" : "stops", took_s, least.seconds));
        stop_.isAwaited = false;
    }
    constexpr double WORTH_A_LOOK_S = 0.05;
    if (!isMoving && least.seconds > WORTH_A_LOOK_S) {
        slowest_stop_ = std::max(slowest_stop_, (took_s - corrections_s) / least.seconds);
    }
}

}  // namespace mw::campaign

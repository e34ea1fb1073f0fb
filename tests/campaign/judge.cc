// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/judge.hh"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace mw::campaign {
namespace {

/// What rounding may make of positions and of differences of them [units, relative].
constexpr double PLACE_ROUNDING = 2e-6, RATE_ROUNDING = 1e-5;
/// With backlash the motor has to make up for it on top of the joint's motion.
constexpr double WITH_BACKLASH = 1.5;
/// What a stop may take of the least, and on top of it for commands on their way.
constexpr double STOP_FACTOR = 2.2, STOP_SLACK_S = 0.02;
/// How often a stop under way is judged [cycles].
constexpr int LOOK_EVERY = 16;
/// Until commands that were on their way when the machine was stopped have been dropped [cycles].
constexpr int IN_FLIGHT = 6;
constexpr double MOVED = 1e-9;
constexpr double COUNTS_AT_INDEX = 2.1;

testing::LimitChecker checker_of(const JointDesign &j, bool isJerk, double period_s) {
    const double more = j.backlash > 0 ? WITH_BACKLASH : 1.0;
    testing::AxisLimit limit;
    limit.velocity = j.velocity * more;
    limit.acceleration = j.acceleration * more;
    if (isJerk && j.jerk > 0) {
        limit.jerk = j.jerk * more;
    }
    return {{limit}, period_s, RATE_ROUNDING};
}

}  // namespace

Judge::Judge(const Design &design, double period_s) : design_(design), period_(period_s) {
    for (const JointDesign &j : design.joints) {
        joints_.push_back({checker_of(j, false, period_s), checker_of(j, design.isJerkLimited, period_s)});
    }
    stop_path_.motors.resize(design.joints.size());
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
    maySwitchOn_ = maySwitchOn_ || leave == Leave::SWITCH_ON;
    mayMove_ = mayMove_ || leave != Leave::SWITCH_ON;
    mayWork_ = mayWork_ || leave == Leave::WORK;
}

void Judge::stop(Stop how, int delay) {
    const bool isWorse = isStopAwaited_ && how_ > how;
    if (isWorse) {
        return;
    }
    const bool isSame = isStopAwaited_ && how == Stop::ALONG_THE_PATH;
    if (!isSame) {
        delay_ = delay;
        since_stop_ = 0;
        begin_stop();
    }
    how_ = how;
    isStopAwaited_ = true;
    restless_ = delay + IN_FLIGHT;
    maySwitchOn_ = mayMove_ = mayWork_ = false;
}

/// The path begins with the samples that tell the speed.
void Judge::begin_stop() {
    constexpr std::size_t KEPT = 3;
    const std::size_t old = stop_path_.axes.size() - std::min(stop_path_.axes.size(), KEPT);
    const auto forget = [old](auto &samples) {
        samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(old));
    };
    forget(stop_path_.axes);
    for (std::vector<double> &motor : stop_path_.motors) {
        forget(motor);
    }
    stop_path_.areAxesKnown = last_.areAxesKnown;
}

/// By the accelerations of joints and axes along the path that was taken since, and what building them up
/// takes where jerk is limited.
LeastStop Judge::time_to_stop() const {
    std::vector<StoppingGroup> groups;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointDesign &d = design_.joints[j];
        groups.push_back({{stop_path_.motors[j]}, built_up(d.isAngular, d.acceleration, d.jerk)});
    }
    StoppingGroup linear{{}, design_.acceleration};
    for (const AxisDesign &a : design_.axes) {
        std::vector<double> places;
        for (const geom::Pose &pose : stop_path_.axes) {
            places.push_back(pose[a.axis]);
        }
        if (!stop_path_.areAxesKnown) {
            continue;
        }
        groups.push_back({{places}, built_up(geom::isAngular(a.axis), a.acceleration, a.jerk)});
        if (!geom::isAngular(a.axis)) {
            linear.places.push_back(places);
        }
    }
    if (!linear.places.empty()) {
        groups.push_back(linear);
    }
    LeastStop stop = least_stop(groups, period_);
    stop.seconds += time_of_jerk();
    return stop;
}

/// Of all that is linear, the longest time in which an acceleration is built up. Angular axes get no longer:
/// docs/motion/planner.md, "Known limits".
double Judge::build_up_s() const {
    double most = 0;
    const auto look = [&](bool isAngular, double acceleration, double jerk) {
        most = !isAngular && jerk > 0 ? std::max(most, acceleration / jerk) : most;
    };
    for (const JointDesign &d : design_.joints) {
        look(d.isAngular, d.acceleration, d.jerk);
    }
    for (const AxisDesign &a : design_.axes) {
        look(geom::isAngular(a.axis), a.acceleration, a.jerk);
    }
    return most;
}

double Judge::built_up(bool isAngular, double acceleration, double jerk) const {
    const bool isShort = design_.isJerkLimited && isAngular && jerk > 0 && build_up_s_ > 0;
    return isShort ? std::min(acceleration, jerk * build_up_s_) : acceleration;
}

/// What building up accelerations takes of those who move as a stop begins.
double Judge::time_of_jerk() const {
    constexpr double UP_AND_DOWN = 2.5;
    double most = 0;
    for (std::size_t j = 0; j < joints_.size() && design_.isJerkLimited && stop_path_.axes.size() > 1; ++j) {
        const JointDesign &d = design_.joints[j];
        const std::vector<double> &motor = stop_path_.motors[j];
        const bool isMoving = std::abs(motor[1] - motor[0]) > MOVED;
        if (!isMoving) {
            continue;
        }
        double a = d.acceleration;
        double jerk = d.jerk;
        most = jerk > 0 ? std::max(most, built_up(d.isAngular, a, jerk) / jerk) : most;
        for (const AxisDesign &x : design_.axes) {
            // Who limits an axis may limit any joint.
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
    restless_ = std::max(0, restless_ - 1);
    last_ = s;
}

/// Until a stop begins, the last samples alone.
void Judge::take_for_stop(const Sample &s) {
    stop_path_.axes.push_back(s.axes);
    stop_path_.areAxesKnown = stop_path_.areAxesKnown && s.areAxesKnown;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        stop_path_.motors[j].push_back(s.joints[j].motor_cmd + s.joints[j].turned);
    }
    if (!isStopAwaited_) {
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
        // Motion sees the feedback before it makes the next command, a cycle's way farther on.
        const double most = std::max(d.ferror * v / d.velocity, d.min_ferror) + v * period_;
        if (q.isAmpOn && before.isAmpOn && !q.isHoming && lag > 1.01 * most + PLACE_ROUNDING) {
            fail("amp", fmt::format("joint {} is on with a following error of {:.6g}, {:.6g} allowed", j, lag,
                                    most));
        }
        const bool isRise = q.isAmpOn && !before.isAmpOn;
        if (isRise && !maySwitchOn_) {
            fail("energise", fmt::format("amplifier of joint {} comes on by itself", j));
        }
        // One that moves by itself is taken where motion has seen it, a cycle ago.
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
            // The command goes on as well as counts tell where the shaft is.
            const double counts = COUNTS_AT_INDEX / design_.joints[j].counts_per_unit;
            const double most = counts + design_.joints[j].acceleration * period_ * period_;
            const double step = (velocity_[j] - before_[j]) * period_;
            if (std::abs(step) > most) {
                fail("step", fmt::format("joint {} is led by {:.6g} off its way at the index", j, step));
            }
            judge.speed.restart();
            velocity_[j] = before_[j];
        }
        before_[j] = velocity_[j];
        judge.speed.sample(&place);
        // What homing has begun may stop without a jerk limit, also when it is given up.
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

/// Soft limits: what is within stays within, what is beyond goes no farther.
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
        if (isJudged && leaves(before.pos_cmd, q.pos_cmd, d.low, d.high)) {
            fail("room", fmt::format("joint {} goes to {:.9g}", j, q.pos_cmd));
        }
    }
    const bool areOn = s.joints[0].isAmpOn && last_.joints[0].isAmpOn;
    for (const AxisDesign &a : design_.axes) {
        const bool isJudged = areOn && s.areAxesKnown && last_.areAxesKnown;
        if (isJudged && leaves(last_.axes[a.axis], s.axes[a.axis], a.low, a.high)) {
            fail("room", fmt::format("axis {} goes to {:.9g}", geom::AXIS_LETTERS[a.axis], s.axes[a.axis]));
        }
    }
}

/// A joint that says that it is homed is where it says that it is.
void Judge::check_homes(const Sample &s) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        JointJudge &judge = joints_[j];
        const JointDesign &d = design_.joints[j];
        const bool isNew = q.isHomed && !judge.wasHomed;
        judge.wasHomed = q.isHomed;
        if (isNew) {
            judge.reference = d.home_kind == HomeKind::IMMEDIATE ? q.pos_fb - q.position : 0;
        }
        if (!q.isHomed || !q.isTruthKnown || !std::isfinite(q.motor_fb)) {
            continue;
        }
        const bool hasIndex = d.home_kind == HomeKind::SWITCH_AND_INDEX;
        const bool hasSwitch = d.home_kind == HomeKind::SWITCH;
        const double latched = hasSwitch ? std::abs(d.latch) * (2 * period_ + d.bounce_s) + d.hysteresis : 0;
        const double allowed = latched + 3 / d.counts_per_unit + d.backlash + 1e-6 + (hasIndex ? 0.01 : 0);
        const double off = q.pos_fb - q.position - judge.reference;
        if (!(std::abs(off) <= allowed)) {
            fail("homed", fmt::format("joint {} says {:.6g} and is at {:.6g}", j, q.pos_fb,
                                      q.position + judge.reference));
        }
    }
}

void Judge::check_outputs(const Sample &s) {
    const bool isRising = (s.isSpindleOn && !last_.isSpindleOn) ||
                          (s.spindle_rpm != 0 && last_.spindle_rpm == 0) || (s.outputs & ~last_.outputs) != 0;
    if (isRising && !mayWork_ && restless_ == 0) {
        fail("energise",
             fmt::format("spindle at {}, outputs {:x} come on by themselves", s.spindle_rpm, s.outputs));
    }
}

void Judge::check_rest(const Sample &s) {
    bool isMoving = false;
    bool isOn = false, wasOn = false;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        isOn = isOn || q.isAmpOn;
        wasOn = wasOn || last_.joints[j].isAmpOn;
        isMoving =
            isMoving ||
            (q.isAmpOn && last_.joints[j].isAmpOn &&
             std::abs(q.motor_cmd + q.turned - last_.joints[j].motor_cmd - last_.joints[j].turned) > MOVED);
    }
    if (wasOn && !isOn) {
        maySwitchOn_ = mayMove_ = mayWork_ = false;
        restless_ = std::max(restless_, IN_FLIGHT);
    }
    const bool wasAtRest = isAtRest();
    standing_ = isMoving ? 0 : standing_ + 1;
    if (isMoving && wasAtRest && !mayMove_ && restless_ == 0) {
        fail("stale", "something moves that nobody has asked for since the last stop");
    }
    if (!isStopAwaited_) {
        return;
    }
    watch_stop(isMoving, isOn);
}

void Judge::watch_stop(bool isMoving, bool isOn) {
    ++since_stop_;
    if (since_stop_ <= delay_) {
        begin_stop();  // it does not know yet
        return;
    }
    const int cycles = since_stop_ - delay_;
    if (how_ == Stop::AT_ONCE) {
        if (isOn) {
            fail("stop", "amplifiers are on in the cycle of what must switch them off");
        }
        isStopAwaited_ = false;
        return;
    }
    const bool isStanding = standing_ >= 3 && cycles >= 3;
    if (isStanding || !isOn || cycles % LOOK_EVERY == 0) {
        check_stop(isMoving && isOn, (cycles - standing_) * period_);
    }
    if (isStanding || !isOn) {
        constexpr int OFF_WITHIN = 10;
        const bool mustBeOff = how_ == Stop::ALONG_THEN_OFF;
        if (mustBeOff && isOn && standing_ > OFF_WITHIN) {
            fail("stop", "it stands, and its amplifiers stay on");
        }
        isStopAwaited_ = mustBeOff && isOn && standing_ <= OFF_WITHIN;
    }
}

void Judge::check_stop(bool isMoving, double took_s) {
    const LeastStop least = time_to_stop();
    if (isMoving && !least.isOver) {
        return;  // nobody could have stopped on what there is of the path yet
    }
    if (took_s > STOP_FACTOR * least.seconds + STOP_SLACK_S) {
        fail("stop", fmt::format("{} {:.3f} s after the stop; its limits need {:.3f} s",
                                 isMoving ? "still moves" : "comes to rest", took_s, least.seconds));
        isStopAwaited_ = false;
    }
    constexpr double WORTH_A_LOOK_S = 0.05;
    if (!isMoving && least.seconds > WORTH_A_LOOK_S) {
        slowest_stop_ = std::max(slowest_stop_, took_s / least.seconds);
    }
}

}  // namespace mw::campaign

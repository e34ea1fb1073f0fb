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
/// Corrections of the motor's place come on top of the joint's motion.
constexpr double WITH_BACKLASH = 1.5;
/// A path brakes along its curves, where part of the acceleration keeps it on them.
constexpr double STOP_FACTOR = 2.2, STOP_SLACK_S = 0.02;
constexpr double BLEND_S = 0.1;  ///< so long after a stop speeds may still grow
/// Until commands that were on their way when the machine was stopped have been dropped [cycles].
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

/// Of the motor, without the external offset: that has been asked for by HAL pins and goes on as long as it
/// is.
double own_place(const JointSample &q) {
    return q.motor_cmd + q.turned - q.offset;
}

/// How exactly homing knows where a slide is.
double found_within(const JointDesign &d, double period_s) {
    const bool hasIndex = d.home_kind == HomeKind::SWITCH_AND_INDEX;
    const bool hasSwitch = d.home_kind == HomeKind::SWITCH;
    const double latched = hasSwitch ? std::abs(d.latch) * (2 * period_s + d.bounce_s) + d.hysteresis : 0;
    return latched + 3 / d.counts_per_unit + 1e-6 + (hasIndex ? 0.01 : 0);
}

}  // namespace

Judge::Judge(const Design &design, double period_s) : design_(design), period_(period_s) {
    for (const JointDesign &j : design.joints) {
        joints_.push_back({checker_of(j, false, period_s), checker_of(j, design.isJerkLimited, period_s)});
    }
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
    const bool isWorse = stop_.isAwaited && stop_.how > how;
    if (isWorse) {
        return;
    }
    stop_.how = how;
    stop_.delay = stop_.isAwaited && how == Stop::ALONG_THE_PATH ? stop_.delay : delay;
    stop_.since = stop_.isAwaited && how == Stop::ALONG_THE_PATH ? stop_.since : 0;
    stop_.isAwaited = true;
    restless_ = delay + IN_FLIGHT;
    maySwitchOn_ = mayMove_ = mayWork_ = false;
    begin_stop();
}

void Judge::begin_stop() {
    stop_.least_s = time_to_stop();
    stop_.due_s = STOP_FACTOR * stop_.least_s + STOP_SLACK_S + time_to_correct() + stops_later_s;
}

/// What corrections take to come to rest, of which the motion on top of which they come knows nothing.
double Judge::time_to_correct() const {
    double most = 0;
    for (const JointDesign &d : design_.joints) {
        const double way = d.isCorrected() ? d.play + 2 * d.screw_error : 0;
        const bool hasJerk = design_.isJerkLimited && d.jerk > 0 && way > 0;
        // With half of the limits.
        most = std::max(most, 2 * std::sqrt(2 * way / d.acceleration) + 2 * way / d.velocity +
                                  (hasJerk ? 2.5 * d.acceleration / d.jerk : 0));
    }
    return most;
}

/// An offset on its own, from its highest speed.
double Judge::time_to_brake() const {
    double most = 0;
    for (const JointDesign &d : design_.joints) {
        most = std::max(most, d.velocity / d.acceleration);
    }
    return most + 3 * design_.rise_s();
}

/// From the speeds of the last sample, by every joint's own acceleration and jerk and those along the path.
double Judge::time_to_stop() const {
    double most = 0;
    double path2 = 0;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointDesign &d = design_.joints[j];
        double a = d.acceleration;
        double jerk = d.jerk;
        for (const AxisDesign &x : design_.axes) {
            // Who limits an axis may limit any joint; of machines whose joints are axes only its own.
            a = std::min(a, x.acceleration);
            jerk = x.jerk > 0 ? (jerk > 0 ? std::min(jerk, x.jerk) : x.jerk) : jerk;
        }
        a = d.isAngular ? a : std::min(a, design_.acceleration);
        jerk = design_.jerk > 0 ? (jerk > 0 ? std::min(jerk, design_.jerk) : design_.jerk) : jerk;
        const double v = std::abs(velocity_[j]);
        path2 += d.isAngular ? 0 : v * v;
        const bool hasJerk = design_.isJerkLimited && jerk > 0;
        most = std::max(most, v / a + (hasJerk && v > 0 ? 2.5 * a / jerk : 0));
    }
    return std::max(most, std::sqrt(path2) / design_.acceleration);
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
    check_rest(s);
    check_places(s);
    restless_ = std::max(0, restless_ - 1);
    last_ = s;
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
        if (isRise && q.offset != 0) {
            fail("offset",
                 fmt::format("joint {} is switched on with an external offset of {:.6g}", j, q.offset));
        }
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
        const double off = q.pos_fb - q.position - judge.reference;
        // In motion corrections may be late, and play is on either side.
        const double allowed = found_within(d, period_) + 2 * d.play + 2 * d.screw_error;
        if (!(std::abs(off) <= allowed)) {
            fail("homed", fmt::format("joint {} says {:.6g} and is at {:.6g}", j, q.pos_fb,
                                      q.position + judge.reference));
        }
    }
}

/// At rest a slide is where it is commanded: corrections have taken up play and what the screw is off.
void Judge::check_places(const Sample &s) {
    constexpr int RESTED = 60;           // the drive has settled
    constexpr double DRIVE = 3e-3;       // friction holds it so near
    constexpr double OVERSHOOT = 0.012;  // of the motor, which takes the slide with it one way only
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        JointJudge &judge = joints_[j];
        const JointDesign &d = design_.joints[j];
        const bool isKnown =
            q.isAmpOn && last_.joints[j].isAmpOn && q.isHomed && q.isTruthKnown && !q.isHoming;
        judge.travel = isKnown ? judge.travel + std::abs(q.pos_cmd - last_.joints[j].pos_cmd) : 0;
        judge.isPlaceKnown = judge.isPlaceKnown && q.isHomed && q.isTruthKnown;
        // Until it has moved farther than the play nobody knows at which end of it the slide is.
        const bool isJudged = d.isCorrected() && standing_ == RESTED && judge.travel > 1 + 4 * d.play;
        if (!isJudged) {
            continue;
        }
        const double off = q.position - q.pos_cmd;
        judge.place = judge.isPlaceKnown ? judge.place : off;
        judge.isPlaceKnown = true;
        ++judged_[d.screw_type >= 0 ? "screw" : "backlash"];
        const double allowed = DRIVE + 3 / d.counts_per_unit + (d.play > 0 ? OVERSHOOT : 0);
        if (std::abs(off - judge.place) > allowed) {
            fail("place", fmt::format("joint {} stands {:.6g} off, where it stood {:.6g} off before", j, off,
                                      judge.place));
        }
        // Where the switch is met soon after a reversal play was not all taken up yet.
        const double late = d.play + (design_.isJerkLimited ? d.screw_error : 0);
        const bool isMeasured = d.home_kind != HomeKind::IMMEDIATE;
        if (isMeasured && std::abs(off) > allowed + late + found_within(d, period_)) {
            fail("place", fmt::format("joint {} stands {:.6g} off where it was homed to be", j, off));
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

/// What has come to rest stays there, but for rounding, until somebody asks for a motion.
void Judge::check_stale(const Sample &s, bool wasAtRest) {
    const bool wasHeld = isHeld_;
    isHeld_ = !mayMove_ && restless_ == 0 && (wasAtRest || wasHeld);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const JointSample &q = s.joints[j];
        const JointSample &before = last_.joints[j];
        const bool isJudged = isHeld_ && wasHeld && q.isAmpOn && before.isAmpOn;
        const double place = own_place(q);
        const double held = isJudged ? joints_[j].held : isHeld_ ? own_place(before) : place;
        joints_[j].held = q.isAmpOn && before.isAmpOn ? held : place;
        if (isHeld_ && q.isAmpOn && before.isAmpOn && std::abs(place - held) > PLACE_ROUNDING) {
            fail("stale", fmt::format("joint {} moves, and nobody has asked for it since the last stop", j));
        }
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
                                std::abs(own_place(q) - own_place(last_.joints[j])) > MOVED);
    }
    if (wasOn && !isOn) {
        maySwitchOn_ = mayMove_ = mayWork_ = false;
        restless_ = std::max(restless_, IN_FLIGHT);
    }
    offsets_standing_ = isOffsetMoving ? 0 : offsets_standing_ + 1;
    const bool wasAtRest = isAtRest();
    standing_ = isMoving ? 0 : standing_ + 1;
    check_stale(s, wasAtRest);
    if (!stop_.isAwaited) {
        return;
    }
    ++stop_.since;
    if (stop_.since <= stop_.delay) {
        begin_stop();  // it does not know yet
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
    const double took = (cycles - standing_) * period_;
    const bool isStanding = standing_ >= 3 && cycles >= 3;
    if (cycles * period_ <= BLEND_S && time_to_stop() > stop_.least_s) {
        // In the middle of a blend all acceleration turns the motion round: it has to be left first.
        begin_stop();
        stop_.due_s += BLEND_S;
    }
    if (isMoving && cycles * period_ > stop_.due_s) {
        fail("stop", fmt::format("still moves {:.3f} s after the stop; its limits need {:.3f} s",
                                 cycles * period_, stop_.least_s));
        stop_.isAwaited = false;
    }
    if (isStanding || !isOn) {
        constexpr double WORTH_A_LOOK_S = 0.05;
        slowest_stop_ =
            stop_.least_s > WORTH_A_LOOK_S
                ? std::max(slowest_stop_, (took - time_to_correct() - stops_later_s) / stop_.least_s)
                : slowest_stop_;
        // The mean that keeps the jerk may stand before it is sure of it.
        const int off_within =
            10 +
            static_cast<int>((design_.rise_s() + (design_.hasOffsets() ? time_to_brake() : 0)) / period_);
        const bool mustBeOff = stop_.how == Stop::ALONG_THEN_OFF;
        if (mustBeOff && isOn && standing_ > off_within) {
            fail("stop", "it stands, and its amplifiers stay on");
        }
        stop_.isAwaited = mustBeOff && isOn && standing_ <= off_within;
    }
}

}  // namespace mw::campaign

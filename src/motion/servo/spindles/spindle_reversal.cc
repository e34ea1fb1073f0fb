// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/spindles/spindle_reversal.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

/// A spindle that has moved back by this much, and by more than the jitter of its encoder, has reversed.
/// Below the next speed it counts as stopped.
constexpr double TURNED = 0.02;  // [turns]
constexpr double TURNED_STEPS = 2;
constexpr double STANDING_RPS = 0.05;
constexpr double STANDING_TURNS = 1e-3;  // in a cycle: the counts of a stopped spindle may still jitter
/// Maximum time for a spindle to reverse or reach its speed.
constexpr double LONGEST_S = 60;
/// Minimum, so that a spindle that reverses within one cycle has a ramp.
constexpr double LEAST_TURNS = 1e-4;
/// Minimum measurable braking, in cycles, and in the time of an encoder step.
constexpr double RESOLUTION = 2, RESOLUTION_STEPS = 10;
/// A spindle that exceeds its speed at the command by more than this factor and its encoder resolution was
/// still accelerating.
constexpr double FASTER = 1.02;

double resolution_s(const SpindleReversal &t, const SpindleMotion &now) noexcept {
    return std::max(RESOLUTION * now.period_s, RESOLUTION_STEPS * now.step / t.speed);
}

double turned_back(const SpindleMotion &now) noexcept {
    return std::max(TURNED, TURNED_STEPS * now.step);
}

void begin(SpindleReversal &t, const SpindleMotion &now) noexcept {
    const bool isReversal = t.wanted * now.wanted < 0 && std::abs(now.speed) > STANDING_RPS;
    const bool isStart =
        t.wanted == 0 && now.wanted != 0 && std::abs(now.speed) * now.period_s < STANDING_TURNS;
    if (isReversal) {
        t.watching = SpindleReversal::Watching::REVERSAL;
        t.direction = now.speed < 0 ? -1.0 : 1.0;
        t.from_turns = t.farthest = t.direction * now.turns;
        t.speed = std::max(std::abs(now.speed), STANDING_RPS);
    } else if (isStart) {
        t.watching = SpindleReversal::Watching::START;
        t.speed = std::abs(now.wanted);
        t.quarter_s = 0;
    } else if (now.wanted != t.wanted) {
        t.watching = SpindleReversal::Watching::NOTHING;  // later data belong to several commands
    }
    if (isReversal || isStart) {
        t.seconds = t.arrived_s = t.left_s = 0;
    }
}

/// Time from the command to standstill: the middle of the time for which the count was at its farthest step.
/// A spindle that brakes evenly stays there for sqrt(2 step/ramp) before it stops; a longer time is a pause
/// of the drive.
double standstill_s(const SpindleReversal &t, double overrun, double step) noexcept {
    const double braking_s = std::max(2.0 * (t.arrived_s - overrun / t.speed), 0.0);
    const double within_step_s = std::sqrt(2.0 * step * braking_s / t.speed);
    return t.arrived_s + std::min(0.5 * (t.left_s - t.arrived_s), within_step_s);
}

void learn_reversal(SpindleReversal &t, const SpindleMotion &now) noexcept {
    const double counted = t.direction * now.turns;
    if (counted > t.farthest) {
        t.farthest = counted;
        t.arrived_s = t.seconds;
    }
    t.left_s = counted >= t.farthest ? t.seconds : t.left_s;
    if (counted - t.from_turns > FASTER * t.speed * t.seconds + turned_back(now)) {
        t.watching = SpindleReversal::Watching::NOTHING;
        return;
    }
    if (counted > t.farthest - turned_back(now)) {
        return;
    }
    const double overrun = std::max(t.farthest - t.from_turns, LEAST_TURNS);
    t.learned[t.direction < 0 ? 1 : 0] =
        trajectory::braking_of({t.speed, overrun, standstill_s(t, overrun, now.step), resolution_s(t, now)});
    t.watching = SpindleReversal::Watching::NOTHING;
}

/// Learns the ramp of a start between a quarter and half of the speed. A start takes as long to half of the
/// speed as the overrun of a reversal takes at full speed.
void learn_start(SpindleReversal &t, const SpindleMotion &now) noexcept {
    const double speed = std::abs(now.shown_speed);
    if (t.quarter_s <= 0 && speed >= 0.25 * t.speed) {
        t.quarter_s = t.seconds;
    }
    if (speed < 0.5 * t.speed) {
        return;
    }
    const double ramp_s = 4.0 * (t.seconds - t.quarter_s);
    t.guessed = trajectory::braking_of(
        {t.speed, t.speed * t.seconds, t.seconds + 0.5 * ramp_s, resolution_s(t, now)});
    t.watching = SpindleReversal::Watching::NOTHING;
}

}  // namespace

void watch(SpindleReversal &t, const SpindleMotion &now) noexcept {
    t.seconds += now.period_s;
    begin(t, now);
    t.wanted = now.wanted;
    if (t.seconds > LONGEST_S) {
        t.watching = SpindleReversal::Watching::NOTHING;
    }
    switch (t.watching) {
    case SpindleReversal::Watching::NOTHING: break;
    case SpindleReversal::Watching::REVERSAL: learn_reversal(t, now); break;
    case SpindleReversal::Watching::START: learn_start(t, now); break;
    }
}

trajectory::SpindleBrakings brakings_of(const SpindleReversal &t, double given_ramp) noexcept {
    const trajectory::SpindleBraking otherwise =
        given_ramp > 0 ? trajectory::SpindleBraking{0, given_ramp} : t.guessed;
    return {t.learned[0].isKnown() ? t.learned[0] : otherwise,
            t.learned[1].isKnown() ? t.learned[1] : otherwise};
}

}  // namespace mw::motion

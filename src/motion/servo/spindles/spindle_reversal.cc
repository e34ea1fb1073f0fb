// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/spindles/spindle_reversal.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

/// A spindle that has run back by this much has reversed; below the next speed it counts as stopped.
constexpr double TURNED = 0.02;  // [turns]
constexpr double STANDING_RPS = 0.05;
constexpr double STANDING_TURNS =
    1e-3;  // in a cycle: the encoder of a stopped spindle may still count to and fro
/// Maximum time to wait for a spindle to reverse or reach its speed.
constexpr double LONGEST_S = 60;
/// Minimum, so that a spindle that reverses within a cycle has a ramp.
constexpr double LEAST_TURNS = 1e-4;

void begin(SpindleReversal &t, const SpindleMotion &now, double counted_rps) noexcept {
    const bool isReversal = t.wanted * now.wanted < 0 && std::abs(counted_rps) > STANDING_RPS;
    const bool isStart =
        t.wanted == 0 && now.wanted != 0 && std::abs(counted_rps) * now.period_s < STANDING_TURNS;
    if (isReversal) {
        t.watching = SpindleReversal::Watching::REVERSAL;
        t.direction = counted_rps < 0 ? -1.0 : 1.0;
        t.from_turns = t.farthest = t.direction * now.turns;
        t.speed = std::max(std::abs(now.speed), STANDING_RPS);
    } else if (isStart) {
        t.watching = SpindleReversal::Watching::START;
        t.speed = 0.5 * std::abs(now.wanted);
    } else if (now.wanted != t.wanted) {
        t.watching = SpindleReversal::Watching::NOTHING;  // data from here belong to several commands
    }
    t.seconds = isReversal || isStart ? 0.0 : t.seconds;
}

void learn_reversal(SpindleReversal &t, const SpindleMotion &now) noexcept {
    const double counted = t.direction * now.turns;
    t.farthest = std::max(t.farthest, counted);
    if (counted > t.farthest - TURNED) {
        return;
    }
    const double turns = std::max(t.farthest - t.from_turns, LEAST_TURNS);
    t.learned[t.direction < 0 ? 1 : 0] = 0.5 * t.speed * t.speed / turns;
    t.watching = SpindleReversal::Watching::NOTHING;
}

}  // namespace

void watch(SpindleReversal &t, const SpindleMotion &now) noexcept {
    const double counted_rps = t.isBegun ? (now.turns - t.last_turns) / now.period_s : 0.0;
    begin(t, now, counted_rps);
    t.isBegun = true;
    t.wanted = now.wanted;
    t.last_turns = now.turns;
    t.seconds += now.period_s;
    if (t.seconds > LONGEST_S) {
        t.watching = SpindleReversal::Watching::NOTHING;
    }
    switch (t.watching) {
    case SpindleReversal::Watching::NOTHING: break;
    case SpindleReversal::Watching::REVERSAL: learn_reversal(t, now); break;
    case SpindleReversal::Watching::START:
        if (std::abs(now.speed) >= t.speed) {
            t.guessed = t.speed / t.seconds;
            t.watching = SpindleReversal::Watching::NOTHING;
        }
        break;
    }
}

std::array<double, 2> ramps_of(const SpindleReversal &t, double given) noexcept {
    const double otherwise = given > 0 ? given : t.guessed;
    return {t.learned[0] > 0 ? t.learned[0] : otherwise, t.learned[1] > 0 ? t.learned[1] : otherwise};
}

}  // namespace mw::motion

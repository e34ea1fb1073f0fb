// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/plan/tap_plan.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/follow/spindle_pursuit.hh"
#include "trajectory/path/line_joints.hh"
#include "trajectory/plan/pass_builder.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory::plan {

namespace {

/// Excess of a load that rounding alone can cause.
constexpr double LOAD_ROUNDING = 1e-9;
/// Minimum speed in the divisor of the load: the joints cannot move along the line.
constexpr double NO_SPEED = 1e-9;

double jerk_time(const MotionLimits &limits) noexcept {
    return limits.jerk < UNLIMITED ? limits.acceleration / limits.jerk : 0.0;
}

/// Deviation of the tool from the helix [rev] while a spindle with this ramp reverses. `use` is the part of
/// the tool's acceleration that follows the spindle. The acceleration builds up over the time use *
/// jerk_time. The tool falls behind meanwhile, and catches up with the rest of the acceleration.
double off_helix(double ramp, double use, const MotionLimits &limits, double late_s2) noexcept {
    const double built_s = use * jerk_time(limits);
    const double caught_up = use < 1 ? use / (1 - use) : UNLIMITED;
    return ramp * (late_s2 + built_s * built_s / 6 + 0.125 * built_s * built_s * caught_up);
}

/// Delay with which the tool follows a change of the spindle's acceleration, squared and halved [s^2].
double late_s2(const TapRequest &tap, double per_turn, const MotionLimits &limits) noexcept {
    const double dt = tap.conditions.limits.period_s();
    const double rate =
        following_rate(per_turn, tap.encoder_step(), usable_jerk(limits.jerk, limits.acceleration, dt), dt);
    return TapTuning::LATE / (rate * rate) + TapTuning::LATE_CYCLES * dt * dt;
}

/// True if the retract is long enough: the spindle reaches its speed and keeps it until the tool follows it
/// well again, before it is commanded forward.
bool isBackLong(const TapTerms &tap, const SpindleBrakings &brakings, double rps,
                double settling_s) noexcept {
    const double back = tap.back_scale * std::abs(rps);
    const double slowest = std::min(brakings[0].ramp, brakings[1].ramp);
    const double turns = slowest > 0 ? back * back / slowest + back * settling_s : 0.0;
    return turns * tap.per_turn <= tap.depth + TapTuning::CLEARANCE * tap.per_turn;
}

/// The line of a tap, and the range of the tool on it.
TapTerms line_of(const TapRequest &tap) noexcept {
    const MoveRequest &r = tap.request;
    TapTerms out;
    out.depth = tap.line.length;
    out.per_turn = r.feed_per_revolution * r.tag.feed_ratio;
    out.back_scale = r.tap_scale;
    out.low = -r.room_before;
    out.high = out.depth + r.room_behind;
    const double rps = tap.rps();
    const SpindleBraking &braking = braking_at(tap.brakings(), rps);
    if (braking.isKnown()) {
        const double turns = TapTuning::MORE_ROOM + 2 * braking.overrun(rps);
        out.high = std::min(out.high, out.depth + turns * out.per_turn);
        if (tap.conditions.workspace.isMapped()) {
            out.low = std::max(out.low, -turns * out.per_turn);
        }
    }
    return out;
}

/// Limits of the tool along the line.
struct Ability {
    double most_speed = 0;  ///< maximum speed at any acceleration
    MotionLimits limits;    ///< limits at the maximum speed for this acceleration
};

double needed_speed(const TapRequest &tap) noexcept {
    const MoveRequest &r = tap.request;
    return r.feed_per_revolution * r.tag.feed_ratio * std::abs(tap.rps()) * std::max(1.0, r.tap_scale);
}

/// At higher speed, the curvature of the joint paths leaves less acceleration. The speed limit is raised
/// above the needed speed as long as the loss of acceleration is small.
Ability ability_of_joints(const TapRequest &tap, const TapTerms &terms) noexcept {
    const Workspace &workspace = tap.conditions.workspace;
    const MotionLimits axes = limits_along(tap.line, tap.conditions.limits.wanted());
    const LineJoints joints = joints_along(workspace, tap.line, terms.low, terms.high);
    if (!joints.isReachable) {
        return {};
    }
    Ability out;
    out.most_speed = std::min(axes.velocity, joints.most_speed(workspace.joints));
    const double least = std::min(out.most_speed, TapTuning::OVERSPEED * needed_speed(tap));
    const auto left_at = [&](double v) {
        const bool has_jerk = tap.conditions.limits.wanted().isJerkLimited;
        const MotionLimits left = joints.limits_at(workspace.joints, v, has_jerk);
        return MotionLimits{v, std::min(axes.acceleration, left.acceleration),
                            std::min(axes.jerk, left.jerk)};
    };
    const double enough = TapTuning::SPEED_WORTH * left_at(least).acceleration;
    for (int n = 0; n <= TapTuning::SPEED_STEPS; ++n) {
        const double part = static_cast<double>(n) / TapTuning::SPEED_STEPS;
        const MotionLimits left = left_at(least + part * (out.most_speed - least));
        if (n == 0 || left.acceleration >= enough) {
            out.limits = left;
        }
    }
    return out;
}

Ability ability_of(const TapRequest &tap, const TapTerms &terms) noexcept {
    if (tap.conditions.workspace.isMapped()) {
        return ability_of_joints(tap, terms);
    }
    const MotionLimits limits = limits_along(tap.line, tap.conditions.limits.wanted());
    return {limits.velocity, limits};
}

}  // namespace

TapTerms tap_terms(const TapRequest &tap) noexcept {
    TapTerms terms = line_of(tap);
    const MotionLimits limits = ability_of(tap, terms).limits;
    terms.velocity = limits.velocity;
    terms.acceleration = limits.acceleration;
    terms.jerk = limits.jerk;
    return terms;
}

TapVerdict check_tap(const TapRequest &tap) noexcept {
    const MoveRequest &r = tap.request;
    const double ahead = std::abs(tap.rps());
    const SpindleBrakings &brakings = tap.brakings();
    const TapTerms terms = line_of(tap);
    const Ability can = ability_of(tap, terms);
    const MotionLimits &limits = can.limits;
    const double operators = tap.conditions.scales.max_velocity * r.tag.feed_ratio;
    const double load = needed_speed(tap) / std::max(std::min(can.most_speed, operators), NO_SPEED);
    if (load > 1.0 + LOAD_ROUNDING) {
        return {TapObstacle::TOO_FAST, load};
    }
    const double fastest = std::max(brakings[0].ramp, brakings[1].ramp);
    const double abruptness =
        terms.per_turn * fastest / (SpindlePursuit::MEETING_SHARE * limits.acceleration);
    if (abruptness > 1.0) {
        return {TapObstacle::TOO_ABRUPT, abruptness};
    }
    const double built_s = jerk_time(limits);
    if (built_s > 0) {
        const bool one_by_one = isBackLong(terms, brakings, tap.rps(), TapTuning::SETTLING * built_s);
        // If the spindle slows down while it accelerates, its acceleration changes by the sum of both ramps.
        const double change = (one_by_one ? 1.0 : 2.0) * fastest;
        const double use = SpindlePursuit::MEETING_SHARE * abruptness;
        const double off = off_helix(change, use, limits, late_s2(tap, terms.per_turn, limits));
        if (off > TapTuning::MOST_OFF) {
            return {TapObstacle::TOO_SUDDEN, off};
        }
    }
    const double overrun = braking_at(brakings, tap.rps()).overrun(ahead) * terms.per_turn;
    const double run_in = run_in_distance(terms.per_turn * ahead, limits);
    if (run_in + overrun > terms.depth) {
        return {TapObstacle::TOO_SHALLOW, (run_in + overrun) / terms.depth};
    }
    // If acceleration and deceleration took the whole depth, no part of the thread would have its pitch.
    return {};
}

}  // namespace mw::trajectory::plan

// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/teleop_smooth.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mw::motion {

namespace {

/// Parts of a joint's jerk that curves may take at maximum speed: by accelerations along them, and by the
/// change of their curvature.
constexpr double SWING_SHARE = 0.25, TURN_SHARE = 0.25;
/// An axis keeps at least this part of the acceleration that the joints leave it, regardless of their jerk:
/// it must be able to brake.
constexpr double LEAST_SHARE = 0.02;
/// The whole margin of the derivatives where another axis waits: by then the joints may have followed
/// straight lines, without that margin.
constexpr double KEPT_BESIDE = 1.05001;
constexpr double ROUNDING = 1e-9;
constexpr double NONE = std::numeric_limits<double>::infinity();

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

std::uint32_t bit_of(const TeleopLoad &load, int i) noexcept {
    return 1U << load.axes[at(i)];
}

int count_of(std::uint32_t axes) noexcept {
    int count = 0;
    for (; axes != 0; axes &= axes - 1) {
        ++count;
    }
    return count;
}

/// Limits of the axes that share the joints; 0 without a share.
struct Allowed {
    AxisValues velocity{}, acceleration{}, mean_s{};
};

struct Sharing {
    const TeleopMachine &m;
    const TeleopLoad &load;
    const Jogs &jogs;
    std::uint32_t axes = 0;  ///< bit per axis that has a share
    double n = 1;            ///< number of them

    const Jog &jog(int i) const noexcept { return jogs.axis[at(load.axes[at(i)])]; }
    bool has(int i) const noexcept { return (axes & bit_of(load, i)) != 0; }
    double jerk(int j) const noexcept {
        const double most = m.joints.jerk[at(j)];
        return most < trajectory::UNLIMITED ? most : NONE;
    }
};

/// Acceleration and jerk that joints with these derivatives leave to an axis on a straight line.
struct Straight {
    double acceleration = 0, jerk = NONE;
};
Straight straight(const Sharing &s, int i, const JointsAt &q1) noexcept {
    const double own = s.m.limits.axis_jog[at(s.load.axes[at(i)])].jerk;
    Straight out{s.jog(i).wanted_acceleration, own > 0 ? own : NONE};
    for (int j = 0; j < s.m.num_joints; ++j) {
        const double used = s.n * q1[at(j)];
        if (used > 0) {
            out.acceleration = std::min(out.acceleration, s.m.joints.acceleration[at(j)] / used);
            out.jerk = std::min(out.jerk, s.jerk(j) / used);
        }
    }
    return out;
}

/// Averaging time of an axis that begins: at most 2 A / J, and at most the time in which it reaches its
/// maximum speed soonest, sqrt(2 V / J), the minimum of V / a + 2 a / J. It stays until the axis stops: at
/// the target the joints may need more than at the start.
double mean_for(const Sharing &s, int i) noexcept {
    JointsAt q1 = s.load.q1[at(i)];
    double v = s.m.limits.axis_jog[at(s.load.axes[at(i)])].velocity;
    for (int j = 0; j < s.m.num_joints; ++j) {
        q1[at(j)] = std::max(q1[at(j)], s.load.q1_sent[at(i)][at(j)]);
        v = q1[at(j)] > 0 ? std::min(v, s.m.joints.velocity[at(j)] / q1[at(j)]) : v;
    }
    const Straight most = straight(s, i, q1);
    return most.jerk == NONE ? 0.0
                             : std::min(2.0 * most.acceleration / most.jerk, std::sqrt(2.0 * v / most.jerk));
}

/// Averaging times, and the accelerations that they and the joints allow on straight lines.
void share_straight(const Sharing &s, Allowed &out) noexcept {
    for (int i = 0; i < s.load.count; ++i) {
        if (!s.has(i)) {
            continue;
        }
        const auto [a, jerk] = straight(s, i, s.load.q1[at(i)]);
        const double in_force = s.jog(i).planner.mean_in_force_s(s.m.period_s);
        const double tau = in_force > 0 ? in_force : mean_for(s, i);
        out.mean_s[at(i)] = tau;
        out.acceleration[at(i)] = jerk == NONE ? a : std::max(std::min(a, 0.5 * tau * jerk), LEAST_SHARE * a);
    }
}

/// Load of accelerations at these speeds on a joint's jerk on curves, and load of the speeds alone.
double swing_of(const Sharing &s, const AxisValues &v, const AxisValues &a, int i, int j) noexcept {
    double sum = 0;
    for (int k = 0; k < s.load.count; ++k) {
        sum += s.load.q2[at(i)][at(k)][at(j)] * a[at(k)];
    }
    return 3.0 * v[at(i)] * sum;
}
double turn_of(const Sharing &s, const AxisValues &v, int j) noexcept {
    double sum = 0;
    for (int i = 0; i < s.load.count; ++i) {
        const double x = v[at(i)];
        sum += x * (s.load.q3[at(i)][at(j)] * x * x + s.load.turn[at(i)][at(j)]);
    }
    return sum;
}

void slow_on_curves(const Sharing &s, Allowed &out) noexcept {
    AxisValues &v = out.velocity;
    for (int i = 0; i < s.load.count; ++i) {
        for (int j = 0; j < s.m.num_joints && s.has(i); ++j) {
            const double most = SWING_SHARE * s.jerk(j) / s.n;
            const double used = swing_of(s, v, out.acceleration, i, j);
            v[at(i)] *= used > most ? most / used : 1.0;
        }
    }
    double factor = 1;
    for (int j = 0; j < s.m.num_joints; ++j) {
        const double most = TURN_SHARE * s.jerk(j);
        const double used = turn_of(s, v, j);
        factor = used > most ? std::min(factor, std::cbrt(most / used)) : factor;
    }
    for (double &x : v) {
        x *= factor;
    }
}

/// Acceleration that curves at these speeds leave.
void leave_for_curves(const Sharing &s, const AxisValues &speed, Allowed &out) noexcept {
    const AxisValues straight = out.acceleration;
    for (int j = 0; j < s.m.num_joints; ++j) {
        double curve = 0;
        double swing = 0;
        for (int i = 0; i < s.load.count; ++i) {
            for (int k = 0; k < s.load.count; ++k) {
                curve += s.load.q2[at(i)][at(k)][at(j)] * speed[at(i)] * speed[at(k)];
            }
            swing += swing_of(s, speed, straight, i, j);
        }
        const double most = s.m.joints.acceleration[at(j)];
        const double a_left = std::max(most - curve, (1.0 - CURVE_SHARE) * most);
        const double jerk = s.jerk(j);
        const double jerk_left = jerk == NONE ? NONE
                                              : std::max(jerk - swing - turn_of(s, speed, j),
                                                         (1.0 - SWING_SHARE - TURN_SHARE) * jerk);
        for (int i = 0; i < s.load.count; ++i) {
            const double used = s.n * s.load.q1[at(i)][at(j)];
            if (!s.has(i) || !(used > 0)) {
                continue;
            }
            double a = a_left / used;
            a = jerk_left < NONE
                    ? std::min(a, std::max(0.5 * out.mean_s[at(i)] * jerk_left / used, LEAST_SHARE * a))
                    : a;
            out.acceleration[at(i)] = std::min(out.acceleration[at(i)], a);
        }
    }
}

/// The command follows its reference by half an averaging time, so an axis that follows a slow wheel may
/// brake at any speed.
bool isBraking(const trajectory::AxisTrajectory &p, double acceleration) noexcept {
    return std::abs(p.leader().velocity) < std::abs(p.velocity) || mustBrake(p, acceleration);
}

/// The speed that an axis may reach within its averaging time: centripetal acceleration depends on it. An
/// axis that brakes gains none, so its acceleration does not fall before its stop.
double soon(const Sharing &s, int i, double speed, const Allowed &allowed) noexcept {
    const trajectory::AxisTrajectory &p = s.jog(i).planner;
    return isBraking(p, s.load.had[at(i)])
               ? speed
               : speed + allowed.acceleration[at(i)] * std::max(allowed.mean_s[at(i)], s.m.period_s);
}

/// True when an axis could not stop at its target if all reached their speeds: curves would leave it too
/// little.
bool isAnyHeld(const Sharing &s, const Allowed &allowed) noexcept {
    Allowed worst = allowed;
    leave_for_curves(s, worst.velocity, worst);
    bool isHeld = false;
    for (int i = 0; i < s.load.count; ++i) {
        isHeld = isHeld || (s.has(i) && s.load.count > 1 &&
                            !canTake(s.jog(i).planner, worst.acceleration[at(i)], s.m.period_s));
    }
    return isHeld;
}

/// Limits shared evenly among the axes of `axes`.
Allowed share(const TeleopMachine &m, const TeleopLoad &load, const Jogs &jogs, std::uint32_t axes,
              int count) noexcept {
    const Sharing s{m, load, jogs, axes, static_cast<double>(count)};
    Allowed out;
    out.velocity = shared_speeds(m, load, jogs, s.n);
    AxisValues speed{};
    for (int i = 0; i < load.count; ++i) {
        out.velocity[at(i)] = s.has(i) ? out.velocity[at(i)] : 0.0;
        const trajectory::AxisTrajectory &p = s.jog(i).planner;
        speed[at(i)] = std::max(std::abs(p.velocity), std::abs(p.leader().velocity));
    }
    share_straight(s, out);
    slow_on_curves(s, out);
    // While one axis is faster than its share, the others keep their speed.
    bool isOver = isAnyHeld(s, out);
    for (int i = 0; i < load.count; ++i) {
        isOver = isOver || speed[at(i)] > out.velocity[at(i)] * (1.0 + ROUNDING);
    }
    for (int i = 0; i < load.count; ++i) {
        double &v = out.velocity[at(i)];
        v = isOver ? std::min(v, speed[at(i)]) : v;
        speed[at(i)] = std::max(std::min(v, soon(s, i, speed[at(i)], out)), speed[at(i)]);
    }
    leave_for_curves(s, speed, out);
    return out;
}

std::uint32_t all_of(const TeleopLoad &load) noexcept {
    std::uint32_t all = 0;
    for (int i = 0; i < load.count; ++i) {
        all |= bit_of(load, i);
    }
    return all;
}

/// Removes axes that have stopped from the shares and from those that wait.
void forget_resting(TeleopShares &shares, std::uint32_t moving) noexcept {
    shares.axes &= moving;
    shares.axes = shares.axes == 0 ? moving : shares.axes;
    shares.room &= moving;
    shares.room = (shares.room & ~shares.axes) == 0 ? 0 : shares.room | shares.axes;
}

}  // namespace

std::uint32_t counted_axes(const TeleopShares &shares) noexcept {
    return shares.room != 0 ? shares.room : shares.axes;
}

void make_room(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs) noexcept {
    TeleopShares &shares = jogs.shares;
    const std::uint32_t moving = all_of(load);
    if (counted_axes(shares) == moving) {
        return;
    }
    const Allowed allowed = share(m, load, jogs, moving, load.count);
    for (int i = 0; i < load.count; ++i) {
        const bool hasShare = (shares.axes & bit_of(load, i)) != 0;
        const trajectory::AxisTrajectory &p = jogs.axis[at(load.axes[at(i)])].planner;
        if (hasShare && !canTake(p, allowed.acceleration[at(i)], m.period_s)) {
            return;
        }
    }
    shares.room = moving;
    shares.calm_s = 0;
}

void apply_smoothly(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs, bool isWhole) noexcept {
    TeleopShares &shares = jogs.shares;
    forget_resting(shares, all_of(load));
    const std::uint32_t counted = counted_axes(shares);
    const Allowed allowed = share(m, load, jogs, counted, count_of(counted));
    for (int i = 0; i < load.count; ++i) {
        trajectory::AxisTrajectory &p = jogs.axis[at(load.axes[at(i)])].planner;
        const bool hasShare = (shares.axes & bit_of(load, i)) != 0;
        p.max_velocity = hasShare ? allowed.velocity[at(i)] : 0.0;
        const double a = allowed.acceleration[at(i)];
        const double had = load.had[at(i)];
        const double most =
            isWhole ? kept(had, a, load.count > 1 ? KEPT_BESIDE : KEPT_ALONE, isBraking(p, had)) : a;
        p.max_acceleration = with_reserve(load, p, most);
        p.mean_s = allowed.mean_s[at(i)];
    }
}

void settle_shares(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs) noexcept {
    TeleopShares &shares = jogs.shares;
    if (shares.room == 0) {
        return;
    }
    bool isCalm = true;
    double longest_s = 0;
    for (int i = 0; i < load.count; ++i) {
        const trajectory::AxisTrajectory &p = jogs.axis[at(load.axes[at(i)])].planner;
        const bool hasShare = (shares.axes & bit_of(load, i)) != 0;
        isCalm = isCalm && (!hasShare || std::abs(p.leader().velocity) <= p.max_velocity * (1.0 + ROUNDING));
        longest_s = std::max(longest_s, p.mean_in_force_s(m.period_s));
    }
    shares.calm_s = isCalm ? shares.calm_s + m.period_s : 0.0;
    if (shares.calm_s > longest_s) {
        shares = {shares.room, 0, 0};
    }
}

}  // namespace mw::motion

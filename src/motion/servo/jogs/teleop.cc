// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/teleop.hh"

#include <algorithm>
#include <cmath>

#include "motion/servo/jogs/teleop_load.hh"
#include "motion/servo/jogs/teleop_smooth.hh"

namespace mw::motion {

namespace {

/// Farther ahead than the jogs would come to rest, at least this [machine units, degrees].
constexpr double LEAST_WINDOW = 0.5;
/// What rounding of positions may make of a joint's soft limit.
constexpr double POSITION_ROUNDING = 1e-9;
constexpr int MOST_CORNER_AXES = 5;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// What `n` axes that share the joints evenly may accelerate with when they turn with these speeds.
AxisValues accelerations(const TeleopMachine &m, const TeleopLoad &load, const Jogs &jogs, double n,
                         const AxisValues &speed) noexcept {
    AxisValues out{};
    for (int i = 0; i < load.count; ++i) {
        out[at(i)] = jogs.axis[at(load.axes[at(i)])].wanted_acceleration;
    }
    for (int j = 0; j < m.num_joints; ++j) {
        double curve = 0;
        for (int k = 0; k < load.count; ++k) {
            for (int l = 0; l < load.count; ++l) {
                curve += load.q2[at(k)][at(l)][at(j)] * speed[at(k)] * speed[at(l)];
            }
        }
        const double most = m.joints.acceleration[at(j)];
        const double left = std::max(most - curve, (1.0 - CURVE_SHARE) * most);
        for (int i = 0; i < load.count; ++i) {
            const double q1 = load.q1[at(i)][at(j)];
            out[at(i)] = q1 > 0 ? std::min(out[at(i)], left / (n * q1)) : out[at(i)];
        }
    }
    return out;
}

/// One that moves would go beyond where it is sent if all had their share and came to the speeds of that.
bool isAnyHeld(const TeleopMachine &m, const TeleopLoad &load, const Jogs &jogs,
               const AxisValues &now) noexcept {
    AxisValues speed = shared_speeds(m, load, jogs, load.count);
    for (int i = 0; i < load.count; ++i) {
        speed[at(i)] = std::max(speed[at(i)], now[at(i)]);
    }
    const AxisValues a = accelerations(m, load, jogs, load.count, speed);
    bool isHeld = false;
    for (int i = 0; i < load.count; ++i) {
        isHeld = isHeld || !canTake(jogs.axis[at(load.axes[at(i)])].planner, a[at(i)], m.period_s);
    }
    return isHeld;
}

/// Shares what each joint can do evenly among the axes that move it. As long as one needs what it has to stop
/// where it is sent, none begins beside it, and none gets faster.
void apply_load(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs, bool isWhole) noexcept {
    AxisValues speed{};
    int moving = 0;
    for (int i = 0; i < load.count; ++i) {
        speed[at(i)] = std::abs(jogs.axis[at(load.axes[at(i)])].planner.velocity);
        moving += speed[at(i)] > 0 ? 1 : 0;
    }
    const bool isHeld = load.count > 1 && moving > 0 && isAnyHeld(m, load, jogs, speed);
    const double n = isHeld ? moving : load.count;
    AxisValues v = shared_speeds(m, load, jogs, n);
    // While one is still faster than its share the others do not take theirs, and it turns with its speed.
    constexpr double ROUNDING = 1e-9;
    bool isOver = isHeld;
    for (int i = 0; i < load.count; ++i) {
        isOver = isOver || speed[at(i)] > v[at(i)] * (1.0 + ROUNDING);
    }
    for (int i = 0; i < load.count; ++i) {
        v[at(i)] = isOver ? std::min(v[at(i)], speed[at(i)]) : v[at(i)];
        // What turning takes goes with the speed that it may have in this cycle, and not with the one that it
        // may come to have: while it brakes more is left from cycle to cycle, never less.
        const double soon = speed[at(i)] + jogs.axis[at(load.axes[at(i)])].wanted_acceleration * m.period_s;
        speed[at(i)] = std::max(std::min(v[at(i)], soon), speed[at(i)]);
    }
    const AxisValues a = accelerations(m, load, jogs, n, speed);
    for (int i = 0; i < load.count; ++i) {
        Jog &axis = jogs.axis[at(load.axes[at(i)])];
        axis.planner.max_velocity = v[at(i)];
        const double had = load.had[at(i)];
        const bool isKept = isWhole && mustBrake(axis.planner, had);
        axis.planner.max_acceleration =
            with_reserve(load, axis.planner, kept(had, a[at(i)], KEPT_ALONE, isKept));
    }
}

double speed_of(const trajectory::AxisTrajectory &p) noexcept {
    return std::max(std::abs(p.velocity), std::abs(p.leader().velocity));
}

/// Of the axis that takes longest.
double time_to_stop(const TeleopLoad &load, const Jogs &jogs, double period_s) noexcept {
    double most_s = 0;
    for (int i = 0; i < load.count; ++i) {
        const trajectory::AxisTrajectory &p = jogs.axis[at(load.axes[at(i)])].planner;
        // With what it had in the last cycle: that has looked as far ahead.
        const double had = p.leader().max_acceleration;
        const double a = had > 0 ? std::min(had, p.max_acceleration) : p.max_acceleration;
        most_s = std::max(most_s, (a > 0 ? speed_of(p) / a : 0.0) + p.mean_in_force_s(period_s));
    }
    return most_s;
}

/// The homed joint that this pose takes beyond its soft limits, farther than it is; -1 for none.
int joint_left_by(const TeleopMachine &m, const geometry::Pose &pose) noexcept {
    JointsAt q{};
    if (!find_joints(m, pose, q)) {
        return m.num_joints;
    }
    for (int j = 0; j < m.num_joints; ++j) {
        const double low = std::min(m.joints.low[at(j)], m.joint_positions[at(j)]);
        const double high = std::max(m.joints.high[at(j)], m.joint_positions[at(j)]);
        const bool isLeft = q[at(j)] < low - POSITION_ROUNDING || q[at(j)] > high + POSITION_ROUNDING;
        if (isLeft) {
            return j;
        }
    }
    return -1;
}

/// What axes ask of the joints at the places of this cycle.
struct Look {
    TeleopLoad load;
    geometry::Pose stop;  ///< where they come to rest when they brake a cycle from now
    bool isFound = true;
};

/// Where it stands first: a jog that begins has no acceleration yet that the joints could bear.
void look_here(const TeleopMachine &m, const geometry::Pose &here, Jogs &jogs, Look &look) noexcept {
    TeleopLoad &load = look.load;
    look.isFound = add_load(m, here, load);
    for (int i = 0; i < load.count && load.isSmooth; ++i) {
        const trajectory::AxisTrajectory &p = jogs.axis[at(load.axes[at(i)])].planner;
        if (p.mean_in_force_s(m.period_s) == 0.0) {
            add_sent(m, here, i, p.target, load);
        }
    }
    load.isSmooth ? apply_smoothly(m, load, jogs, false) : apply_load(m, load, jogs, false);
}

/// Then as far ahead as they may come while they brake.
void look_ahead(const TeleopMachine &m, const geometry::Pose &here, const Jogs &jogs, Look &look) noexcept {
    TeleopLoad &load = look.load;
    const double longest_s = load.count > 1 ? time_to_stop(load, jogs, m.period_s) : 0.0;
    look.stop = here;
    geometry::Pose far = here;
    for (int i = 0; i < load.count; ++i) {
        const int axis = load.axes[at(i)];
        const trajectory::AxisTrajectory &p = jogs.axis[at(axis)].planner;
        load.speed[at(i)] = std::max(p.max_velocity, std::abs(p.velocity));
        const double way = p.rest_after(m.period_s) - here[axis];
        look.stop[axis] += TELEOP_BRAKE_MARGIN * way;
        const double sign = p.target >= here[axis] ? 1.0 : -1.0;
        // Not behind what it may come to at all: else more would be taken off while it brakes.
        double low = here[axis];
        double high = here[axis];
        p.add_reach(low, high);
        // While another brakes this one goes on, and turns what the joints do for the other.
        const double on = std::max(2.0 * std::abs(way), TELEOP_BRAKE_MARGIN * speed_of(p) * longest_s);
        far[axis] = std::clamp(here[axis] + std::copysign(on, way), low, high) + LEAST_WINDOW * sign;
    }
    constexpr int PLACES = 2;
    for (int n = 1; n <= PLACES && look.isFound; ++n) {
        look.isFound = add_load(m, here + (far - here) * (static_cast<double>(n) / PLACES), load);
    }
    for (int i = 0; i < load.count && load.count > 1 && look.isFound; ++i) {
        const int axis = load.axes[at(i)];
        geometry::Pose p = here;
        p[axis] = far[axis];
        look.isFound = add_load(m, p, load, {i, far[axis] - here[axis]});
    }
}

/// The axes of a look without those that wait: these stand, so that nothing of what they would ask is asked.
Look without_waiting(const Look &all, std::uint32_t counted, Jogs &jogs) noexcept {
    Look some;
    some.load.isSmooth = true;
    for (int i = 0; i < all.load.count; ++i) {
        const int axis = all.load.axes[at(i)];
        trajectory::AxisTrajectory &p = jogs.axis[at(axis)].planner;
        if ((counted & (1U << axis)) != 0) {
            some.load.had[at(some.load.count)] = all.load.had[at(i)];
            some.load.axes[at(some.load.count++)] = axis;
        } else {
            p.max_velocity = p.max_acceleration = p.mean_s = 0;
        }
    }
    return some;
}

/// Sets what the axes may do; what all of them ask.
Look limit_axes(const TeleopMachine &m, const geometry::Pose &here, Jogs &jogs) noexcept {
    Look all;
    all.load.isSmooth = m.limits.path.isJerkLimited;
    for (int i = 0; i < MAX_AXES; ++i) {
        if (const trajectory::AxisTrajectory &p = jogs.axis[at(i)].planner; !p.isAtRest()) {
            all.load.had[at(all.load.count)] = p.leader().max_acceleration;
            all.load.axes[at(all.load.count++)] = i;
        }
    }
    if (all.load.count == 0) {
        return all;
    }
    look_here(m, here, jogs, all);
    look_ahead(m, here, jogs, all);
    if (!all.load.isSmooth) {
        apply_load(m, all.load, jogs, true);
        return all;
    }
    make_room(m, all.load, jogs);
    const std::uint32_t counted = counted_axes(jogs.shares);
    Look some = without_waiting(all, counted, jogs);
    if (some.load.count < all.load.count) {
        look_here(m, here, jogs, some);
        look_ahead(m, here, jogs, some);
    }
    const Look &last = some.load.count < all.load.count ? some : all;
    apply_smoothly(m, last.load, jogs, true);
    settle_shares(m, last.load, jogs);
    return all;
}

}  // namespace

TeleopStop limit_teleop(Jogs &jogs, const TeleopMachine &m) noexcept {
    geometry::Pose here;
    for (int i = 0; i < MAX_AXES; ++i) {
        here[i] = jogs.axis[at(i)].planner.position;
    }
    const Look look = limit_axes(m, here, jogs);
    const TeleopLoad &load = look.load;
    if (load.count == 0) {
        return {};
    }
    // The axes stop one after the other: every corner of the box that they stop in counts.
    int left = look.isFound ? -1 : m.num_joints;
    const int corners = 1 << std::min(load.count, MOST_CORNER_AXES);
    for (int n = 1; n < corners && left < 0; ++n) {
        geometry::Pose corner = look.stop;
        for (int i = 0; i < std::min(load.count, MOST_CORNER_AXES); ++i) {
            const int axis = load.axes[at(i)];
            corner[axis] = (n & (1 << i)) != 0 ? look.stop[axis] : here[axis];
        }
        left = joint_left_by(m, corner);
    }
    if (left < 0) {
        return {};
    }
    for (int i = 0; i < load.count; ++i) {
        jogs.axis[at(load.axes[at(i)])].planner.stop();
    }
    const bool isNew = !jogs.isTeleopStopped;
    jogs.isTeleopStopped = true;
    return {isNew, left < m.num_joints ? left : -1};
}

}  // namespace mw::motion

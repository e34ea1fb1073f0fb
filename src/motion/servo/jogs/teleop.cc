// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/teleop.hh"

#include <algorithm>
#include <cmath>

#include "motion/servo/jogs/teleop_load.hh"
#include "motion/servo/jogs/teleop_smooth.hh"

namespace mw::motion {

namespace {

/// Minimum distance past the stop of the jogs at which the kinematics is checked [machine units, degrees].
constexpr double LEAST_WINDOW = 0.5;
/// Rounding of a position at a joint's soft limit.
constexpr double POSITION_ROUNDING = 1e-9;
constexpr int MOST_CORNER_AXES = 5;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Accelerations of `n` axes that share the joints evenly, on curves at these speeds.
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

/// True when an axis could not stop at its target if all axes had their share and reached its speeds.
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

/// Shares the limits of each joint evenly among the axes that move it. While an axis needs all that it has to
/// stop at its target, no other axis begins or accelerates.
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
    // While one axis is faster than its share, the others keep their speed; the curve counts at its actual
    // speed.
    constexpr double ROUNDING = 1e-9;
    bool isOver = isHeld;
    for (int i = 0; i < load.count; ++i) {
        isOver = isOver || speed[at(i)] > v[at(i)] * (1.0 + ROUNDING);
    }
    for (int i = 0; i < load.count; ++i) {
        v[at(i)] = isOver ? std::min(v[at(i)], speed[at(i)]) : v[at(i)];
        // The centripetal part depends on the speed possible in this cycle, not on the target speed: while an
        // axis brakes, the remainder grows from cycle to cycle and never falls.
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

/// Longest time of any axis to stop.
double time_to_stop(const TeleopLoad &load, const Jogs &jogs, double period_s) noexcept {
    double most_s = 0;
    for (int i = 0; i < load.count; ++i) {
        const trajectory::AxisTrajectory &p = jogs.axis[at(load.axes[at(i)])].planner;
        // With the acceleration of the last cycle, whose samples reached as far.
        const double had = p.leader().max_acceleration;
        const double a = had > 0 ? std::min(had, p.max_acceleration) : p.max_acceleration;
        most_s = std::max(most_s, (a > 0 ? speed_of(p) / a : 0.0) + p.mean_in_force_s(period_s));
    }
    return most_s;
}

/// The homed joint that this pose moves outside its soft limits, further than it is now; -1 for none.
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

/// Load of the axes on the joints at the samples of this cycle.
struct Look {
    TeleopLoad load;
    geometry::Pose stop;  ///< stop position if they brake from the next cycle on
    bool isFound = true;
};

/// First at the current pose: a jog that begins has no acceleration yet that the joints can follow.
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

/// Then at the farthest positions that they may reach while they brake.
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
        // Not past the reachable range: otherwise the acceleration would be reduced while it brakes.
        double low = here[axis];
        double high = here[axis];
        p.add_reach(low, high);
        // While another axis brakes, this one continues and changes the joint motion of the other.
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

/// The axes of `all` without those that wait: these are stopped and need nothing of the joints.
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

/// Sets the limits of the axes; returns the load of all of them.
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
    // The axes stop one after the other: each corner of the box of their stop positions is checked.
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

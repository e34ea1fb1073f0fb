// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes on machines whose joints are not axes. After every cycle, the axes can stop without a joint
// exceeding a limit. If a cycle would end without such a stop, the axes brake along their current stop
// instead.
#include <algorithm>
#include <cmath>

#include "motion/servo/jogs/joint_load.hh"

namespace mw::motion {

namespace {

/// Distance past the stop of the jogs within which joints are examined [machine units, degrees].
constexpr double LEAST_WINDOW = 0.5;
/// Rounding of a position at a joint's soft limit, and at the target of an axis.
constexpr double POSITION_ROUNDING = 1e-9;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

std::uint32_t bit(int axis) noexcept {
    return 1U << axis;
}

/// Maximum speed during a stop from here; the acceleration must first fall to 0.
double fastest_of(const trajectory::AxisMotion &p) noexcept {
    const trajectory::MotionState state{0, p.velocity, p.acceleration};
    const double settled = p.max_jerk > 0 ? trajectory::settled_speed(state, p.max_jerk) : 0.0;
    return std::max(std::abs(p.velocity), std::abs(settled));
}

struct PositionRange {
    double low = 0, high = 0;

    bool contains(const PositionRange &other) const noexcept {
        return other.low >= low - POSITION_ROUNDING && other.high <= high + POSITION_ROUNDING;
    }
};

/// Outcome of an attempt to begin a cycle.
struct Attempt {
    enum class Kind : std::uint8_t { ACCEPTED, NO_STOP, JOINT_LIMIT } kind = Kind::ACCEPTED;
    int joint = -1;  ///< of JOINT_LIMIT; -1: the kinematics has no solution
};

using AxisJogs = std::array<Jog, MAX_AXES>;

/// The jogs of one cycle.
class TeleopCycle {
  public:
    TeleopCycle(AxisJogs &jogs, const TeleopMachine &machine) noexcept : jogs_(jogs), m_(machine) {
        load_.hasJerk = m_.limits.path.isJerkLimited;
        for (int i = 0; i < MAX_AXES; ++i) {
            const trajectory::AxisMotion &p = motion(i);
            here_[i] = p.position;
            if (p.isAtRest() || (m_.locked & bit(i)) != 0) {
                continue;
            }
            load_.axes[at(load_.count++)] = i;
            requested_ |= bit(i);
            const bool isMoving = p.velocity != 0.0 || p.acceleration != 0.0;
            moving_ |= isMoving ? bit(i) : 0U;
        }
    }

    /// `wasStopped`: jogs were already stopped, and reported.
    TeleopStop run(bool wasStopped) noexcept {
        if (requested_ == 0) {
            return {};
        }
        const Attempt attempt = begin();
        if (attempt.kind == Attempt::Kind::ACCEPTED) {
            return {};
        }
        if (attempt.kind == Attempt::Kind::JOINT_LIMIT) {
            stop_all();
        }
        brake();
        const bool isNew = attempt.kind == Attempt::Kind::JOINT_LIMIT && !wasStopped;
        return {isNew, attempt.joint};
    }

  private:
    const trajectory::AxisMotion &motion(int axis) const noexcept { return jogs_[at(axis)].motion(); }
    Jog &jog(int i) noexcept { return jogs_[at(load_.axes[at(i)])]; }
    const Jog &jog(int i) const noexcept { return jogs_[at(load_.axes[at(i)])]; }

    /// Tries all requested axes with their share of the joint limits. If no stop is possible, tries the
    /// moving axes alone: with the same share, with the limits that the joints allow them alone, then with
    /// their current limits.
    Attempt begin() noexcept {
        if (!examine()) {
            return {Attempt::Kind::JOINT_LIMIT, -1};
        }
        const AxisDemand shared = allowed_demand(m_, ahead_, requested_, wanted());
        Attempt attempt = attempt_with(shared, requested_);
        if (attempt.kind == Attempt::Kind::ACCEPTED || moving_ == 0) {
            return attempt;
        }
        AxisDemand own = shared;
        if (moving_ != requested_) {
            attempt = attempt_with(shared, moving_);
            if (attempt.kind == Attempt::Kind::ACCEPTED) {
                return attempt;
            }
            own = allowed_demand(m_, ahead_, moving_, wanted());
            attempt = attempt_with(own, moving_);
        }
        if (attempt.kind != Attempt::Kind::ACCEPTED) {
            attempt = attempt_with(with_current_limits(own), moving_);
        }
        return attempt;
    }

    /// What the jogs request.
    AxisDemand wanted() const noexcept {
        AxisDemand out;
        for (int i = 0; i < load_.count; ++i) {
            const double most = m_.limits.axis_jog[at(load_.axes[at(i)])].velocity;
            out.velocity[at(i)] = std::min(jog(i).wanted().velocity * m_.scale, most);
            out.acceleration[at(i)] = jog(i).wanted().acceleration;
            out.jerk[at(i)] = jog(i).wanted().jerk;
        }
        return out;
    }
    /// Acceleration and jerk of the last cycle.
    AxisDemand with_current_limits(const AxisDemand &speeds) const noexcept {
        AxisDemand out = speeds;
        for (int i = 0; i < load_.count; ++i) {
            out.acceleration[at(i)] = jog(i).motion().max_acceleration;
            out.jerk[at(i)] = jog(i).motion().max_jerk;
        }
        return out;
    }

    /// Calculates the load up to the stop of the axes, and past it. False if the kinematics has no solution
    /// before the stop.
    bool examine() noexcept {
        double square = 0;
        for (int i = 0; i < load_.count; ++i) {
            load_.direction[at(i)] = jog(i).wanted().velocity;
            square += load_.direction[at(i)] * load_.direction[at(i)];
        }
        geometry::Pose far = here_;
        for (int i = 0; i < load_.count; ++i) {
            const int axis = load_.axes[at(i)];
            const trajectory::AxisMotion &p = motion(axis);
            load_.direction[at(i)] *= p.target < p.position ? -1.0 : 1.0;
            load_.direction[at(i)] /= square > 0 ? std::sqrt(square) : 1.0;
            const double more = 2.0 * p.velocity * m_.period_s;
            const double distance = p.stopping().distance + more;
            PositionRange &near = near_[at(i)];
            near = {here_[axis], here_[axis]};
            p.add_stop(near.low, near.high);
            near.low += std::min(more, 0.0);
            near.high += std::max(more, 0.0);
            double low = here_[axis];
            double high = here_[axis];
            p.add_reach(low, high);
            far[axis] = std::clamp(here_[axis] + 2.0 * distance, low, high) +
                        LEAST_WINDOW * (p.target < p.position ? -1.0 : 1.0);
            far_[at(i)] = {std::min(near.low, far[axis]), std::max(near.high, far[axis])};
        }
        const bool isFound = add_pose(m_, here_, load_) && (moving_ == 0 || add_stop(moving_, load_));
        // Past the stop, only reachable positions count, because a jog may end at the edge of the workspace.
        ahead_ = load_;
        JointLoad more = load_;
        if (isFound && add_pose(m_, here_ + (far - here_) * 0.5, more)) {
            ahead_ = more;
            isFarKnown_ = add_pose(m_, far, more);
            ahead_ = isFarKnown_ ? more : ahead_;
        }
        return isFound;
    }

    /// Adds the load along the stop of the axes and one cycle past it. False if the kinematics has no
    /// solution there.
    bool add_stop(std::uint32_t members, JointLoad &load) const noexcept {
        constexpr int SAMPLES = 3;
        const Stop stop = stop_of(members);
        bool isFound = true;
        for (int n = 1; n <= SAMPLES && isFound; ++n) {
            geometry::Pose pose = pose_of(stop, stop.longest_s * n / SAMPLES);
            for (int i = 0; i < load_.count; ++i) {
                const int axis = load_.axes[at(i)];
                pose[axis] += 2.0 * motion(axis).velocity * m_.period_s;
            }
            isFound = add_pose(m_, pose, load);
        }
        return isFound;
    }

    /// Starts the cycle with these limits if the axes of `members` have a stop after it.
    Attempt attempt_with(const AxisDemand &limits, std::uint32_t members) noexcept {
        const AxisJogs before = jogs_;
        AxisDemand now = limits;
        bool hasStop = true;
        bool isNear = true;
        for (int i = 0; i < load_.count; ++i) {
            const int axis = load_.axes[at(i)];
            if (!isMember(members, i)) {
                continue;
            }
            const trajectory::AxisMotion &p = motion(axis);
            double low = p.position;
            double high = p.position;
            p.add_reach(low, high);
            jog(i).set_limits({limits.velocity[at(i)], limits.acceleration[at(i)], limits.jerk[at(i)]});
            const trajectory::MotionState begin{0, p.velocity, p.acceleration};
            jog(i).step(m_.period_s);
            now.velocity[at(i)] = std::max(std::abs(begin.v), fastest_of(p));
            // If the acceleration changes sign, the maximum speed is within the cycle.
            const bool isPeak = begin.a * p.acceleration < 0;
            now.velocity[at(i)] += isPeak ? p.max_jerk * m_.period_s * m_.period_s / 8 : 0.0;
            now.acceleration[at(i)] = std::max(now.acceleration[at(i)], std::abs(p.acceleration));
            // The axis must not pass its target.
            double next_low = p.position;
            double next_high = p.position;
            p.add_reach(next_low, next_high);
            hasStop = hasStop && next_low >= low - POSITION_ROUNDING && next_high <= high + POSITION_ROUNDING;
            PositionRange stop{p.position, p.position};
            p.add_stop(stop.low, stop.high);
            isNear = isNear && near_[at(i)].contains(stop);
            hasStop = hasStop && (isNear || (isFarKnown_ && far_[at(i)].contains(stop)));
        }
        Attempt out;
        const JointLoad &known = isNear ? load_ : ahead_;
        if (!hasStop || !isWithinJoints(m_, known, members, now) ||
            !isStopWithinJoints(known, members, now)) {
            out.kind = Attempt::Kind::NO_STOP;
        } else {
            out = examine_stop(members);
        }
        if (out.kind != Attempt::Kind::ACCEPTED) {
            jogs_ = before;
        }
        return out;
    }

    /// Other limits change the line along which several axes stop, so the joints are examined there, too.
    bool isStopWithinJoints(const JointLoad &known, std::uint32_t members, const AxisDemand &now) noexcept {
        if (load_.count < 2) {
            return true;
        }
        JointLoad along = known;
        return add_stop(members, along) && isWithinJoints(m_, along, members, now);
    }

    /// Checks that the joints stay within their soft limits along the stop of the axes.
    Attempt examine_stop(std::uint32_t members) const noexcept {
        constexpr int SAMPLES = 16;
        const Stop stop = stop_of(members);
        const double step_s = stop.longest_s / SAMPLES;
        JointsAt before = m_.joint_positions;
        JointsAt here{};
        JointsAt next{};
        if (!find_joints(m_, pose_of(stop, 0), here)) {
            return {Attempt::Kind::JOINT_LIMIT, -1};
        }
        for (int n = 0; n <= SAMPLES; ++n) {
            if (!find_joints(m_, pose_of(stop, step_s * (n + 1)), next)) {
                return {Attempt::Kind::JOINT_LIMIT, -1};
            }
            for (int j = 0; j < m_.num_joints; ++j) {
                // If a joint reverses, it exceeds the samples by at most a dt^2 / 8.
                const bool isReversal = (here[at(j)] - before[at(j)]) * (next[at(j)] - here[at(j)]) < 0;
                const double more = isReversal ? m_.joints.acceleration[at(j)] * step_s * step_s / 8 : 0.0;
                if (isOutside(j, here[at(j)], more)) {
                    return {Attempt::Kind::JOINT_LIMIT, j};
                }
            }
            before = here;
            here = next;
        }
        return {};
    }
    bool isOutside(int j, double position, double more) const noexcept {
        const double now = m_.joint_positions[at(j)];
        return position - more < std::min(m_.joints.low[at(j)], now) - POSITION_ROUNDING ||
               position + more > std::max(m_.joints.high[at(j)], now) + POSITION_ROUNDING;
    }

    bool isMember(std::uint32_t members, int i) const noexcept {
        return (members & bit(load_.axes[at(i)])) != 0;
    }
    /// Stops of the axes of `members` from their current states.
    struct Stop {
        std::uint32_t members = 0;
        std::array<trajectory::SpeedChange, MAX_AXES> axis{};
        double longest_s = 0;
    };
    Stop stop_of(std::uint32_t members) const noexcept {
        Stop stop;
        stop.members = members;
        for (int i = 0; i < load_.count; ++i) {
            if (isMember(members, i)) {
                stop.axis[at(i)] = jog(i).motion().stopping();
                stop.longest_s = std::max(stop.longest_s, stop.axis[at(i)].duration);
            }
        }
        return stop;
    }
    geometry::Pose pose_of(const Stop &stop, double t) const noexcept {
        geometry::Pose pose = here_;
        for (int i = 0; i < load_.count; ++i) {
            const trajectory::AxisMotion &p = jog(i).motion();
            pose[load_.axes[at(i)]] =
                isMember(stop.members, i) ? p.stop_position(stop.axis[at(i)], t) : p.position;
        }
        return pose;
    }
    void stop_all() noexcept {
        for (int i = 0; i < load_.count; ++i) {
            jog(i).stop();
        }
    }
    /// Brakes the moving axes with the current limits; that stop has been accepted before.
    void brake() noexcept {
        for (int i = 0; i < load_.count; ++i) {
            const trajectory::AxisMotion &m = jog(i).motion();
            jog(i).set_limits({0, m.max_acceleration, m.max_jerk});
            if (isMember(moving_, i)) {
                jog(i).step(m_.period_s);
            }
        }
    }

    AxisJogs &jogs_;
    const TeleopMachine &m_;
    geometry::Pose here_;
    std::uint32_t requested_ = 0;  ///< bit per axis that is not at its target
    std::uint32_t moving_ = 0;
    JointLoad load_;   ///< up to the stop
    JointLoad ahead_;  ///< and past it
    bool isFarKnown_ = false;
    std::array<PositionRange, MAX_AXES> near_{},
        far_{};  ///< positions of the axes for which these loads are valid
};

}  // namespace

TeleopStop Jogs::step_teleop(const TeleopMachine &machine) noexcept {
    const TeleopStop stop = TeleopCycle(axis_, machine).run(teleop_stopped_);
    teleop_stopped_ = teleop_stopped_ || stop.isNew;
    return stop;
}

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// moveoff: offsets added to joint positions in HAL, for instance to retract the tool during a pause; up to 9
// joints (`personality=`, 3 by default). The manual page describes all pins.
#include <cmath>

#include "components/limit/limit_core.hh"
#include "components/machine/follower.hh"
#include "hal/sdk/component.hh"

MW_PERSONALITY("joints of each instance");

namespace mw::components {
using namespace sdk;

enum MoveoffState : std::int32_t {
    MOVEOFF_IDLE,
    MOVEOFF_ON,
    MOVEOFF_FULL,
    MOVEOFF_STOPPING,
    MOVEOFF_RETURNING
};

constexpr int MAX_JOINTS = 9;
constexpr int MAX_WAYPOINTS = 1000;
constexpr int TEST_WAYPOINTS = 10;
constexpr double NEGLIGIBLE = 1e-9;

struct MoveoffJoint {
    In<double> offset_in, pos, fb, vel, accel, min, max;
    Out<double> offset_current, pos_plusoffset, fb_minusoffset;
    Follower follower;
    double leg_velocity = 0.0;
    double leg_acceleration = 0.0;
    double leg_target = 0.0;

    bool hasLimits() const noexcept { return vel > 0.0 && accel > 0.0; }
};

struct Moveoff {
    int joints = 0;
    MoveoffJoint joint[MAX_JOINTS];
    In<bool> power_on, move_enable, apply_offsets, backtrack_enable, limit_test;
    In<double> epsilon, waypoint_threshold, waypoint_sample_secs;
    Out<bool> warning, offset_applied, waypoint_limit;
    Out<std::int32_t> waypoint_ct, waypoint_percent, dbg_state;

    double waypoint[MAX_WAYPOINTS][MAX_JOINTS] = {};
    int waypoints = 0;
    double since_waypoint_s = 0.0;
    double tolerance = 0.0005;  // the settings that are used while not idle
    double threshold = 0.02;
    double sample_s = 0.02;
    bool leg_started = false;
    MoveoffState state = MOVEOFF_IDLE;

    void declare(Declare &d) noexcept;
    void declare_joint(Declare &d, int number) noexcept;
    void read_inputs(long period_ns) noexcept;
    void write_outputs() noexcept;

  private:
    int max_waypoints() const noexcept { return limit_test ? TEST_WAYPOINTS : MAX_WAYPOINTS; }
    bool isAway() const noexcept;
    bool isMoving() const noexcept;
    void take_settings() noexcept;
    void record(double dt) noexcept;
    void follow_inputs(double dt) noexcept;
    void stop(double dt) noexcept;
    void return_home(double dt) noexcept;
    void start_leg() noexcept;
    void next_state(bool enabled) noexcept;
    void show(bool enabled) noexcept;
};

void Moveoff::declare(Declare &d) noexcept {
    joints = d.personality_number(personality[d.index()], 3, MAX_JOINTS, "joints");
    d.pin(power_on, "power-on");
    d.pin(move_enable, "move-enable");
    d.pin(apply_offsets, "apply-offsets");
    d.pin(backtrack_enable, "backtrack-enable", true);
    d.pin(epsilon, "epsilon", 0.0005);
    d.pin(waypoint_threshold, "waypoint-threshold", 0.02);
    d.pin(waypoint_sample_secs, "waypoint-sample-secs", 0.02);
    d.pin(warning, "warning");
    d.pin(offset_applied, "offset-applied");
    d.pin(waypoint_limit, "waypoint-limit");
    d.pin(waypoint_ct, "waypoint-ct");
    d.pin(waypoint_percent, "waypoint-percent-used");
    for (int i = 0; i < joints; ++i) {
        declare_joint(d, i);
    }
    d.pin(limit_test, "dbg-waypoint-limit-test");
    d.pin(dbg_state, "dbg-state");
    d.function<&Moveoff::read_inputs>(this, "read-inputs");
    d.function<&Moveoff::write_outputs>(this, "write-outputs");
}

void Moveoff::declare_joint(Declare &d, int number) noexcept {
    MoveoffJoint &made = joint[number];
    d.pin_at(made.offset_in, "offset-in-%d", number);
    d.pin_at(made.pos, "pos-%d", number);
    d.pin_at(made.fb, "fb-%d", number);
    d.pin_at(made.offset_current, "offset-current-%d", number);
    d.pin_at(made.pos_plusoffset, "pos-plusoffset-%d", number);
    d.pin_at(made.fb_minusoffset, "fb-minusoffset-%d", number);
    d.pin_at(made.vel, "offset-vel-%d", number, 10.0);
    d.pin_at(made.accel, "offset-accel-%d", number, 100.0);
    d.pin_at(made.min, "offset-min-%d", number, -1e20);
    d.pin_at(made.max, "offset-max-%d", number, 1e20);
}

bool Moveoff::isAway() const noexcept {
    for (int i = 0; i < joints; ++i) {
        if (std::fabs(joint[i].follower.position()) > 0.0) {
            return true;
        }
    }
    return false;
}

bool Moveoff::isMoving() const noexcept {
    for (int i = 0; i < joints; ++i) {
        if (joint[i].follower.velocity() != 0.0) {
            return true;
        }
    }
    return false;
}

void Moveoff::take_settings() noexcept {
    constexpr double SMALLEST_EPSILON = 0.0001;
    tolerance = epsilon > SMALLEST_EPSILON ? epsilon.get() : SMALLEST_EPSILON;
    threshold = waypoint_threshold > 0.0 ? waypoint_threshold.get() : 0.0;
    sample_s = waypoint_sample_secs > 0.0 ? waypoint_sample_secs.get() : 0.0;
    waypoints = 0;
    since_waypoint_s = 0.0;
}

/// Records the positions of the joints when they are far enough from the last recorded position.
void Moveoff::record(double dt) noexcept {
    since_waypoint_s += dt;
    if (since_waypoint_s < sample_s) {
        return;
    }
    double farthest = 0.0;
    for (int i = 0; i < joints; ++i) {
        const double last = waypoints > 0 ? waypoint[waypoints - 1][i] : 0.0;
        farthest = std::fmax(farthest, std::fabs(joint[i].follower.position() - last));
    }
    if (farthest <= threshold) {
        return;
    }
    if (waypoints >= max_waypoints()) {
        state = MOVEOFF_FULL;
        return;
    }
    for (int i = 0; i < joints; ++i) {
        waypoint[waypoints][i] = joint[i].follower.position();
    }
    ++waypoints;
    since_waypoint_s = 0.0;
}

void Moveoff::follow_inputs(double dt) noexcept {
    for (int i = 0; i < joints; ++i) {
        MoveoffJoint &moved = joint[i];
        const double wanted = moved.offset_in;
        const double target = std::isfinite(wanted) ? limit::between(wanted, moved.min, moved.max) : wanted;
        moved.follower.run(target, moved.vel, moved.accel, dt);
    }
}

void Moveoff::stop(double dt) noexcept {
    for (int i = 0; i < joints; ++i) {
        joint[i].follower.stop(joint[i].accel, dt);
    }
}

/// A straight line to the next waypoint: all joints cover the same fraction of their distance at all times.
/// Without backtracking each joint moves to 0 by itself.
void Moveoff::start_leg() noexcept {
    const bool is_last = waypoints == 0 || !backtrack_enable;
    waypoints = is_last ? 0 : waypoints - 1;
    double rate = 1e30;  // fraction of the distance per second, and per second squared
    double rate2 = 1e30;
    for (int i = 0; i < joints; ++i) {
        joint[i].leg_target = is_last ? 0.0 : waypoint[waypoints][i];
        const double way = std::fabs(joint[i].leg_target - joint[i].follower.position());
        if (way < NEGLIGIBLE) {
            // Its share of the line would be slower than the resolution of positions.
            joint[i].follower.planner.reset(joint[i].leg_target);
            continue;
        }
        rate = std::fmin(rate, joint[i].vel / way);
        rate2 = std::fmin(rate2, joint[i].accel / way);
    }
    for (int i = 0; i < joints; ++i) {
        const double way = std::fabs(joint[i].leg_target - joint[i].follower.position());
        const bool straight = backtrack_enable;
        joint[i].leg_velocity = straight ? rate * way : joint[i].vel.get();
        joint[i].leg_acceleration = straight ? rate2 * way : joint[i].accel.get();
    }
}

void Moveoff::return_home(double dt) noexcept {
    if (!leg_started) {
        start_leg();
        leg_started = true;
    }
    bool present = true;
    for (int i = 0; i < joints; ++i) {
        MoveoffJoint &moved = joint[i];
        // A joint without limits cannot move; it must not block the others.
        moved.follower.run(moved.leg_target, moved.leg_velocity, moved.leg_acceleration, dt);
        const double missing = std::fabs(moved.follower.position() - moved.leg_target);
        const bool near = missing <= tolerance && moved.follower.velocity() == 0.0;
        present = present && (near || !moved.hasLimits());
    }
    leg_started = !present;
}

void Moveoff::next_state(bool enabled) noexcept {
    switch (state) {
    case MOVEOFF_IDLE:
        take_settings();
        state = enabled ? MOVEOFF_ON : MOVEOFF_IDLE;
        break;
    case MOVEOFF_ON:
    case MOVEOFF_FULL: state = enabled ? state : MOVEOFF_STOPPING; break;
    case MOVEOFF_STOPPING:
    case MOVEOFF_RETURNING:
        if (enabled) {
            state = MOVEOFF_ON;
        } else if (state == MOVEOFF_STOPPING && !isMoving()) {
            state = MOVEOFF_RETURNING;
            leg_started = false;
        } else if (state == MOVEOFF_RETURNING && !isAway() && !isMoving()) {
            state = MOVEOFF_IDLE;
        }
        break;
    }
}

void Moveoff::show(bool enabled) noexcept {
    bool applied = false;
    for (int i = 0; i < joints; ++i) {
        applied = applied || std::fabs(joint[i].follower.position()) > tolerance;
    }
    const bool dropped = applied && !apply_offsets && power_on;
    if (dropped && !warning && !enabled) {
        rtapi_print_msg(RTAPI_MSG_ERR, "moveoff: apply-offsets became false while offsets are applied\n");
    }
    warning = dropped;
    offset_applied = applied;
    waypoint_limit = state == MOVEOFF_FULL;
    waypoint_ct = waypoints;
    waypoint_percent = 100 * waypoints / max_waypoints();
    dbg_state = state;
}

void Moveoff::read_inputs(long period_ns) noexcept {
    const double dt = seconds(period_ns);
    const bool enabled = move_enable && apply_offsets;
    if (!power_on) {
        // Nothing can move. The offsets are kept, so that the feedback remains correct.
        for (int i = 0; i < joints; ++i) {
            joint[i].follower.planner.reset(joint[i].follower.position());
        }
        leg_started = false;
        show(enabled);
        return;
    }
    next_state(enabled);
    switch (state) {
    case MOVEOFF_ON:
        follow_inputs(dt);
        record(dt);
        break;
    case MOVEOFF_FULL:
    case MOVEOFF_STOPPING: stop(dt); break;
    case MOVEOFF_RETURNING: return_home(dt); break;
    default: break;
    }
    show(enabled);
}

void Moveoff::write_outputs() noexcept {
    for (int i = 0; i < joints; ++i) {
        const double offset = joint[i].follower.position();
        joint[i].offset_current = offset;
        set_finite(joint[i].pos_plusoffset, joint[i].pos + offset);
        set_finite(joint[i].fb_minusoffset, joint[i].fb - offset);
    }
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Moveoff, "moveoff", mw::sdk::MANY);

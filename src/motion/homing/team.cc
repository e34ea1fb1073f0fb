// SPDX-License-Identifier: GPL-2.0-or-later
// Moves joints together. A group has one number of HOME_SEQUENCE, negative for at least one of its joints:
// its joints begin the final move together. A team is the part of a group that moves one axis, for instance
// the two sides of a gantry. Its joints start and stop together on each leg, with one speed and one
// acceleration, and no two of them differ by more than HOME_MAX_SKEW.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "motion/homing/homing.hh"

namespace mw::homing {

namespace {

/// Default of HOME_MAX_SKEW as a fraction of the range between the soft limits.
constexpr double SKEW_SHARE = 0.01;
/// Ratio of `travel` to that range.
constexpr double TRAVEL_PER_RANGE = 2;
/// Rounding error of a joint's travel.
constexpr double ROUNDING = 1e-9;

double skew_of(const Parameters &p) noexcept {
    return p.max_skew > 0 ? p.max_skew : SKEW_SHARE * p.travel / TRAVEL_PER_RANGE;
}

bool areSameWay(double a, double b) noexcept {
    return (a > 0) == (b > 0) && (a < 0) == (b < 0);
}

}  // namespace

/// Both joints are homing, end together, and move one axis or have a maximum difference.
bool Homing::areTeam(int a, int b) const noexcept {
    const Parameters &p = at(a).parameters;
    const Parameters &q = at(b).parameters;
    const bool isGroup = isHoming(a) && isHoming(b) && p.isInSequence() && q.isInSequence() &&
                         std::abs(p.sequence) == std::abs(q.sequence) && (p.sequence < 0 || q.sequence < 0);
    return isGroup && ((p.axis >= 0 && p.axis == q.axis) || (p.max_skew > 0 && q.max_skew > 0));
}

bool Homing::hasTeam(int joint) const noexcept {
    for (int k = 0; k < num_joints_; ++k) {
        if (k != joint && areTeam(joint, k)) {
            return true;
        }
    }
    return false;
}

std::uint32_t Homing::team_events(int joint, const JointInput *inputs) const noexcept {
    const Joint &j = at(joint);
    // Also true if the joint must back off further.
    const auto isClosed = [&](int n) {
        const Joint &one = at(n);
        const bool isNear = one.state == State::LATCH_BACKOFF && !inputs[n].isAtRest &&
                            std::abs(one.way - one.closed_way) < one.parameters.clearance;
        return inputs[n].isSwitchClosed || isNear;
    };
    bool isAnyClosed = isClosed(joint);
    bool areAtRest = inputs[joint].isAtRest;
    int shortest = j.wait;
    bool areUnlocked = inputs[joint].isUnlocked || !j.parameters.isLockingIndexer;
    bool areLatched = j.state == State::LATCHED;
    bool areHere = true;
    bool isOther = false;
    bool isFarApart = false;
    constexpr std::uint32_t MANNER = setting::SEARCHING | setting::LATCHING | setting::INDEX |
                                     setting::ABSOLUTE | setting::STAYING | setting::LOCKING;
    for (int k = 0; k < num_joints_; ++k) {
        if (k == joint || !areTeam(joint, k)) {
            continue;
        }
        const Joint &other = at(k);
        const Parameters &p = other.parameters;
        isAnyClosed = isAnyClosed || isClosed(k);
        areAtRest = areAtRest && inputs[k].isAtRest;
        shortest = std::min(shortest, other.wait);
        areUnlocked = areUnlocked && (inputs[k].isUnlocked || !p.isLockingIndexer);
        areLatched = areLatched && other.state == State::LATCHED;
        areHere = areHere && other.state == j.state;
        isOther = isOther || ((settings_of(joint) ^ settings_of(k)) & MANNER) != 0 ||
                  !areSameWay(j.parameters.search_vel, p.search_vel) ||
                  !areSameWay(j.parameters.latch_vel, p.latch_vel);
        isFarApart = isFarApart || isSkewed(joint, k, inputs);
    }
    std::uint32_t out = isAnyClosed ? event::TEAM_CLOSED : event::TEAM_OPEN;
    out |= areAtRest && areHere ? event::TEAM_AT_REST : 0U;
    const bool areSettled = areAtRest && areHere && shortest * period_s_ > LONGEST_BOUNCE_S;
    out |= areSettled ? event::TEAM_SETTLED : 0U;
    out |= areUnlocked ? event::TEAM_UNLOCKED : 0U;
    out |= areLatched ? event::TEAM_LATCHED : 0U;
    out |= isOther ? event::TEAM_DIFFERS : 0U;
    out |= isFarApart ? event::TEAM_SKEWED : 0U;
    return out;
}

/// The difference between two joints of a team exceeds its maximum, or would exceed it before they stop.
bool Homing::isSkewed(int a, int b, const JointInput *inputs) const noexcept {
    const Parameters &p = at(a).parameters;
    const Parameters &q = at(b).parameters;
    const double most = std::min(skew_of(p), skew_of(q));
    const double now = at(a).way - at(b).way;
    if (std::abs(now) > most + ROUNDING) {
        return true;
    }
    const bool isLast = at(a).state == State::WAIT_FOR_GROUP && at(b).state == State::WAIT_FOR_GROUP;
    if (isLast) {
        const double left = (p.home - inputs[a].pos_cmd) - (q.home - inputs[b].pos_cmd);
        return std::abs(now + left) > most + ROUNDING;
    }
    if (at(a).state == State::FINAL) {
        return false;  // the joint moves directly to its target
    }
    const double acceleration = std::min(inputs[a].max_acceleration, inputs[b].max_acceleration);
    const double v = inputs[a].vel_cmd;
    const double w = inputs[b].vel_cmd;
    if (!(acceleration > 0) || (v == 0 && w == 0)) {
        return false;
    }
    // Travel of each joint if it brakes one cycle later than now, after one more cycle of acceleration.
    const auto rest = [&](double way, double speed) {
        const double gain = speed == 0 ? 0.0 : std::copysign(acceleration * period_s_ * period_s_, speed);
        return way + 2 * speed * period_s_ + gain + speed * std::abs(speed) / (2 * acceleration);
    };
    return std::abs(rest(at(a).way, v) - rest(at(b).way, w)) > most;
}

/// All joints of a synchronised group have found their zero.
bool Homing::isGroupReady(int joint) const noexcept {
    const int number = std::abs(at(joint).parameters.sequence);
    bool isSynchronised = false;
    bool isReady = true;
    for (int k = 0; k < num_joints_; ++k) {
        const Joint &j = at(k);
        if (!j.parameters.isInSequence() || std::abs(j.parameters.sequence) != number || !isHoming(k)) {
            continue;
        }
        const bool isThere =
            j.state == State::WAIT_FOR_GROUP || j.state == State::FINAL || j.state == State::LOCK;
        isSynchronised = isSynchronised || j.parameters.sequence < 0;
        isReady = isReady && isThere;
    }
    return !isSynchronised || isReady;
}

/// A signed move at a signed speed, limited to the travel; the same for all joints of a team.
void Homing::go(int joint, double Parameters::*velocity, double sign, const JointInput *inputs,
                JointCommand &out) noexcept {
    Joint &j = at(joint);
    const double own = sign * j.parameters.*velocity;
    Leg leg{std::abs(own), inputs[joint].max_velocity, inputs[joint].max_acceleration, j.parameters.travel};
    bool isAlone = true;
    for (int k = 0; k < num_joints_; ++k) {
        if (k != joint && areTeam(joint, k)) {
            const Parameters &p = at(k).parameters;
            leg.velocity = std::min(leg.velocity, std::abs(p.*velocity));
            leg.most_velocity = std::min(leg.most_velocity, inputs[k].max_velocity);
            leg.acceleration = std::min(leg.acceleration, inputs[k].max_acceleration);
            leg.travel = std::min(leg.travel, p.travel);
            isAlone = false;
        }
    }
    out.move = Move::BY;
    out.value = std::copysign(leg.travel, own);
    out.velocity = isAlone ? leg.velocity : std::min(leg.velocity, leg.most_velocity);
    if (!isAlone) {
        out.most_velocity = leg.most_velocity;
        out.acceleration = leg.acceleration;
        j.team_acceleration = leg.acceleration;
    }
}

/// The final move. Joints of a team move for the same time, each over its part of the longest distance, so
/// that their difference changes linearly to its final value.
void Homing::go_home(int joint, const JointInput *inputs, JointCommand &out) noexcept {
    Joint &j = at(joint);
    const auto speed_of = [](const Parameters &p, const JointInput &in) {
        return p.final_vel > 0 ? std::min(p.final_vel, in.max_velocity) : in.max_velocity;
    };
    out.move = Move::TO;
    out.value = j.parameters.home;
    out.velocity = j.parameters.final_vel > 0 ? j.parameters.final_vel : 0;
    out.isSmooth = true;
    if (!hasTeam(joint)) {
        return;
    }
    const auto way_of = [&](int k) { return std::abs(at(k).parameters.home - inputs[k].pos_cmd); };
    double farthest = 0;
    for (int k = 0; k < num_joints_; ++k) {
        farthest = k == joint || areTeam(joint, k) ? std::max(farthest, way_of(k)) : farthest;
    }
    const double part = farthest > 0 ? way_of(joint) / farthest : 0.0;
    if (part <= 0) {
        return;
    }
    constexpr double NO_JERK_LIMIT = 1e300;
    Leg leg{1e300, 1e300, 1e300, 0};
    double jerk = NO_JERK_LIMIT;
    for (int k = 0; k < num_joints_; ++k) {
        const double share = way_of(k) / farthest;
        if ((k == joint || areTeam(joint, k)) && share > 0) {
            leg.velocity = std::min(leg.velocity, speed_of(at(k).parameters, inputs[k]) / share);
            leg.most_velocity = std::min(leg.most_velocity, inputs[k].max_velocity / share);
            leg.acceleration = std::min(leg.acceleration, inputs[k].max_acceleration / share);
            jerk = inputs[k].max_jerk > 0 ? std::min(jerk, inputs[k].max_jerk / share) : jerk;
        }
    }
    out.velocity = part * leg.velocity;
    out.most_velocity = part * leg.most_velocity;
    out.acceleration = part * leg.acceleration;
    out.jerk = jerk < NO_JERK_LIMIT ? part * jerk : 0.0;
    j.team_acceleration = out.acceleration;
}

}  // namespace mw::homing

// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/core/homing/homing_drive.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

constexpr int ALL = -1, VOLATILE_ONES = -2;

}  // namespace

std::uint32_t homed_mask(const HomingDrive &drive) noexcept {
    std::uint32_t mask = 0;
    for (int j = 0; j < drive.num_joints; ++j) {
        mask |= drive.homing.isHomed(j) ? 1U << j : 0U;
    }
    return mask;
}

Verdict take(HomingDrive &drive, const Home &command, const HomeConditions &conditions) noexcept {
    const int j = command.joint;
    if (j < ALL || j >= drive.num_joints) {
        return verdict_of(j, Reason::NO_SUCH_JOINT);
    }
    if (!conditions.isReady) {
        return verdict_of(j, Reason::NOT_ENABLED);
    }
    if (conditions.mode != Mode::FREE) {
        return verdict_of(j, Reason::WRONG_MODE);
    }
    if (drive.isUnderWay()) {
        return verdict_of(j, Reason::HOMING);
    }
    if (conditions.isInhibited) {
        return verdict_of(j, Reason::HOMING_INHIBITED);
    }
    drive.isDue = true;
    drive.due = j;
    return verdict_of(j, Reason::NONE);
}

Verdict take(HomingDrive &drive, const Unhome &command, const HomeConditions &conditions,
             const Settings &settings) noexcept {
    const int j = command.joint;
    if (j < VOLATILE_ONES || j >= drive.num_joints) {
        return verdict_of(j, Reason::NO_SUCH_JOINT);
    }
    if (drive.isUnderWay()) {
        return verdict_of(j, Reason::HOMING);
    }
    if (conditions.isMoving) {
        return verdict_of(j, Reason::MOVING);
    }
    if (conditions.isReady && conditions.mode != Mode::FREE) {
        return verdict_of(j, Reason::WRONG_MODE);  // a pose stands on the homes
    }
    for (int k = 0; k < drive.num_joints; ++k) {
        const bool isVolatile = j == VOLATILE_ONES && settings.isSet(Parameter::JOINT_VOLATILE_HOME, k);
        if (j == ALL || j == k || isVolatile) {
            drive.homing.unhome(k);
        }
    }
    return verdict_of(j, Reason::NONE);
}

void configure(HomingDrive &drive, int j, const Settings &settings) noexcept {
    const auto get = [&](Parameter p) { return settings.get(p, j); };
    homing::Parameters &p = drive.homing.parameters(j);
    p.search_vel = get(Parameter::JOINT_HOME_SEARCH_VEL);
    p.latch_vel = get(Parameter::JOINT_HOME_LATCH_VEL);
    p.final_vel = get(Parameter::JOINT_HOME_FINAL_VEL);
    p.home = get(Parameter::JOINT_HOME);
    p.offset = get(Parameter::JOINT_HOME_OFFSET);
    p.isUsingIndex = settings.isSet(Parameter::JOINT_HOME_USE_INDEX, j);
    p.isIndexWithoutReset = settings.isSet(Parameter::JOINT_HOME_INDEX_NO_ENCODER_RESET, j);
    p.isSharedSwitch = settings.isSet(Parameter::JOINT_HOME_IS_SHARED, j);
    p.isIgnoringLimits = settings.isSet(Parameter::JOINT_HOME_IGNORE_LIMITS, j);
    p.absolute_encoder = static_cast<int>(get(Parameter::JOINT_HOME_ABSOLUTE_ENCODER));
    p.sequence = static_cast<int>(get(Parameter::JOINT_HOME_SEQUENCE));
    const double range = get(Parameter::JOINT_MAX_LIMIT) - get(Parameter::JOINT_MIN_LIMIT);
    constexpr double LONGEST_SEARCH = 1e9;
    p.travel = std::isfinite(range) && range < LONGEST_SEARCH ? 2.0 * std::max(range, 0.0) : LONGEST_SEARCH;
}

void abort(HomingDrive &drive, homing::Failure why) noexcept {
    drive.homing.abort(why);
    drive.isDue = false;
}

void switch_off(HomingDrive &drive, const Settings &settings) noexcept {
    abort(drive, homing::Failure::ABORTED);
    for (int j = 0; j < drive.num_joints; ++j) {
        if (settings.isSet(Parameter::JOINT_VOLATILE_HOME, j)) {
            drive.homing.unhome(j);
        }
    }
}

void begin_due(HomingDrive &drive, bool isMoving) noexcept {
    if (drive.isDue && !isMoving) {
        drive.isDue = false;
        drive.homing.start(drive.due);
    }
}

HomingFailure take_failure(HomingDrive &drive) noexcept {
    HomingFailure out;
    out.joint = drive.homing.take_failure(out.why);
    return out.why == homing::Failure::ABORTED ? HomingFailure() : out;
}

void fill(const HomingDrive &drive, Outputs &out) noexcept {
    out.status.isHoming = drive.isUnderWay();
    for (int j = 0; j < drive.num_joints; ++j) {
        const auto n = static_cast<std::size_t>(j);
        out.status.joint[n].isHoming = drive.homing.isHoming(j);
        out.joint[n].isIndexEnabled = drive.homing.isIndexWanted(j);
        out.joint[n].home_state = static_cast<int>(drive.homing.state(j));
    }
}

}  // namespace mw::motion

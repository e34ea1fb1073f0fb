// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/homing/homing_drive.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::motion {

namespace {

constexpr int ALL = -1, VOLATILE_ONES = -2;

/// Millwright's homing is called directly: every cycle calls it.
template <class Function>
auto with_module(const HomingDrive &drive, const Function &function) noexcept {
    return drive.foreign != nullptr ? function(*drive.foreign) : function(drive.own);
}

}  // namespace

std::uint32_t homed_mask(const HomingDrive &drive) noexcept {
    if (drive.foreign == nullptr) [[likely]] {
        return drive.own.summary().homed & ((1U << drive.num_joints) - 1U);
    }
    std::uint32_t mask = 0;
    for (int j = 0; j < drive.num_joints; ++j) {
        mask |= drive.foreign->isHomed(j) ? 1U << j : 0U;
    }
    return mask;
}

bool isAllHomed(const HomingDrive &drive) noexcept {
    const std::uint32_t all = (1U << drive.num_to_home) - 1U;
    return drive.num_to_home > 0 && (homed_mask(drive) & all) == all;
}

CommandResult take(HomingDrive &drive, const Home &command, const HomeConditions &conditions) noexcept {
    const int j = command.joint;
    if (j < ALL || j >= drive.num_joints) {
        return result_of(j, Reason::NO_SUCH_JOINT);
    }
    if (!conditions.isReady) {
        return result_of(j, Reason::NOT_ENABLED);
    }
    if (conditions.mode != Mode::FREE) {
        return result_of(j, Reason::WRONG_MODE);
    }
    if (drive.isUnderWay()) {
        return result_of(j, Reason::HOMING);
    }
    if (conditions.isInhibited) {
        return result_of(j, Reason::HOMING_INHIBITED);
    }
    if (j >= 0 && (conditions.inactive >> j & 1U) != 0) {
        return result_of(j, Reason::JOINT_INACTIVE);
    }
    drive.isDue = true;
    drive.due = j;
    return result_of(j, Reason::NONE);
}

CommandResult take(HomingDrive &drive, const Unhome &command, const HomeConditions &conditions,
                   const Settings &settings) noexcept {
    const int j = command.joint;
    if (j < VOLATILE_ONES || j >= drive.num_joints) {
        return result_of(j, Reason::NO_SUCH_JOINT);
    }
    if (drive.isUnderWay()) {
        return result_of(j, Reason::HOMING);
    }
    if (conditions.isMoving) {
        return result_of(j, Reason::MOVING);
    }
    if (conditions.isReady && conditions.mode != Mode::FREE) {
        return result_of(j, Reason::WRONG_MODE);  // the pose depends on the homes
    }
    std::uint32_t meant = 0;
    for (int k = 0; k < drive.num_joints; ++k) {
        const bool isVolatile = j == VOLATILE_ONES && settings.isSet(Parameter::JOINT_VOLATILE_HOME, k);
        meant |= j == ALL || j == k || isVolatile ? 1U << k : 0U;
    }
    if (const std::uint32_t kept = meant & conditions.kept_while_on; kept != 0) {
        return result_of(std::countr_zero(kept), Reason::SWITCHED_ON);
    }
    for (; meant != 0; meant &= meant - 1) {
        drive.module().unhome(std::countr_zero(meant));
    }
    return result_of(j, Reason::NONE);
}

namespace {

/// Travel at the latch velocity in which backlash is compensated, with the half of the joint's limits that
/// corrections have. The slow move may begin at this distance from the switch.
double way_of_play(const Settings &settings, int j) noexcept {
    const auto get = [&](Parameter p) { return settings.get(p, j); };
    const double play = get(Parameter::JOINT_BACKLASH);
    const double v = 0.5 * get(Parameter::JOINT_MAX_VELOCITY);
    const double a = 0.5 * get(Parameter::JOINT_MAX_ACCELERATION);
    if (!(play > 0) || !(v > 0) || !(a > 0)) {
        return 0;
    }
    const double jerk = get(Parameter::JOINT_MAX_JERK);
    const bool hasMean = settings.isSet(Parameter::TRAJ_PLANNER_TYPE) && jerk < NO_JERK_LIMIT && jerk > 0;
    const double seconds =
        (play < v * v / a ? 2 * std::sqrt(play / a) : play / v + v / a) + (hasMean ? 4 * a / jerk : 0.0);
    const double fastest = std::max(1.0, settings.get(Parameter::MAX_FEED_SCALE));
    return seconds * std::min(2 * v, fastest * std::abs(get(Parameter::JOINT_HOME_LATCH_VEL)));
}

}  // namespace

void note_play(HomingDrive &drive, int j, const Settings &settings) noexcept {
    drive.own.parameters(j).clearance = way_of_play(settings, j);
}

void configure(HomingDrive &drive, int j, const Settings &settings) noexcept {
    const auto get = [&](Parameter p) { return settings.get(p, j); };
    homing::Parameters &p = drive.own.parameters(j);
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
    p.low = get(Parameter::JOINT_MIN_LIMIT);
    p.high = get(Parameter::JOINT_MAX_LIMIT);
    p.max_skew = get(Parameter::JOINT_HOME_MAX_SKEW);
    note_play(drive, j, settings);
    p.isLockingIndexer = settings.isSet(Parameter::JOINT_LOCKING_INDEXER, j);
    p.isVolatile = settings.isSet(Parameter::JOINT_VOLATILE_HOME, j);
    drive.module().configure(j, p);
}

void set_axis(HomingDrive &drive, int j, int axis) noexcept {
    drive.own.parameters(j).axis = axis;
}

void abort(HomingDrive &drive, homing::event::Event why, int joint) noexcept {
    drive.module().abort(why, joint);
    drive.isEndAsked = true;
    drive.isDue = false;
}

void switch_off(HomingDrive &drive, const Settings &settings) noexcept {
    abort(drive, homing::event::OFF);
    drive.module().lock();
    for (int j = 0; j < drive.num_joints; ++j) {
        if (drive.arePositionsLost || settings.isSet(Parameter::JOINT_VOLATILE_HOME, j)) {
            drive.module().unhome(j);
        }
    }
    drive.arePositionsLost = false;
}

homing::Failure begin_due(HomingDrive &drive, const HomeConditions &conditions) noexcept {
    if (!drive.isDue || conditions.isMoving) {
        return homing::Failure::NONE;
    }
    drive.isDue = false;
    if (conditions.isInhibited) {
        return homing::Failure::INHIBITED;
    }
    for (int j = 0; j < drive.num_joints; ++j) {
        drive.own.parameters(j).isActive = (conditions.inactive >> j & 1U) == 0;
    }
    drive.isEndAsked = false;
    drive.module().start(drive.due);
    return homing::Failure::NONE;
}

namespace {

/// A user's module does not report why homing ends: a joint that was being homed and is not homed now has
/// failed.
int joint_given_up(HomingDrive &drive) noexcept {
    std::uint32_t homing = 0;
    for (int j = 0; j < drive.num_joints; ++j) {
        homing |= drive.module().isHoming(j) ? 1U << j : 0U;
    }
    const std::uint32_t over = drive.known & ~homing & ~homed_mask(drive);
    drive.known = homing;
    return over != 0 && !drive.isEndAsked ? std::countr_zero(over) : -1;
}

}  // namespace

HomingFailure take_failure(HomingDrive &drive) noexcept {
    HomingFailure out;
    if (drive.foreign != nullptr) [[unlikely]] {
        out.joint = joint_given_up(drive);
        out.why = out.joint >= 0 ? homing::Failure::MODULE_FAILED : homing::Failure::NONE;
        return out;
    }
    out.joint = drive.own.take_failure(out.why);
    return out.why == homing::Failure::ABORTED ? HomingFailure() : out;
}

bool areFinite(const HomingDrive &drive, const homing::JointCommand *commands) noexcept {
    for (int j = 0; j < drive.num_joints; ++j) {
        const homing::JointCommand &c = commands[j];
        for (const double x :
             {c.value, c.velocity, c.most_velocity, c.acceleration, c.jerk, c.shift, c.zero}) {
            if (!std::isfinite(x)) {
                return false;
            }
        }
    }
    return true;
}

void fill(const HomingDrive &drive, Outputs &out) noexcept {
    out.status.isHoming = drive.isUnderWay();
    const bool isQuiet = drive.foreign == nullptr && drive.own.summary().isQuiet;
    if (isQuiet && out.isHomingQuiet) [[likely]] {
        return;
    }
    out.isHomingQuiet = isQuiet;
    with_module(drive, [&](const auto &module) {
        for (int j = 0; j < drive.num_joints; ++j) {
            const auto n = static_cast<std::size_t>(j);
            out.status.joint[n].isHoming = module.isHoming(j);
            out.joint[n].isIndexEnabled = module.isIndexWanted(j);
            out.joint[n].isUnlockWanted = module.isUnlockWanted(j);
            out.joint[n].home_state = module.step_number(j);
        }
    });
}

}  // namespace mw::motion

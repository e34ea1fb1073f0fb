// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/homing/homing_drive.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::motion {

namespace {

constexpr int ALL = -1, VOLATILE_ONES = -2;

/// Travel at the latch velocity during which backlash is compensated with half of the joint's limits. The
/// slow move may begin at this distance from the switch.
double clearance_of(const Settings &settings, int j) noexcept {
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

HomingDrive::HomingDrive(double period_s, homing::Module *foreign) noexcept : foreign_(foreign) {
    own_.set_period(period_s);
}

void HomingDrive::use_joints(int num_joints, int num_to_home) noexcept {
    num_joints_ = num_joints;
    num_to_home_ = num_to_home;
    module().set_num_joints(num_to_home);
}

std::uint32_t HomingDrive::take_clamped() noexcept {
    return isForeign() ? foreign_->take_clamped() : own_.take_clamped();
}

std::uint32_t HomingDrive::homed_joints() const noexcept {
    if (foreign_ == nullptr) [[likely]] {
        return own_.summary().homed & ((1U << num_joints_) - 1U);
    }
    std::uint32_t mask = 0;
    for (int j = 0; j < num_joints_; ++j) {
        mask |= foreign_->isHomed(j) ? 1U << j : 0U;
    }
    return mask;
}

bool HomingDrive::isAllHomed() const noexcept {
    const std::uint32_t all = (1U << num_to_home_) - 1U;
    return num_to_home_ > 0 && (homed_joints() & all) == all;
}

CommandResult HomingDrive::take(const Home &command, const HomeConditions &conditions) noexcept {
    const int j = command.joint;
    if (j < ALL || j >= num_joints_) {
        return result_of(j, Reason::NO_SUCH_JOINT);
    }
    if (!conditions.isReady) {
        return result_of(j, Reason::NOT_ENABLED);
    }
    if (conditions.mode != Mode::FREE) {
        return result_of(j, Reason::WRONG_MODE);
    }
    if (isUnderWay()) {
        return result_of(j, Reason::HOMING);
    }
    if (conditions.isInhibited) {
        return result_of(j, Reason::HOMING_INHIBITED);
    }
    if (j >= 0 && (conditions.inactive >> j & 1U) != 0) {
        return result_of(j, Reason::JOINT_INACTIVE);
    }
    due_ = true;
    due_joint_ = j;
    return result_of(j, Reason::NONE);
}

CommandResult HomingDrive::take(const Unhome &command, const HomeConditions &conditions,
                                const Settings &settings) noexcept {
    const int j = command.joint;
    if (j < VOLATILE_ONES || j >= num_joints_) {
        return result_of(j, Reason::NO_SUCH_JOINT);
    }
    if (isUnderWay()) {
        return result_of(j, Reason::HOMING);
    }
    if (conditions.isMoving) {
        return result_of(j, Reason::MOVING);
    }
    if (conditions.isReady && conditions.mode != Mode::FREE) {
        return result_of(j, Reason::WRONG_MODE);  // the pose depends on the home positions
    }
    std::uint32_t meant = 0;
    for (int k = 0; k < num_joints_; ++k) {
        const bool isVolatile = j == VOLATILE_ONES && settings.isSet(Parameter::JOINT_VOLATILE_HOME, k);
        meant |= j == ALL || j == k || isVolatile ? 1U << k : 0U;
    }
    if (const std::uint32_t kept = meant & conditions.kept_while_on; kept != 0) {
        return result_of(std::countr_zero(kept), Reason::SWITCHED_ON);
    }
    for (; meant != 0; meant &= meant - 1) {
        module().unhome(std::countr_zero(meant));
    }
    return result_of(j, Reason::NONE);
}

void HomingDrive::set_clearance(int j, const Settings &settings) noexcept {
    own_.parameters(j).clearance = clearance_of(settings, j);
}

void HomingDrive::configure(int j, const Settings &settings) noexcept {
    const auto get = [&](Parameter p) { return settings.get(p, j); };
    homing::Parameters &p = own_.parameters(j);
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
    set_clearance(j, settings);
    p.isLockingIndexer = settings.isSet(Parameter::JOINT_LOCKING_INDEXER, j);
    p.isVolatile = settings.isSet(Parameter::JOINT_VOLATILE_HOME, j);
    module().configure(j, p);
}

void HomingDrive::set_axis(int j, int axis) noexcept {
    own_.parameters(j).axis = axis;
}

void HomingDrive::abort(homing::event::Event why, int joint) noexcept {
    module().abort(why, joint);
    end_requested_ = true;
    due_ = false;
}

void HomingDrive::switch_off(const Settings &settings) noexcept {
    abort(homing::event::OFF);
    module().lock();
    for (int j = 0; j < num_joints_; ++j) {
        if (positions_lost_ || settings.isSet(Parameter::JOINT_VOLATILE_HOME, j)) {
            module().unhome(j);
        }
    }
    positions_lost_ = false;
}

homing::Failure HomingDrive::begin_due(const HomeConditions &conditions) noexcept {
    if (!due_ || conditions.isMoving) {
        return homing::Failure::NONE;
    }
    due_ = false;
    if (conditions.isInhibited) {
        return homing::Failure::INHIBITED;
    }
    for (int j = 0; j < num_joints_; ++j) {
        own_.parameters(j).isActive = (conditions.inactive >> j & 1U) == 0;
    }
    end_requested_ = false;
    module().start(due_joint_);
    return homing::Failure::NONE;
}

/// A user's module does not report why homing ends. A joint that was homing and is not homed now has failed.
int HomingDrive::failed_foreign_joint() noexcept {
    std::uint32_t homing = 0;
    for (int j = 0; j < num_joints_; ++j) {
        homing |= module().isHoming(j) ? 1U << j : 0U;
    }
    const std::uint32_t over = homing_joints_ & ~homing & ~homed_joints();
    homing_joints_ = homing;
    return over != 0 && !end_requested_ ? std::countr_zero(over) : -1;
}

HomingFailure HomingDrive::take_failure() noexcept {
    HomingFailure out;
    if (foreign_ != nullptr) [[unlikely]] {
        out.joint = failed_foreign_joint();
        out.why = out.joint >= 0 ? homing::Failure::MODULE_FAILED : homing::Failure::NONE;
        return out;
    }
    out.joint = own_.take_failure(out.why);
    return out.why == homing::Failure::ABORTED ? HomingFailure() : out;
}

bool HomingDrive::step(const homing::JointInput *inputs, homing::JointCommand *commands) noexcept {
    module().step(inputs, commands);
    if (foreign_ == nullptr) {
        return true;
    }
    for (int j = 0; j < num_joints_; ++j) {
        const homing::JointCommand &c = commands[j];
        for (const double x :
             {c.value, c.velocity, c.most_velocity, c.acceleration, c.jerk, c.shift, c.zero}) {
            if (!std::isfinite(x)) {
                abort(homing::event::ABORT);
                return false;
            }
        }
    }
    return true;
}

void HomingDrive::fill(Outputs &out) const noexcept {
    out.status.isHoming = isUnderWay();
    const bool isQuiet = foreign_ == nullptr && own_.summary().isQuiet;
    if (isQuiet && out.isHomingQuiet) [[likely]] {
        return;
    }
    out.isHomingQuiet = isQuiet;
    const homing::Module &homing = module();
    for (int j = 0; j < num_joints_; ++j) {
        const auto n = static_cast<std::size_t>(j);
        out.status.joint[n].isHoming = homing.isHoming(j);
        out.joint[n].isIndexEnabled = homing.isIndexWanted(j);
        out.joint[n].isUnlockWanted = homing.isUnlockWanted(j);
        out.joint[n].home_state = homing.step_number(j);
    }
}

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/interface/limits.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::motion {

namespace {

/// Fraction of the joint limits for axes if the planner cannot call the kinematics.
constexpr double UNKNOWN_SHARE = 0.4;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

bool isHomed(const HomedJoints &homed, int joint) noexcept {
    return (homed.joints >> joint & 1U) != 0;
}

double path_jerk(double jerk) noexcept {
    return jerk < NO_JERK_LIMIT ? jerk : trajectory::UNLIMITED;
}

double jog_jerk(double jerk) noexcept {
    return jerk < NO_JERK_LIMIT ? jerk : 0.0;
}

/// The lowest of the limits that were added.
struct Tightest {
    double velocity, acceleration, jerk;

    void take(double v, double a, double j) noexcept {
        velocity = std::min(velocity, v);
        acceleration = std::min(acceleration, a);
        jerk = std::min(jerk, j);
    }
    void take_joint(const Settings &s, int joint, double share) noexcept {
        const double own_jerk = s.get(Parameter::JOINT_MAX_JERK, joint);
        take(share * s.get(Parameter::JOINT_MAX_VELOCITY, joint),
             share * s.get(Parameter::JOINT_MAX_ACCELERATION, joint),
             own_jerk < NO_JERK_LIMIT ? share * own_jerk : own_jerk);
    }
};

/// External offsets may use `ratio` of the limits of the axis; paths and jogs may use the rest.
void share_with_offset(double ratio, Tightest &all, MotionLimits &jog, MotionLimits &offset) noexcept {
    offset = {ratio * jog.velocity, ratio * jog.acceleration, ratio * jog.jerk};
    const double rest = 1 - ratio;
    jog = {rest * jog.velocity, rest * jog.acceleration, rest * jog.jerk};
    all.velocity *= rest;
    all.acceleration *= rest;
    all.jerk = all.jerk < NO_JERK_LIMIT ? rest * all.jerk : all.jerk;
}

void fold_locks(const Settings &s, const AxisMap &map, int axis, FoldedLimits &out) noexcept {
    const int named = static_cast<int>(s.get(Parameter::AXIS_LOCKING_INDEXER_JOINT, axis));
    std::uint32_t locks = 0;
    if (named >= 0 && named < map.num_joints) {
        out.indexer[at(axis)] = static_cast<std::int8_t>(named);
        locks = 1U << named;
    }
    for (int j = 0; j < map.num_joints; ++j) {
        const std::uint32_t bit = s.isSet(Parameter::JOINT_LOCKING_INDEXER, j) ? 1U << j : 0U;
        locks |= map.moves(j, axis) ? bit : 0U;
        out.locks |= bit;
    }
    out.axis_locks[at(axis)] = locks;
    out.locks |= locks;
}

/// True if a joint of the axis has a lock.
bool isLocked(const AxisMap &map, int axis, const FoldedLimits &out) noexcept {
    bool isAny = out.axis_locks[at(axis)] != 0;
    for (int j = 0; j < map.num_led(); ++j) {
        isAny = isAny || (map.linear.moves(j, axis) && (out.locks >> j & 1U) != 0);
    }
    return isAny;
}

void fold_axis(const Settings &s, const AxisMap &map, int axis, FoldedLimits &out) noexcept {
    Tightest all{s.get(Parameter::AXIS_MAX_VELOCITY, axis), s.get(Parameter::AXIS_MAX_ACCELERATION, axis),
                 s.get(Parameter::AXIS_MAX_JERK, axis)};
    out.low[axis] = out.homed.areAll ? s.get(Parameter::AXIS_MIN_LIMIT, axis) : -UNBOUNDED;
    out.high[axis] = out.homed.areAll ? s.get(Parameter::AXIS_MAX_LIMIT, axis) : UNBOUNDED;
    for (int j = 0; j < map.num_joints; ++j) {
        if (!map.moves(j, axis)) {
            continue;
        }
        all.take_joint(s, j, 1);
        if (isHomed(out.homed, j)) {
            out.low[axis] = std::max(out.low[axis], s.get(Parameter::JOINT_MIN_LIMIT, j));
            out.high[axis] = std::min(out.high[axis], s.get(Parameter::JOINT_MAX_LIMIT, j));
        }
    }
    const double most_jog_jerk =
        geometry::isAngular(axis) ? all.jerk : std::min(all.jerk, s.get(Parameter::TRAJ_MAX_JERK));
    out.axis_jog[at(axis)] = {all.velocity, all.acceleration,
                              isJerkLimited(s) ? jog_jerk(most_jog_jerk) : 0.0};
    fold_locks(s, map, axis, out);
    const double ratio = s.get(Parameter::AXIS_OFFSET_RATIO, axis);
    if (ratio > 0 && !isLocked(map, axis, out) && map.mayHaveOffset(axis)) {
        share_with_offset(ratio, all, out.axis_jog[at(axis)], out.offset[at(axis)]);
    }
    for (int j = 0; j < map.num_led() && map.kind == AxisMap::Kind::UNKNOWN; ++j) {
        // It is unknown how the joints follow the axes. So axes use less than the limits of joints of the
        // same type, and the servo thread keeps jogs within the joint limits.
        if (s.isSet(Parameter::JOINT_IS_ANGULAR, j) == geometry::isAngular(axis)) {
            all.take_joint(s, j, UNKNOWN_SHARE);
        }
    }
    out.axes |= map.hasAxis(axis) ? 1U << axis : 0U;
    out.path.velocity[at(axis)] = std::min(all.velocity, trajectory::UNLIMITED);
    out.path.acceleration[at(axis)] = std::min(all.acceleration, trajectory::UNLIMITED);
    out.path.jerk[at(axis)] = path_jerk(all.jerk);
}

void fold_joint(const Settings &s, int j, FoldedLimits &out) noexcept {
    const double jerk = s.get(Parameter::JOINT_MAX_JERK, j);
    const double low = s.get(Parameter::JOINT_MIN_LIMIT, j);
    const double high = s.get(Parameter::JOINT_MAX_LIMIT, j);
    out.joints.velocity[at(j)] = s.get(Parameter::JOINT_MAX_VELOCITY, j);
    out.joints.acceleration[at(j)] = s.get(Parameter::JOINT_MAX_ACCELERATION, j);
    out.joints.jerk[at(j)] = path_jerk(jerk);
    out.joints.low[at(j)] = isHomed(out.homed, j) ? low : -UNBOUNDED;
    out.joints.high[at(j)] = isHomed(out.homed, j) ? high : UNBOUNDED;
    out.travel[at(j)] = std::max(0.0, high - low);
    const double most_jog_jerk =
        s.isSet(Parameter::JOINT_IS_ANGULAR, j) ? jerk : std::min(jerk, s.get(Parameter::TRAJ_MAX_JERK));
    out.joint_jog[at(j)] = {out.joints.velocity[at(j)], out.joints.acceleration[at(j)],
                            isJerkLimited(s) ? jog_jerk(most_jog_jerk) : 0.0};
}

bool isOffsetOf(const AxisMap &map, int j, int axis, const FoldedLimits &out) noexcept {
    return out.offset[at(axis)].velocity > 0 && map.linear.moves(j, axis);
}

/// If joints are not axes: each external offset may use its ratio of the joint limits divided by the slopes
/// of all axes with offsets.
void limit_offsets(const Settings &s, const AxisMap &map, int j, FoldedLimits &out) noexcept {
    double sum = 0;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        sum += isOffsetOf(map, j, axis, out) ? std::abs(map.linear.slope[at(j)][axis]) : 0.0;
    }
    const MotionLimits &whole = out.joint_jog[at(j)];
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if (!isOffsetOf(map, j, axis, out)) {
            continue;
        }
        MotionLimits &offset = out.offset[at(axis)];
        const double share = s.get(Parameter::AXIS_OFFSET_RATIO, axis) / sum;
        offset.velocity = std::min(offset.velocity, share * whole.velocity);
        offset.acceleration = std::min(offset.acceleration, share * whole.acceleration);
        const bool isTighter = whole.jerk > 0 && !(offset.jerk > 0 && offset.jerk <= share * whole.jerk);
        offset.jerk = isTighter ? share * whole.jerk : offset.jerk;
    }
}

/// Limits of a joint for paths and jogs: its limits without the share of external offsets.
void leave_to_paths(const AxisMap &map, int j, FoldedLimits &out) noexcept {
    trajectory::JointLimits &left = out.path_joints;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if (!isOffsetOf(map, j, axis, out)) {
            continue;
        }
        const MotionLimits &offset = out.offset[at(axis)];
        const double slope = std::abs(map.linear.slope[at(j)][axis]);
        left.velocity[at(j)] -= slope * offset.velocity;
        left.acceleration[at(j)] -= slope * offset.acceleration;
        left.jerk[at(j)] -= left.jerk[at(j)] < trajectory::UNLIMITED ? slope * offset.jerk : 0.0;
    }
}

}  // namespace

bool AxisMap::hasAxis(int axis) const noexcept {
    bool isFound = !areJointsAxes();
    for (int j = 0; j < num_joints; ++j) {
        isFound = isFound || axis_of_joint[at(j)] == axis;
    }
    return isFound;
}

void AxisMap::set_linear(const kinematics::LinearJoints &all) noexcept {
    linear = all;
    linear.joints &= (1U << num_led()) - 1U;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        bool isMoving = false;
        for (int j = 0; j < num_led(); ++j) {
            isMoving = isMoving || linear.moves(j, axis);
        }
        linear.axes &= isMoving ? ~0U : ~(1U << axis);
    }
}

bool AxisMap::isAsIn(const kinematics::Kinematics &kinematics) const noexcept {
    AxisMap now;
    now.num_joints = num_joints;
    now.num_extra = num_extra;
    now.set_linear(kinematics.linear());
    return now.linear == linear;
}

bool AxisMap::mayHaveOffset(int axis) const noexcept {
    return areJointsAxes() ? hasAxis(axis) : (linear.axes >> axis & 1U) != 0;
}

AxisMap axis_map(const kinematics::Kinematics &kinematics, int num_joints, int num_extra) noexcept {
    AxisMap out;
    out.num_joints = num_joints;
    out.num_extra = num_extra;
    out.axis_of_joint.fill(-1);
    if (const kinematics::IdentityMap *identity = kinematics.identity()) {
        std::copy_n(identity->axis_of_joint.begin(), std::min(out.num_led(), identity->num_joints),
                    out.axis_of_joint.begin());
        return out;
    }
    out.kind = kinematics.isShareable() ? AxisMap::Kind::PLANNED : AxisMap::Kind::UNKNOWN;
    if (out.kind == AxisMap::Kind::PLANNED) {
        out.set_linear(kinematics.linear());
    }
    return out;
}

AxisMap axis_map(std::string_view letters, int num_joints) noexcept {
    AxisMap out;
    out.num_joints = num_joints;
    out.axis_of_joint.fill(-1);
    const int count = std::min(num_joints, static_cast<int>(letters.size()));
    for (int j = 0; j < count; ++j) {
        out.axis_of_joint[at(j)] = static_cast<std::int8_t>(geometry::axis_of_letter(letters[at(j)]));
    }
    return out;
}

bool isJerkLimited(const Settings &settings) noexcept {
    return settings.isSet(Parameter::TRAJ_PLANNER_TYPE) &&
           settings.get(Parameter::TRAJ_MAX_JERK) >= LEAST_JERK;
}

FoldedLimits fold_limits(const Settings &settings, const AxisMap &map, const HomedJoints &homed) noexcept {
    FoldedLimits out;
    out.homed = homed;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        fold_axis(settings, map, axis, out);
    }
    out.path.velocity[trajectory::XYZ_NORM] =
        std::min(settings.get(Parameter::TRAJ_MAX_VELOCITY), trajectory::UNLIMITED);
    out.path.acceleration[trajectory::XYZ_NORM] =
        std::min(settings.get(Parameter::TRAJ_MAX_ACCELERATION), trajectory::UNLIMITED);
    out.path.jerk[trajectory::XYZ_NORM] = path_jerk(settings.get(Parameter::TRAJ_MAX_JERK));
    out.path.isJerkLimited = isJerkLimited(settings);
    for (int joint = 0; joint < map.num_joints; ++joint) {
        fold_joint(settings, joint, out);
    }
    out.joints.count = map.num_led();
    out.path_joints = out.joints;
    const int shared = map.areJointsAxes() ? 0 : map.num_led();
    for (int joint = 0; joint < shared; ++joint) {
        limit_offsets(settings, map, joint, out);
    }
    for (int joint = 0; joint < shared; ++joint) {
        leave_to_paths(map, joint, out);
    }
    return out;
}

JointRange SharedJoints::at(const geometry::Pose &pose) const noexcept {
    return within({pose, pose});
}

JointRange SharedJoints::within(const PoseRange &range) const noexcept {
    JointRange out;
    for (std::uint32_t left = joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            const double k = slope[j][i];
            if (k != 0) {
                out.low[j] += k * (k > 0 ? range.low[i] : range.high[i]);
                out.high[j] += k * (k > 0 ? range.high[i] : range.low[i]);
            }
        }
    }
    return out;
}

SharedJoints shared_joints(const kinematics::LinearJoints &linear, std::uint32_t offset_axes) noexcept {
    SharedJoints out;
    for (std::uint32_t left = linear.joints; left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        std::uint32_t axes = 0;
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            axes |= linear.moves(j, i) ? 1U << i : 0U;
        }
        if ((axes & offset_axes) != 0) {
            out.joints |= 1U << j;
            out.axes |= axes;
            out.slope[at(j)] = linear.slope[at(j)];
        }
    }
    return out;
}

JogRange jog_range(const FoldedLimits &limits, const AxisMap &map, const JogTarget &target,
                   const double *joint_positions) noexcept {
    constexpr double FAR = 1e9;
    JogRange out{-FAR, FAR};
    const auto narrow = [&out](double low, double high) {
        out.low = std::max(out.low, low);
        out.high = std::min(out.high, high);
    };
    if (!target.isJoint) {
        narrow(limits.low[target.index], limits.high[target.index]);
    }
    for (int j = 0; j < map.num_joints; ++j) {
        const bool isMeant = target.isJoint ? j == target.index : map.moves(j, target.index);
        if (!isMeant) {
            continue;
        }
        const double around = 2.0 * limits.travel[at(j)];
        const bool isKnown = isHomed(limits.homed, j);
        narrow(isKnown ? limits.joints.low[at(j)] : joint_positions[j] - around,
               isKnown ? limits.joints.high[at(j)] : joint_positions[j] + around);
    }
    return out;
}

}  // namespace mw::motion

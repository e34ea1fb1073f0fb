// SPDX-License-Identifier: GPL-2.0-or-later
// Combines the limits of joints, axes and the machine for paths, jogs, checks and estimates. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "base/geometry/pose.hh"
#include "base/limits.hh"
#include "kinematics/kinematics.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"
#include "trajectory/path/joint_map.hh"
#include "trajectory/path/limits.hh"

namespace mw::motion {

/// A path jerk limit below this value switches jerk-limited planning off [machine units/s^3].
inline constexpr double LEAST_JERK = 1;

/// The axis that each joint moves, and the thread that may call the kinematics if joints are not axes.
struct AxisMap {
    enum class Kind : std::uint8_t {
        JOINTS_ARE_AXES,  ///< limits of a joint are limits of its axis
        PLANNED,          ///< the planner calls the kinematics and keeps the limits of the joints
        UNKNOWN,          ///< only the servo thread may call the kinematics
    };
    Kind kind = Kind::JOINTS_ARE_AXES;
    int num_joints = 0;                                   ///< number of joints of the machine
    int num_extra = 0;                                    ///< the last joints, which no pose moves
    std::array<std::int8_t, MAX_JOINTS> axis_of_joint{};  ///< -1: none; used only if joints are axes
    kinematics::LinearJoints linear;                      ///< of joints that are not axes

    /// True if a joint of the machine moves this axis; kinematics may move any axis.
    bool hasAxis(int axis) const noexcept;
    int num_led() const noexcept { return num_joints - num_extra; }  ///< that a pose moves
    /// Joints of the machine that a pose moves, and the axes that move any of them.
    void set_linear(const kinematics::LinearJoints &all) noexcept;
    /// False after a change of a kinematics parameter on which the linearity of joints depends.
    bool isAsIn(const kinematics::Kinematics &kinematics) const noexcept;
    /// The axis may have an offset that adds to a jog or path and moves its joints.
    bool mayHaveOffset(int axis) const noexcept;
    bool areJointsAxes() const noexcept { return kind == Kind::JOINTS_ARE_AXES; }
    bool moves(int joint, int axis) const noexcept {
        return areJointsAxes() && axis_of_joint[static_cast<std::size_t>(joint)] == axis;
    }
};

/// The last `num_extra` of `num_joints` joints are not joints of the kinematics.
AxisMap axis_map(const kinematics::Kinematics &kinematics, int num_joints, int num_extra = 0) noexcept;
/// Joint n moves the axis of the n-th letter.
AxisMap axis_map(std::string_view letters, int num_joints) noexcept;

/// Soft limits apply to homed joints, and to axes when all joints are homed.
struct HomedJoints {
    std::uint32_t joints = 0;  ///< bit per joint
    bool areAll = false;
};
inline constexpr HomedJoints ALL_HOMED{~0U, true};

/// Current or possible range of each axis.
struct PoseRange {
    geometry::Pose low, high;

    void include(const geometry::Pose &pose) noexcept {
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            low[i] = std::min(low[i], pose[i]);
            high[i] = std::max(high[i], pose[i]);
        }
    }
    void include(const PoseRange &other) noexcept {
        include(other.low);
        include(other.high);
    }
};

/// Current or possible range of each joint.
struct JointRange {
    std::array<double, MAX_JOINTS> low{}, high{};

    void include(const JointRange &other) noexcept {
        for (std::size_t j = 0; j < low.size(); ++j) {
            low[j] = std::min(low[j], other.low[j]);
            high[j] = std::max(high[j], other.high[j]);
        }
    }
};

/// Joints that are not axes, move in proportion to axes, and are moved by an axis that may have an external
/// offset. Program and offsets share their travel.
struct SharedJoints {
    std::uint32_t joints = 0;  ///< bit per joint
    std::uint32_t axes = 0;    ///< bit per axis that moves one of them
    std::array<geometry::Pose, MAX_JOINTS> slope{};

    /// Joint positions at a pose; 0 for other joints.
    JointRange at(const geometry::Pose &pose) const noexcept;
    /// Joint range while each axis may be anywhere in its range.
    JointRange within(const PoseRange &range) const noexcept;
};
/// The second argument has a bit for each axis that may have an external offset.
SharedJoints shared_joints(const kinematics::LinearJoints &linear, std::uint32_t offset_axes) noexcept;

/// Current or possible range of each axis, and of shared joints.
struct TravelRange {
    PoseRange axes;
    JointRange joints;

    void include(const TravelRange &other) noexcept {
        axes.include(other.axes);
        joints.include(other.joints);
    }
};

/// Limits of a move of one joint, axis or external offset.
struct MotionLimits {
    double velocity = 0, acceleration = 0;
    double jerk = 0;  ///< 0: none
};

inline constexpr std::array<std::int8_t, MAX_AXES> NO_INDEXERS = [] {
    std::array<std::int8_t, MAX_AXES> none{};
    none.fill(-1);
    return none;
}();

struct FoldedLimits {
    trajectory::Limits path;  ///< of moves of axes: limits of the axes and of the joints that move them
    geometry::Pose low,
        high;  ///< soft limits of axes, including those of their joints; +-infinity without a limit
    std::uint32_t axes = 0;  ///< bit per axis that a joint or the kinematics moves
    trajectory::JointLimits joints;
    trajectory::JointLimits
        path_joints;  ///< limits of joints for paths and jogs of axes, without the share of external offsets
    HomedJoints homed;
    /// Joint whose lock opens for a G0 of this axis; -1: none.
    std::array<std::int8_t, MAX_AXES> indexer = NO_INDEXERS;
    std::uint32_t locks = 0;                           ///< bit per joint that has a lock
    std::array<std::uint32_t, MAX_AXES> axis_locks{};  ///< bit per lock of the joints that each axis moves
    std::array<double, MAX_JOINTS> travel{};  ///< distance between the soft limits of a joint, homed or not
    std::array<MotionLimits, MAX_JOINTS> joint_jog{};
    std::array<MotionLimits, MAX_AXES> axis_jog{};
    std::array<MotionLimits, MAX_AXES> offset{};  ///< external offsets; velocity 0: the axis has none

    /// Locks that must open for a jog.
    std::uint32_t locks_of(const JogTarget &target) const noexcept {
        return target.isJoint ? locks & 1U << target.index
                              : axis_locks[static_cast<std::size_t>(target.index)];
    }
    const MotionLimits &jog(const JogTarget &target) const noexcept {
        const auto i = static_cast<std::size_t>(target.index);
        return target.isJoint ? joint_jog[i] : axis_jog[i];
    }
};

/// True if jerk-limited planning is selected and has a limit.
bool isJerkLimited(const Settings &settings) noexcept;

/// [any thread]
FoldedLimits fold_limits(const Settings &settings, const AxisMap &map, const HomedJoints &homed) noexcept;

struct JogRange {
    double low = 0, high = 0;
};
/// Range of a jog: soft limits of homed joints and axes; before homing, twice the travel around the current
/// position. `joint_positions` has MAX_JOINTS elements.
JogRange jog_range(const FoldedLimits &limits, const AxisMap &map, const JogTarget &target,
                   const double *joint_positions) noexcept;

}  // namespace mw::motion

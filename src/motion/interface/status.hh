// SPDX-License-Identifier: GPL-2.0-or-later
// Reports of the motion controller: one snapshot per servo cycle, answers to commands, error texts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/limits.hh"
#include "base/parted_seqlock.hh"
#include "motion/interface/command.hh"
#include "motion/interface/path_command.hh"

namespace mw::motion {

struct JointStatus {
    double pos_cmd = 0, pos_fb = 0, vel_cmd = 0;
    double motor_pos_cmd = 0, motor_pos_fb = 0;
    double ferror = 0, ferror_highmark = 0;
    double min_limit = 0, max_limit = 0, max_velocity = 0, max_acceleration = 0;
    bool isActive = false, isInPosition = true, isEnabled = false, isHoming = false, isHomed = false;
    bool isFaulted = false, isOnPosSoftLimit = false, isOnNegSoftLimit = false;
    bool isOnPosHardLimit = false, isOnNegHardLimit = false, isFerrorTripped = false,
         isOverridingLimits = false;
};

struct AxisStatus {
    double velocity = 0, min_limit = 0, max_limit = 0;
    double external_offset = 0;  ///< in carte_pos_cmd and carte_pos_fb
};

struct SpindleStatus {
    double speed_cmd_rpm = 0;
    double scale = 1.0;
    double speed_in_rps = 0, revs = 0;
    int direction = 0;  ///< +1 cw, 0, -1 ccw
    bool isOn = false, isAtSpeed = false, isBrakeOn = false, isOverrideEnabled = true;
    int orient_state = 0, orient_fault = 0;
};

struct Status {
    std::uint64_t cycle = 0;  ///< servo cycles since load
    std::int64_t time_ns = 0;
    Epoch epoch = 0;
    CommandId last_immediate_id = 0;  ///< answered or done
    CommandId last_path_id = 0;       ///< last path command whose motion has completed
    CommandId active_path_id = 0;     ///< being executed, 0: none
    Mode mode = Mode::FREE;
    bool isEnabled = false;
    bool isInPosition = true;  ///< nothing moves and no plan is committed
    bool isPaused = false, isStepping = false, isReverse = false;
    bool isTaskLost = false;  ///< the watchdog or the host reports the end of the task process
    bool isAllHomed = false;
    bool isHoming = false;
    bool isCartePosValid = false;   ///< requirement C3
    std::uint32_t queue_depth = 0;  ///< path commands accepted by the planner and not complete
    bool isQueueFull = false;
    SourceTag source;  ///< of the move being executed
    MotionType motion_type = MotionType::NONE;
    double current_velocity = 0;  ///< along the path [machine units/s]
    double requested_velocity = 0, distance_to_go = 0;
    geometry::Pose carte_pos_cmd, carte_pos_fb, probed_pos, dtg;
    bool isProbing = false, isProbeTripped = false, probe_value = false;
    double feed_scale = 1.0, rapid_scale = 1.0, net_feed_scale = 1.0;
    bool isFeedOverrideEnabled = true, isAdaptiveFeedEnabled = false, isFeedHoldEnabled = true;
    int num_joints = 0, num_spindles = 0;
    int num_extra_joints = 0;                       ///< the last joints, which no pose moves
    std::uint64_t digital_in = 0, digital_out = 0;  ///< bit per pin
    std::array<JointStatus, MAX_JOINTS> joint{};
    std::array<AxisStatus, MAX_AXES> axis{};
    std::array<SpindleStatus, MAX_SPINDLES> spindle{};
    std::array<double, MAX_ANALOG_IO> analog_in{}, analog_out{};
};

/// Position of the machine as the program sees it, without external offsets.
inline geometry::Pose programmed_position(const Status &status) noexcept {
    geometry::Pose pose = status.carte_pos_cmd;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        pose[i] -= status.axis[static_cast<std::size_t>(i)].external_offset;
    }
    return pose;
}

/// `Status` is published in parts, so that a client that reads often copies only parts that have changed.
namespace status_part {
inline constexpr int WHOLE_MACHINE = 0, JOINTS = 1, AXES = JOINTS + MAX_JOINTS, SPINDLES = AXES + 1,
                     ANALOG_IN = SPINDLES + MAX_SPINDLES, ANALOG_OUT = ANALOG_IN + 1, COUNT = ANALOG_OUT + 1;
inline constexpr PartStarts<COUNT> STARTS = [] {
    PartStarts<COUNT> starts{};
    for (std::size_t i = 0; i < MAX_JOINTS; ++i) {
        starts[JOINTS + i] = offsetof(Status, joint) + i * sizeof(JointStatus);
    }
    for (std::size_t i = 0; i < MAX_SPINDLES; ++i) {
        starts[SPINDLES + i] = offsetof(Status, spindle) + i * sizeof(SpindleStatus);
    }
    starts[AXES] = offsetof(Status, axis);
    starts[ANALOG_IN] = offsetof(Status, analog_in);
    starts[ANALOG_OUT] = offsetof(Status, analog_out);
    return starts;
}();
}  // namespace status_part

using PublishedStatus = PartedSeqlock<Status, status_part::STARTS>;

enum class AnswerKind : std::uint8_t { DONE, REFUSED, STALE };

/// Reason for rejecting a command; `reason_text` makes the text for the operator outside realtime.
enum class Reason : std::uint16_t {
    NONE,
    NOT_ENABLED,
    WRONG_MODE,
    MOVING,
    NOT_HOMED,
    HOMING,
    NO_SUCH_JOINT,
    NO_SUCH_AXIS,
    NO_SUCH_SPINDLE,
    NO_SUCH_OUTPUT,
    NO_SUCH_PARAMETER,
    OUT_OF_RANGE,
    BEYOND_SOFT_LIMIT,
    ON_HARD_LIMIT,
    UNREACHABLE,
    JOINT_BEYOND_LIMIT,  ///< index is the joint
    AMP_FAULT,
    EXTERNAL_ENABLE_OFF,
    JOINT_INACTIVE,
    QUEUE_FULL,
    PROBE_ALREADY_TRIPPED,
    PROBE_ALREADY_OPEN,
    NOT_A_NUMBER,
    NO_WAY_BACK,  ///< no path is recorded
    BAD_ARC,
    RIGID_TAPPING,   ///< the planner cannot call the kinematics
    TAP_OFFSET,      ///< index: an axis of the tap that external offsets move, or whose joints they move
    TAP_ROOM,        ///< index: the axis whose soft limit is too close
    TAP_JOINT_ROOM,  ///< index: the joint whose soft limit is too close; -1: end of the range of the
                     ///< kinematics
    ONE_WAY_SPINDLE,
    JOG_INHIBITED,
    HOMING_INHIBITED,
    SYNCHRONISED_JOINT,  ///< a joint of a negative HOME_SEQUENCE is not jogged alone
    NO_JOG_TO_RENEW,
    SWITCHED_ON,     ///< the command requires machine off
    TOO_FEW_JOINTS,  ///< index: number of joints that the kinematics moves
    SINGULAR,        ///< the path contains a pose for which the kinematics has many solutions
    POSE_UNKNOWN,    ///< the kinematics has no pose for the joint positions
    SIDE_APART,      ///< index: the joint whose position differs from that of the pose
    NO_FEEDBACK,     ///< a joint's feedback is not a number
    DRIVEN_BY_PIN,   ///< index: a homed extra joint, which its pin commands
    INDEXER_ALONE,   ///< a locking indexer moves only alone, in programs only with G0; other axes only while
                     ///< it is locked
    INDEXER_OPEN,    ///< a locking indexer is not locked
    COUNT,
};

/// Each command gets exactly one answer. For path commands, DONE is sent when the motion has completed.
struct Answer {
    CommandId id = 0;
    AnswerKind kind = AnswerKind::DONE;
    Reason reason = Reason::NONE;
    std::int16_t index = -1;  ///< joint or axis of the reason, or -1
    bool isPath = false;
};

/// A fault without a command. `index`: joint, axis or spindle, -1: none.
enum class FaultKind : std::uint16_t {
    FOLLOWING_ERROR,
    AMP_FAULT,
    HARD_LIMIT,
    SOFT_LIMIT,
    ENABLE_LOST,
    TASK_LOST,     ///< index: 1 if it has ended, 0 if it does not loop; value: time [s]
    MOTION_STOOD,  ///< the servo thread was interrupted; index: 1 if axes moved, 0 if not; value: time [s]
    HOMING_FAILED,
    PROBE_NOT_TRIPPED,  ///< at the end of the move; detail: 1 for loss of contact
    PROBE_TRIPPED_IN_MOVE,
    KINEMATICS_FAILED,
    PATH_LIMIT,
    SPINDLE_FAULT,
    MISC_ERROR,
    NO_WAY_ON,        ///< the planner has stopped the path because it finds no plan
    JOG_JOINT_LIMIT,  ///< an axis jog was stopped before a joint's soft limit
    JOG_UNREACHABLE,  ///< an axis jog was stopped before a pose that the kinematics do not reach
    JOINT_TOO_FAST,   ///< value: use of the limit; the planner cannot call the kinematics
    JOINT_LEFT_RANGE,
    THREAD_TOO_FAST,  ///< index: spindle; value: required speed over the possible one
    JOG_LEASE_ENDED,  ///< a jog was not renewed in time; detail: 1 a joint, 0 an axis; value: the lease [s]
    KINEMATICS_JUMP,  ///< index: the joint that would jump; value: distance
    NO_KINEMATICS_TYPE,            ///< value: the requested type
    KINEMATICS_SWITCHED_ON_PATH,   ///< as above, but the path was stopped
    KINEMATICS_TYPE_WITHOUT_POSE,  ///< as above, but the type has no pose for the joint positions
    HOMING_CLAMPED,          ///< a homing module has commanded more than the limits of joint `index` allow
    FEEDBACK_LOST,           ///< index: the joint whose feedback is not a number
    TAP_TOO_FAST,            ///< index: spindle; value: required speed over the possible one
    TAP_TOO_ABRUPT,          ///< index: spindle; value: acceleration of its reversal over the possible one
    TAP_TOO_SUDDEN,          ///< index: spindle; value: distance from the helix [turns]
    TAP_TOO_SHALLOW,         ///< index: spindle; value: required travel over the depth
    TAP_LOST,                ///< index: spindle
    INDEXER_NOT_UNLOCKED,    ///< index: the joint whose lock did not respond in time
    INDEXER_NOT_LOCKED,      ///< the same
    INDEXER_LOCKED_IN_MOVE,  ///< index: the joint whose pin is-unlocked became FALSE during its move
    EXTRA_JOINT_LOST,        ///< index: the joint whose pin posthome-cmd is not a number
    EXTRA_JOINT_LIMIT,       ///< index: the joint whose pin posthome-cmd is outside its range
    SIDE_APART,              ///< index: joint; the machine was switched on in free mode
    POSE_UNKNOWN,            ///< the kinematics has no pose for the joint positions; switched on in free mode
    PLANNER_MODULE,          ///< detail: PlannerModuleFault; value: requested over possible speed
    POSITIONS_LOST,          ///< a driver reports that its positions do not match the machine
    SPINDLE_LOST,            ///< index: spindle whose feedback is not a number during a synchronized move
    COUNT,
};
/// Detail of PLANNER_MODULE: error in the speeds of the module.
enum class PlannerModuleFault : std::uint16_t { NO_ANSWER = 1, TOO_FAST, TOO_HARD, TOO_LATE, NOT_THERE };
/// True for a message without effect on the path.
constexpr bool isOnlyTold(FaultKind kind) noexcept {
    return kind == FaultKind::HOMING_CLAMPED || kind == FaultKind::JOG_JOINT_LIMIT ||
           kind == FaultKind::JOG_UNREACHABLE || kind == FaultKind::JOG_LEASE_ENDED ||
           kind == FaultKind::EXTRA_JOINT_LIMIT || kind == FaultKind::SIDE_APART ||
           kind == FaultKind::POSE_UNKNOWN;
}
struct Fault {
    FaultKind kind = FaultKind::FOLLOWING_ERROR;
    std::int16_t index = -1;
    std::uint16_t detail = 0;  ///< per kind: homing: homing::Failure
    double value = 0;          ///< depends on the fault: the position, the following error
    SourceTag source;
};

}  // namespace mw::motion

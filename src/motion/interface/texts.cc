// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/interface/texts.hh"

#include <fmt/core.h>

#include "motion/homing/table.hh"

namespace mw::motion {

namespace {

std::string joint_name(int index) {
    return index >= 0 ? fmt::format("joint {}", index) : std::string("all joints");
}

std::string axis_name(int index) {
    return index >= 0 && index < geometry::AXIS_COUNT ? fmt::format("axis {}", geometry::AXIS_LETTERS[index])
                                                      : std::string("an axis");
}

/// Path commands name axes; immediate commands name joints, or axes in teleop mode; both if the mode is
/// unknown.
std::string place_name(const Answer &a) {
    if (a.index < 0) {
        return "a joint or axis";
    }
    return a.isPath ? axis_name(a.index) : fmt::format("joint or axis {}", a.index);
}

std::string kinematics_reason(const Answer &answer) {
    switch (answer.reason) {
    case Reason::JOINT_BEYOND_LIMIT:
        return "the move exceeds the soft limit of a joint: change the program, the part zero or the tool "
               "offset";
    case Reason::UNREACHABLE: return "the kinematics cannot reach the move";
    case Reason::SINGULAR:
        return "the move begins at or passes near a singular pose of the kinematics: program a path around "
               "it, or jog a joint away from it";
    case Reason::POSE_UNKNOWN:
        return "forward kinematics found no pose for the current joint positions: jog single joints, or set "
               "the start pose of the kinematics module";
    case Reason::SIDE_APART:
        return fmt::format("joint {} differs from the other joint of its axis by more than its MIN_FERROR: "
                           "jog it to the position of the other joint, or home, in joint mode",
                           answer.index);
    case Reason::TOO_FEW_JOINTS:
        return fmt::format(
            "the kinematics moves {} joints: see [KINS]JOINTS and coordinates= of the kinematics",
            answer.index);
    default: return "refused";
    }
}

std::string indexer_reason(const Answer &answer) {
    return answer.reason == Reason::INDEXER_OPEN
               ? "a locking indexer is not locked: jog it, or switch the machine off, and check its pin "
                 "joint.N.is-unlocked"
               : fmt::format("{} is a locking indexer, or an indexer is unlocked: program the indexer alone "
                             "in a G0 block; other moves wait until it is locked",
                             place_name(answer));
}

std::string tap_reason(const Answer &answer) {
    switch (answer.reason) {
    case Reason::RIGID_TAPPING:
        return "rigid tapping (G33.1) needs a kinematics module that the planner may call "
               "(mw_kinematics_is_pure): tap with a floating holder (G84, G74)";
    case Reason::TAP_OFFSET:
        return fmt::format("rigid tapping along {} is not possible: OFFSET_AV_RATIO allows external offsets "
                           "of this axis or of an axis that shares its joints",
                           place_name(answer));
    case Reason::TAP_JOINT_ROOM:
        if (answer.index < 0) {
            return "the tap begins or ends too near to the end of the reach of the kinematics: the tool "
                   "overruns by up to one spindle revolution at the reversal";
        }
        [[fallthrough]];
    case Reason::TAP_ROOM:
        return fmt::format("the tap begins or ends too near to the soft limit of {}: the tool overruns by up "
                           "to one spindle revolution at the reversal",
                           answer.reason == Reason::TAP_JOINT_ROOM ? joint_name(answer.index)
                                                                   : place_name(answer));
    case Reason::ONE_WAY_SPINDLE:
        return "rigid tapping reverses the spindle, but its range in one direction is 0: see "
               "MAX_FORWARD_VELOCITY and MAX_REVERSE_VELOCITY";
    default: return "refused";
    }
}

const char *mode_reason(bool isPath) {
    return isPath ? "programmed moves need coordinated mode"
                  : "not possible in this mode: joints jog, home and unhome in joint mode, axes jog in world "
                    "mode";
}

}  // namespace

std::string reason_text(const Answer &answer) {
    const int i = answer.index;
    switch (answer.reason) {
    case Reason::NONE:
    case Reason::COUNT: return {};
    case Reason::NOT_ENABLED: return "the machine is off: turn it on first";
    case Reason::WRONG_MODE: return mode_reason(answer.isPath);
    case Reason::MOVING: return "the machine is moving: wait until it has stopped, or stop it";
    case Reason::NOT_HOMED: return "home all joints first";
    case Reason::HOMING: return "joints are being homed: wait, or abort homing";
    case Reason::NO_SUCH_JOINT: return fmt::format("there is no joint {}", i);
    case Reason::NO_SUCH_AXIS:
        return i >= 0 && i < geometry::AXIS_COUNT
                   ? fmt::format("no joint drives axis {}: see coordinates= of the kinematics",
                                 geometry::AXIS_LETTERS[i])
                   : fmt::format("there is no axis {}", i);
    case Reason::NO_SUCH_SPINDLE: return "there is no such spindle: see num_spindles= of motmod";
    case Reason::NO_SUCH_OUTPUT: return "there is no such output: see num_dio= and num_aio= of motmod";
    case Reason::NO_SUCH_PARAMETER: return "there is no such motion parameter";
    case Reason::OUT_OF_RANGE: return "a value is out of its range";
    case Reason::BEYOND_SOFT_LIMIT:
        return fmt::format("the move exceeds the soft limit of {}: see MIN_LIMIT and MAX_LIMIT",
                           place_name(answer));
    case Reason::ON_HARD_LIMIT:
        return fmt::format("{} is on a limit switch: jog off it (override limits to turn the machine on)",
                           joint_name(i));
    case Reason::NO_FEEDBACK:
        return fmt::format("the feedback of {} is not a number: check the signal of its pin motor-pos-fb",
                           joint_name(i));
    case Reason::AMP_FAULT: return fmt::format("the amplifier of {} reports a fault", joint_name(i));
    case Reason::EXTERNAL_ENABLE_OFF:
        return "the external enable is off: pin motion.enable or the e-stop chain is FALSE";
    case Reason::JOINT_INACTIVE: return fmt::format("{} is deactivated", joint_name(i));
    case Reason::QUEUE_FULL: return "the motion queue is full";
    case Reason::PROBE_ALREADY_TRIPPED:
        return "the probe is already tripped before G38.2, which ends at contact: move the probe clear first";
    case Reason::PROBE_ALREADY_OPEN:
        return "the probe is already open before G38.4, which ends when contact is lost: bring the probe "
               "into "
               "contact first";
    case Reason::NOT_A_NUMBER: return "a value is not a finite number";
    case Reason::NO_WAY_BACK:
        return "reverse run is not possible: the path is not recorded (docs/developer/motion_commands.md)";
    case Reason::BAD_ARC: return "the arc's centre, normal and end do not define a helix";
    case Reason::JOG_INHIBITED:
        return "jogging is inhibited: pin motion.jog-inhibit, motion.jog-stop or motion.jog-stop-immediate "
               "is TRUE";
    case Reason::HOMING_INHIBITED: return "homing is inhibited: pin motion.homing-inhibit is TRUE";
    case Reason::SYNCHRONISED_JOINT:
        return fmt::format(
            "{} has a negative HOME_SEQUENCE: jogging it alone would rack the machine; home, then jog "
            "its axis in world mode",
            joint_name(i));
    case Reason::DRIVEN_BY_PIN:
        return fmt::format("{0} is an extra joint and homed: its pin joint.{1}.posthome-cmd moves it",
                           joint_name(i), i);
    case Reason::INDEXER_ALONE:
    case Reason::INDEXER_OPEN: return indexer_reason(answer);
    case Reason::SWITCHED_ON: return "the machine is on: switch it off first";
    case Reason::NO_JOG_TO_RENEW:
        return fmt::format("there is no jog of {} to renew: it has ended or was stopped; start it again",
                           place_name(answer));
    case Reason::JOINT_BEYOND_LIMIT:
    case Reason::UNREACHABLE:
    case Reason::SINGULAR:
    case Reason::POSE_UNKNOWN:
    case Reason::SIDE_APART:
    case Reason::TOO_FEW_JOINTS: return kinematics_reason(answer);
    case Reason::RIGID_TAPPING:
    case Reason::TAP_OFFSET:
    case Reason::TAP_ROOM:
    case Reason::TAP_JOINT_ROOM:
    case Reason::ONE_WAY_SPINDLE: return tap_reason(answer);
    }
    return "refused";
}

namespace {

std::string planner_module_fault(const Fault &fault) {
    const char *what = "";
    switch (static_cast<PlannerModuleFault>(fault.detail)) {
    case PlannerModuleFault::NO_ANSWER: what = "returned no speed, or a speed that is not a number"; break;
    case PlannerModuleFault::NOT_THERE: what = "does not reach the end of a segment"; break;
    case PlannerModuleFault::TOO_FAST: what = "requests {:.3g} times the maximum speed"; break;
    case PlannerModuleFault::TOO_HARD: what = "requests {:.3g} times the maximum acceleration"; break;
    case PlannerModuleFault::TOO_LATE:
        what = "ends a segment with {:.3g} times the maximum entry speed of the next segment";
        break;
    }
    return "the planner module of [TRAJ]TPMOD " + fmt::format(fmt::runtime(what), fault.value) +
           ": motion was stopped within the limits. Correct the module";
}

std::string kinematics_fault(const Fault &fault) {
    const int i = fault.index;
    switch (fault.kind) {
    case FaultKind::JOINT_TOO_FAST:
        return fmt::format(
            "joint {} would have to move at {:.2f} times its velocity or acceleration limit: the planner "
            "cannot call this kinematics module. Lower the feed or the limits of the axes",
            i, fault.value);
    case FaultKind::JOINT_LEFT_RANGE:
        return fmt::format("the path exceeds the soft limit of joint {}: the planner cannot call this "
                           "kinematics module to check it before. Change the program or the part zero",
                           i);
    case FaultKind::KINEMATICS_FAILED: return "the kinematics could not reach the commanded pose";
    case FaultKind::KINEMATICS_JUMP:
        return fmt::format("the position of joint {} would jump by {:.6g}: a pin of the kinematics changed "
                           "at a pose where it moves "
                           "the joints. Change such pins only at poses where they have no effect",
                           i, fault.value);
    case FaultKind::NO_KINEMATICS_TYPE:
        return fmt::format("motion.switchkins-type: the kinematics has no type {:g}; the active type stays",
                           fault.value);
    case FaultKind::KINEMATICS_SWITCHED_ON_PATH:
        return fmt::format("motion.switchkins-type changed to {:g} during a path: motion was stopped. In "
                           "programs, change it with M68, then wait with M66 E0 L0",
                           fault.value);
    case FaultKind::KINEMATICS_TYPE_WITHOUT_POSE:
        return fmt::format("motion.switchkins-type: type {:g} of the kinematics has no pose for the current "
                           "joint positions; the active type stays",
                           fault.value);
    case FaultKind::JOG_UNREACHABLE:
        return "the jog was stopped: the kinematics cannot reach its target. Jog in the other direction";
    default: return "unknown motion fault";
    }
}

std::string spindle_fault(const Fault &fault) {
    const int i = fault.index;
    switch (fault.kind) {
    case FaultKind::THREAD_TOO_FAST:
        return fmt::format(
            "the thread needs {:.2f} times the speed that the machine, its velocity override, or the length "
            "of the thread allows at the present speed of spindle {}: use a lower speed or a finer pitch",
            fault.value, i);
    case FaultKind::TAP_TOO_FAST:
        return fmt::format("the tap needs {:.2f} times the speed that the machine, or its velocity override, "
                           "allows at the present speed of spindle {}: use a lower speed or a finer pitch",
                           fault.value, i);
    case FaultKind::TAP_TOO_ABRUPT:
        return fmt::format("spindle {} reverses so fast that the tap needs {:.2f} times the acceleration "
                           "that the machine allows: lengthen the ramp of its drive, or use a finer pitch",
                           i, fault.value);
    case FaultKind::TAP_TOO_SUDDEN:
        return fmt::format(
            "spindle {} reverses so suddenly that a tool within the jerk limits would leave the thread by "
            "{:.2f} revolutions: lengthen the ramp of its drive, raise the jerk limits, or use a finer pitch",
            i, fault.value);
    case FaultKind::TAP_TOO_SHALLOW:
        return fmt::format("the hole is too shallow for the current speed of spindle {}: acceleration and "
                           "reversal need {:.2f} times its depth; use a lower speed",
                           i, fault.value);
    case FaultKind::TAP_LOST:
        return fmt::format("the tool lost synchronization with spindle {} in a rigid tap: the spindle did "
                           "not reverse in time, or its encoder jumped. The tap may be stuck in the hole",
                           i);
    case FaultKind::SPINDLE_LOST:
        return fmt::format("spindle {} feedback is not a number during a synchronized move", i);
    case FaultKind::SPINDLE_FAULT:
        return fault.value != 0 ? fmt::format("spindle {} orient fault {}", i, static_cast<int>(fault.value))
                                : fmt::format("spindle {} amplifier fault", i);
    default: return "unknown motion fault";
    }
}

std::string who_stood(const Fault &fault) {
    if (fault.kind == FaultKind::TASK_LOST) {
        return fault.index == 1
                   ? "the task process has ended: the machine was stopped"
                   : fmt::format("the task process (millwright start) did not run for {:.2f} s: the machine "
                                 "was stopped. It hung, was stopped, or the computer was too busy",
                                 fault.value);
    }
    return fmt::format(
        "motion (millwright-rt) did not run for {:.2f} s{}. It was stopped, or the computer was too busy",
        fault.value,
        fault.index == 1 ? ", while axes moved: the machine was switched off; positions may be lost, home "
                           "the joints without encoders"
                         : "");
}

std::string joint_fault(const Fault &fault) {
    const int i = fault.index;
    switch (fault.kind) {
    case FaultKind::INDEXER_NOT_UNLOCKED:
        return fmt::format(
            "the locking indexer of joint {0} did not unlock in time: see joint.{0}.is-unlocked, which "
            "joints in unlock_joints_mask= of motmod have",
            i);
    case FaultKind::INDEXER_NOT_LOCKED:
        return fmt::format("the locking indexer of joint {0} did not lock in time: see joint.{0}.is-unlocked",
                           i);
    case FaultKind::INDEXER_LOCKED_IN_MOVE:
        return fmt::format("the indexer of joint {0} locked during its move: check joint.{0}.is-unlocked", i);
    case FaultKind::EXTRA_JOINT_LOST:
        return fmt::format("joint.{}.posthome-cmd is not a number: check the signal of the pin", i);
    case FaultKind::EXTRA_JOINT_LIMIT:
        return fmt::format("joint.{0}.posthome-cmd is {1:.6g}, outside the soft limits of joint {0}: the "
                           "joint stops at its limit",
                           i, fault.value);
    case FaultKind::POSITIONS_LOST:
        return "joint positions are lost, for the reason in the message of a driver: the machine was "
               "switched off; home all joints again";
    default: return "unknown motion fault";
    }
}

std::string what_failed(const Fault &fault) {
    const int i = fault.index;
    switch (fault.kind) {
    case FaultKind::FOLLOWING_ERROR: return fmt::format("joint {} following error", i);
    case FaultKind::FEEDBACK_LOST: return fmt::format("joint {} feedback is not a number", i);
    case FaultKind::INDEXER_NOT_UNLOCKED:
    case FaultKind::INDEXER_NOT_LOCKED:
    case FaultKind::INDEXER_LOCKED_IN_MOVE:
    case FaultKind::EXTRA_JOINT_LOST:
    case FaultKind::EXTRA_JOINT_LIMIT:
    case FaultKind::POSITIONS_LOST: return joint_fault(fault);
    case FaultKind::AMP_FAULT: return fmt::format("joint {} amplifier fault", i);
    case FaultKind::HARD_LIMIT: return fmt::format("joint {} on limit switch error", i);
    case FaultKind::SOFT_LIMIT: return fmt::format("{} exceeded its soft limit", axis_name(i));
    case FaultKind::ENABLE_LOST: return "motion stopped by enable input";
    case FaultKind::TASK_LOST:
    case FaultKind::MOTION_STOOD: return who_stood(fault);
    case FaultKind::HOMING_FAILED:
        return fmt::format("homing{} failed: {}", i >= 0 ? fmt::format(" of joint {}", i) : "",
                           homing::failure_text(static_cast<homing::Failure>(fault.detail)));
    case FaultKind::HOMING_CLAMPED:
        return fmt::format("the homing module commanded more than the limits of joint {} allow: the joint "
                           "moves within its limits",
                           i);
    case FaultKind::PROBE_NOT_TRIPPED:
        return fault.detail == 0 ? "G38.2 move finished without making contact."
                                 : "G38.4 move finished without breaking contact.";
    case FaultKind::PROBE_TRIPPED_IN_MOVE:
        return fault.detail == 0 ? "probe tripped during a move that does not probe"
                                 : "probe tripped in a jog or while homing, which has stopped: see "
                                   "[TRAJ]NO_PROBE_JOG_ERROR and NO_PROBE_HOME_ERROR";
    case FaultKind::PLANNER_MODULE: return planner_module_fault(fault);
    case FaultKind::NO_WAY_ON:
        return "the planner found no motion from here that keeps all limits and the path tolerance (G64 P): "
               "raise the tolerance or lower the feed";
    case FaultKind::JOG_JOINT_LIMIT:
        return fmt::format("the jog was stopped: joint {} would leave its soft limits", i);
    case FaultKind::JOG_LEASE_ENDED:
        return fmt::format("the jog of {} was stopped: it was not renewed within {:g} ms",
                           fault.detail != 0 ? joint_name(i) : axis_name(i), fault.value * 1e3);
    case FaultKind::SIDE_APART:
        return fmt::format(
            "{} differs from the other joint of its axis by more than its MIN_FERROR: the machine is on in "
            "joint mode. Home, or jog the joint to the position of the other, before axes move",
            joint_name(i));
    case FaultKind::POSE_UNKNOWN:
        return "forward kinematics found no pose for the current joint positions: the machine is on in joint "
               "mode. Home, or jog single joints to other positions, before axes move";
    case FaultKind::PATH_LIMIT: return "the path exceeded its limits";
    case FaultKind::MISC_ERROR: return "an error input of motion is on: see pins motion.misc-error-NN";
    case FaultKind::JOINT_TOO_FAST:
    case FaultKind::JOINT_LEFT_RANGE:
    case FaultKind::KINEMATICS_FAILED:
    case FaultKind::KINEMATICS_JUMP:
    case FaultKind::NO_KINEMATICS_TYPE:
    case FaultKind::KINEMATICS_SWITCHED_ON_PATH:
    case FaultKind::KINEMATICS_TYPE_WITHOUT_POSE:
    case FaultKind::JOG_UNREACHABLE: return kinematics_fault(fault);
    case FaultKind::THREAD_TOO_FAST:
    case FaultKind::TAP_TOO_FAST:
    case FaultKind::TAP_TOO_ABRUPT:
    case FaultKind::TAP_TOO_SUDDEN:
    case FaultKind::TAP_TOO_SHALLOW:
    case FaultKind::TAP_LOST:
    case FaultKind::SPINDLE_LOST:
    case FaultKind::SPINDLE_FAULT: return spindle_fault(fault);
    case FaultKind::COUNT: break;
    }
    return "unknown motion fault";
}

}  // namespace

std::string fault_text(const Fault &fault) {
    const int line = fault.source.line;
    return line > 0 ? fmt::format("{} (line {})", what_failed(fault), line) : what_failed(fault);
}

}  // namespace mw::motion

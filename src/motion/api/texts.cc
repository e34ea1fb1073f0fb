// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/api/texts.hh"

#include "base/text.hh"
#include "geom/pose.hh"

namespace mw::motion {
namespace {

std::string joint_name(int index) {
    return index >= 0 ? "joint " + std::to_string(index) : std::string("a joint");
}

std::string axis_name(int index) {
    const bool isAxis = index >= 0 && index < geom::AXIS_COUNT;
    return isAxis ? std::string("axis ") + geom::AXIS_LETTERS[index] : std::string("an axis");
}

std::string number(int index) {
    return std::to_string(index);
}

}  // namespace

std::string reason_text(const Answer &answer) {
    const int index = answer.index;
    switch (answer.reason) {
    case Reason::NONE: break;
    case Reason::NOT_ENABLED: return "the machine is not on";
    case Reason::WRONG_MODE: return "not possible in the present motion mode";
    case Reason::MOVING: return "not possible while the machine moves";
    case Reason::NOT_HOMED: return joint_name(index) + " is not homed";
    case Reason::HOMING: return "not possible while homing";
    case Reason::NO_SUCH_JOINT: return "there is no joint " + number(index);
    case Reason::NO_SUCH_AXIS: return "there is no such axis (number " + number(index) + ")";
    case Reason::NO_SUCH_SPINDLE: return "there is no spindle " + number(index);
    case Reason::NO_SUCH_OUTPUT: return "there is no input or output " + number(index);
    case Reason::NO_SUCH_PARAMETER: return "there is no setting " + number(index);
    case Reason::OUT_OF_RANGE: return "a value is out of range";
    case Reason::BEYOND_SOFT_LIMIT:
        return answer.isPath ? "the move goes beyond the soft limit of " + axis_name(index)
                             : joint_name(index) + " would go beyond its soft limit";
    case Reason::ON_HARD_LIMIT:
        return joint_name(index) + " is on its limit switch; override the limits and jog it off";
    case Reason::UNREACHABLE: return "the position cannot be reached";
    case Reason::AMP_FAULT: return joint_name(index) + " has an amplifier fault";
    case Reason::EXTERNAL_ENABLE_OFF:
        return "cannot switch on: pin motion.enable is FALSE, or the e-stop chain is open";
    case Reason::JOINT_INACTIVE: return joint_name(index) + " is not active";
    case Reason::QUEUE_FULL: return "the queue of moves is full";
    case Reason::PROBE_ALREADY_TRIPPED: return "the probe is tripped before the probing move begins";
    case Reason::NOT_A_NUMBER: return "a value is not a finite number";
    case Reason::NOT_SUPPORTED: return "not supported by this version";
    case Reason::JOG_INHIBITED: return "jogs are inhibited by pin motion.jog-inhibit";
    case Reason::HOMING_INHIBITED: return "homing is inhibited by pin motion.homing-inhibit";
    case Reason::SYNCHRONISED_JOINT:
        return joint_name(index) + " homes together with others and cannot be jogged alone before that";
    case Reason::COUNT: break;
    case Reason::BAD_ARC: return "the arc has no radius";
    }
    return "refused";
}

std::string fault_text(const Fault &fault) {
    const std::string line = fault.source.line > 0 ? " at line " + number(fault.source.line) : "";
    switch (fault.kind) {
    case FaultKind::FOLLOWING_ERROR:
        return joint_name(fault.index) + " following error (" + to_text(fault.value) + ')' + line;
    case FaultKind::AMP_FAULT: return joint_name(fault.index) + " amplifier fault";
    case FaultKind::HARD_LIMIT: return joint_name(fault.index) + " on limit switch error";
    case FaultKind::SOFT_LIMIT: return joint_name(fault.index) + " has come to its soft limit" + line;
    case FaultKind::ENABLE_LOST:
        return "motion stopped by the enable input (motion.enable or the e-stop chain)";
    case FaultKind::TASK_LOST: return "the task process is gone or hangs: motion has stopped";
    case FaultKind::HOMING_FAILED: return joint_name(fault.index) + ": homing failed";
    case FaultKind::PROBE_NOT_TRIPPED: return "the probing move ended without contact" + line;
    case FaultKind::PROBE_TRIPPED_IN_MOVE: return "the probe tripped in a move that does not probe" + line;
    case FaultKind::KINEMATICS_FAILED: return "the kinematics have no solution for the position" + line;
    case FaultKind::PATH_LIMIT:
        return "the path would go beyond a limit of " + joint_name(fault.index) + line;
    case FaultKind::MISC_ERROR: return "pin motion.misc-error-" + number(fault.index) + " is TRUE";
    case FaultKind::COUNT: break;
    case FaultKind::SPINDLE_FAULT: return "spindle " + number(fault.index) + " reports a fault";
    }
    return "unknown motion fault";
}

}  // namespace mw::motion

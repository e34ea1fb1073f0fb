// SPDX-License-Identifier: GPL-2.0-or-later
// The numbers that scripts compare. They equal those of the messages, and never change.
#include <array>

#include "base/limits.hh"
#include "clients/python/linuxcnc/module.hh"

namespace mw::python {
namespace {

struct Constant {
    const char *name;
    int value;
};

constexpr std::array CONSTANTS{
    Constant{"LINEAR", 1},
    Constant{"ANGULAR", 2},
    Constant{"MODE_MANUAL", 1},
    Constant{"MODE_AUTO", 2},
    Constant{"MODE_MDI", 3},
    Constant{"STATE_ESTOP", 1},
    Constant{"STATE_ESTOP_RESET", 2},
    Constant{"STATE_OFF", 3},
    Constant{"STATE_ON", 4},
    Constant{"INTERP_IDLE", 1},
    Constant{"INTERP_READING", 2},
    Constant{"INTERP_PAUSED", 3},
    Constant{"INTERP_WAITING", 4},
    Constant{"EXEC_ERROR", 1},
    Constant{"EXEC_DONE", 2},
    Constant{"EXEC_WAITING_FOR_MOTION", 3},
    Constant{"EXEC_WAITING_FOR_MOTION_QUEUE", 4},
    Constant{"EXEC_WAITING_FOR_IO", 5},
    Constant{"EXEC_WAITING_FOR_MOTION_AND_IO", 7},
    Constant{"EXEC_WAITING_FOR_DELAY", 8},
    Constant{"EXEC_WAITING_FOR_SYSTEM_CMD", 9},
    Constant{"EXEC_WAITING_FOR_SPINDLE_ORIENTED", 10},
    Constant{"RCS_DONE", 1},
    Constant{"RCS_EXEC", 2},
    Constant{"RCS_ERROR", 3},
    Constant{"TRAJ_MODE_FREE", 1},
    Constant{"TRAJ_MODE_COORD", 2},
    Constant{"TRAJ_MODE_TELEOP", 3},
    Constant{"MOTION_TYPE_TRAVERSE", 1},
    Constant{"MOTION_TYPE_FEED", 2},
    Constant{"MOTION_TYPE_ARC", 3},
    Constant{"MOTION_TYPE_TOOLCHANGE", 4},
    Constant{"MOTION_TYPE_PROBING", 5},
    Constant{"MOTION_TYPE_INDEXROTARY", 6},
    Constant{"KINEMATICS_IDENTITY", 1},
    Constant{"KINEMATICS_FORWARD_ONLY", 2},
    Constant{"KINEMATICS_INVERSE_ONLY", 3},
    Constant{"KINEMATICS_BOTH", 4},
    Constant{"AUTO_RUN", 0},
    Constant{"AUTO_PAUSE", 1},
    Constant{"AUTO_RESUME", 2},
    Constant{"AUTO_STEP", 3},
    Constant{"AUTO_REVERSE", 4},
    Constant{"AUTO_FORWARD", 5},
    Constant{"JOG_STOP", 0},
    Constant{"JOG_CONTINUOUS", 1},
    Constant{"JOG_INCREMENT", 2},
    Constant{"BRAKE_RELEASE", 0},
    Constant{"BRAKE_ENGAGE", 1},
    Constant{"FLOOD_OFF", 0},
    Constant{"FLOOD_ON", 1},
    Constant{"MIST_OFF", 0},
    Constant{"MIST_ON", 1},
    Constant{"SPINDLE_REVERSE", -1},
    Constant{"SPINDLE_OFF", 0},
    Constant{"SPINDLE_FORWARD", 1},
    Constant{"SPINDLE_INCREASE", 10},
    Constant{"SPINDLE_DECREASE", 11},
    Constant{"SPINDLE_CONSTANT", 12},
    Constant{"NML_ERROR", 1},
    Constant{"NML_TEXT", 2},
    Constant{"NML_DISPLAY", 3},
    Constant{"OPERATOR_ERROR", 11},
    Constant{"OPERATOR_TEXT", 12},
    Constant{"OPERATOR_DISPLAY", 13},
    Constant{"DEBUG_CONFIG", 2},
    Constant{"DEBUG_VERSIONS", 8},
    Constant{"DEBUG_TASK_ISSUE", 16},
    Constant{"DEBUG_NML", 64},
    Constant{"DEBUG_MOTION_TIME", 128},
    Constant{"DEBUG_INTERP", 256},
    Constant{"DEBUG_RCS", 512},
    Constant{"DEBUG_INTERP_LIST", 2048},
    Constant{"DEBUG_OWORD", 8192},
    Constant{"DEBUG_REMAP", 16384},
    Constant{"DEBUG_PYTHON", 32768},
    Constant{"DEBUG_STATE_TAGS", 524288},
    Constant{"MAX_JOINTS", MAX_JOINTS},
    Constant{"MAX_AXIS", MAX_AXES},
};

}  // namespace

void define_constants(pybind11::module_ &module) {
    for (const Constant &constant : CONSTANTS) {
        module.attr(constant.name) = constant.value;
    }
}

}  // namespace mw::python

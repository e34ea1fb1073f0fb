// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc.stat: the status of the machine, as of the last poll(). One table of attributes.
#include <pybind11/stl.h>

#include <cstring>
#include <span>

#include "clients/python/linuxcnc/connection.hh"
#include "clients/python/linuxcnc/module.hh"
#include "clients/python/linuxcnc/stat_parts.hh"
#include "clients/python/linuxcnc/stat_words.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

using Status = messages::MachineStatus;

/// Before the first poll.
const Status &nothing() {
    static const Status zero = [] {
        Status status;
        std::memset(static_cast<void *>(&status), 0, sizeof status);
        return status;
    }();
    return zero;
}

/// Guarded by the GIL.
class Stat {
  public:
    /// Never waits for the machine, and costs it nothing: reads what it published last.
    void poll() {
        client::Viewer &viewer = view_.viewer();
        if (viewer.segment().cycles.load(std::memory_order_acquire) == 0) {
            return;  // programs of HAL files look before task has begun: nothing yet
        }
        const auto read = viewer.read_status();
        if (!read.has_value()) {
            throw_error(read.error().str());
        }
        const auto tools = viewer.read_tools();
        if (!tools.has_value()) {
            throw_error(tools.error().str());
        }
        if (tools->has_value()) {
            table_ = **tools;
            shown_table_ = py::none();
        }
        view_.check_alive();
        isPolled_ = true;
        if (ini_.empty()) {
            ini_ = viewer.identity().ini.str();
        }
    }
    const Status &status() { return isPolled_ && view_.isJoined() ? view_.viewer().status() : nothing(); }
    const std::string &ini() {
        if (isPolled_ && view_.isJoined() && view_.viewer().link() != nullptr) {
            throw_error("ini_filename: the machine is on another computer, and so is its INI file");
        }
        return ini_;
    }
    const messages::ToolTable &table() {
        if (isPolled_ && view_.isJoined() && view_.viewer().link() != nullptr) {
            if (const auto tools = view_.viewer().link()->check_tools(); !tools.has_value()) {
                throw_error(tools.error().str());
            }
        }
        return table_;
    }
    py::object tool_table() {
        static_cast<void>(table());
        if (shown_table_.is_none()) {
            shown_table_ = tool_tuples(table_);
        }
        return shown_table_;
    }

  private:
    View view_;
    bool isPolled_ = false;
    std::string ini_;
    messages::ToolTable table_;
    py::object shown_table_ = py::none();
};

template <class Number, std::size_t N>
py::tuple numbers(const std::array<Number, N> &values) {
    py::tuple out(N);
    for (std::size_t i = 0; i < N; ++i) {
        out[i] = py::cast(values[i]);
    }
    return out;
}

py::tuple bits(std::uint64_t word) {
    py::tuple out(MAX_DIGITAL_IO);
    for (int i = 0; i < MAX_DIGITAL_IO; ++i) {
        out[static_cast<std::size_t>(i)] = static_cast<int>(word >> i & 1U);
    }
    return out;
}

template <class Value>
py::tuple of_joints(const Status &status, Value value) {
    py::tuple out(MAX_JOINTS);
    for (std::size_t i = 0; i < MAX_JOINTS; ++i) {
        out[i] = value(status.joints[i]);
    }
    return out;
}

int limit_bits(const messages::JointStatus &joint) {
    return (joint.isOnNegHardLimit ? 1 : 0) | (joint.isOnPosHardLimit ? 2 : 0) |
           (joint.isOnNegSoftLimit ? 4 : 0) | (joint.isOnPosSoftLimit ? 8 : 0);
}

bool isIdle(const Status &s) {
    return s.task.interp_state == messages::InterpState::IDLE;
}

int program_units(const Status &s) {
    constexpr std::size_t UNITS = 5;  // place in the modal codes
    constexpr int G20 = 200, G21 = 210, INCH = 1, MM = 2;
    return s.codes.g[UNITS] == G20 ? INCH : s.codes.g[UNITS] == G21 ? MM : 0;
}

/// The block under execution; nothing when idle, but after a program that has ended.
std::string block(const Status &s) {
    const bool isTold = !isIdle(s) || (s.task.mode == messages::Mode::AUTO && s.task.programs_ended > 0);
    return isTold ? s.task.block.str() : std::string();
}

struct Attribute {
    const char *name, *doc;
    py::object (*get)(const Status &);
};

py::object make(py::tuple value) {
    return value;
}
template <class Value>
py::object make(Value value) {
    return py::cast(value);
}

#define MW_STAT(name, doc, expression)                                                                       \
    Attribute {                                                                                              \
        name, doc, [](const Status &s) -> py::object {                                                       \
            static_cast<void>(s);                                                                            \
            return make(expression);                                                                         \
        }                                                                                                    \
    }

const Attribute OF_TASK[] = {
    MW_STAT("echo_serial_number", "number of the command that task took last", s.last_command),
    MW_STAT("state", "RCS_*: of the last command and what is under way", static_cast<int>(rcs_state(s))),
    MW_STAT("task_mode", "MODE_*", static_cast<int>(s.task.mode)),
    MW_STAT("task_state", "STATE_*", static_cast<int>(s.task.state)),
    MW_STAT("exec_state", "EXEC_*: what task waits for", static_cast<int>(s.task.exec_state)),
    MW_STAT("interp_state", "INTERP_*", static_cast<int>(s.task.interp_state)),
    MW_STAT("call_level", "depth of subroutines", isIdle(s) ? 0 : s.task.call_level),
    MW_STAT("read_line", "line that the interpreter has read, 0 when idle", isIdle(s) ? 0 : s.task.read_line),
    MW_STAT("motion_line", "line of the move that is made", s.task.motion_line),
    MW_STAT("current_line", "line that is carried out", s.task.motion_line),
    MW_STAT("file", "path of the open program", s.task.program.str()),
    MW_STAT("command", "block under execution", block(s)),
    MW_STAT("program_units", "1 inch, 2 mm", program_units(s)),
    MW_STAT("interpreter_errcode", "0, or 5 after a block that failed", s.task.error_code),
    MW_STAT("optional_stop", "M1 stops", s.task.isOptionalStop),
    MW_STAT("block_delete", "lines that begin with / are left out", s.task.isBlockDelete),
    MW_STAT("task_paused", "held", static_cast<int>(s.task.isPaused)),
    MW_STAT("input_timeout", "the last M66 has waited in vain", static_cast<int>(s.task.isInputTimedOut)),
    MW_STAT("rotation_xy", "degrees, of the coordinate system", s.offsets.rotation_xy_deg),
    MW_STAT("delay_left", "seconds of a dwell", s.task.delay_left_s),
    MW_STAT("queued_mdi_commands", "lines of MDI that wait", s.task.queued_mdi),
    MW_STAT("debug", "bits of [EMC]DEBUG", s.settings.debug),
    MW_STAT("taskbeat", "cycles of task", s.cycle),
    MW_STAT("gcodes", "modal G codes, ten times the number, -1 none", numbers(s.codes.g)),
    MW_STAT("mcodes", "modal M codes, -1 none", numbers(s.codes.m)),
    MW_STAT("settings", "sequence number, F, S, G64 P, G64 Q", numbers(s.codes.settings)),
    MW_STAT("g5x_index", "1 G54 ... 9 G59.3", s.offsets.g5x_index),
    MW_STAT("g5x_offset", "work offset", pose(s.offsets.g5x)),
    MW_STAT("g92_offset", "G92 offset", pose(s.offsets.g92)),
    MW_STAT("tool_offset", "tool offset in force", pose(s.offsets.tool)),
};

const Attribute OF_MOTION[] = {
    MW_STAT("linear_units", "machine units in a millimetre", s.settings.linear_units),
    MW_STAT("angular_units", "machine units in a degree", s.settings.angular_units),
    MW_STAT("cycle_time", "seconds, of the planner", s.settings.cycle_time_s),
    MW_STAT("joints", "how many", s.trajectory.num_joints),
    MW_STAT("num_extrajoints", "the last of them", s.trajectory.num_extra_joints),
    MW_STAT("spindles", "how many", s.trajectory.num_spindles),
    MW_STAT("axis_mask", "bit 0 X ... bit 8 W", s.trajectory.axis_mask),
    MW_STAT("motion_mode", "TRAJ_MODE_*", static_cast<int>(s.trajectory.mode)),
    MW_STAT("enabled", "motion is enabled", s.trajectory.isEnabled),
    MW_STAT("inpos", "nothing moves", s.trajectory.isInPosition),
    MW_STAT("queue", "moves in the planner", s.trajectory.queue_depth),
    MW_STAT("active_queue", "of them being blended", s.trajectory.active_move != 0 ? 1 : 0),
    MW_STAT("queue_full", "no further move is taken", s.trajectory.isQueueFull),
    MW_STAT("motion_id", "line of the move that is made, 0 none",
            s.trajectory.active_move != 0 ? s.task.motion_line : 0),
    MW_STAT("paused", "the program or motion is paused", s.task.isPaused || s.trajectory.isPaused),
    MW_STAT("single_stepping", "one block at a time", s.trajectory.isStepping),
    MW_STAT("feedrate", "feed override, 1 is 100 %", s.overrides.feed),
    MW_STAT("rapidrate", "rapid override, 1 is 100 %", s.overrides.rapid),
    MW_STAT("velocity", "0; see current_vel", 0.0),
    MW_STAT("acceleration", "of the path", s.settings.max_acceleration),
    MW_STAT("max_velocity", "of the path, as limited by maxvel()", s.settings.max_velocity),
    MW_STAT("max_acceleration", "of the path", s.settings.max_acceleration),
    MW_STAT("probe_tripped", "the last probe has met something", s.probe.isTripped),
    MW_STAT("probing", "a probe move is made", s.probe.isProbing),
    MW_STAT("probe_val", "the probe input", static_cast<int>(s.probe.isOn)),
    MW_STAT("kinematics_type", "KINEMATICS_*", static_cast<int>(s.settings.kinematics)),
    MW_STAT("motion_type", "MOTION_TYPE_* of the move that is made, 0 none",
            static_cast<int>(s.trajectory.move_kind)),
    MW_STAT("distance_to_go", "of the move that is made", s.trajectory.distance_to_go),
    MW_STAT("current_vel", "along the path", s.trajectory.current_velocity),
    MW_STAT("feed_override_enabled", "M50", s.overrides.isFeedEnabled),
    MW_STAT("adaptive_feed_enabled", "M52", s.overrides.isAdaptiveFeedEnabled),
    MW_STAT("feed_hold_enabled", "M53", s.overrides.isFeedHoldEnabled),
    MW_STAT("position", "commanded", pose(s.trajectory.position_cmd)),
    MW_STAT("actual_position", "by feedback", pose(s.trajectory.position_fb)),
    MW_STAT("dtg", "distance to go of each axis", pose(s.trajectory.dtg)),
    MW_STAT("probed_position", "where the probe tripped last", pose(s.probe.position)),
    MW_STAT("joint_position", "commanded", of_joints(s, [](const auto &j) { return py::cast(j.pos_cmd); })),
    MW_STAT("joint_actual_position", "by feedback",
            of_joints(s, [](const auto &j) { return py::cast(j.pos_fb); })),
    MW_STAT("homed", "0 or 1 for each joint",
            of_joints(s, [](const auto &j) { return py::cast(static_cast<int>(j.isHomed)); })),
    MW_STAT("limit", "bits: 1 min hard, 2 max hard, 4 min soft, 8 max soft",
            of_joints(s, [](const auto &j) { return py::cast(limit_bits(j)); })),
    MW_STAT("ain", "motion.analog-in", numbers(s.motion.analog_in)),
    MW_STAT("aout", "motion.analog-out", numbers(s.motion.analog_out)),
    MW_STAT("din", "motion.digital-in", bits(s.motion.digital_in)),
    MW_STAT("dout", "motion.digital-out", bits(s.motion.digital_out)),
    MW_STAT("misc_error", "motion.misc-error", bits(0)),
    MW_STAT("heartbeat", "servo cycles", s.motion.cycle),
    MW_STAT("joint", "a dict for each joint", joint_dicts(s)),
    MW_STAT("axis", "a dict for each axis", axis_dicts(s)),
    MW_STAT("spindle", "a dict for each spindle", spindle_dicts(s)),
};

const Attribute OF_DEVICES[] = {
    MW_STAT("pocket_prepped", "entry of tool_table that is prepared, -1 none", s.tool.prepared_index),
    MW_STAT("tool_in_spindle", "number of the tool, 0 none", s.tool.in_spindle),
    MW_STAT("tool_from_pocket", "pocket that it was taken from", s.tool.from_pocket),
    MW_STAT("mist", "0 or 1", static_cast<int>(s.io.coolant.isMistOn)),
    MW_STAT("flood", "0 or 1", static_cast<int>(s.io.coolant.isFloodOn)),
    MW_STAT("lube", "0 or 1", static_cast<int>(s.io.lube.isOn)),
    MW_STAT("lube_level", "1: enough", static_cast<int>(s.io.lube.hasOil)),
    MW_STAT("estop", "0 or 1", static_cast<int>(s.task.state == messages::State::ESTOP)),
};
#undef MW_STAT

}  // namespace

void define_stat(py::module_ &module) {
    py::class_<Stat> stat(module, "stat", "stat(): the status of the machine as of the last poll().");
    stat.def(py::init<>())
        .def("poll", &Stat::poll, "Takes the status as it is now. linuxcnc.error when there is no machine.")
        .def_property_readonly("ini_filename", [](Stat &self) { return self.ini(); })
        .def_property_readonly("tool_table", &Stat::tool_table)
        .def(
            "toolinfo", [](Stat &self, int toolno) { return tool_dict(self.table(), toolno); },
            py::arg("tool"), "A dict of the tool of that number. ValueError when there is none.");
    for (const std::span<const Attribute> table :
         {std::span<const Attribute>(OF_TASK), std::span<const Attribute>(OF_MOTION),
          std::span<const Attribute>(OF_DEVICES)}) {
        for (const Attribute &attribute : table) {
            stat.def_property_readonly(
                attribute.name, [get = attribute.get](Stat &self) { return get(self.status()); },
                attribute.doc);
        }
    }
}

}  // namespace mw::python

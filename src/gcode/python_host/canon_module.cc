// SPDX-License-Identifier: GPL-2.0-or-later
// _millwright_canon: canon calls for scripts. Names and arguments are those of LinuxCNC's scripts. `line` is
// accepted as the first argument of moves and ignored, because calls belong to the block that called the
// script.
#include <pybind11/stl.h>

#include <algorithm>

#include "gcode/python_host/modules.hh"

namespace mw::python_host {
namespace {

using gcode::Canon;
using gcode::MachineSnapshot;

geometry::Pose pose_of(double x, double y, double z, double a, double b, double c, double u, double v,
                       double w) {
    geometry::Pose out;
    const double values[] = {x, y, z, a, b, c, u, v, w};
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        out[axis] = values[axis];
    }
    return out;
}

/// Any object with nine items: EmcPose, tuple, list.
geometry::Pose pose_from(const py::iterable &items) {
    geometry::Pose out;
    int axis = 0;
    for (const py::handle item : items) {
        if (axis == geometry::AXIS_COUNT) {
            throw py::value_error("a pose has nine coordinates");
        }
        out[axis++] = item.cast<double>();
    }
    return out;
}

MachineSnapshot machine() {
    return current_view().world().snapshot();
}

/// Runs `what` with the canon and passes the call on.
template <class What>
void with_canon(What what) {
    gcode::InterpreterView &view = current_view();
    what(view.canon());
    view.deliver();
}

template <class Call, class... Fields>
void def_fields(py::module_ &m, const char *name, Call preset, std::tuple<Fields Call::*...> fields) {
    m.def(name, [preset, fields](Fields... values) {
        Call call = preset;
        std::apply([&](auto... field) { ((call.*field = std::move(values)), ...); }, fields);
        with_canon([&](Canon &canon) { canon.take(call); });
    });
}

/// Defines a call by its name, with its fields as arguments; all other fields are from `preset`.
template <gcode::RegularCall Call>
void def(py::module_ &m, const Call &preset = {}) {
    def_fields(m, name_of(preset).data(), preset, Call::FIELDS);
}

/// Defines the same call with a second name.
template <gcode::RegularCall Call>
void def_with_twin(py::module_ &m, const Call &preset = {}) {
    def(m, preset);
    def_fields(m, ("enqueue_" + std::string(name_of(preset))).c_str(), preset, Call::FIELDS);
}

void define_moves(py::module_ &m) {
    using D = double;
    m.def("STRAIGHT_TRAVERSE", [](int, D x, D y, D z, D a, D b, D c, D u, D v, D w) {
        with_canon(
            [&](Canon &canon) { canon.take(gcode::StraightTraverse{pose_of(x, y, z, a, b, c, u, v, w)}); });
    });
    m.def("STRAIGHT_FEED", [](int, D x, D y, D z, D a, D b, D c, D u, D v, D w) {
        with_canon(
            [&](Canon &canon) { canon.take(gcode::StraightFeed{pose_of(x, y, z, a, b, c, u, v, w)}); });
    });
    m.def("STRAIGHT_PROBE", [](int, D x, D y, D z, D a, D b, D c, D u, D v, D w, int kind) {
        with_canon([&](Canon &canon) {
            canon.take(gcode::StraightProbe{pose_of(x, y, z, a, b, c, u, v, w),
                                            static_cast<gcode::ProbeKind>(kind & 3)});
        });
        current_view().expect_probe();
    });
    m.def("ARC_FEED", [](int, D first, D second, D first_axis, D second_axis, int rotation, D end, D a, D b,
                         D c, D u, D v, D w) {
        with_canon([&](Canon &canon) {
            const auto plane = current_view().attribute("plane");
            const std::int64_t number = plane ? std::get<std::int64_t>(*plane) : 1;
            const geometry::Pose pose = number == 2   ? pose_of(end, first, second, a, b, c, u, v, w)
                                        : number == 3 ? pose_of(second, end, first, a, b, c, u, v, w)
                                                      : pose_of(first, second, end, a, b, c, u, v, w);
            canon.take(gcode::ArcFeed{first, second, first_axis, second_axis, rotation, end, pose});
        });
    });
    m.def("RIGID_TAP", [](int, D x, D y, D z, D scale) {
        with_canon([&](Canon &canon) { canon.take(gcode::RigidTap{x, y, z, scale}); });
    });
    def_with_twin<gcode::Dwell>(m);
    m.def("START_SPEED_FEED_SYNCH", [](int spindle, D feed_per_revolution, bool is_velocity_mode) {
        with_canon([&](Canon &canon) {
            canon.take(gcode::StartSpeedFeedSynch{spindle, feed_per_revolution, is_velocity_mode});
        });
    });
    def<gcode::StopSpeedFeedSynch>(m);
    def<gcode::Finish>(m);
}

void define_modes(py::module_ &m) {
    using D = double;
    def<gcode::OnReset>(m);
    m.def("USE_LENGTH_UNITS", [](int units) {
        if (units != 1 && units != 2) {
            throw py::value_error("units must be CANON_UNITS_INCHES or CANON_UNITS_MM");
        }
        with_canon([&](Canon &canon) {
            canon.take(gcode::UseLengthUnits{units == 1 ? gcode::LengthUnits::INCH : gcode::LengthUnits::MM});
        });
    });
    m.def("SELECT_PLANE", [](int plane) {
        using gcode::Plane;
        constexpr Plane PLANES[] = {Plane::XY, Plane::YZ, Plane::XZ, Plane::UV, Plane::VW, Plane::UW};
        if (plane < 1 || plane > 6) {
            throw py::value_error("a plane is CANON_PLANE_XY to CANON_PLANE_UW");
        }
        with_canon([&](Canon &canon) { canon.take(gcode::SelectPlane{PLANES[plane - 1]}); });
    });
    m.def("SET_G5X_OFFSET", [](int index, D x, D y, D z, D a, D b, D c, D u, D v, D w) {
        with_canon([&](Canon &canon) {
            canon.take(gcode::SetG5xOffset{index, pose_of(x, y, z, a, b, c, u, v, w)});
        });
    });
    m.def("SET_G92_OFFSET", [](D x, D y, D z, D a, D b, D c, D u, D v, D w) {
        with_canon(
            [&](Canon &canon) { canon.take(gcode::SetG92Offset{pose_of(x, y, z, a, b, c, u, v, w)}); });
    });
    def<gcode::SetXyRotation>(m);
    m.def("USE_TOOL_LENGTH_OFFSET", [](const py::iterable &pose) {
        with_canon([&](Canon &canon) { canon.take(gcode::UseToolLengthOffset{pose_from(pose)}); });
    });
    def<gcode::SetNaivecamTolerance>(m);
    def_with_twin<gcode::SetFeedRate>(m);
    for (const char *name : {"SET_FEED_MODE", "enqueue_SET_FEED_MODE"}) {
        m.def(name, [](int spindle, int mode) {
            with_canon([&](Canon &canon) {
                canon.take(gcode::SetFeedMode{spindle, static_cast<gcode::FeedMode>(std::clamp(mode, 0, 2))});
            });
        });
    }
}

void define_spindles(py::module_ &m) {
    def_with_twin<gcode::SetSpindleMode>(m);
    def_with_twin<gcode::SetSpindleSpeed>(m);
    for (const char *prefix : {"", "enqueue_"}) {
        for (const bool clockwise : {true, false}) {
            const std::string name = std::string(prefix).append(name_of(gcode::StartSpindle{0, clockwise}));
            m.def(
                name.c_str(),
                [clockwise](int spindle, int wait) {
                    with_canon([&](Canon &canon) {
                        canon.take(gcode::StartSpindle{spindle, clockwise, wait != 0});
                    });
                },
                py::arg("spindle"), py::arg("wait_for_atspeed") = 1);
        }
    }
    def_with_twin<gcode::StopSpindle>(m);
    for (const bool on : {true, false}) {
        def_with_twin(m, gcode::SwitchMist{on});
        def_with_twin(m, gcode::SwitchFlood{on});
    }
    def<gcode::OrientSpindle>(m);
}

void define_tools(py::module_ &m) {
    def<gcode::SelectTool>(m);
    // Changes to the selected tool. The argument, its pocket, exists only for compatibility.
    m.def(
        "CHANGE_TOOL", [](int) { with_canon([](Canon &canon) { canon.take(gcode::ChangeTool{}); }); },
        py::arg("slot") = 0);
    def<gcode::ChangeToolNumber>(m);
    m.def("SET_TOOL_TABLE_ENTRY", [](int index, int toolno, const py::iterable &offset, double diameter,
                                     double frontangle, double backangle, int orientation) {
        gcode::ToolEntry entry = current_view().tool(index);
        entry.toolno = toolno;
        entry.offset = pose_from(offset);
        entry.diameter = diameter;
        entry.frontangle = frontangle;
        entry.backangle = backangle;
        entry.orientation = orientation;
        with_canon([&](Canon &canon) { canon.take(gcode::SetToolTableEntry{index, entry}); });
    });
    for (const char *name : {"START_CHANGE", "TURN_PROBE_ON", "TURN_PROBE_OFF"}) {
        m.def(name, [] {});  // CHANGE_TOOL and STRAIGHT_PROBE include this wait
    }
}

void define_switches(py::module_ &m) {
    for (const bool on : {true, false}) {
        def(m, gcode::SwitchFeedOverride{on});
        def(m, gcode::SwitchSpeedOverride{0, on});
        def(m, gcode::SwitchFeedHold{on});
        def(m, gcode::SwitchAdaptiveFeed{on});
        for (const bool synched : {true, false}) {
            def(m, gcode::SetDigitalOutput{0, on, synched});
        }
    }
    for (const bool synched : {true, false}) {
        m.def(name_of(gcode::SetAnalogOutput{0, 0, synched}).data(), [synched](int index, double value) {
            with_canon([&](Canon &canon) { canon.take(gcode::SetAnalogOutput{index, value, synched}); });
        });
    }
    m.def("WAIT", [](int index, int type, int kind, double timeout) {
        with_canon([&](Canon &canon) {
            canon.take(gcode::WaitInput{index, type == 0,
                                        static_cast<gcode::WaitKind>(std::clamp(kind, 0, 4)), timeout});
        });
        current_view().expect_input();
        return 0;
    });
}

void define_rest(py::module_ &m) {
    def(m, gcode::ProgramStop{false});
    def(m, gcode::ProgramStop{true});
    def<gcode::ProgramEnd>(m);
    def<gcode::PalletShuttle>(m);
    def_with_twin<gcode::ProgramComment>(m);
    def<gcode::OperatorMessage>(m);
    def<gcode::LogLine>(m);
    m.def(gcode::CanonError::NAME.data(), [](const std::string &what) {
        with_canon([&](Canon &canon) { canon.take(gcode::CanonError{what}); });
    });
    def(m, gcode::OpenLog{{}, false});
    def(m, gcode::OpenLog{{}, true});
    def<gcode::CloseLog>(m);
    for (const char *name : {"CLAMP_AXIS",
                             "GET_EXTERNAL_MOTION_CONTROL_MODE",
                             "GET_EXTERNAL_MOTION_CONTROL_NAIVECAM_TOLERANCE",
                             "GET_EXTERNAL_MOTION_CONTROL_TOLERANCE",
                             "GET_EXTERNAL_OFFSETS",
                             "GET_EXTERNAL_OFFSET_APPLIED",
                             "GET_EXTERNAL_PARAMETER_FILE_NAME",
                             "GET_EXTERNAL_QUEUE_EMPTY",
                             "GET_EXTERNAL_TRAVERSE_RATE",
                             "INIT_CANON",
                             "IO_PLUGIN_CALL",
                             "LOCK_ROTARY",
                             "NURBS_FEED",
                             "PLUGIN_CALL",
                             "RELOAD_TOOLDATA",
                             "SET_BLOCK_DELETE",
                             "SET_CUTTER_RADIUS_COMPENSATION",
                             "SET_OPTIONAL_PROGRAM_STOP",
                             "SET_PARAMETER_FILE_NAME",
                             "SET_TRAVERSE_RATE",
                             "SPINDLE_RETRACT",
                             "SPINDLE_RETRACT_TRAVERSE",
                             "START_CUTTER_RADIUS_COMPENSATION",
                             "STOP_CUTTER_RADIUS_COMPENSATION",
                             "UNLOCK_ROTARY",
                             "UPDATE_TAG",
                             "USE_NO_SPINDLE_FORCE"}) {
        m.def(name, [name](const py::args &, const py::kwargs &) {
            PyErr_SetString(PyExc_NotImplementedError,
                            (std::string("emccanon.") + name + " is not supported by Millwright").c_str());
            throw py::error_already_set();
        });
    }
}

/// Queries of the machine return its state at the last synchronisation.
void define_questions(py::module_ &m) {
    m.def("GET_BLOCK_DELETE", [] { return current_view().world().isBlockDeleteOn(); });
    m.def("GET_OPTIONAL_PROGRAM_STOP", [] { return current_view().world().isOptionalStopOn(); });
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const std::string letter(1, geometry::AXIS_LETTERS[axis]);
        m.def(("GET_EXTERNAL_POSITION_" + letter).c_str(), [axis] { return machine().position[axis]; });
        m.def(("GET_EXTERNAL_PROBE_POSITION_" + letter).c_str(),
              [axis] { return machine().probed_position[axis]; });
        m.def(("GET_EXTERNAL_TOOL_LENGTH_" + letter + "OFFSET").c_str(),
              [axis] { return current_view().tool_offset()[axis]; });
    }
    m.def("GET_EXTERNAL_PROBE_TRIPPED_VALUE", [] { return machine().isProbeTripped ? 1 : 0; });
    m.def("GET_EXTERNAL_PROBE_VALUE", [] { return machine().isProbeTripped ? 1.0 : 0.0; });
    // Result of the last awaited input; the default when no input was awaited or it timed out.
    m.def("GET_EXTERNAL_DIGITAL_INPUT", [](int, int missing) {
        const MachineSnapshot now = machine();
        return now.isInputTimedOut ? missing : (now.input_value != 0.0 ? 1 : 0);
    });
    m.def("GET_EXTERNAL_ANALOG_INPUT", [](int, double missing) {
        const MachineSnapshot now = machine();
        return now.isInputTimedOut ? missing : now.input_value;
    });
    m.def("GET_EXTERNAL_FEED_RATE", [] { return machine().feed_rate; });
    m.def("GET_EXTERNAL_SPEED", [](std::size_t spindle) { return machine().spindle_speed.at(spindle); });
    m.def("GET_EXTERNAL_SPINDLE", [](std::size_t spindle) {
        const int direction = machine().spindle_direction.at(spindle);
        return direction == 0 ? 1 : (direction > 0 ? 2 : 3);
    });
    m.def("GET_EXTERNAL_TOOL_SLOT", [] { return machine().current_pocket; });
    m.def("GET_EXTERNAL_SELECTED_TOOL_SLOT", [] { return machine().selected_pocket; });
    m.def("GET_EXTERNAL_TOOL_TABLE", [](int index) {
        return py::module_::import("interpreter").attr("this").attr("tool_table").attr("__getitem__")(index);
    });
    m.def("GET_EXTERNAL_AXIS_MASK", [] { return current_view().world().axis_mask(); });
    m.def("GET_EXTERNAL_LENGTH_UNITS",
          [] { return current_view().world().machine_units() == gcode::LengthUnits::MM ? 1.0 : 1.0 / 25.4; });
    m.def("GET_EXTERNAL_ANGLE_UNITS", [] { return 1.0; });
    m.def("GET_EXTERNAL_PLANE", [] { return std::get<std::int64_t>(*current_view().attribute("plane")); });
    m.def("GET_EXTERNAL_MIST", [] { return machine().isMistOn ? 1 : 0; });
    m.def("GET_EXTERNAL_FLOOD", [] { return machine().isFloodOn ? 1 : 0; });
    m.def("GET_EXTERNAL_FEED_OVERRIDE_ENABLE", [] { return machine().isFeedOverrideEnabled ? 1 : 0; });
    m.def("GET_EXTERNAL_SPINDLE_OVERRIDE_ENABLE",
          [](int) { return machine().speed_override_enabled ? 1 : 0; });
    m.def("GET_EXTERNAL_FEED_HOLD_ENABLE", [] { return machine().isFeedHoldEnabled ? 1 : 0; });
    m.def("GET_EXTERNAL_ADAPTIVE_FEED_ENABLE", [] { return machine().isAdaptiveFeedEnabled ? 1 : 0; });
    m.def("GET_EXTERNAL_TC_FAULT", [] { return 0; });
}

}  // namespace

void define_canon(py::module_ &module) {
    define_moves(module);
    define_modes(module);
    define_spindles(module);
    define_tools(module);
    define_switches(module);
    define_rest(module);
    define_questions(module);
}

}  // namespace mw::python_host

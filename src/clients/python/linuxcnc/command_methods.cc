// SPDX-License-Identifier: GPL-2.0-or-later
// The methods of linuxcnc.command; each converts a call of a script to a message.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "base/text.hh"
#include "clients/python/linuxcnc/command.hh"
#include "clients/python/linuxcnc/module.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

/// Maximum length of an MDI line and a path in LinuxCNC's clients. [bytes]
constexpr std::size_t MAX_LINE = 254;

enum AutoWord { RUN, PAUSE, RESUME, STEP, REVERSE, FORWARD };
enum JogWord { STOP, CONTINUOUS, INCREMENT };
enum SpindleWord { TURN_BACK = -1, OFF = 0, TURN = 1, INCREASE = 10, DECREASE = 11, CONSTANT = 12 };

template <class Enum>
Enum checked(int value, int low, int high, const char *what) {
    if (value < low || value > high) {
        throw py::value_error(std::string("there is no such ") + what + ": " + std::to_string(value));
    }
    return static_cast<Enum>(value);
}

void check_length(const std::string &text) {
    if (text.size() > MAX_LINE) {
        throw py::value_error("a text of at most " + std::to_string(MAX_LINE) + " bytes is taken");
    }
}

void open_program(Command &self, const std::string &path) {
    check_length(path);
    self.send(messages::CloseProgram{});
    self.send(messages::OpenProgram{path});
}

void mdi(Command &self, const std::string &line) {
    check_length(line);
    self.send_and_look(messages::Mdi{line});
}

void run_auto(Command &self, int word, std::optional<int> line) {
    switch (word) {
    case RUN:
        if (!line.has_value()) {
            throw_error("auto(AUTO_RUN, line) needs the line to begin at, 0 for the start");
        }
        self.send(messages::RunProgram{*line});
        return;
    case PAUSE: self.send(messages::PauseProgram{}); return;
    case RESUME: self.send(messages::ResumeProgram{}); return;
    case STEP: self.send(messages::StepProgram{}); return;
    case REVERSE: self.send(messages::ReverseProgram{}); return;
    case FORWARD: self.send(messages::ForwardProgram{}); return;
    default: throw_error("auto() has no such word: " + std::to_string(word));
    }
}

void jog(Command &self, const py::args &words) {
    const auto need = [&words](std::size_t count) {
        if (words.size() != count) {
            throw py::type_error(
                "jog(JOG_STOP, joint?, number), jog(JOG_CONTINUOUS, joint?, number, speed) or "
                "jog(JOG_INCREMENT, joint?, number, speed, distance)");
        }
    };
    if (words.size() < 3) {
        need(3);
    }
    const auto kind = checked<JogWord>(words[0].cast<int>(), STOP, INCREMENT, "jog");
    const bool is_joint = words[1].cast<int>() != 0;
    const int index = words[2].cast<int>();
    switch (kind) {
    case STOP:
        need(3);
        self.send(messages::JogStop{is_joint, index});
        return;
    case CONTINUOUS:
        need(4);
        self.send(messages::JogContinuous{is_joint, index, words[3].cast<double>()});
        return;
    case INCREMENT: {
        need(5);
        const double speed = words[3].cast<double>(), distance = words[4].cast<double>();
        self.send(messages::JogIncrement{is_joint, index, speed, speed < 0 ? -distance : distance});
        return;
    }
    }
}

void turn_spindle(Command &self, const py::args &words) {
    if (words.empty()) {
        throw py::type_error("spindle(word, ...) needs SPINDLE_FORWARD, SPINDLE_OFF, ...");
    }
    const int word = words[0].cast<int>();
    const bool turned = word == TURN || word == TURN_BACK;
    const double rpm = turned && words.size() > 1 ? words[1].cast<double>() : 0;
    const std::size_t place = turned ? 2 : 1;
    const int spindle = words.size() > place ? words[place].cast<int>() : 0;
    switch (word) {
    case TURN:
    case TURN_BACK: self.send(messages::SpindleOn{spindle, word * rpm}); return;
    case OFF: self.send(messages::SpindleOff{spindle}); return;
    case INCREASE: self.send(messages::SpindleIncrease{spindle}); return;
    case DECREASE: self.send(messages::SpindleDecrease{spindle}); return;
    case CONSTANT: self.send(messages::SpindleConstant{spindle}); return;
    default: throw_error("spindle() has no such word: " + std::to_string(word));
    }
}

void set_tool(Command &self, int toolno, double z, double x, double diameter, double front, double back,
              int orientation) {
    messages::SetToolEntry entry;
    entry.toolno = toolno;
    entry.offset[geometry::AXIS_X] = x;
    entry.offset[geometry::AXIS_Z] = z;
    entry.diameter = diameter;
    entry.frontangle_deg = front;
    entry.backangle_deg = back;
    entry.orientation = orientation;
    self.send(entry);
}

using Class = py::class_<Command>;

void define_modes(Class &command) {
    command
        .def(
            "mode",
            [](Command &self, int mode) {
                self.send(messages::SetMode{checked<messages::Mode>(mode, 1, 3, "mode")});
            },
            py::arg("mode"), "MODE_MANUAL, MODE_AUTO or MODE_MDI.")
        .def(
            "state",
            [](Command &self, int state) {
                self.send(messages::SetState{checked<messages::State>(state, 1, 4, "state")});
            },
            py::arg("state"), "STATE_ESTOP, STATE_ESTOP_RESET, STATE_ON or STATE_OFF.")
        .def("mdi", &mdi, py::arg("line"), "Executes a line of G-code.")
        .def("program_open", &open_program, py::arg("path"), "Opens a program.")
        .def("auto", &run_auto, py::arg("word"), py::arg("line") = py::none(),
             "AUTO_RUN with the line to begin at, AUTO_PAUSE, AUTO_RESUME, AUTO_STEP, AUTO_REVERSE, "
             "AUTO_FORWARD.")
        .def(
            "abort", [](Command &self) { self.send(messages::AbortAll{}); }, "Stops everything.")
        .def(
            "task_plan_synch", [](Command &self) { self.send(messages::SynchInterpreter{}); },
            "The interpreter takes the machine's position.")
        .def(
            "reset_interpreter", [](Command &self) { self.send(messages::ResetInterpreter{}); },
            "Resets the interpreter and closes the program.")
        .def(
            "set_optional_stop", [](Command &self, int on) { self.send(messages::SetOptionalStop{on != 0}); },
            py::arg("on"))
        .def(
            "set_block_delete", [](Command &self, int on) { self.send(messages::SetBlockDelete{on != 0}); },
            py::arg("on"))
        .def(
            "debug",
            [](Command &self, int bits) { self.send(messages::SetDebug{static_cast<std::uint32_t>(bits)}); },
            py::arg("bits"))
        .def(
            "error_msg",
            [](Command &self, const std::string &text) { self.send(messages::OperatorError{text}); },
            py::arg("text"))
        .def(
            "text_msg",
            [](Command &self, const std::string &text) { self.send(messages::OperatorText{text}); },
            py::arg("text"))
        .def(
            "display_msg",
            [](Command &self, const std::string &text) { self.send(messages::OperatorDisplay{text}); },
            py::arg("text"));
}

void define_joints(Class &command) {
    command
        .def(
            "home", [](Command &self, int joint) { self.send(messages::HomeJoint{joint}); }, py::arg("joint"),
            "A joint, or -1: all.")
        .def(
            "unhome", [](Command &self, int joint) { self.send(messages::UnhomeJoint{joint}); },
            py::arg("joint"), "A joint, -1: all, -2: those of VOLATILE_HOME.")
        .def("jog", &jog, "JOG_STOP, JOG_CONTINUOUS or JOG_INCREMENT of a joint (1) or an axis (0).")
        .def(
            "teleop_enable", [](Command &self, int on) { self.send(messages::SetTeleop{on != 0}); },
            py::arg("on"))
        .def(
            "traj_mode",
            [](Command &self, int mode) {
                self.send(
                    messages::SetMotionMode{checked<messages::MotionMode>(mode, 1, 3, "mode of motion")});
            },
            py::arg("mode"))
        .def("override_limits", [](Command &self) { self.send(messages::OverrideLimits{}); })
        .def(
            "set_min_limit",
            [](Command &self, int joint, double limit) {
                self.send(messages::SetJointMinLimit{joint, limit});
            },
            py::arg("joint"), py::arg("limit"))
        .def(
            "set_max_limit",
            [](Command &self, int joint, double limit) {
                self.send(messages::SetJointMaxLimit{joint, limit});
            },
            py::arg("joint"), py::arg("limit"));
}

/// A factor below 0 is treated as 0, as in LinuxCNC, and reported.
double checked_factor(Command &self, const char *method, double factor) {
    if (factor >= 0) {
        return factor;
    }
    self.send(messages::OperatorText{std::string(method) + '(' + to_text(factor) +
                                     ") becomes 0: an override cannot be below 0"});
    return 0;
}

void define_overrides(Class &command) {
    command
        .def(
            "feedrate",
            [](Command &self, double factor) {
                self.send(messages::SetFeedOverride{checked_factor(self, "feedrate", factor)});
            },
            py::arg("factor"), "1 is 100 %.")
        .def(
            "rapidrate",
            [](Command &self, double factor) {
                self.send(messages::SetRapidOverride{checked_factor(self, "rapidrate", factor)});
            },
            py::arg("factor"), "1 is 100 %.")
        .def(
            "spindleoverride",
            [](Command &self, double factor, int spindle) {
                self.send(
                    messages::SetSpindleOverride{checked_factor(self, "spindleoverride", factor), spindle});
            },
            py::arg("factor"), py::arg("spindle") = 0)
        .def(
            "maxvel", [](Command &self, double speed) { self.send(messages::SetMaxVelocity{speed}); },
            py::arg("speed"), "Machine units in a second.")
        .def(
            "set_feed_override",
            [](Command &self, int on) { self.send(messages::EnableFeedOverride{on != 0}); }, py::arg("on"),
            "M50.")
        .def(
            "set_spindle_override",
            [](Command &self, int on, int spindle) {
                self.send(messages::EnableSpindleOverride{on != 0, spindle});
            },
            py::arg("on"), py::arg("spindle") = 0, "M51.")
        .def(
            "set_adaptive_feed",
            [](Command &self, int on) { self.send(messages::EnableAdaptiveFeed{on != 0}); }, py::arg("on"),
            "M52.")
        .def(
            "set_feed_hold", [](Command &self, int on) { self.send(messages::EnableFeedHold{on != 0}); },
            py::arg("on"), "M53.");
}

void define_devices(Class &command) {
    const auto toggle = [](auto on, auto off) {
        return [on, off](Command &self, int word) { word != 0 ? self.send(on) : self.send(off); };
    };
    command
        .def("spindle", &turn_spindle, "SPINDLE_FORWARD or _REVERSE with speed, _OFF, _INCREASE, _DECREASE.")
        .def(
            "brake",
            [](Command &self, int word, int spindle) {
                word != 0 ? self.send(messages::EngageBrake{spindle})
                          : self.send(messages::ReleaseBrake{spindle});
            },
            py::arg("word"), py::arg("spindle") = 0, "BRAKE_ENGAGE or BRAKE_RELEASE.")
        .def("flood", toggle(messages::FloodOn{}, messages::FloodOff{}), py::arg("on"))
        .def("mist", toggle(messages::MistOn{}, messages::MistOff{}), py::arg("on"))
        .def("load_tool_table", [](Command &self) { self.send(messages::LoadToolTable{}); })
        .def("tool_offset", &set_tool, py::arg("tool"), py::arg("z"), py::arg("x"), py::arg("diameter"),
             py::arg("frontangle"), py::arg("backangle"), py::arg("orientation"))
        .def(
            "set_digital_output",
            [](Command &self, int index, int value) {
                messages::SetDigitalOutput output;
                output.index = index;
                output.isOn = value != 0;
                self.send(output);
            },
            py::arg("index"), py::arg("value"))
        .def(
            "set_analog_output",
            [](Command &self, int index, double value) {
                messages::SetAnalogOutput output;
                output.index = index;
                output.value = value;
                self.send(output);
            },
            py::arg("index"), py::arg("value"));
}

}  // namespace

void define_command(py::module_ &module) {
    Class command(module, "command",
                  "command(): a client of the machine. Each method returns when task has taken its command; "
                  "wait_complete() returns how it ends.");
    command.def(py::init<>())
        .def_property_readonly("serial", &Command::serial, "Number of the last command sent.")
        .def("wait_complete", &Command::wait_complete, py::arg("timeout") = py::none(),
             "RCS_DONE, RCS_ERROR, or -1 when the time (5 s) is over before the last command has ended.");
    define_modes(command);
    define_joints(command);
    define_overrides(command);
    define_devices(command);
}

}  // namespace mw::python

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/gcode/linecode.hh"

#include <pybind11/stl.h>

namespace py = pybind11;

namespace mw::python {
namespace {

/// Indices in ActiveCodes, with the names that preview programs use.
struct CodeName {
    const char *name;
    bool is_m;
    std::size_t place;
};
constexpr CodeName CODE_NAMES[] = {
    {"sequence_number", false, 0},
    {"motion_mode", false, 1},
    {"block", false, 2},
    {"plane", false, 3},
    {"cutter_side", false, 4},
    {"units", false, 5},
    {"distance_mode", false, 6},
    {"feed_mode", false, 7},
    {"origin", false, 8},
    {"tool_length_offset", false, 9},
    {"retract_mode", false, 10},
    {"path_mode", false, 11},
    {"stopping", true, 1},
    {"spindle", true, 2},
    {"toolchange", true, 3},
    {"mist", true, 4},
    {"flood", true, 5},
    {"overrides", true, 6},
};

}  // namespace

void define_linecode(py::module_ &module) {
    py::class_<LineCode> line(module, "linecode", "The active modal codes before a line of a program.");
    for (const CodeName &code : CODE_NAMES) {
        line.def_property_readonly(code.name, [code](const LineCode &self) {
            return code.is_m ? self.codes.m[code.place] : self.codes.g[code.place];
        });
    }
    line.def_property_readonly("feed_rate", [](const LineCode &self) { return self.codes.settings[1]; })
        .def_property_readonly("speed", [](const LineCode &self) { return self.codes.settings[2]; })
        .def_property_readonly("gcodes",
                               [](const LineCode &self) { return py::tuple(py::cast(self.codes.g)); })
        .def_property_readonly("mcodes",
                               [](const LineCode &self) { return py::tuple(py::cast(self.codes.m)); });
}

}  // namespace mw::python

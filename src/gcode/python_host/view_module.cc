// SPDX-License-Identifier: GPL-2.0-or-later
// _millwright_script: the interpreter's view as plain functions, wrapped by modules/interpreter.py.
#include <pybind11/stl.h>

#include "gcode/python_host/modules.hh"

namespace mw::python_host {
namespace {

using gcode::InterpreterView;

constexpr int CODE_ERROR = 5;

void require(const Result<> &result) {
    if (!result) {
        throw std::runtime_error(result.error().message);
    }
}

py::object to_python(const gcode::ScriptValue &value) {
    return std::visit([](const auto &v) -> py::object { return py::cast(v); }, value);
}

gcode::ScriptValue from_python(const py::object &value) {
    if (py::isinstance<py::bool_>(value)) {
        return value.cast<bool>();
    }
    if (py::isinstance<py::int_>(value)) {
        return value.cast<std::int64_t>();
    }
    if (py::isinstance<py::str>(value)) {
        return value.cast<std::string>();
    }
    return value.cast<double>();
}

py::tuple codes_of(const gcode::ActiveCodes &codes) {
    return py::make_tuple(codes.g, codes.m, codes.settings);
}

std::array<double, geometry::AXIS_COUNT> axes_of(const geometry::Pose &pose) {
    std::array<double, geometry::AXIS_COUNT> out{};
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        out[static_cast<std::size_t>(axis)] = pose[axis];
    }
    return out;
}

geometry::Pose pose_of(const std::array<double, geometry::AXIS_COUNT> &axes) {
    geometry::Pose out;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        out[axis] = axes[static_cast<std::size_t>(axis)];
    }
    return out;
}

/// (code, message, line, text)
py::tuple execute(const ViewHandle &self, const std::string &text, int line) {
    InterpreterView &view = self.get();
    const auto done = view.execute(text, line);
    if (!done) {
        return py::make_tuple(CODE_ERROR, done.error().message, done.error().line, done.error().text);
    }
    return py::make_tuple(*done ? CODE_OK : CODE_EXECUTE_FINISH, "", 0, "");
}

py::object remap_of(const std::optional<gcode::ScriptRemap> &remap) {
    if (!remap) {
        return py::none();
    }
    return py::make_tuple(remap->name, remap->argspec, remap->prolog, remap->epilog, remap->ngc,
                          remap->function, remap->modal_group, remap->motion_code);
}

py::dict block_of(const ViewHandle &self, int level) {
    const gcode::ScriptBlock block = self.get().block(level);
    py::dict words;
    for (std::size_t i = 0; i < block.value.size(); ++i) {
        if ((block.present & (1u << i)) != 0) {
            const char name[] = {static_cast<char>('a' + i), '\0'};
            words[name] = block.value[i];
        }
    }
    py::dict out;
    out["words"] = words;
    out["polar"] = py::make_tuple(block.radius, block.angle);
    out["remap"] = remap_of(block.remap);
    out["g_modes"] = block.g_modes;
    out["m_modes"] = block.m_modes;
    out["params"] = block.params;
    out["o_name"] = block.o_name;
    out["motion_to_be"] = block.motion;
    out["m_count"] = block.m_count;
    out["line_number"] = block.line;
    out["saved_line_number"] = block.line;
    out["n_number"] = block.number;
    out["builtin_used"] = block.builtins > 0;
    out["comment"] = block.comment;
    return out;
}

py::dict context_of(const gcode::ScriptContext &context) {
    py::dict out;
    out["name"] = context.name;
    out["file"] = context.file;
    out["line"] = context.line;
    out["kind"] = context.kind;
    out["status"] = context.status;
    out["saved"] = codes_of(context.saved);
    out["arguments"] = context.arguments;
    out["named"] = context.named;
    return out;
}

py::list contexts_of(const ViewHandle &self) {
    py::list out;
    for (const gcode::ScriptContext &context : self.get().contexts()) {
        out.append(context_of(context));
    }
    return out;
}

py::tuple tool_of(const ViewHandle &self, int index) {
    const gcode::ToolEntry tool = self.get().tool(index);
    return py::make_tuple(tool.toolno, tool.pocketno, axes_of(tool.offset), tool.diameter, tool.frontangle,
                          tool.backangle, tool.orientation, tool.comment);
}

void define_state(py::class_<ViewHandle, std::shared_ptr<ViewHandle>> &type) {
    type.def("attribute",
             [](const ViewHandle &self, const std::string &name) {
                 const auto value = self.get().attribute(name);
                 if (!value) {
                     throw py::attribute_error("'Interp' object has no attribute '" + name + "'");
                 }
                 return to_python(*value);
             })
        .def("set_attribute",
             [](const ViewHandle &self, const std::string &name, const py::object &value) {
                 const Result<> done = self.get().set_attribute(name, from_python(value));
                 if (!done) {
                     throw py::attribute_error(done.error().message);
                 }
             })
        .def("attribute_names", [](const ViewHandle &self) { return self.get().attribute_names(); })
        .def("active_codes", [](const ViewHandle &self) { return codes_of(self.get().active_codes()); })
        .def("spindle_speed",
             [](const ViewHandle &self, int spindle) { return self.get().spindle_speed(spindle); })
        .def("set_spindle_speed", [](const ViewHandle &self, int spindle,
                                     double speed) { self.get().set_spindle_speed(spindle, speed); })
        .def("tool_offset", [](const ViewHandle &self) { return axes_of(self.get().tool_offset()); })
        .def("set_tool_offset",
             [](const ViewHandle &self, const std::array<double, geometry::AXIS_COUNT> &offset) {
                 self.get().set_tool_offset(pose_of(offset));
             })
        .def("count_tools", [](const ViewHandle &self) { return self.get().count_tools(); })
        .def("tool", &tool_of)
        .def("find_tool", [](const ViewHandle &self, int number) { return self.get().find_tool(number); })
        .def("load_tool", [](const ViewHandle &self) { self.get().load_tool(); })
        .def("synch", [](const ViewHandle &self) { self.get().synch(); });
}

void define_parameters(py::class_<ViewHandle, std::shared_ptr<ViewHandle>> &type) {
    type.def("parameter", [](const ViewHandle &self, int number) { return self.get().parameter(number); })
        .def("set_parameter", [](const ViewHandle &self, int number,
                                 double value) { require(self.get().set_parameter(number, value)); })
        .def("named", [](const ViewHandle &self, const std::string &name) { return self.get().named(name); })
        .def("set_named", [](const ViewHandle &self, const std::string &name,
                             double value) { require(self.get().set_named(name, value)); })
        .def("locals", [](const ViewHandle &self) { return self.get().local_names(); })
        .def("globals", [](const ViewHandle &self) { return self.get().global_names(); })
        .def("predefined", [](const ViewHandle &self) { return self.get().predefined_names(); })
        .def("scripted", [](const ViewHandle &self) { return self.get().script_names(); })
        .def("no_context", [](const ViewHandle &) { return context_of({}); });
}

}  // namespace

void add_native_modules() {
    const py::dict loaded = py::module_::import("sys").attr("modules");
    if (loaded.contains("_millwright_script")) {
        return;
    }
    // The definitions of modules live as long as the process.
    static py::module_::module_def script_def, canon_def;
    py::module_ script = py::module_::create_extension_module("_millwright_script", nullptr, &script_def);
    py::class_<ViewHandle, std::shared_ptr<ViewHandle>> type(script, "View");
    type.def("execute", &execute).def("block", &block_of).def("contexts", &contexts_of);
    define_state(type);
    define_parameters(type);
    loaded["_millwright_script"] = script;
    py::module_ canon = py::module_::create_extension_module("_millwright_canon", nullptr, &canon_def);
    define_canon(canon);
    loaded["_millwright_canon"] = canon;
}

py::object make_interpreter(const std::shared_ptr<ViewHandle> &handle) {
    return py::module_::import("interpreter").attr("Interp")(py::cast(handle));
}

}  // namespace mw::python_host

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/stat_parts.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

/// The rows of the table that have a name in Python.
template <class Table, class From>
py::dict dict_of(const Table &table, const From &from) {
    py::dict out;
    legacy::for_each_row(table, [&](const auto &row) {
        if (const char *const name = python_name(row.names); legacy::isNamed(name)) {
            out[name] = python_value(row, from);
        }
    });
    return out;
}

py::dict axis_dict(const messages::AxisStatus &axis) {
    py::dict out;
    out["velocity"] = axis.velocity;
    out["min_position_limit"] = axis.min_limit;
    out["max_position_limit"] = axis.max_limit;
    return out;
}

py::tuple tool_tuple(const messages::ToolRecord &tool, const py::object &kind) {
    const geometry::Pose &o = tool.offset;
    return kind(tool.toolno, o[0], o[1], o[2], o[3], o[4], o[5], o[6], o[7], o[8], tool.diameter,
                tool.frontangle_deg, tool.backangle_deg, tool.orientation);
}

}  // namespace

py::tuple joint_dicts(const messages::MachineStatus &status) {
    py::tuple out(status.joints.size());
    for (std::size_t i = 0; i < status.joints.size(); ++i) {
        out[i] = dict_of(legacy::JOINT_STATUS, legacy::Joint{status.joints[i], status.settings.joints[i]});
    }
    return out;
}

py::tuple axis_dicts(const messages::MachineStatus &status) {
    py::tuple out(status.axes.size());
    for (std::size_t i = 0; i < status.axes.size(); ++i) {
        out[i] = axis_dict(status.axes[i]);
    }
    return out;
}

py::tuple spindle_dicts(const messages::MachineStatus &status) {
    py::tuple out(status.spindles.size());
    for (std::size_t i = 0; i < status.spindles.size(); ++i) {
        out[i] = dict_of(legacy::SPINDLE_STATUS, status.spindles[i]);
    }
    return out;
}

py::tuple tool_tuples(const messages::ToolTable &table) {
    const py::object kind = py::module_::import("linuxcnc").attr("tool");
    py::tuple out(table.tools.size());
    for (std::size_t i = 0; i < table.tools.size(); ++i) {
        out[i] = tool_tuple(table.tools[i], kind);
    }
    return out;
}

py::dict tool_dict(const messages::ToolTable &table, int toolno) {
    for (std::size_t i = 1; i < table.tools.size() && toolno > 0; ++i) {
        const messages::ToolRecord &tool = table.tools[i];
        if (tool.toolno != toolno) {
            continue;
        }
        py::dict out;
        out["toolno"] = tool.toolno;
        out["pocketno"] = tool.pocketno;
        out["diameter"] = tool.diameter;
        out["frontangle"] = tool.frontangle_deg;
        out["backangle"] = tool.backangle_deg;
        out["orientation"] = tool.orientation;
        const char *const names[] = {"xoffset", "yoffset", "zoffset", "aoffset", "boffset",
                                     "coffset", "uoffset", "voffset", "woffset"};
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            out[names[axis]] = tool.offset[axis];
        }
        out["comment"] = tool.comment;
        return out;
    }
    throw py::value_error("there is no tool " + std::to_string(toolno) + " in the tool table");
}

}  // namespace mw::python

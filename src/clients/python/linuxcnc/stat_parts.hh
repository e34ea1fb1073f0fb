// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of the status as objects for scripts: poses, joints, axes, spindles, tools.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <type_traits>

#include "messages/legacy/status_table.hh"

namespace mw::python {

/// A value of the status for scripts: enumerations as numbers, poses and arrays as tuples.
template <class Value>
pybind11::object as_python(const Value &value) {
    if constexpr (std::is_enum_v<Value>) {
        return pybind11::cast(static_cast<int>(value));
    } else {
        return pybind11::cast(value);
    }
}
template <class Number, std::size_t N>
pybind11::object as_python(const std::array<Number, N> &values) {
    pybind11::tuple out(N);
    for (std::size_t i = 0; i < N; ++i) {
        out[i] = pybind11::cast(values[i]);
    }
    return out;
}
inline pybind11::object as_python(const geometry::Pose &pose) {
    return pybind11::make_tuple(pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], pose[7],
                                pose[8]);
}

inline const char *python_name(const legacy::Names &names) {
    return legacy::isNamed(names.python_int) ? names.python_int : names.python;
}
template <class Row, class From>
pybind11::object python_value(const Row &row, const From &from) {
    const auto value = row.get(from);
    if constexpr (std::is_same_v<decltype(value), const bool>) {
        return legacy::isNamed(row.names.python_int) ? pybind11::cast(static_cast<int>(value))
                                                     : pybind11::cast(value);
    } else {
        return as_python(value);
    }
}

/// One item for each possible joint, axis or spindle; those that the machine does not have contain values at
/// standstill.
pybind11::tuple joint_dicts(const messages::MachineStatus &status);
pybind11::tuple axis_dicts(const messages::MachineStatus &status);
pybind11::tuple spindle_dicts(const messages::MachineStatus &status);
/// Named tuples linuxcnc.tool, one for each entry.
pybind11::tuple tool_tuples(const messages::ToolTable &table);
/// ValueError if there is no tool of that number.
pybind11::dict tool_dict(const messages::ToolTable &table, int toolno);

}  // namespace mw::python

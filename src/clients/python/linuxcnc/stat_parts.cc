// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/stat_parts.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

/// As a joint that the machine has not.
constexpr double NO_LIMIT = 1.0;

py::dict joint_dict(const messages::JointStatus &joint, const messages::JointSettings &set) {
    py::dict out;
    out["jointType"] = static_cast<int>(joint.isPresent ? set.kind : messages::JointKind::LINEAR);
    out["units"] = joint.isPresent ? set.units : 1.0;
    out["backlash"] = set.backlash;
    out["min_position_limit"] = joint.isPresent ? joint.min_limit : -NO_LIMIT;
    out["max_position_limit"] = joint.isPresent ? joint.max_limit : NO_LIMIT;
    out["max_ferror"] = set.max_ferror;
    out["min_ferror"] = set.min_ferror;
    out["ferror_current"] = joint.ferror;
    out["ferror_highmark"] = joint.ferror_highmark;
    out["output"] = joint.pos_cmd;
    out["input"] = joint.pos_fb;
    out["velocity"] = joint.vel_cmd;
    out["inpos"] = static_cast<int>(!joint.isPresent || joint.isInPosition);
    out["homing"] = static_cast<int>(joint.isHoming);
    out["homed"] = static_cast<int>(joint.isHomed);
    out["fault"] = static_cast<int>(joint.isFaulted);
    out["enabled"] = static_cast<int>(joint.isEnabled);
    out["min_soft_limit"] = static_cast<int>(joint.isOnNegSoftLimit);
    out["max_soft_limit"] = static_cast<int>(joint.isOnPosSoftLimit);
    out["min_hard_limit"] = static_cast<int>(joint.isOnNegHardLimit);
    out["max_hard_limit"] = static_cast<int>(joint.isOnPosHardLimit);
    out["override_limits"] = static_cast<int>(joint.isOverridingLimits);
    return out;
}

py::dict axis_dict(const messages::AxisStatus &axis) {
    py::dict out;
    out["velocity"] = axis.velocity;
    out["min_position_limit"] = axis.min_limit;
    out["max_position_limit"] = axis.max_limit;
    return out;
}

py::dict spindle_dict(const messages::SpindleStatus &spindle) {
    py::dict out;
    out["brake"] = static_cast<int>(spindle.isBrakeOn);
    out["direction"] = spindle.direction;
    out["enabled"] = static_cast<int>(spindle.isOn);
    out["override_enabled"] = spindle.isOverrideEnabled;
    out["speed"] = spindle.speed_cmd_rpm;
    out["override"] = spindle.override_factor;
    out["homed"] = false;
    out["orient_state"] = spindle.orient_state;
    out["orient_fault"] = spindle.orient_fault;
    return out;
}

py::tuple tool_tuple(const messages::ToolRecord &tool, const py::object &kind) {
    const geometry::Pose &o = tool.offset;
    return kind(tool.toolno, o[0], o[1], o[2], o[3], o[4], o[5], o[6], o[7], o[8], tool.diameter,
                tool.frontangle_deg, tool.backangle_deg, tool.orientation);
}

}  // namespace

py::tuple pose(const geometry::Pose &pose) {
    return py::make_tuple(pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]);
}

py::tuple joint_dicts(const messages::MachineStatus &status) {
    py::tuple out(status.joints.size());
    for (std::size_t i = 0; i < status.joints.size(); ++i) {
        out[i] = joint_dict(status.joints[i], status.settings.joints[i]);
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
        out[i] = spindle_dict(status.spindles[i]);
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/ini_pins.hh"

namespace mw::machine {

Result<> IniPins::create(hal::Hal &hal, const std::vector<motion::SetParameter> &parameters) {
    const auto id = hal.new_component("inihal");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    Result<> status;
    planner_type_.make(hal, comp_id_, "ini.traj-planner-type", hal::Dir::IN, status);
    corner_scale_.make(hal, comp_id_, "ini.traj-scurve-peak-scale", hal::Dir::IN, status);
    if (!status.has_value()) {
        destroy();
        return status;
    }
    for (const motion::SetParameter &p : parameters) {
        if (p.parameter == static_cast<std::uint16_t>(motion::Parameter::TRAJ_PLANNER_TYPE)) {
            last_type_ = static_cast<std::int32_t>(p.value);
        } else if (p.parameter == static_cast<std::uint16_t>(motion::Parameter::TRAJ_CORNER_SCALE)) {
            last_scale_ = p.value;
        }
    }
    planner_type_ = last_type_;
    corner_scale_ = last_scale_;
    status = hal.set_ready(comp_id_);
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

void IniPins::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->delete_component(comp_id_));
        hal_ = nullptr;
    }
}

void IniPins::step(task::Task &task) {
    const std::int32_t type = planner_type_;
    const double scale = corner_scale_;
    if (type != last_type_) {
        last_type_ = type;
        task.planner_mode().wish(type);
    }
    if (scale != last_scale_) {
        last_scale_ = scale;
        task.planner_mode().set_corner_scale(scale);
    }
}

}  // namespace mw::machine

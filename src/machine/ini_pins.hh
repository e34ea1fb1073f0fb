// SPDX-License-Identifier: GPL-2.0-or-later
// Settings of the INI file that may be changed at run time by HAL pins: component "inihal".
#pragma once

#include "base/result.hh"
#include "hal/core/user_pin.hh"
#include "task/task.hh"

namespace mw::machine {

/// ini.traj-planner-type (s32: 0, 1) and ini.traj-scurve-peak-scale (float: 0.1 to 1). Not realtime; one
/// thread.
class IniPins {
  public:
    /// Makes the component and its pins, which hold what the INI file says.
    Result<> create(hal::Hal &hal, const std::vector<motion::SetParameter> &parameters);
    void destroy();
    /// Tells task what has changed since the last call.
    void step(task::Task &task);

  private:
    hal::Hal *hal_ = nullptr;
    int comp_id_ = 0;
    hal::UserPin<std::int32_t> planner_type_;
    hal::UserPin<double> corner_scale_;
    std::int32_t last_type_ = 0;
    double last_scale_ = 1;
};

}  // namespace mw::machine

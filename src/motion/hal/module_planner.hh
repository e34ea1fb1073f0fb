// SPDX-License-Identifier: GPL-2.0-or-later
// Speeds from a user's planner module, requested with the C functions of planner.h.
#pragma once

#include "hal/include/planner.h"
#include "trajectory/path/speed_choice.hh"

namespace mw::motion {

class ModulePlanner final : public trajectory::SpeedChooser {
  public:
    enum class Found : std::uint8_t { NONE, SOME, ALL };
    /// Looks for the functions in the loaded modules; `missing` is the first missing function. [while
    /// loading]
    Found find(const char *&missing) noexcept;
    /// Starts the module and keeps it loaded as long as component `comp_id`. Returns 0 or its error code.
    /// [while loading]
    int start(int comp_id, double period_s) noexcept;

    int choose(const trajectory::SpeedStretch &stretch,
               std::span<trajectory::ChosenPhase> out) noexcept override;

  private:
    decltype(&::mw_tp_init) init_ = nullptr;
    decltype(&::mw_tp_plan) plan_ = nullptr;
};

}  // namespace mw::motion

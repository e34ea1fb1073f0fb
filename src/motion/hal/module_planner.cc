// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/hal/module_planner.hh"

#include "hal/include/millwright_ext.h"

namespace mw::motion {

static_assert(MW_TP_PHASES == trajectory::CHOSEN_PHASES);

ModulePlanner::Found ModulePlanner::find(const char *&missing) noexcept {
    init_ = reinterpret_cast<decltype(init_)>(mw_ext_find_symbol("mw_tp_init"));
    plan_ = reinterpret_cast<decltype(plan_)>(mw_ext_find_symbol("mw_tp_plan"));
    if (init_ == nullptr && plan_ == nullptr) {
        return Found::NONE;
    }
    missing = init_ == nullptr ? "mw_tp_init" : plan_ == nullptr ? "mw_tp_plan" : nullptr;
    return missing != nullptr ? Found::SOME : Found::ALL;
}

int ModulePlanner::start(int comp_id, double period_s) noexcept {
    const int status = init_(comp_id, period_s);
    return status < 0 ? status : mw_ext_use_module("mw_tp_plan", comp_id);
}

int ModulePlanner::choose(const trajectory::SpeedStretch &stretch,
                          std::span<trajectory::ChosenPhase> out) noexcept {
    mw_tp_stretch asked = {};
    asked.length = stretch.length;
    asked.speed = stretch.speed;
    asked.speed_cap = stretch.cap;
    asked.speed_out = stretch.out;
    asked.acceleration_at_rest = stretch.at_rest;
    asked.acceleration_at_cap = stretch.at_cap;
    asked.line = stretch.line;
    asked.is_end = stretch.isEnd ? 1 : 0;
    mw_tp_phase phases[MW_TP_PHASES] = {};
    const int count = plan_(&asked, phases);
    if (count < 0 || count > MW_TP_PHASES || static_cast<std::size_t>(count) > out.size()) {
        return 0;
    }
    for (int n = 0; n < count; ++n) {
        out[static_cast<std::size_t>(n)] = {phases[n].length, phases[n].speed};
    }
    return count;
}

}  // namespace mw::motion

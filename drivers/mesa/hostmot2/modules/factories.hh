// SPDX-License-Identifier: GPL-2.0-or-later
// One function for each module type, which creates it for a board.
#pragma once

#include "drivers/mesa/hostmot2/module.hh"

namespace mw::mesa {

std::unique_ptr<Module> make_stepgens(const ModuleRequest &request);
std::unique_ptr<Module> make_encoders(const ModuleRequest &request);
std::unique_ptr<Module> make_pwmgens(const ModuleRequest &request);
std::unique_ptr<Module> make_leds(const ModuleRequest &request);
std::unique_ptr<Module> make_ssrs(const ModuleRequest &request);
std::unique_ptr<Module> make_outms(const ModuleRequest &request);
std::unique_ptr<Module> make_sserial(const ModuleRequest &request);
std::unique_ptr<Module> make_dpll(const ModuleRequest &request);
std::unique_ptr<Module> make_inmuxs(const ModuleRequest &request);
std::unique_ptr<Module> make_inms(const ModuleRequest &request);
std::unique_ptr<Module> make_three_phase_pwms(const ModuleRequest &request);
std::unique_ptr<Module> make_rc_pwms(const ModuleRequest &request);
std::unique_ptr<Module> make_resolvers(const ModuleRequest &request);
std::unique_ptr<Module> make_galvanometers(const ModuleRequest &request);
std::unique_ptr<Module> make_one_shots(const ModuleRequest &request);
std::unique_ptr<Module> make_period_meters(const ModuleRequest &request);
std::unique_ptr<Module> make_absolute_encoders(const ModuleRequest &request);
/// For firmware with transmitters and receivers; null otherwise.
std::unique_ptr<Module> make_uarts(const ModuleRequest &request);
std::unique_ptr<Module> make_packet_uarts(const ModuleRequest &request);
std::unique_ptr<Module> make_bspis(const ModuleRequest &request);

/// A used module; null if the firmware does not have it.
const UsedModule *find_module(const Assignment &assignment, Gtag gtag) noexcept;

/// Access of a user to any register (enable_raw in config=).
std::unique_ptr<Module> make_raw();

/// True if the firmware has a used phase-locked loop, so that modules have a timer-number pin.
bool hasDpll(const Assignment &assignment) noexcept;

}  // namespace mw::mesa

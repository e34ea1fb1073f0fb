// SPDX-License-Identifier: GPL-2.0-or-later
// Runs a plan at a simulated board and judges it by the motor.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "mesa_campaign/plan.hh"

namespace mw::mesa_campaign {

/// Events and figures of a session.
struct Verdict {
    std::uint64_t cycles = 0, failed_cycles = 0, stops = 0, bites = 0, arms = 0, latches = 0, losses = 0;
    double worst_steps = 0;  ///< largest distance of the motor from its command, divided by the bound of rule
                             ///< 1
    std::string fault;       ///< "rule: text"; empty: none
};

/// `told`: stream for the events; nullptr: none.
Verdict run_session(const Plan &plan, std::FILE *told);

}  // namespace mw::mesa_campaign

// SPDX-License-Identifier: GPL-2.0-or-later
// The session of a seed: faults of the network, and events of host, cable and board.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mw::mesa_campaign {

/// Seeds of another version are other sessions.
constexpr unsigned PLAN_VERSION = 1;

enum class Trouble : std::uint8_t {
    NONE,
    HOST_SILENT,  ///< no cycles, as with SIGSTOP
    LINK_DOWN,
    POWER_OFF,
    RESET,     ///< the board restarts at once
    WATCHDOG,  ///< the watchdog trips without a cause
};

/// Random moves, then a fault, then rest.
struct Act {
    int moving_cycles = 0;
    Trouble trouble = Trouble::NONE;
    int trouble_ms = 0;
    int resting_cycles = 0;
};

struct Plan {
    unsigned seed = 1;
    bool usable = true;   ///< a machine can work with this network
    std::string network;  ///< lines to_board and to_host of the fault table
    double steps_per_mm = 100, max_accel = 3000, accel = 2000, speed = 100;
    int watchdog_ms = 5;
    int reaction_ms = 500;          ///< after which the operator clears a fault
    double arm_probability = 0.01;  ///< of the index, in each cycle
    std::int64_t max_delay_ns = 0;  ///< of a packet
    std::vector<Act> acts;
};

Plan make_plan(unsigned seed);
/// Only the parts named in `kept` (campaign_runner/kept.hh); empty: all.
Plan reduced(Plan plan, const std::string &kept);

}  // namespace mw::mesa_campaign

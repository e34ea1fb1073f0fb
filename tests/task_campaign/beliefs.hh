// SPDX-License-Identifier: GPL-2.0-or-later
// What the machine may be in by the facts, and whether it is: as seen by clients, at pins and on the disk.
#pragma once

#include <string>
#include <vector>

#include "task_campaign/bench.hh"
#include "task_campaign/facts.hh"

namespace mw::task_campaign {

struct Beliefs {
    std::vector<World> worlds;  ///< one of them is true
    messages::State state = messages::State::ESTOP;
    bool isOptionalStop = true, isBlockDelete = true, isHomed = false;
    double feed_override = 1;

    /// Of a stop: no spindle turns, nothing flows.
    void switch_devices_off();
};

void switch_devices_off(World &world);
/// Once only.
void add(std::vector<World> &worlds, const World &world);
/// The axes are where the status says: after what cannot be foretold.
void adopt_place(const Bench &bench, Beliefs &beliefs);
/// Of a machine at rest; worlds that do not fit are dropped. Empty, or "rule: what is wrong".
std::string judge(Bench &bench, messages::Mode mode, Beliefs &beliefs);

}  // namespace mw::task_campaign

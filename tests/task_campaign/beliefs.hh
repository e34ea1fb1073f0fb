// SPDX-License-Identifier: GPL-2.0-or-later
// The possible states of the machine according to the facts, and the check that it is in one of them, as seen
// by clients, at pins and on the disk.
#pragma once

#include <string>
#include <vector>

#include "task_campaign/bench.hh"
#include "task_campaign/facts.hh"

namespace mw::task_campaign {

struct Beliefs {
    std::vector<World> worlds;  ///< one of these states is true
    messages::State state = messages::State::ESTOP;
    bool isOptionalStop = true, isBlockDelete = true, isHomed = false;
    double feed_override = 1;

    /// Assumes a stop: no spindle turns and no coolant flows.
    void switch_devices_off();
};

void switch_devices_off(World &world);
/// Called only once.
void add(std::vector<World> &worlds, const World &world);
/// After an unpredictable event, takes the positions of the axes from the status.
void adopt_place(const Bench &bench, Beliefs &beliefs);
/// Checks a machine at rest and drops the states that do not match. Returns an empty text, or "rule: fault".
std::string judge(Bench &bench, messages::Mode mode, Beliefs &beliefs);

}  // namespace mw::task_campaign

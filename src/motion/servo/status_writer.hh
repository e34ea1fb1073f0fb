// SPDX-License-Identifier: GPL-2.0-or-later
// Last stage of a servo cycle: the status for all clients, the view of the path planner, and the trace.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// What is reported beside the parts.
struct StatusInputs {
    const Inputs &in;
    Epoch epoch = 0;
    CommandId last_immediate_id = 0;  ///< last one that was answered
    bool isTaskLost = false;
};

/// Writes `out` and publishes it.
[[gnu::hot]] void write_status(const ControllerParts &parts, const StatusInputs &now, Outputs &out) noexcept;

}  // namespace mw::motion

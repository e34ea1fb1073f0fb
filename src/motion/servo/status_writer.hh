// SPDX-License-Identifier: GPL-2.0-or-later
// Last stage of a servo cycle: status for clients, view for the path planner, and trace.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Data that the parts do not contain.
struct StatusInputs {
    const Inputs &in;
    Epoch epoch = 0;
    CommandId last_immediate_id = 0;  ///< last one that was answered
    bool isTaskLost = false;
};

/// Writes `out` and publishes it.
[[gnu::hot]] void write_status(const ControllerParts &parts, const StatusInputs &now, Outputs &out) noexcept;

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Offsets of the program for clients.
#pragma once

#include "machine/task/run/task_canon.hh"
#include "messages/declarations/status.hh"

namespace mw::task {

inline void show(const gcode::UseOffsets &from, messages::OffsetsStatus &to) {
    to.g5x_index = from.g5x_index;
    to.g5x = from.g5x;
    to.g92 = from.g92;
    to.rotation_xy_deg = from.rotation_xy_deg;
}

/// Announced offsets are active at once without a run: at the start, and after an abort.
inline void show_announced(const TaskCanon &canon, messages::OffsetsStatus &to) {
    if (canon.offsets().has_value()) {
        show(*canon.offsets(), to);
    }
    if (canon.tool_offset().has_value()) {
        to.tool = *canon.tool_offset();
    }
}

}  // namespace mw::task

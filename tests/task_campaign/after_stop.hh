// SPDX-License-Identifier: GPL-2.0-or-later
// Possible states of a machine after an interrupted program or line.
#pragma once

#include <optional>
#include <vector>

#include "task_campaign/beliefs.hh"

namespace mw::task_campaign {

/// State after the complete program, with its moves from line `from` on; empty: a line of it must fail.
std::optional<World> carried_out(const std::vector<Line> &lines, World world, bool isBlockDelete,
                                 std::size_t from = 1);
/// An executed block has set its modes, and its devices are as before or after it. Blocks that were only read
/// ahead have no effect. `from` above 0: the program began at that line, and the device states that
/// its approach has set count. All spindles are stopped.
std::vector<World> after_stop(const std::vector<Line> &lines, const World &before, bool isBlockDelete,
                              std::size_t from = 0);
/// States after an MDI line: no effect, its complete effect, or only its effect on the interpreter.
std::vector<World> with_or_without(const Line &line, const World &before);

}  // namespace mw::task_campaign

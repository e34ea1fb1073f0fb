// SPDX-License-Identifier: GPL-2.0-or-later
// What a machine may be in when a program or a line has not come to its end.
#pragma once

#include <optional>
#include <vector>

#include "task_campaign/beliefs.hh"

namespace mw::task_campaign {

/// The program to its end, its moves from line `from` on; nothing: a line of it must fail.
std::optional<World> carried_out(const std::vector<Line> &lines, World world, bool isBlockDelete,
                                 std::size_t from = 1);
/// A block that is executed has set its modes, and its devices are as before or after it; nothing is left of
/// blocks that were only read ahead. `from` above 0: the program began at that line, and whatever its
/// approach had brought about of the devices counts. No spindle turns.
std::vector<World> after_stop(const std::vector<Line> &lines, const World &before, bool isBlockDelete,
                              std::size_t from = 0);
/// Nothing of a line of MDI, all of it, or all of it that the interpreter does.
std::vector<World> with_or_without(const Line &line, const World &before);

}  // namespace mw::task_campaign

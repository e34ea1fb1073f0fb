// SPDX-License-Identifier: GPL-2.0-or-later
// The ordered queue between the interpreter and the machine: the actions of a program, in program order.
#pragma once

#include <cstdint>
#include <deque>

#include "gcode/canon/machine_canon.hh"
#include "motion/interface/path_command.hh"

namespace mw::task {

struct Item {
    motion::SourceTag source;
    gcode::MachineCall call;
    std::uint64_t read = 0;  ///< number of the interpreter step that created the item; never decreases
};

using ItemQueue = std::deque<Item>;

/// Source position of an item.
struct ItemPlace {
    motion::SourceTag source;
    std::uint64_t read = 0;  ///< Item::read
};

}  // namespace mw::task

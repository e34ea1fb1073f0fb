// SPDX-License-Identifier: GPL-2.0-or-later
// Boards under the virtual clock, each simulated in this process. A real board is not used there, because
// another process may drive a machine with it, and its time is not that of the clock.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "drivers/mesa/direct/register_access.hh"
#include "drivers/mesa/lbp16/transport.hh"

namespace mw::mesa {

/// The simulated board for an address.
struct VirtualBoardPlan {
    std::string model;         ///< a built-in model such as 7i76e, or a file
    std::string physics_file;  ///< motors, encoders and switches; empty: none

    bool operator==(const VirtualBoardPlan &) const = default;
};

/// Reads MODEL or MODEL:PHYSICS_FILE.
VirtualBoardPlan parse_virtual_board(std::string_view text);
/// The plan for `board` from a list of BOARD=MODEL[:PHYSICS_FILE], separated by commas: an address, or a
/// component such as hm2_pci, with the suffix .1 for its second board. Empty if there is no model.
VirtualBoardPlan find_virtual_board(std::string_view list, std::string_view board);
/// The plan from the environment variable MILLWRIGHT_MESA. A relative path of a file is relative to the
/// folder CONFIG_DIR of the environment.
VirtualBoardPlan virtual_board_of(std::string_view board);
/// The plan with absolute paths.
VirtualBoardPlan with_paths(VirtualBoardPlan plan);
/// The reason why there is no virtual board, and how to select its model.
std::string missing_virtual_board(std::string_view board);

/// A simulated board whose registers this process accesses directly, as on PCI.
struct VirtualRegisters {
    std::string card_name;  ///< the name that the card reports: 5I20
    std::unique_ptr<RegisterAccess> access;
};
/// Its time follows `clock_ns`. It allocates memory, so it is only for the virtual clock. [one thread]
Result<VirtualRegisters> open_virtual_registers(const VirtualBoardPlan &plan,
                                                std::function<std::int64_t()> clock_ns);

/// A connection to a simulated board. Its time follows `clock_ns` and is ahead of it while packets are in
/// transit within a cycle. It allocates memory, so it is only for the virtual clock. [one thread]
Result<std::unique_ptr<lbp16::Transport>> open_virtual_board(const VirtualBoardPlan &plan,
                                                             std::function<std::int64_t()> clock_ns);

}  // namespace mw::mesa

// SPDX-License-Identifier: GPL-2.0-or-later
// The boards of hm2_pci: all cards of the table in the computer, in the order of their PCI addresses.
#pragma once

#include <span>

#include "drivers/mesa/hostmot2/hal/driver.hh"

namespace mw::mesa {

constexpr int MAX_PCI_BOARDS = 8;

/// 0, or a negated errno with a message. unload_pci_boards() is also called after a failure. [while loading]
MW_HOSTMOT2_API int load_pci_boards(int comp_id, std::span<char *const> configs);
/// Call it when no function of the boards can run.
MW_HOSTMOT2_API void unload_pci_boards(int comp_id);

}  // namespace mw::mesa

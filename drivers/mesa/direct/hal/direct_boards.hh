// SPDX-License-Identifier: GPL-2.0-or-later
// The boards of the components hm2_pci, hm2_7i43, hm2_7i90, hm2_spi, hm2_rpspi and hm2_spix.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "drivers/mesa/direct/direct_bus.hh"
#include "drivers/mesa/hostmot2/hal/driver.hh"

namespace mw::mesa {

struct DirectBoardRequest {
    int comp_id = 0;
    std::string module;  ///< name of the component, for messages
    std::unique_ptr<RegisterAccess> access;
    DirectCard card;
    std::string place;  ///< position for messages: "PCI 0000:01:00.0"
    std::string config;
};

/// Registers a board as hm2_CARD.N with its pins: 0, or a negated errno with a message. [while loading]
MW_HOSTMOT2_API int add_direct_board(DirectBoardRequest request);
/// Switches the outputs of all boards of a component off and removes the boards. Call it when none of their
/// functions can run. [while unloading]
MW_HOSTMOT2_API void remove_direct_boards(int comp_id);
/// The text of an array of module parameters; empty if none was set.
MW_HOSTMOT2_API std::string text_at(std::span<char *const> texts, std::size_t index);

}  // namespace mw::mesa

// SPDX-License-Identifier: GPL-2.0-or-later
// The boards of hm2_eth: opens the connection of each, prepares the network, and registers it with the
// driver.
#pragma once

#include <span>
#include <string>

#include "drivers/mesa/hostmot2/hal/driver.hh"

namespace mw::mesa {

/// Maximum number of boards of one load.
constexpr int MAX_ETHERNET_BOARDS = 4;

/// The module parameters of hm2_eth.
struct EthernetLoad {
    int comp_id = 0;
    std::span<char *const>
        addresses;  ///< board_ip=: ADDRESS or ADDRESS:PORT; the first empty value ends the list
    std::span<char *const> configs;         ///< config=
    std::span<char *const> virtual_boards;  ///< virtual_board=: MODEL[:PHYSICS_FILE] under the virtual clock
    std::string firewall;                   ///< auto, nft or none
};

/// 0, or a negated errno with a message in the log. unload_ethernet_boards() is also called after a failure.
/// [while loading]
MW_HOSTMOT2_API int load_ethernet_boards(const EthernetLoad &load);
/// Switches the outputs of the boards off and undoes the changes of the network settings. Call it when none
/// of their functions can run. [while unloading]
MW_HOSTMOT2_API void unload_ethernet_boards(int comp_id);

}  // namespace mw::mesa

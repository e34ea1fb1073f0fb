// SPDX-License-Identifier: GPL-2.0-or-later
// The boards of hm2_7i43 and hm2_7i90: one on each parallel port.
#pragma once

#include <span>

#include "drivers/mesa/hostmot2/hal/driver.hh"

namespace mw::mesa {

constexpr int MAX_EPP_BOARDS = 8;

enum class EppCard : std::uint8_t { CARD_7I43, CARD_7I90 };

/// The module parameters.
struct EppLoad {
    int comp_id = 0;
    EppCard card = EppCard::CARD_7I90;
    std::span<const int>
        addresses;  ///< ioaddr=; below 16: the number of a port; the first negative value ends the list
    std::span<const int> high_addresses;  ///< ioaddr_hi=; 0: detected
    std::span<const int> wide;            ///< epp_wide=
    std::span<char *const> configs;
};

/// 0, or a negated errno with a message. remove_direct_boards() is also called after a failure. [while
/// loading]
MW_HOSTMOT2_API int load_epp_boards(const EppLoad &load);

}  // namespace mw::mesa

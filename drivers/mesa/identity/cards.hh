// SPDX-License-Identifier: GPL-2.0-or-later
// The cards by name: name in HAL, ports, connectors. Source: shared/hardware.md, part A3.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace mw::mesa {

constexpr std::size_t MAX_PORTS = 6;

/// A type of card.
struct Card {
    std::string_view name_begins;  ///< the beginning of the name that the card reports
    std::string_view hal_name;     ///< hm2_HAL_NAME.0
    std::uint8_t ports = 0;
    std::uint8_t port_width = 0;
    std::array<std::string_view, MAX_PORTS>
        connectors{};  ///< one for each port, as on the board; empty: the pins have their own names
};

/// All known cards with Ethernet; longer names come before their prefixes.
std::span<const Card> ethernet_cards() noexcept;
/// The card with the reported name (16 characters, padded with spaces or zeros); nullptr: unknown.
const Card *find_ethernet_card(std::string_view reported_name) noexcept;

}  // namespace mw::mesa

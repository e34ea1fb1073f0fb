// SPDX-License-Identifier: GPL-2.0-or-later
// Boards on SPI by the name in their firmware. Source: the names and lamps of LinuxCNC's hm2_spi.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "drivers/mesa/direct/direct_bus.hh"

namespace mw::mesa::spi {

/// A card is stopped after five consecutive failures, because a single disturbed bit is not a fault of the
/// machine.
constexpr int MOST_FAILURES = 5;

/// The card of a firmware with this name of 8 characters, such as MESA7I90. An unknown card gets its name
/// without MESA, and its properties from the firmware.
inline DirectCard card_of(std::string_view board_name) {
    if (board_name == "MESA7I90") {
        return {.hal_name = "7i90",
                .connectors = {"P1", "P2", "P3"},
                .port_width = 24,
                .leds = 2,
                .most_failures = MOST_FAILURES};
    }
    std::string name;
    const bool is_mesa = board_name.starts_with("MESA");
    for (const char c : is_mesa ? board_name.substr(4) : board_name) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
            name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
    }
    return {.hal_name = name.empty() ? "spi" : name,
            .connectors = {},
            .port_width = 0,
            .leds = 0,
            .most_failures = MOST_FAILURES};
}

}  // namespace mw::mesa::spi

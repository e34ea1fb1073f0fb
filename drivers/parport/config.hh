// SPDX-License-Identifier: GPL-2.0-or-later
// The string cfg= of hal_parport: addresses and types of ports, such as "0x378 out 0x278 in".
#pragma once

#include <array>
#include <cstdint>

#include "drivers/parport/lines.hh"

namespace mw::parport {

constexpr int MAX_PORTS = 8;

struct PortConfig {
    std::uint16_t address = 0;  ///< below 16: the number of a port that Linux has detected
    Mode mode = Mode::OUT;

    bool operator==(const PortConfig &) const = default;
};

/// The ports of a string, or the reason why it is not valid.
struct Config {
    std::array<PortConfig, MAX_PORTS> port{};
    int count = 0;
    const char *problem = nullptr;  ///< nullptr: none
    std::array<char, 32> token{};   ///< the word with the problem; may be empty
};

/// Reads the string; words are separated by spaces or underscores. [while loading; no allocation]
Config read_config(const char *text) noexcept;

}  // namespace mw::parport

// SPDX-License-Identifier: GPL-2.0-or-later
// The string config= of a board: how many instances of each module are used, and modes of smart serial
// channels. Unused instances release their pins as general inputs and outputs.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

/// As many instances as the firmware has.
constexpr int ALL_INSTANCES = -1;
constexpr int MAX_SMART_SERIAL_PORTS = 4, MAX_CHANNELS = 8;

struct Config {
    std::string firmware;          ///< file to load into the board; empty: keep its firmware
    std::map<Gtag, int> wanted{};  ///< instances by module; modules not listed use all
    int stepgen_width = 2;         ///< number of output pins of each stepgen
    bool raw_enabled = false;
    /// One character for each channel: a mode, or x for an unused channel. Other channels have mode 0.
    std::array<std::string, MAX_SMART_SERIAL_PORTS> sserial_modes{};
    /// Formats of absolute encoders, by channel: only channels with a format are used.
    std::map<int, std::string> ssi_formats{}, biss_formats{}, fanuc_formats{};
    /// Options of `loadrt hostmot2`, which are not in the string.
    bool is_named_by_serial_number = false;  ///< pins of smart serial cards
    int sserial_baudrate = -1;               ///< baud rate of smart serial ports [bit/s]; -1: that of the
                                             ///< firmware

    /// Formats of a module of absolute encoders; null for other modules.
    const std::map<int, std::string> *formats_of(Gtag gtag) const noexcept;
    /// ALL_INSTANCES unless the string limits the module.
    int wanted_of(Gtag gtag) const;
};

/// Parses tokens separated by blanks, such as "num_encoders=1 sserial_port_0=00xx". An error names the token
/// and the most similar known token.
Result<Config> parse_config(std::string_view text);

/// The token that limits a module, such as "num_encoders"; empty if there is none.
std::string_view token_of(Gtag gtag) noexcept;

}  // namespace mw::mesa

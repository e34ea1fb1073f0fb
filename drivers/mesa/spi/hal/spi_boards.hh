// SPDX-License-Identifier: GPL-2.0-or-later
// The boards of hm2_spi, hm2_rpspi and hm2_spix.
#pragma once

#include <span>
#include <string>

#include "drivers/mesa/hostmot2/hal/driver.hh"

namespace mw::mesa {

constexpr int MAX_SPI_BOARDS = 5;

/// One board.
struct SpiLoad {
    int comp_id = 0;
    std::string module;  ///< hm2_spi, for messages
    std::string path;    ///< /dev/spidev1.0
    int rate_khz = 0;
    int read_rate_khz = 0;  ///< up to 0: as rate_khz
    std::string config;
};

/// 0, or a negated errno with a message. remove_direct_boards() is also called after a failure. [while
/// loading]
MW_HOSTMOT2_API int load_spi_board(const SpiLoad &load);

/// The module parameters of hm2_rpspi and hm2_spix.
struct ProbeLoad {
    int comp_id = 0;
    std::string module;
    unsigned probe = 1;              ///< spi_probe=
    std::span<const int> rates_khz;  ///< spiclk_rate=; in the order of the boards; up to 0: as for the first
                                     ///< board
    std::span<const int> read_rates_khz;  ///< spiclk_rate_rd=
    std::span<char *const> configs;
};

/// Loads the boards of all probe bits. Returns 0, or a negated errno with a message. remove_direct_boards()
/// is also called after a failure. [while loading]
MW_HOSTMOT2_API int load_probed_boards(const ProbeLoad &load);

}  // namespace mw::mesa

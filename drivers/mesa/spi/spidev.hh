// SPDX-License-Identifier: GPL-2.0-or-later
// An SPI bus through /dev/spidevB.C of Linux.
#pragma once

#include <memory>
#include <string>

#include "base/result.hh"
#include "drivers/mesa/spi/spi_device.hh"

namespace mw::mesa::spi {

/// Clock rates [Hz]; the controller uses the next lower rate that it has.
struct ClockRates {
    std::uint32_t read_hz = 0, write_hz = 0;
};

/// Opens a device and sets its mode. If the controller does not support words of 32 bits, bytes are sent in
/// the same order. [while loading]
Result<std::unique_ptr<Device>> open_spidev(const std::string &path, ClockRates rates);

/// Devices of the probe bits of hm2_rpspi and hm2_spix, in the order of the search: 1 SPI0/CE0, 2 SPI0/CE1, 4
/// SPI1/CE0, 8 SPI1/CE1, 16 SPI1/CE2. Empty: no such bit.
std::string path_of_probe(unsigned bit);

}  // namespace mw::mesa::spi

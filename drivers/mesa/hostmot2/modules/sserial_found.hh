// SPDX-License-Identifier: GPL-2.0-or-later
// The smart serial ports of a board that the driver found while loading.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/mesa/hostmot2/modules/sserial_records.hh"

namespace mw::mesa {

/// A parameter of a card and its value at the time of the discovery.
struct FoundParameter {
    DataRecord record;
    std::uint64_t value = 0;  ///< value as bits in the card
};

/// A card on a channel.
struct FoundCard {
    int channel = 0;
    std::uint8_t mode = 0;
    std::string name;  ///< in lower case: 7i76
    std::uint32_t serial_number = 0;
    std::vector<DataRecord> process;
    ProcessLayout layout;
    std::vector<FoundParameter> parameters;
};

/// A port with at least one card.
struct FoundPort {
    int port = 0;
    std::vector<FoundCard> cards;  ///< by channel
};

}  // namespace mw::mesa

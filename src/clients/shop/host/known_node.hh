// SPDX-License-Identifier: GPL-2.0-or-later
// A Sparkplug node as described in its birth, and the position in its sequence of messages.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "clients/shop/reading.hh"

namespace mw::shop {

/// Meaning of data by their alias.
struct KnownMetric {
    SeriesId series = 0;
    std::uint32_t type = 0;  ///< type number of Sparkplug
};

struct KnownDevice {
    bool isAlive = false;
    bool isAwaited = false;  ///< it existed before the last birth of its node
    TimeMs presence_at = 0;  ///< time of the last presence
    std::map<std::uint64_t, KnownMetric> by_alias;
    std::map<std::string, KnownMetric, std::less<>> by_name;
};

struct KnownNode {
    bool isInOrder = false;  ///< no message since the birth is missing
    /// Its messages have positions; it receives receipts, and repeats messages without a receipt.
    bool isCounted = false;
    Receipt position;      ///< position of the last message in order
    std::uint8_t seq = 0;  ///< sequence number of the next message
    /// From its last message, because the death sent by the broker has no time of the node's clock.
    std::int64_t clock_ahead_ms = 0;
    double requested_s = -1e9;
    double receipt_s = -1e9;
    bool hasReported = false;
    std::map<std::string, KnownDevice, std::less<>> devices;
};

}  // namespace mw::shop

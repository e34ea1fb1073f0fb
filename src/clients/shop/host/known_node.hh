// SPDX-License-Identifier: GPL-2.0-or-later
// A node of Sparkplug as its birth describes it, and where its sequence of messages is.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "clients/shop/reading.hh"

namespace mw::shop {

/// What data mean by their alias.
struct KnownMetric {
    SeriesId series = 0;
    std::uint32_t type = 0;  ///< of Sparkplug
};

struct KnownDevice {
    bool isAlive = false;
    bool isAwaited = false;  ///< it was there before the last birth of its node
    TimeMs presence_at = 0;  ///< of the last presence
    std::map<std::uint64_t, KnownMetric> by_alias;
    std::map<std::string, KnownMetric, std::less<>> by_name;
};

struct KnownNode {
    bool isInOrder = false;  ///< no message since the birth is missing
    /// Its messages have positions: it gets receipts, and sends again what has none.
    bool isCounted = false;
    Receipt position;      ///< of the last message in order
    std::uint8_t seq = 0;  ///< of the next message
    /// By its last message: the death that the broker sends has no time of the node's clock.
    std::int64_t clock_ahead_ms = 0;
    double requested_s = -1e9;
    double receipt_s = -1e9;
    bool hasReported = false;
    std::map<std::string, KnownDevice, std::less<>> devices;
};

}  // namespace mw::shop

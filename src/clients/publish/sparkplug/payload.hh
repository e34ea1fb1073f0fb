// SPDX-License-Identifier: GPL-2.0-or-later
// Converts payloads of Sparkplug B to and from bytes. Only this file uses protobuf.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/publish/value.hh"

namespace mw::publish {

/// A metric in a message. Empty names and absent numbers are not written.
struct PayloadMetric {
    std::string name{};
    std::optional<std::uint64_t> alias{};
    std::optional<TimeMs> at{};
    std::optional<DataType> type{};  ///< written only in births
    /// The type number that was read, also of a type that is not used here; 0: none.
    std::uint32_t type_number = 0;
    bool isHistorical = false;
    std::string unit{};  ///< written as the property engUnit
    Value value{};
};

/// Number of a message in a birth; unique among the messages of a node.
struct Position {
    TimeMs birth = 0;         ///< time of NBIRTH
    std::uint64_t count = 0;  ///< number of messages from NBIRTH on, NBIRTH and this one included

    bool operator==(const Position &other) const = default;
};

struct Payload {
    std::optional<TimeMs> at{};
    std::optional<std::uint64_t> seq{};
    std::optional<Position> position{};  ///< for a host with receipts
    std::vector<PayloadMetric> metrics{};
};

std::string encode(const Payload &payload);
/// Nothing if the bytes are not a payload. Values of types that are not used here are omitted.
std::optional<Payload> decode_payload(std::string_view bytes);

}  // namespace mw::publish

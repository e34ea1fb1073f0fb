// SPDX-License-Identifier: GPL-2.0-or-later
// The data of a shop about its machines.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clients/publish/sparkplug/host_state.hh"
#include "clients/publish/value.hh"

namespace mw::shop {

using publish::Receipt;
using publish::TimeMs;
using publish::Value;

/// An edge node of Sparkplug.
struct NodeName {
    std::string group, node;

    auto operator<=>(const NodeName &other) const = default;
};

/// A device of a node; an empty device is the node itself.
struct MachineName {
    NodeName node;
    std::string device;

    auto operator<=>(const MachineName &other) const = default;
};

/// All values of one metric of a machine.
struct Series {
    MachineName machine;
    std::string metric;
    std::string unit;
};
/// Number of a series in this process, from 0.
using SeriesId = std::uint32_t;

/// The key is series and time, so a repeated value has the same key.
struct Reading {
    SeriesId series = 0;
    TimeMs at = 0;
    Value value;
    TimeMs late_ms = 0;  ///< age of the value when the machine sent it
};

/// A machine has started or ended.
/// Times of the presences of a machine increase strictly.
struct Presence {
    MachineName machine;
    TimeMs at = 0;  ///< by the clock of the machine
    bool isAlive = false;
    std::int64_t clock_ahead_ms = 0;  ///< difference of the machine's clock from this computer's
};

struct NodeReceipt {
    NodeName node;
    Receipt receipt;
};

/// The running machines; other machines of these groups ended while no collector ran.
struct Census {
    std::vector<MachineName> present;
    std::vector<std::string> groups;  ///< empty: all
};

/// Stored completely or not at all.
struct Batch {
    std::vector<Series> new_series;  ///< their numbers follow those of earlier batches
    std::vector<Reading> readings;
    std::vector<Presence> presences;
    std::optional<Census> census;
    std::vector<NodeReceipt> receipts;  ///< sent when the batch is stored

    bool isEmpty() const {
        return new_series.empty() && readings.empty() && presences.empty() && !census.has_value() &&
               receipts.empty();
    }
};

}  // namespace mw::shop

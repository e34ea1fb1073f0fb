// SPDX-License-Identifier: GPL-2.0-or-later
// What a host application reports to nodes: whether it is online (STATE), and what it has stored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mw::publish {

struct HostState {
    bool isOnline = false;
    std::uint64_t at = 0;  ///< milliseconds of UTC
    /// It reports what it has stored ("receipts", which is not of Sparkplug).
    bool hasReceipts = false;
};

/// Nothing when it is no JSON with "online" and "timestamp".
std::optional<HostState> read_host_state(std::string_view payload);
std::string write_host_state(const HostState &state);

/// A host has stored the first messages of a birth of a node.
struct Receipt {
    std::uint64_t bdseq = 0;
    std::uint64_t birth = 0;  ///< time of NBIRTH; unique among the births of a node
    std::uint64_t count = 0;  ///< messages from NBIRTH on, that included

    bool operator==(const Receipt &other) const = default;
};

std::string receipt_topic(std::string_view host, std::string_view group, std::string_view node);
std::string write_receipt(const Receipt &receipt);
/// Nothing when it is no receipt.
std::optional<Receipt> read_receipt(std::string_view payload);

}  // namespace mw::publish

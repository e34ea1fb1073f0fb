// SPDX-License-Identifier: GPL-2.0-or-later
// Reports of a host application to nodes: whether it is online (STATE), and the messages that it has stored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mw::publish {

struct HostState {
    bool isOnline = false;
    std::uint64_t at = 0;  ///< milliseconds of UTC
    /// It reports stored messages ("receipts", which are not part of Sparkplug).
    bool hasReceipts = false;
};

/// Nothing if it is not JSON with "online" and "timestamp".
std::optional<HostState> read_host_state(std::string_view payload);
std::string write_host_state(const HostState &state);

/// A host has stored the first messages of a birth of a node.
struct Receipt {
    std::uint64_t bdseq = 0;
    std::uint64_t birth = 0;  ///< time of NBIRTH; unique among the births of a node
    std::uint64_t count = 0;  ///< number of messages, NBIRTH included

    bool operator==(const Receipt &other) const = default;
};

std::string receipt_topic(std::string_view host, std::string_view group, std::string_view node);
std::string write_receipt(const Receipt &receipt);
/// Nothing if it is not a receipt.
std::optional<Receipt> read_receipt(std::string_view payload);

}  // namespace mw::publish

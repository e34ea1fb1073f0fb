// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/host_state.hh"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace mw::publish {

std::optional<HostState> read_host_state(std::string_view payload) {
    const auto document = nlohmann::json::parse(payload, nullptr, false);
    if (!document.is_object()) {
        return std::nullopt;
    }
    const auto online = document.find("online"), at = document.find("timestamp");
    if (online == document.end() || at == document.end() || !online->is_boolean() ||
        !at->is_number_unsigned()) {
        return std::nullopt;
    }
    const auto receipts = document.find("receipts");
    return HostState{online->get<bool>(), at->get<std::uint64_t>(),
                     receipts != document.end() && receipts->is_boolean() && receipts->get<bool>()};
}

std::string write_host_state(const HostState &state) {
    return fmt::format(R"({{"online":{},"timestamp":{},"receipts":{}}})", state.isOnline, state.at,
                       state.hasReceipts);
}

std::string receipt_topic(std::string_view host, std::string_view group, std::string_view node) {
    return fmt::format("millwright/stored/{}/{}/{}", host, group, node);
}

std::string write_receipt(const Receipt &receipt) {
    return fmt::format(R"({{"bdSeq":{},"birth":{},"count":{}}})", receipt.bdseq, receipt.birth,
                       receipt.count);
}

std::optional<Receipt> read_receipt(std::string_view payload) {
    const auto document = nlohmann::json::parse(payload, nullptr, false);
    const auto number = [&document](const char *name) -> std::optional<std::uint64_t> {
        const auto found = document.find(name);
        return found != document.end() && found->is_number_unsigned()
                   ? std::optional(found->get<std::uint64_t>())
                   : std::nullopt;
    };
    if (!document.is_object()) {
        return std::nullopt;
    }
    const auto bdseq = number("bdSeq"), birth = number("birth"), count = number("count");
    if (!bdseq.has_value() || !birth.has_value() || !count.has_value()) {
        return std::nullopt;
    }
    return Receipt{*bdseq, *birth, *count};
}

}  // namespace mw::publish

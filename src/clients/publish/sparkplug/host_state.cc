// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/host_state.hh"

#include <nlohmann/json.hpp>

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
    return HostState{online->get<bool>(), at->get<std::uint64_t>()};
}

}  // namespace mw::publish

// SPDX-License-Identifier: GPL-2.0-or-later
// The payload of STATE, by which a host application says whether it is there.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mw::publish {

struct HostState {
    bool isOnline = false;
    std::uint64_t at = 0;  ///< milliseconds of UTC
};

/// Nothing when it is no JSON with "online" and "timestamp".
std::optional<HostState> read_host_state(std::string_view payload);

}  // namespace mw::publish

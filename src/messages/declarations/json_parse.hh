// SPDX-License-Identifier: GPL-2.0-or-later
// Parses JSON from clients. All readers use this function, because it limits the nesting.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace mw::messages {

/// Maximum nesting: that of the largest command, with a margin.
inline constexpr int MOST_JSON_LEVELS = 16;

/// The result is discarded if the text is not JSON, or more than MOST_JSON_LEVELS objects and arrays are
/// nested.
inline nlohmann::ordered_json parse_json(std::string_view text) {
    using Json = nlohmann::ordered_json;
    constexpr bool HAS_EXCEPTIONS = false;
    bool isDeep = false;
    const auto look = [&isDeep](int depth, Json::parse_event_t, Json &) {
        isDeep = isDeep || depth > MOST_JSON_LEVELS;
        return !isDeep;
    };
    Json json = Json::parse(text.begin(), text.end(), look, HAS_EXCEPTIONS);
    return isDeep ? Json(Json::value_t::discarded) : json;
}

}  // namespace mw::messages

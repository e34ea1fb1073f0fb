// SPDX-License-Identifier: GPL-2.0-or-later
// JSON of clients. Each reader of it parses it here, so that none keeps what a client nests without end.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace mw::messages {

/// Levels of the largest command, and some more.
inline constexpr int MOST_JSON_LEVELS = 16;

/// Discarded where it is not JSON, or where more than MOST_JSON_LEVELS objects and arrays are in one another.
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

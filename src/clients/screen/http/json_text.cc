// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/http/json_text.hh"

#include <utility>

namespace mw::screen {

std::string text_of(const Json &json) {
    constexpr int COMPACT = -1;
    constexpr bool IS_ASCII = false;
    return json.dump(COMPACT, ' ', IS_ASCII, Json::error_handler_t::replace);
}

std::string member_text(const char *key, Json value) {
    Json json = Json::object();
    json[key] = std::move(value);
    return text_of(json);
}

}  // namespace mw::screen

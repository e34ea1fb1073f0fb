// SPDX-License-Identifier: GPL-2.0-or-later
// JSON as compact text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mw::screen {

/// Its members keep their order.
using Json = nlohmann::ordered_json;

/// In one line; invalid UTF-8 is replaced.
std::string text_of(const Json &json);
/// {"key": value}
std::string member_text(const char *key, Json value);

}  // namespace mw::screen

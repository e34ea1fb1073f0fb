// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/facts/panel.hh"

#include <algorithm>
#include <array>
#include <utility>

#include "clients/screen/http/json_text.hh"
#include "messages/declarations/json_parse.hh"

namespace mw::screen {
namespace {

/// Parts of a panel, and whether the operator sets a value with them.
constexpr std::array<std::pair<std::string_view, bool>, 6> PARTS{{{"lamp", false},
                                                                  {"value", false},
                                                                  {"bar", false},
                                                                  {"button", true},
                                                                  {"switch", true},
                                                                  {"number", true}}};

}  // namespace

Result<> check_panel(std::string_view text) {
    const Json json = messages::parse_json(text);
    const auto rows = json.is_object() ? json.find("parts") : json.end();
    if (!json.is_object() || rows == json.end() || !rows->is_array()) {
        return fail(R"(a panel is {"parts": [...]} in JSON)");
    }
    for (const Json &row : *rows) {
        const auto text_at = [&row](const char *key) {
            return row.is_object() && row.contains(key) && row[key].is_string() ? row[key].get<std::string>()
                                                                                : "";
        };
        const std::string kind = text_at("kind");
        if (std::ranges::find(PARTS, kind, &std::pair<std::string_view, bool>::first) == PARTS.end()) {
            return fail("'" + kind +
                        "' is no part of a panel: lamp, value, bar, button, switch and number are");
        }
        if (text_at("name").empty() || text_at("label").empty()) {
            return fail("each part of a panel has a label, and a name of HAL");
        }
    }
    return {};
}

std::vector<std::string> settable_names(std::string_view panel) {
    std::vector<std::string> names;
    if (check_panel(panel).has_value()) {
        const Json json = messages::parse_json(panel);  // must outlive its rows
        for (const Json &row : json["parts"]) {
            const auto kind = std::ranges::find(PARTS, row["kind"].get<std::string>(),
                                                &std::pair<std::string_view, bool>::first);
            if (kind->second) {
                names.push_back(row["name"].get<std::string>());
            }
        }
    }
    return names;
}

}  // namespace mw::screen

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/files/file_documents.hh"

#include <algorithm>
#include <utility>

#include "clients/screen/http/json_text.hh"
#include "messages/declarations/json_parse.hh"

namespace mw::screen {

std::string lines_document(std::span<const std::string> lines) {
    return member_text("lines", std::vector<std::string>(lines.begin(), lines.end()));
}

std::optional<std::vector<std::string>> read_lines(std::string_view text, std::size_t most) {
    const Json json = messages::parse_json(text);
    const auto lines = json.is_object() ? json.find("lines") : json.end();
    if (!json.is_object() || lines == json.end() || !lines->is_array() || lines->size() > most) {
        return std::nullopt;
    }
    const bool are_lines = std::ranges::all_of(*lines, [](const Json &line) {
        return line.is_string() &&
               line.get_ref<const std::string &>().find_first_of("\r\n") == std::string::npos;
    });
    return are_lines ? std::optional(lines->get<std::vector<std::string>>()) : std::nullopt;
}

bool isObject(std::string_view json) {
    return messages::parse_json(json).is_object();
}

std::string offsets_document(std::span<const std::array<double, 10>> systems) {
    Json list = Json::array();
    for (const std::array<double, 10> &system : systems) {
        list.push_back({{"offset", std::vector<double>(system.begin(), system.end() - 1)},
                        {"rotation_deg", system.back()}});
    }
    return member_text("systems", std::move(list));
}

std::string files_document(std::span<const FileFacts> files) {
    Json list = Json::array();
    for (const FileFacts &file : files) {
        list.push_back({{"name", file.name}, {"size", file.size}, {"modified_s", file.modified_s}});
    }
    return member_text("files", std::move(list));
}

}  // namespace mw::screen

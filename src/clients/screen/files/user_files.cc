// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/files/user_files.hh"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "clients/screen/files/file_documents.hh"
#include "clients/screen/http/error_response.hh"

namespace mw::screen {
namespace {

Response document(std::string body) {
    Response response;
    response.body = std::move(body);
    return response;
}

/// Content of a file; empty when it does not exist.
Result<std::string> content(const std::string &path) {
    std::error_code error;
    return std::filesystem::exists(path, error) ? read_file(path) : Result<std::string>("");
}

Response kept(const Result<> &written) {
    return written.has_value() ? document("{}") : error_response(403, written.error().str());
}

Response wrong(const Request &request) {
    return error_response(400, "'" + printable(request.method) + "' is not possible with " +
                                   printable(request.path));
}

}  // namespace

Response UserFiles::mdi_history(const Request &request) const {
    const std::string &path = facts_.files.mdi_history;
    if (path.empty()) {
        return error_response(404,
                              "[DISPLAY]MDI_HISTORY_FILE names no file: each browser keeps its own lines");
    }
    if (request.method == "GET") {
        const auto text = content(path);
        if (!text.has_value()) {
            return error_response(403, text.error().str());
        }
        std::vector<std::string> lines;
        std::istringstream read(*text);
        for (std::string line; std::getline(read, line);) {
            if (!trim(line).empty()) {
                lines.emplace_back(trim(line));
            }
        }
        const std::size_t first = lines.size() > MOST_LINES ? lines.size() - MOST_LINES : 0;
        return document(lines_document(std::span(lines).subspan(first)));
    }
    const auto lines = request.method == "PUT" ? read_lines(request.body, MOST_LINES) : std::nullopt;
    if (!lines.has_value()) {
        return error_response(400,
                              R"(lines are kept by PUT {"lines": [...]}, at most 500 without line breaks)");
    }
    std::string text;
    for (const std::string &line : *lines) {
        text += line + '\n';
    }
    return kept(write_file_atomically(path, text));
}

Response UserFiles::preferences(const Request &request) const {
    const std::string &path = facts_.files.preferences;
    if (path.empty()) {
        return error_response(404, "[DISPLAY]PREFERENCE_FILE_PATH names no file: each browser keeps its own");
    }
    if (request.method != "GET" && request.method != "PUT") {
        return wrong(request);
    }
    const auto old = content(path);
    if (!old.has_value()) {
        return error_response(403, old.error().str());
    }
    if (!old->empty() && !isObject(*old)) {
        return error_response(
            409, path + " is another screen's: name another file in [DISPLAY]PREFERENCE_FILE_PATH");
    }
    if (request.method == "GET") {
        return document(old->empty() ? "{}" : *old);
    }
    constexpr std::size_t MOST_BYTES = 65536;
    if (request.body.size() > MOST_BYTES || !isObject(request.body)) {
        return error_response(400, "preferences are an object of JSON of at most 64 KiB");
    }
    return kept(write_file_atomically(path, request.body));
}

Response UserFiles::icon() const {
    constexpr std::array<std::pair<const char *, const char *>, 4> TYPES{
        {{".png", "image/png"}, {".svg", "image/svg+xml"}, {".jpg", "image/jpeg"}, {".gif", "image/gif"}}};
    const auto *const type = std::ranges::find_if(
        TYPES, [this](const auto &one) { return to_lower(facts_.files.icon).ends_with(one.first); });
    if (facts_.files.icon.empty() || type == TYPES.end()) {
        return error_response(404, "[DISPLAY]ICON names no .png, .svg, .jpg or .gif");
    }
    auto picture = read_file(facts_.files.icon);
    if (!picture.has_value()) {
        return error_response(404, picture.error().str());
    }
    Response response;
    response.type = type->second;
    response.body = std::move(*picture);
    return response;
}

Response UserFiles::certificate() const {
    auto text = read_file(facts_.files.certificate);
    if (!text.has_value()) {
        return error_response(404, "no program has been certified: " + text.error().str());
    }
    Response response;
    response.type = "application/json";
    response.body = std::move(*text);
    return response;
}

Response UserFiles::offsets() const {
    const auto text = content(facts_.files.parameters);
    if (!text.has_value()) {
        return error_response(403, text.error().str());
    }
    constexpr int FIRST = 5221, STEP = 20, SYSTEMS = 9, NUMBERS = 10;
    std::vector<std::array<double, NUMBERS>> systems(SYSTEMS);
    std::istringstream read(*text);
    for (std::string line; std::getline(read, line);) {
        const auto words = split_words(line);
        const auto number = words.size() == 2 ? parse_int(words[0]) : std::nullopt;
        const auto value = words.size() == 2 ? parse_double(words[1]) : std::nullopt;
        const std::int64_t at = number.value_or(0) - FIRST;
        const bool offset = at >= 0 && at < SYSTEMS * STEP && at % STEP < NUMBERS;
        if (offset && value.has_value()) {
            systems[static_cast<std::size_t>(at / STEP)][static_cast<std::size_t>(at % STEP)] = *value;
        }
    }
    return document(offsets_document(systems));
}

}  // namespace mw::screen

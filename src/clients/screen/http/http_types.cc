// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/http/http_types.hh"

#include <charconv>

namespace mw::screen {
namespace {

bool isControl(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// Replaces %xx.
std::optional<std::string> decode(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '%') {
            unsigned value = 0;
            const std::string_view digits = text.substr(i + 1, 2);
            const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
            if (digits.size() != 2 || read.ec != std::errc() || read.ptr != digits.data() + 2) {
                return std::nullopt;
            }
            c = static_cast<char>(value);
            i += 2;
        }
        if (isControl(c)) {
            return std::nullopt;
        }
        out += c;
    }
    return out;
}

}  // namespace

std::optional<Request> parse_target(std::string_view target) {
    if (!target.starts_with('/')) {
        return std::nullopt;
    }
    Request request;
    const std::size_t mark = target.find('?');
    const auto path = decode(target.substr(0, mark));
    if (!path.has_value()) {
        return std::nullopt;
    }
    request.path = *path;
    std::string_view rest = mark == std::string_view::npos ? "" : target.substr(mark + 1);
    while (!rest.empty()) {
        const std::size_t end = rest.find('&');
        const std::string_view pair = rest.substr(0, end);
        rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
        const std::size_t equals = pair.find('=');
        const auto name = decode(pair.substr(0, equals));
        const auto value =
            decode(equals == std::string_view::npos ? std::string_view{} : pair.substr(equals + 1));
        if (!name.has_value() || !value.has_value()) {
            return std::nullopt;
        }
        request.query[*name] = *value;
    }
    return request;
}

}  // namespace mw::screen

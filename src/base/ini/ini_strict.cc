// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/ini/ini_strict.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::ini {
namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// A printing ASCII character without a meaning in the INI syntax.
bool isOfName(char c) {
    return c > ' ' && c < '\x7f' && std::string_view("[]=#;\"'\\").find(c) == std::string_view::npos;
}

bool isName(std::string_view name) {
    return std::all_of(name.begin(), name.end(), isOfName);
}

}  // namespace

std::optional<std::string> fault_of_header(std::string_view line) {
    const auto end = line.find(']');
    if (end == line.npos) {
        return "Invalid section. Missing ']'";
    }
    const std::string_view name = trim(line.substr(1, end - 1));
    if (name.empty()) {
        return "Invalid section. No content between '[' and ']'";
    }
    if (isDigit(name.front())) {
        return fmt::format("Invalid section '{}'. Cannot start with a digit", name);
    }
    return isName(name) ? std::nullopt
                        : std::optional(fmt::format(
                              "Invalid section '{}'. Identifier contains invalid character(s)", name));
}

std::optional<std::string> fault_of_setting(std::string_view line) {
    const auto equals = line.find('=');
    const std::string_view name = trim(line.substr(0, equals));
    if (equals == line.npos) {
        return fmt::format("Invalid tag '{}'. Expected '=' after tag identifier", name);
    }
    if (name.empty()) {
        return "Invalid tag. Missing identifier before '='";
    }
    if (isDigit(name.front())) {
        return fmt::format("Invalid tag '{}'. Tag identifiers cannot start with a digit", name);
    }
    return isName(name) ? std::nullopt
                        : std::optional(fmt::format(
                              "Invalid tag name '{}'. Identifier contains invalid character(s)", name));
}

}  // namespace mw::ini

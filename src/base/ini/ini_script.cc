// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/ini/ini_script.hh"

#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/ini/ini_value.hh"

namespace mw::ini {
namespace {

std::string label(const IniEntry &entry) {
    return fmt::format("[{}]{}='{}'", entry.section, entry.key, entry.value);
}

void invalid(const IniEntry &entry, const char *type, std::string &messages) {
    messages += fmt::format("{}error: Invalid {} {}\n", script_place(entry.place), type, label(entry));
}

void warn_of_rest(const IniEntry &entry, const char *type, const char *end, std::string &messages) {
    if (end != entry.value.data() + entry.value.size()) {
        messages += fmt::format("{}warning: Trailing character(s) in {} conversion ({})\n",
                                script_place(entry.place), type, label(entry));
    }
}

struct Whole {
    bool negative = false;
    std::uint64_t size = 0;
    const char *end = nullptr;  ///< text after the number; null when there is none
};

Whole read_whole(std::string_view text) {
    Whole out;
    if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
        out.negative = text[0] == '-';
        text.remove_prefix(1);
    }
    int base = 10;
    if (text.size() > 2 && text[0] == '0') {
        const char letter = static_cast<char>(text[1] | 0x20);
        base = letter == 'x' ? 16 : letter == 'o' ? 8 : letter == 'b' ? 2 : 10;
        text.remove_prefix(base == 10 ? 0 : 2);
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.size, base);
    out.end = error == std::errc() ? end : nullptr;
    return out;
}

}  // namespace

std::string script_place(const SourcePlace &place) {
    return place.line > 0 ? fmt::format("{}:{}: ", place.file, place.line) : place.file + ": ";
}

std::optional<bool> script_bool(const IniEntry &entry, std::string &messages) {
    const auto truth = ini_bool(entry.value);
    if (!truth) {
        invalid(entry, "boolean value", messages);
    }
    return truth;
}

std::optional<std::int64_t> script_signed(const IniEntry &entry, std::string &messages) {
    constexpr std::uint64_t LOWEST_SIZE = 1ULL << 63U;
    const Whole whole = read_whole(entry.value);
    if (whole.end == nullptr || whole.size > LOWEST_SIZE - (whole.negative ? 0 : 1)) {
        invalid(entry, "signed integer", messages);
        return std::nullopt;
    }
    warn_of_rest(entry, "signed integer", whole.end, messages);
    return static_cast<std::int64_t>(whole.negative ? 0 - whole.size : whole.size);
}

std::optional<std::uint64_t> script_unsigned(const IniEntry &entry, std::string &messages) {
    const Whole whole = read_whole(entry.value);
    if (whole.end == nullptr) {
        invalid(entry, "unsigned integer", messages);
        return std::nullopt;
    }
    if (whole.negative) {
        messages += script_place(entry.place) +
                    "warning: Unsigned integer conversion detected a leading minus sign (-)\n";
    }
    warn_of_rest(entry, "unsigned integer", whole.end, messages);
    return whole.negative ? 0 - whole.size : whole.size;
}

std::optional<double> script_real(const IniEntry &entry, std::string &messages) {
    const char *first = entry.value.data();
    const char *const last = first + entry.value.size();
    const bool has_plus = entry.value.size() > 1 && entry.value[0] == '+' && entry.value[1] != '-';
    double value = 0.0;
    const auto [end, error] = std::from_chars(first + (has_plus ? 1 : 0), last, value);
    if (error != std::errc() || !std::isfinite(value)) {
        invalid(entry, "floating point", messages);
        return std::nullopt;
    }
    warn_of_rest(entry, "floating point", end, messages);
    return value;
}

}  // namespace mw::ini

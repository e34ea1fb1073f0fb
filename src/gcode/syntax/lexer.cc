// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/lexer.hh"

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace mw::gcode::detail {
namespace {

constexpr double POWERS_OF_TEN[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                    1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

}  // namespace

bool Lexer::accept_word(std::string_view word) {
    const std::size_t start = pos_;
    for (const char c : word) {
        if (!accept(c)) {
            pos_ = start;
            return false;
        }
    }
    return true;
}

std::string Lexer::text_from(std::size_t start) const {
    std::string text(line_.substr(start, pos_ - start));
    std::erase_if(text, isBlank);
    return text;
}

Lexer::Number Lexer::take_number(double &value) {
    // Numbers with this many digits are exact doubles; one division by an exact power of ten rounds
    // correctly.
    constexpr std::ptrdiff_t EXACT_DIGITS = 15;
    const char *const begin = line_.data() + pos_;
    const char *const end = line_.data() + line_.size();
    const char *at = begin;
    std::int64_t digits = 0;
    const auto take_digits = [&at, &digits, end](std::ptrdiff_t most) {
        const char *const first = at;
        const char *const last = at + std::min(most, end - at);
        for (; at != last; ++at) {
            const unsigned digit = static_cast<unsigned char>(*at) - static_cast<unsigned>('0');
            if (digit > 9) {
                break;
            }
            digits = digits * 10 + digit;
        }
        return at - first;
    };
    std::ptrdiff_t count = take_digits(EXACT_DIGITS), decimals = 0;
    const bool is_fraction = at != end && *at == '.';
    if (is_fraction) {
        ++at;
        decimals = take_digits(EXACT_DIGITS - count);
        count += decimals;
    }
    while (at != end && isBlank(*at)) {
        ++at;
    }
    const bool ended = at == end || !(isDigit(*at) || *at == '.');
    if (count == 0 || !ended) {
        return take_odd_number(value);
    }
    pos_ = static_cast<std::size_t>(at - line_.data());
    value = static_cast<double>(digits) / POWERS_OF_TEN[decimals];
    return Number::OK;
}

/// Any number: with blanks, with many digits, or none at all.
Lexer::Number Lexer::take_odd_number(double &value) {
    std::string text;
    bool is_fraction = false, is_number = false;
    for (char c = peek(); isDigit(c) || (c == '.' && !is_fraction); c = peek()) {
        is_fraction = is_fraction || c == '.';
        is_number = is_number || c != '.';
        text += c;
        take();
    }
    if (!is_number) {
        return is_fraction ? Number::BAD : Number::NONE;
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() ? Number::OK : Number::BAD;
}

std::optional<std::string> Lexer::take_name(char closer) {
    const std::size_t pos = pos_;
    for (std::size_t i = pos_; i < line_.size(); ++i) {
        if (line_[i] == closer) {
            pos_ = i + 1;
            return folded_name(line_.substr(pos, i - pos));
        }
    }
    return std::nullopt;
}

std::string folded_name(std::string_view text) {
    constexpr std::string_view HAL_NAME = "_hal[";
    std::string name;
    bool kept = false;
    for (const char c : text) {
        if (!Lexer::isBlank(c)) {
            name += kept ? c : Lexer::lower(c);
            kept = kept || name == HAL_NAME;
        }
    }
    return name;
}

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/detail/lexer.hh"

#include <charconv>

namespace mw::interp::detail {
namespace {

constexpr bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

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
    // Digits that a double holds exactly, divided once by an exact power of ten, are correctly rounded.
    constexpr int EXACT_DIGITS = 15;
    std::uint64_t digits = 0;
    int count = 0, decimals = 0;
    bool isFraction = false;
    const std::size_t start = pos_;
    // Blanks inside of numbers are rare: without one the digits are taken straight from the line.
    const char *at = line_.data() + pos_;
    const char *const end_of_line = line_.data() + line_.size();
    const auto take_digits = [&] {
        const char *const first = at;
        for (; at != end_of_line && isDigit(*at); ++at) {
            digits =
                digits * 10 + static_cast<std::uint64_t>(*at - '0');  // wraps beyond EXACT_DIGITS: not used
        }
        return static_cast<int>(at - first);
    };
    count = take_digits();
    if (at != end_of_line && *at == '.') {
        isFraction = true;
        ++at;
        decimals = take_digits();
        count += decimals;
    }
    pos_ = static_cast<std::size_t>(at - line_.data());
    for (char c = peek(); isDigit(c) || (c == '.' && !isFraction); c = peek()) {
        if (c == '.') {
            isFraction = true;
        } else {
            if (count < EXACT_DIGITS) {
                digits = digits * 10 + static_cast<std::uint64_t>(c - '0');
            }
            ++count;
            decimals += isFraction ? 1 : 0;
        }
        take();
    }
    if (count == 0) {
        return isFraction ? Number::BAD : Number::NONE;
    }
    if (count <= EXACT_DIGITS) {
        // Signed numbers are the faster ones to convert.
        value = static_cast<double>(static_cast<std::int64_t>(digits)) / POWERS_OF_TEN[decimals];
        return Number::OK;
    }
    const std::string whole = text_from(start);
    const auto [end, error] = std::from_chars(whole.data(), whole.data() + whole.size(), value);
    return error == std::errc() ? Number::OK : Number::BAD;
}

std::optional<std::string> Lexer::take_name(char closer) {
    std::string name;
    for (std::size_t i = pos_; i < line_.size(); ++i) {
        if (line_[i] == closer) {
            pos_ = i + 1;
            return name;
        }
        if (!isBlank(line_[i])) {
            name += lower(line_[i]);
        }
    }
    return std::nullopt;
}

}  // namespace mw::interp::detail

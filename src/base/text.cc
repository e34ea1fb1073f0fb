// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/text.hh"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace mw {
namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

char lower(char c) {
    return (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
}

char upper(char c) {
    return (c >= 'a' && c <= 'z') ? static_cast<char>(c - 'a' + 'A') : c;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        row[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            const std::size_t cost = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
            row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + cost});
            diagonal = above;
        }
    }
    return row[b.size()];
}

template <class T>
std::optional<T> parse_whole(std::string_view digits, int base) {
    T value{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
    const bool whole = error == std::errc() && end == digits.data() + digits.size();
    return whole ? std::optional<T>(value) : std::nullopt;
}

/// Two digits for each number below 100.
constexpr std::array<char, 200> PAIRS = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < 100; ++i) {
        pairs[2 * i] = static_cast<char>('0' + i / 10);
        pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
}();

bool has_hex_prefix(std::string_view digits) {
    return digits.size() > 2 && digits[0] == '0' && lower(digits[1]) == 'x';
}

/// Text of a number without its sign.
struct Signed {
    bool is_negative = false;
    std::string_view digits;

    explicit Signed(std::string_view text) : digits(text) {
        const bool has_sign = !text.empty() && (text.front() == '-' || text.front() == '+');
        is_negative = has_sign && text.front() == '-';
        digits.remove_prefix(has_sign ? 1 : 0);
    }
    /// False when a second sign follows.
    bool has_digits() const { return !digits.empty() && digits.front() != '-' && digits.front() != '+'; }
};

enum class Octal { NO, YES };

/// Magnitude of an integer, without its sign.
std::optional<std::uint64_t> magnitude(const Signed &number, Octal octal) {
    if (!number.has_digits()) {
        return std::nullopt;
    }
    if (has_hex_prefix(number.digits)) {
        return parse_whole<std::uint64_t>(number.digits.substr(2), 16);
    }
    const bool is_octal = octal == Octal::YES && number.digits.size() > 1 && number.digits.front() == '0';
    return parse_whole<std::uint64_t>(number.digits, is_octal ? 8 : 10);
}

std::optional<std::int64_t> whole_int(const Signed &number, Octal octal) {
    constexpr auto LARGEST = std::uint64_t{std::numeric_limits<std::int64_t>::max()};
    const auto size = magnitude(number, octal);
    if (!size || *size > LARGEST + (number.is_negative ? 1 : 0)) {
        return std::nullopt;
    }
    return static_cast<std::int64_t>(number.is_negative ? 0 - *size : *size);
}

std::optional<std::uint64_t> whole_uint(const Signed &number, Octal octal) {
    const auto size = magnitude(number, octal);
    const bool is_below_zero = number.is_negative && size.value_or(1) != 0;
    return is_below_zero ? std::nullopt : size;
}

/// True if a number outside the range of double is too small rather than too large, by the sign of its
/// exponent.
bool is_below_one(std::string_view digits, bool is_hex) {
    const std::size_t exponent = digits.find_first_of(is_hex ? "pP" : "eE");
    return exponent != std::string_view::npos && exponent + 1 < digits.size() && digits[exponent + 1] == '-';
}

}  // namespace

std::optional<double> parse_double(std::string_view text) {
    if (!text.empty() && text.front() == '+') {
        text.remove_prefix(1);
        if (!text.empty() && text.front() == '-') {
            return std::nullopt;
        }
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

std::optional<double> parse_c_double(std::string_view text) {
    if (const auto decimal = parse_double(text)) {
        return decimal;
    }
    const Signed number(text);
    const bool is_hex = has_hex_prefix(number.digits);
    const std::string_view digits = number.digits.substr(is_hex ? 2 : 0);
    if (!number.has_digits() || digits.front() == '-') {
        return std::nullopt;
    }
    const auto format = is_hex ? std::chars_format::hex : std::chars_format::general;
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, format);
    if (end != digits.data() + digits.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    const bool is_tiny = error == std::errc::result_out_of_range && is_below_one(digits, is_hex);
    if (error != std::errc() && !is_tiny) {
        return std::nullopt;
    }
    const double size = is_tiny ? 0.0 : value;
    return number.is_negative ? -size : size;
}

std::optional<std::int64_t> parse_int(std::string_view text) {
    return whole_int(Signed(text), Octal::NO);
}

std::optional<std::uint64_t> parse_uint(std::string_view text) {
    return whole_uint(Signed(text), Octal::NO);
}

std::optional<std::int64_t> parse_c_int(std::string_view text) {
    return whole_int(Signed(text), Octal::YES);
}

std::optional<std::uint64_t> parse_c_uint(std::string_view text) {
    return whole_uint(Signed(text), Octal::YES);
}

std::string to_text(double value) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    return error == std::errc() ? std::string(buffer, end) : std::string("?");
}

std::size_t write_fixed4(std::span<char, FIXED4_SIZE> out, double value) {
    // The nearest whole number to value * 10,000 is correct unless the value is near a tie. The rounding of
    // the product is less than NEAR_TIE, or (from 2^44 on, where doubles are further apart and may be a tie)
    // less than their distance from the tie.
    constexpr double SCALE = 1e4, LARGEST = 1e14, NEAR_TIE = 1e-3;
    const double scaled = std::fabs(value) * SCALE;
    const bool small = scaled < LARGEST;  // false for NaN
    const auto whole = static_cast<std::int64_t>(small ? scaled : 0.0);
    const double rest = scaled - static_cast<double>(whole);
    if (!small || std::fabs(rest - 0.5) <= NEAR_TIE) {
        char *const begin = out.data();
        const auto made = std::to_chars(begin, begin + out.size(), value, std::chars_format::fixed, 4);
        return static_cast<std::size_t>(made.ptr - begin);
    }
    constexpr std::uint64_t DECIMALS = 10000;
    // the longest number has 17 characters: sign, eleven digits, point and four digits
    constexpr std::size_t MOST = 24;
    const std::uint64_t digits = static_cast<std::uint64_t>(whole) + (rest > 0.5 ? 1 : 0);
    char
        buffer[2 * MOST];  // twice, so that MOST characters can be copied from any position in the first half
    char *at = buffer + MOST;
    const auto put_pair = [&at](std::uint64_t pair) {
        at -= 2;
        std::memcpy(at, &PAIRS[2 * pair], 2);
    };
    put_pair(digits % 100);
    put_pair(digits % DECIMALS / 100);
    *--at = '.';
    std::uint64_t before = digits / DECIMALS;
    for (; before >= 100; before /= 100) {
        put_pair(before % 100);
    }
    if (before >= 10) {
        put_pair(before);
    } else {
        *--at = static_cast<char>('0' + before);
    }
    if (std::signbit(value)) {
        *--at = '-';
    }
    std::memcpy(out.data(), at, MOST);
    return static_cast<std::size_t>(buffer + MOST - at);
}

std::string shell_word(std::string_view text) {
    constexpr std::string_view PLAIN =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+@:,";
    if (!text.empty() && text.find_first_not_of(PLAIN) == std::string_view::npos) {
        return std::string(text);
    }
    std::string out = "'";
    for (const char c : text) {
        out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out + "'";
}

std::string printable(std::string_view text) {
    constexpr unsigned char DELETE = 0x7f, C1_LEAD = 0xc2, C1_FIRST = 0x80, C1_LAST = 0x9f;
    std::string out(text);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto c = static_cast<unsigned char>(out[i]);
        const auto next = i + 1 < out.size() ? static_cast<unsigned char>(out[i + 1]) : 0;
        if ((c < ' ' && c != '\t' && c != '\n') || c == DELETE) {
            out[i] = '?';
        } else if (c == C1_LEAD && next >= C1_FIRST && next <= C1_LAST) {
            out[i] = out[i + 1] = '?';
        }
    }
    return out;
}

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view MARK = "\xEF\xBB\xBF";
    return text.starts_with(MARK) ? text.substr(MARK.size()) : text;
}

std::string_view trim(std::string_view text) {
    while (!text.empty() && isBlank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && isBlank(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

std::string to_lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), lower);
    return out;
}

std::string to_upper(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), upper);
    return out;
}

bool equals_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

std::vector<std::string> split_words(std::string_view text) {
    std::vector<std::string> words;
    std::size_t i = 0;
    while (i < text.size()) {
        while (i < text.size() && isBlank(text[i])) {
            ++i;
        }
        const std::size_t start = i;
        while (i < text.size() && !isBlank(text[i])) {
            ++i;
        }
        if (i > start) {
            words.emplace_back(text.substr(start, i - start));
        }
    }
    return words;
}

std::string nearest_name(std::string_view name, const std::vector<std::string> &candidates) {
    std::size_t best = name.size() / 3 + 1;
    std::string found;
    // A longer or abbreviated name is a better match than a name with other letters.
    constexpr std::size_t LEAST_PREFIX = 6;
    for (const std::string &candidate : candidates) {
        const std::size_t common = std::min(name.size(), candidate.size());
        const bool is_cut = common >= LEAST_PREFIX && common != std::max(name.size(), candidate.size()) &&
                            name.substr(0, common) == candidate.substr(0, common) &&
                            std::max(name.size(), candidate.size()) <= 2 * common;
        if (is_cut) {
            return candidate;
        }
    }
    for (const std::string &candidate : candidates) {
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < best) {
            best = distance;
            found = candidate;
        }
    }
    return found;
}

}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
// Small text helpers. Reading and writing numbers is independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mw {

/// `text` as a number ("1", "-2.5", "+.15", "4.2e1"); nothing if characters are left over or the value is not
/// finite. A decimal comma is not accepted.
std::optional<double> parse_double(std::string_view text);

/// As parse_double(), and hexadecimal in C syntax ("-0x10", "0x1.8p3"). A value that is too small becomes 0.
std::optional<double> parse_c_double(std::string_view text);

/// `text` as an integer, decimal or with prefix 0x after the sign; nothing if characters are left over or on
/// overflow.
std::optional<std::int64_t> parse_int(std::string_view text);
std::optional<std::uint64_t> parse_uint(std::string_view text);

/// As parse_int(), and octal with prefix 0, as in C: "010" is 8 and "08" is nothing.
std::optional<std::int64_t> parse_c_int(std::string_view text);
std::optional<std::uint64_t> parse_c_uint(std::string_view text);

/// Shortest text that reads back as the same double.
std::string to_text(double value);

/// Sufficient for any number that write_fixed4() writes: the largest double has 309 digits before the point.
inline constexpr std::size_t FIXED4_SIZE = 320;
/// Writes `value` as printf's "%.4f" does in the C locale, without a terminating zero. @return its length
std::size_t write_fixed4(std::span<char, FIXED4_SIZE> out, double value);

/// `text` for a terminal: each byte of control characters other than tab and newline becomes a question mark.
std::string printable(std::string_view text);

/// `text` quoted as one word of a shell, if it has other characters than letters, digits and _ - . / + @ : ,
std::string shell_word(std::string_view text);

/// `text` without the UTF-8 byte order mark that some editors write at the start of a file.
std::string_view without_byte_order_mark(std::string_view text);

std::string_view trim(std::string_view text);
std::string to_lower(std::string_view text);
std::string to_upper(std::string_view text);
bool equals_ignoring_case(std::string_view a, std::string_view b);
std::vector<std::string> split_words(std::string_view text);

/// The candidate that differs from `name` in the fewest edits, or empty when none is near
/// (at most a third of the name's length).
std::string nearest_name(std::string_view name, const std::vector<std::string> &candidates);

}  // namespace mw

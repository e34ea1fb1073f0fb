// SPDX-License-Identifier: GPL-2.0-or-later
// Small text helpers. Numbers are read and written without any regard to the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mw {

/// The whole of `text` as a number ("1", "-2.5", "+.15", "4.2e1"); nothing when anything is left over or the
/// value is not finite. A decimal comma is never accepted.
std::optional<double> parse_double(std::string_view text);

/// As parse_double(), and hexadecimal as C writes it ("-0x10", "0x1.8p3"). Too small a value is 0.
std::optional<double> parse_c_double(std::string_view text);

/// The whole of `text` as an integer, decimal or with prefix 0x, which follows the sign; nothing on leftovers
/// or overflow.
std::optional<std::int64_t> parse_int(std::string_view text);
std::optional<std::uint64_t> parse_uint(std::string_view text);

/// As parse_int(), and octal with prefix 0, as in C: "010" is 8 and "08" is nothing.
std::optional<std::int64_t> parse_c_int(std::string_view text);
std::optional<std::uint64_t> parse_c_uint(std::string_view text);

/// Shortest text that reads back as the same double.
std::string to_text(double value);

/// Room for any number that write_fixed4() writes: the largest double has 309 digits before the point.
inline constexpr std::size_t FIXED4_SIZE = 320;
/// Writes `value` as printf's "%.4f" does in the C locale, without an end. @return its length
std::size_t write_fixed4(std::span<char, FIXED4_SIZE> out, double value);

/// `text` for a terminal: control characters but tabs and newlines become question marks, one for each byte.
std::string printable(std::string_view text);

/// `text` as one word of a shell: in single quotes where it has more than letters, digits and _ - . / + @ : ,
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

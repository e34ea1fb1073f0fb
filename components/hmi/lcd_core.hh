// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers and texts for a character display, without HAL. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::lcd {

constexpr int MAX_FIELD = 20;

/// One item of a page: a plain character, or a number in a field.
struct Item {
    enum class Kind : std::uint8_t { CHARACTER, FLOAT, SIGNED, UNSIGNED, HEX, OCTAL, CHAR_CODE, BIT };
    Kind kind = Kind::CHARACTER;
    std::uint8_t character = 0;
    std::uint8_t other = 0;  ///< for a BIT: the character for false
    std::uint8_t width = 0;  ///< 0: as wide as needed
    std::uint8_t decimals = 4;
    bool zero_padded = false;
    bool has_plus = false;
};

/// The contents of a field.
struct Text {
    char text[MAX_FIELD + 24];
    int length = 0;

    void add(char c) noexcept {
        if (length < static_cast<int>(sizeof text)) {
            text[length++] = c;
        }
    }
};

/// Reads the format item at the start of `text` and moves `text` past it. False when it is invalid.
bool parse_item(const char *&text, Item &out) noexcept;

/// `value` in the field; a number that does not fit is shown as asterisks.
Text show_float(const Item &item, double value, char separator) noexcept;
Text show_integer(const Item &item, std::uint32_t magnitude, bool negative) noexcept;
/// For CHAR_CODE and BIT.
Text show_character(const Item &item, std::uint32_t value) noexcept;

}  // namespace mw::lcd

// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/hmi/lcd_core.hh"

#include <cmath>

namespace mw::lcd {

namespace {

int hex_digit(char c) noexcept {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// Reads a character or \NN, and moves `text` past it.
bool parse_character(const char *&text, std::uint8_t &out) noexcept {
    if (*text == '\0') {
        return false;
    }
    if (*text != '\\') {
        out = static_cast<std::uint8_t>(*text++);
        return true;
    }
    const int high = hex_digit(text[1]);
    const int low = high < 0 ? -1 : hex_digit(text[2]);
    if (low >= 0) {
        out = static_cast<std::uint8_t>(16 * high + low);
        text += 3;
        return true;
    }
    if (text[1] == '\\') {
        out = '\\';
        text += 2;
        return true;
    }
    return false;
}

bool parse_number(const char *&text, std::uint8_t &out, int most) noexcept {
    int number = 0;
    while (*text >= '0' && *text <= '9') {
        number = 10 * number + (*text++ - '0');
        if (number > most) {
            return false;
        }
    }
    out = static_cast<std::uint8_t>(number);
    return true;
}

bool parse_kind(const char *&text, Item &out) noexcept {
    switch (*text++) {
    case 'f':
    case 'F': out.kind = Item::Kind::FLOAT; return true;
    case 'i':
    case 'd': out.kind = Item::Kind::SIGNED; return true;
    case 'u': out.kind = Item::Kind::UNSIGNED; return true;
    case 'x':
    case 'X': out.kind = Item::Kind::HEX; return true;
    case 'o': out.kind = Item::Kind::OCTAL; return true;
    case 'c': out.kind = Item::Kind::CHAR_CODE; return true;
    case 'b':
        out.kind = Item::Kind::BIT;
        return parse_character(text, out.character) && parse_character(text, out.other);
    default: return false;
    }
}

/// Adds sign and padding to `digits`, so that they fill the field of the item.
Text in_field(const Item &item, const Text &digits, bool negative) noexcept {
    const char sign = negative ? '-' : (item.has_plus ? '+' : '\0');
    const int needed = digits.length + (sign != '\0' ? 1 : 0);
    const int width = item.width > 0 ? item.width : needed;
    Text out;
    if (needed > width) {
        for (int i = 0; i < width; ++i) {
            out.add(i == 0 && sign != '\0' ? sign : '*');
        }
        return out;
    }
    for (int i = needed; i < width && !item.zero_padded; ++i) {
        out.add(' ');
    }
    if (sign != '\0') {
        out.add(sign);
    }
    for (int i = needed; i < width && item.zero_padded; ++i) {
        out.add('0');
    }
    for (int i = 0; i < digits.length; ++i) {
        out.add(digits.text[i]);
    }
    return out;
}

void add_digits(Text &out, std::uint64_t value, unsigned base, int least) noexcept {
    char reversed[MAX_FIELD + 4];
    int count = 0;
    while (count < static_cast<int>(sizeof reversed) && (value > 0 || count < least)) {
        reversed[count++] = "0123456789ABCDEF"[value % base];
        value /= base;
    }
    while (count > 0) {
        out.add(reversed[--count]);
    }
}

}  // namespace

bool parse_item(const char *&text, Item &out) noexcept {
    out = Item{};
    if (*text != '%') {
        return parse_character(text, out.character);
    }
    ++text;
    if (*text == '%') {
        out.character = '%';
        ++text;
        return true;
    }
    while (*text == ' ' || *text == '0' || *text == '+') {
        out.zero_padded = out.zero_padded || *text == '0';
        out.has_plus = out.has_plus || *text == '+';
        ++text;
    }
    if (!parse_number(text, out.width, MAX_FIELD)) {
        return false;
    }
    if (*text == '.') {
        ++text;
        if (!parse_number(text, out.decimals, MAX_FIELD - 2)) {
            return false;
        }
    }
    return parse_kind(text, out);
}

Text show_float(const Item &item, double value, char separator) noexcept {
    double scale = 1.0;
    for (int i = 0; i < item.decimals; ++i) {
        scale *= 10.0;
    }
    const double scaled = std::round(std::fabs(value) * scale);
    Text digits;
    if (!(scaled < 1e18)) {  // too large, or NaN
        for (int i = 0; i < (item.width > 0 ? item.width : 6); ++i) {
            digits.add('*');
        }
        return digits;
    }
    const auto whole = static_cast<std::uint64_t>(scaled);
    const auto unit = static_cast<std::uint64_t>(scale);
    add_digits(digits, whole / unit, 10, 1);
    if (item.decimals > 0) {
        digits.add(separator);
        add_digits(digits, whole % unit, 10, item.decimals);
    }
    return in_field(item, digits, value < 0.0);
}

Text show_integer(const Item &item, std::uint32_t magnitude, bool negative) noexcept {
    const unsigned base = item.kind == Item::Kind::HEX ? 16 : (item.kind == Item::Kind::OCTAL ? 8 : 10);
    Text digits;
    add_digits(digits, magnitude, base, 1);
    return in_field(item, digits, negative);
}

Text show_character(const Item &item, std::uint32_t value) noexcept {
    Text out;
    if (item.kind == Item::Kind::BIT) {
        out.add(static_cast<char>(value != 0 ? item.character : item.other));
        return out;
    }
    constexpr std::uint32_t FIRST_VISIBLE = 32;
    const int times = item.width > 0 ? item.width : 1;
    for (int i = 0; i < times && value >= FIRST_VISIBLE && value < 256; ++i) {
        out.add(static_cast<char>(value));
    }
    return out;
}

}  // namespace mw::lcd

// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/machine/raster_core.hh"

#include <cmath>

namespace mw::raster {

namespace {

/// The power of ten after an 'e', up to two digits; 1 when there is none. Moves `text` past it.
double read_exponent(const char *&text) noexcept {
    constexpr int MOST = 12;
    if ((*text | 0x20) != 'e') {
        return 1.0;
    }
    ++text;
    const bool negative = *text == '-';
    text += negative || *text == '+' ? 1 : 0;
    int exponent = 0;
    for (int digits = 0; digits < 2 && *text >= '0' && *text <= '9'; ++digits) {
        exponent = 10 * exponent + (*text++ - '0');
    }
    double power = 1.0;
    for (int i = 0; i < exponent && i <= MOST; ++i) {
        power *= 10.0;
    }
    return negative ? 1.0 / power : power;
}

/// Reads a decimal number that ends with the character `end`, and moves `text` past that character. False
/// when there is none.
bool read_number(const char *&text, char end, double &out) noexcept {
    constexpr double LARGEST = 1e12;
    const bool negative = *text == '-';
    text += negative ? 1 : 0;
    double number = 0.0;
    double place = 0.0;  // place of the last digit after the point: 10, 100, ...; 0 before the point
    bool has_digit = false;
    for (; (*text >= '0' && *text <= '9') || (*text == '.' && place == 0.0); ++text) {
        if (*text == '.') {
            place = 1.0;
            continue;
        }
        has_digit = true;
        number = 10.0 * number + (*text - '0');
        place *= 10.0;
    }
    number = place > 1.0 ? number / place : number;
    number *= has_digit ? read_exponent(text) : 1.0;
    const bool whole = has_digit && *text == end && number <= LARGEST;
    text += whole ? 1 : 0;
    out = negative ? -number : number;
    return whole;
}

}  // namespace

/// Evaluates the header field that has just ended with ';'. Returns the error, or HEADER or PIXELS.
Reading Line::take_field() noexcept {
    const char *text = header_;
    header_[header_size_ - 1] = ';';
    double number = 0.0;
    const bool is_read = read_number(text, ';', number);
    header_size_ = 0;
    switch (fields_++) {
    case 0: offset_ = number; return is_read ? Reading::HEADER : Reading::BAD_OFFSET;
    case 1: {
        const int digits = is_read && number >= 4.0 && number <= 32.0 ? static_cast<int>(number) / 4 : 0;
        digits_ = digits;
        return digits > 0 && number == 4.0 * digits ? Reading::HEADER : Reading::BAD_BITS;
    }
    case 2: per_unit_ = number; return is_read && number > 0.0 ? Reading::HEADER : Reading::BAD_SCALE;
    default: {
        const bool good = is_read && number >= 2.0 && number <= MAX_PIXELS && number == std::floor(number);
        count_ = good ? static_cast<int>(number) : 0;
        pixels_ = 0;
        digit_ = 0;
        return good ? Reading::PIXELS : Reading::BAD_COUNT;
    }
    }
}

void Line::take_header(char byte) noexcept {
    if (header_size_ >= MAX_FIELD - 1) {
        constexpr Reading BAD[] = {Reading::BAD_OFFSET, Reading::BAD_BITS, Reading::BAD_SCALE,
                                   Reading::BAD_COUNT};
        reading_ = BAD[fields_];
        return;
    }
    header_[header_size_++] = byte;
    if (byte == ';') {
        reading_ = take_field();
    }
}

void Line::take_pixel(char byte) noexcept {
    const char lower = static_cast<char>(byte | 0x20);
    const bool decimal = byte >= '0' && byte <= '9';
    const bool is_letter = lower >= 'a' && lower <= 'f';
    if (!decimal && !is_letter) {
        reading_ = Reading::BAD_PIXEL;
        return;
    }
    const unsigned nibble = static_cast<unsigned>(decimal ? byte - '0' : lower - 'a' + 10);
    const unsigned before = digit_ == 0 ? 0U : pixel_[pixels_];
    pixel_[pixels_] = before << 4U | nibble;
    if (++digit_ == digits_) {
        digit_ = 0;
        if (++pixels_ == count_) {
            reading_ = Reading::COMPLETE;
        }
    }
}

void Line::take(char byte) noexcept {
    if (reading_ == Reading::NOTHING && byte != '\n') {
        header_size_ = 0;
        fields_ = 0;
        reading_ = Reading::HEADER;
    }
    if (reading_ == Reading::HEADER) {
        take_header(byte);
    } else if (reading_ == Reading::PIXELS && byte != '\n') {
        take_pixel(byte);
    }
}

double Line::percent(int index) const noexcept {
    const std::uint32_t highest =
        digits_ == 8 ? 0xffffffffU : (1U << (4U * static_cast<unsigned>(digits_))) - 1U;
    return pixel_[index] == highest ? NO_PIXEL : 100.0 * pixel_[index] / (highest - 1U);
}

double Line::way(double from_start) const noexcept {
    const double from_first = from_start - offset_;
    return (offset_ < 0.0 ? -from_first : from_first) * per_unit_;
}

}  // namespace mw::raster

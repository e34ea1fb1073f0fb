// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/utf8.hh"

#include <array>

namespace mw {

Utf8Character first_character(std::string_view text) {
    const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80U) {
        return {1, first};
    }
    const std::size_t size = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
    if (first < 0xC2U || first > 0xF4U || text.size() < size) {
        return {};
    }
    char32_t code = first & (0xFFU >> (size + 1));
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) {
            return {};
        }
        code = (code << 6U) | (byte(i) & 0x3FU);
    }
    constexpr std::array<char32_t, 5> LEAST{0, 0, 0x80U, 0x800U, 0x10000U};
    const bool isSurrogate = code >= 0xD800U && code <= 0xDFFFU;
    return code >= LEAST[size] && code <= 0x10FFFFU && !isSurrogate ? Utf8Character{size, code}
                                                                    : Utf8Character{};
}

}  // namespace mw

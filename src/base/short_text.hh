// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace mw {

/// `text` for a message that quotes a file, which may have megabytes in one line: a text of more than 1000
/// bytes is cut after 300 and ends in "...". UTF-8 characters are not split.
inline std::string short_text(std::string_view text) {
    constexpr std::size_t LONGEST = 1000, SHOWN = 300;
    if (text.size() <= LONGEST) {
        return std::string(text);
    }
    std::size_t end = SHOWN;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) {
        --end;
    }
    return std::string(text.substr(0, end)) + "...";
}

}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
// Characters of texts in UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace mw {

struct Utf8Character {
    std::size_t size = 0;  ///< [bytes]; 0: the text does not begin with valid UTF-8
    char32_t code = 0;
};

/// The character at the front of `text`, which is not empty. Overlong forms, surrogates and codes above
/// U+10FFFF are not valid.
Utf8Character first_character(std::string_view text);

}  // namespace mw

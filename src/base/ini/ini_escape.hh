// SPDX-License-Identifier: GPL-2.0-or-later
// Escapes in the values of INI files, for the readers that support them (inivalue, Python).
#pragma once

#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::ini {

/// The value with its escapes replaced: backslash and one of `a b f n r t v \ " '`, one to three octal
/// digits, xHH, uHHHH (two of them for a surrogate pair) or UHHHHHHHH. Any other backslash is kept.
/// The result is valid UTF-8 without a null character, or an error.
Result<std::string> decode_ini_value(std::string_view text);

/// Text that decode_ini_value() reads as `value`, and that keeps blanks at its ends.
std::string encode_ini_value(std::string_view value);

}  // namespace mw::ini

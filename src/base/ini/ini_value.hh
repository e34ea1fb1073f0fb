// SPDX-License-Identifier: GPL-2.0-or-later
// Meaning of words in an INI file.
#pragma once

#include <optional>
#include <string_view>

namespace mw::ini {

/// TRUE YES ON 1 / FALSE NO OFF 0 in any case; nothing for any other word.
std::optional<bool> ini_bool(std::string_view value);

}  // namespace mw::ini

// SPDX-License-Identifier: GPL-2.0-or-later
// What words in an INI file mean.
#pragma once

#include <optional>
#include <string_view>

namespace mw::ini {

/// TRUE YES ON 1 / FALSE NO OFF 0 in any case; nothing for any other word.
std::optional<bool> ini_bool(std::string_view value);

}  // namespace mw::ini

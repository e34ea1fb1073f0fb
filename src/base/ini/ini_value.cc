// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/ini/ini_value.hh"

#include "base/text.hh"

namespace mw::ini {

std::optional<bool> ini_bool(std::string_view value) {
    for (const char *word : {"TRUE", "YES", "ON", "1"}) {
        if (equals_ignoring_case(value, word)) {
            return true;
        }
    }
    for (const char *word : {"FALSE", "NO", "OFF", "0"}) {
        if (equals_ignoring_case(value, word)) {
            return false;
        }
    }
    return std::nullopt;
}

}  // namespace mw::ini

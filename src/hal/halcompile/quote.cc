// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/quote.hh"

#include <fmt/core.h>

namespace mw::halcompile {

std::string c_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\' || c == '?') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (byte < 0x20 || byte == 0x7f) {
            out += fmt::format("\\{:03o}", static_cast<unsigned>(byte));
        } else {
            out += c;
        }
    }
    return out + '"';
}

}  // namespace mw::halcompile

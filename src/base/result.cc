// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/result.hh"

#include "base/short_text.hh"

namespace mw {

std::string SourcePlace::str() const {
    std::string out = file;
    if (line > 0) {
        out += ':' + std::to_string(line);
        if (column > 0) {
            out += ':' + std::to_string(column);
        }
    }
    return out;
}

std::string Error::str() const {
    std::string out = place.str();
    if (!out.empty()) {
        out += ": ";
    }
    out += short_text(message);
    if (!hint.empty()) {
        out += " (" + short_text(hint) + ')';
    }
    return out;
}

}  // namespace mw

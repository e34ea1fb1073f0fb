// SPDX-License-Identifier: GPL-2.0-or-later
// The encodings of a message as bytes.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace mw::nml {

enum class Encoding : std::uint8_t {
    RAW,      ///< numbers in the format of this processor
    XDR,      ///< External Data Representation, RFC 4506: for other hosts
    ASCII,    ///< values as text, one after the other
    DISPLAY,  ///< a line "name=value" for each value, for persons
};
inline constexpr std::array ALL_ENCODINGS{Encoding::RAW, Encoding::XDR, Encoding::ASCII, Encoding::DISPLAY};

constexpr std::string_view name_of(Encoding encoding) {
    switch (encoding) {
    case Encoding::RAW: return "raw";
    case Encoding::XDR: return "xdr";
    case Encoding::ASCII: return "ascii";
    case Encoding::DISPLAY: return "disp";
    }
    return "";
}

}  // namespace mw::nml

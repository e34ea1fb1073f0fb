// SPDX-License-Identifier: GPL-2.0-or-later
// Reads compiled objects (64-bit ELF in this machine's byte order).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::halcompile {

struct ObjectFacts {
    std::vector<std::string> exported;   ///< named by EXPORT_SYMBOL
    std::vector<std::string> defined;    ///< global symbols that the object defines
    std::vector<std::string> undefined;  ///< global symbols that it needs
};

/// Reads the bytes of an object; an error when they are not an object.
Result<ObjectFacts> look_at_object(std::string_view bytes, const std::string &file);

}  // namespace mw::halcompile

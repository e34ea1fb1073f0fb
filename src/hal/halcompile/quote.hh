// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace mw::halcompile {

/// The text as a C string literal with its quotes.
std::string c_string(std::string_view text);

}  // namespace mw::halcompile

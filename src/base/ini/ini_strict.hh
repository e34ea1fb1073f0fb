// SPDX-License-Identifier: GPL-2.0-or-later
// Syntax of a line of an INI file for the strict readers (IniSyntax::STRICT).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mw::ini {

/// The error in a trimmed line that starts with '['; nothing if it is a section header. Text after the ']' is
/// allowed.
std::optional<std::string> fault_of_header(std::string_view line);

/// The error in a trimmed line that is not empty, not a comment and not a header.
std::optional<std::string> fault_of_setting(std::string_view line);

}  // namespace mw::ini

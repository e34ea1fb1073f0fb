// SPDX-License-Identifier: GPL-2.0-or-later
// What a line of an INI file must look like for the strict readers (IniSyntax::STRICT).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mw::ini {

/// What is wrong with a trimmed line that starts with '['; nothing when it is a section's header. Text after
/// the ']' is no fault.
std::optional<std::string> fault_of_header(std::string_view line);

/// What is wrong with a trimmed line that is neither empty, a comment nor a header.
std::optional<std::string> fault_of_setting(std::string_view line);

}  // namespace mw::ini

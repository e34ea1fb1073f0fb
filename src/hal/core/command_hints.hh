// SPDX-License-Identifier: GPL-2.0-or-later
// Programs and modules that users of such controllers know, that configurations call, and that are not here.
#pragma once

#include <string>
#include <string_view>

namespace mw::hal {

/// What to do where `name` is such a module or program: a hint for the error that says it is not there. Empty
/// for any other name.
std::string hint_for_absent(std::string_view name);

}  // namespace mw::hal

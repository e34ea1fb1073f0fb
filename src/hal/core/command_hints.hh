// SPDX-License-Identifier: GPL-2.0-or-later
// Programs and modules of LinuxCNC that configurations use and that Millwright does not have.
#pragma once

#include <string>
#include <string_view>

namespace mw::hal {

/// Hint for the error that the module or program `name` does not exist. Empty for other names.
std::string hint_for_absent(std::string_view name);

}  // namespace mw::hal

// SPDX-License-Identifier: GPL-2.0-or-later
// Programs as a shell would find them.
#pragma once

#include <string>

namespace mw {

/// The whole path of an executable file: a name with a slash relative to `folder`, any other one in `folder`
/// and then along PATH. Empty when there is none.
std::string find_program(const std::string &name, const std::string &folder);

}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
// The reference page docs/reference/messages.md, generated from the declarations.
#pragma once

#include <string>

namespace mw::messages {

std::string reference_page();

}  // namespace mw::messages

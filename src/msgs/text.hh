// SPDX-License-Identifier: GPL-2.0-or-later
// One line of text for logs and people.
#pragma once

#include <string>

#include "msgs/describe.hh"

namespace mw::msgs {

/// "JogStop is_joint=true index=0".
std::string to_text(const ConstObject &message);

}  // namespace mw::msgs

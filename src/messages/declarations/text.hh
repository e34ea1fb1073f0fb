// SPDX-License-Identifier: GPL-2.0-or-later
// A message as one line of text, for logs and people.
#pragma once

#include <string>
#include <string_view>

#include "messages/declarations/describe.hh"

namespace mw::messages {

/// "JogStop is_joint=true index=0".
std::string to_text(const ConstObject &message);
/// The text in quotes; characters that would break a line are written as \", \\ and \xNN.
std::string quoted(std::string_view text);

}  // namespace mw::messages

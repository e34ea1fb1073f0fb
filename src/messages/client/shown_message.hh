// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include "messages/client/viewer.hh"

namespace mw::client {

/// A line for the operator in the language of this process's environment. Texts of programs and clients
/// (OPERATOR_DISPLAY) are not translated.
std::string shown_message(const Viewer::Message &message);

}  // namespace mw::client

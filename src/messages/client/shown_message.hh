// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include "messages/client/viewer.hh"

namespace mw::client {

/// A line for the operator as a person reads it: in the language of this process's environment, but what
/// programs say (OPERATOR_DISPLAY: (MSG,), clients), which is in that of whoever wrote it.
std::string shown_message(const Viewer::Message &message);

}  // namespace mw::client

// SPDX-License-Identifier: GPL-2.0-or-later
// The commands that task accepts and the names of its states are declared in messages/declarations.
#pragma once

#include "messages/declarations/command.hh"

namespace mw::task {

using namespace messages;  // NOLINT(google-build-using-namespace): task uses the names of messages

}  // namespace mw::task

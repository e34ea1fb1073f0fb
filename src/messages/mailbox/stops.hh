// SPDX-License-Identifier: GPL-2.0-or-later
// Commands that stop or pause the machine: any client may post them at any time.
#pragma once

#include <optional>

#include "messages/declarations/command.hh"

namespace mw::mailbox {

/// Never subject to another's right to operate, and has a separate slot beside the queue of its client.
bool isStop(const messages::Command &command);

/// As many as there are different stops: each type, of each joint and axis.
inline constexpr int STOP_PLACES = 36;
/// The slot of a stop; nothing for a command that is none.
std::optional<int> stop_place(const messages::Command &command);
/// The stop that has this slot, from 0 to STOP_PLACES - 1.
messages::Command stop_at(int place);

}  // namespace mw::mailbox

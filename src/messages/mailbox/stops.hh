// SPDX-License-Identifier: GPL-2.0-or-later
// Commands that stop or pause the machine. Any client may post them at any time.
#pragma once

#include <optional>

#include "messages/declarations/command.hh"

namespace mw::mailbox {

/// True for a stop. Another client's right to operate never affects it, and it has a separate slot beside the
/// queue of its client.
bool isStop(const messages::Command &command);

/// Number of different stops: each type, for each joint and axis.
inline constexpr int STOP_PLACES = 36;
/// The slot of a stop; nothing for other commands.
std::optional<int> stop_place(const messages::Command &command);
/// The stop of a slot, from 0 to STOP_PLACES - 1.
messages::Command stop_at(int place);

}  // namespace mw::mailbox

// SPDX-License-Identifier: GPL-2.0-or-later
// Slots of the mailbox and the clients that may use them.
#pragma once

namespace mw::mailbox {

/// The first slots are reserved for servers of screens, so that each screen can stop the machine however many
/// clients there are.
inline constexpr int RESERVED_CLIENTS = 2;

enum class Places { ORDINARY, RESERVED };

}  // namespace mw::mailbox

// SPDX-License-Identifier: GPL-2.0-or-later
// Which clients may take which places of the mailbox.
#pragma once

namespace mw::mailbox {

/// The first places are for servers of screens alone: through them each screen can stop the machine, however
/// many clients there are.
inline constexpr int RESERVED_CLIENTS = 2;

enum class Places { ORDINARY, RESERVED };

}  // namespace mw::mailbox

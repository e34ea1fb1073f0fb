// SPDX-License-Identifier: GPL-2.0-or-later
// Processes as the realtime process sees them.
#pragma once

#include <cstdint>

namespace mw::hal {

/// Of the process that a pidfd names; 0: none.
std::int32_t pid_of(int fd);

}  // namespace mw::hal

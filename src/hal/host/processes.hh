// SPDX-License-Identifier: GPL-2.0-or-later
// Processes as seen by the realtime process.
#pragma once

#include <cstdint>

namespace mw::hal {

/// Id of the process of a pidfd; 0 if there is none.
std::int32_t pid_of(int fd);

}  // namespace mw::hal

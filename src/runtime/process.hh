// SPDX-License-Identifier: GPL-2.0-or-later
// Identity of a process, safe against reuse of process ids.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.hh"

namespace mw::runtime {

struct ProcessId {
    std::int32_t pid = 0;
    std::uint64_t start_time = 0;  ///< clock ticks since boot

    bool operator==(const ProcessId &) const noexcept = default;
};

ProcessId this_process();
/// False when that process has ended (or is a zombie), even if its id has been reused.
bool isAlive(const ProcessId &process);

/// The folder of this user's sockets and locks, mode 0700: $XDG_RUNTIME_DIR/millwright or
/// /tmp/millwright-UID. It is an error if the folder belongs to another user or other users may enter it.
Result<std::string> runtime_folder();

}  // namespace mw::runtime

// SPDX-License-Identifier: GPL-2.0-or-later
// Who a process is, safe against process ids that are used again.
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
/// False when that process is gone (or a zombie), even if its number belongs to another one now.
bool isAlive(const ProcessId &process);

/// The folder of this user's sockets and locks: $XDG_RUNTIME_DIR/millwright or /tmp/millwright-UID, made with
/// mode 0700; an error when it belongs to someone else or others may enter it.
Result<std::string> runtime_folder();

}  // namespace mw::runtime

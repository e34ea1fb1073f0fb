// SPDX-License-Identifier: GPL-2.0-or-later
// Reserves descriptors for connections, so that files of clients cannot block stops.
#pragma once

#include <sys/resource.h>

#include <algorithm>

namespace mw::screen {

inline constexpr rlim_t RESERVED_DESCRIPTORS = 32;

/// True if `fd` is in the reserve and must not be used for a file. The kernel assigns the lowest free number.
inline bool isReserved(int fd) {
    rlimit limit{};
    return fd >= 0 && ::getrlimit(RLIMIT_NOFILE, &limit) == 0 &&
           static_cast<rlim_t>(fd) + RESERVED_DESCRIPTORS >= limit.rlim_cur;
}

/// Raises the limit to the maximum that this process may have and a server can need.
inline void raise_descriptor_limit() {
    constexpr rlim_t ENOUGH = 1024;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < ENOUGH) {
        limit.rlim_cur = std::min(ENOUGH, limit.rlim_max);
        static_cast<void>(::setrlimit(RLIMIT_NOFILE, &limit));
    }
}

}  // namespace mw::screen

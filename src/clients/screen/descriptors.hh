// SPDX-License-Identifier: GPL-2.0-or-later
// Descriptors that files of clients leave free for connections, through which stops come.
#pragma once

#include <sys/resource.h>

#include <algorithm>

namespace mw::screen {

inline constexpr rlim_t RESERVED_DESCRIPTORS = 32;

/// `fd` is one of the reserve: not for a file. The kernel gives the lowest number that is free.
inline bool isReserved(int fd) {
    rlimit limit{};
    return fd >= 0 && ::getrlimit(RLIMIT_NOFILE, &limit) == 0 &&
           static_cast<rlim_t>(fd) + RESERVED_DESCRIPTORS >= limit.rlim_cur;
}

/// As many as this process may have, and a server can need.
inline void raise_descriptor_limit() {
    constexpr rlim_t ENOUGH = 1024;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < ENOUGH) {
        limit.rlim_cur = std::min(ENOUGH, limit.rlim_max);
        static_cast<void>(::setrlimit(RLIMIT_NOFILE, &limit));
    }
}

}  // namespace mw::screen

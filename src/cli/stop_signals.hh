// SPDX-License-Identifier: GPL-2.0-or-later
// SIGINT, SIGTERM, SIGHUP and SIGQUIT as a variable that programs look at.
#pragma once

#include <csignal>

namespace mw::cli {

inline volatile std::sig_atomic_t stop_requested = 0;

/// From now on these signals set stop_requested. Without SA_RESTART, so that waiting for input ends too.
inline void catch_stop_signals() {
    struct sigaction action{};
    action.sa_handler = [](int) { stop_requested = 1; };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        sigaction(signal, &action, nullptr);
    }
}

}  // namespace mw::cli

// SPDX-License-Identifier: GPL-2.0-or-later
// Stores a received SIGINT, SIGTERM, SIGHUP or SIGQUIT in a variable that programs poll, so that they end in
// an orderly way.
#pragma once

#include <csignal>
#include <string>

namespace mw {

/// The first stop signal received, 0 for none. Set by the signal handler.
inline volatile std::sig_atomic_t stop_signal = 0;

/// Stop signals set stop_signal from now on, without SA_RESTART, so that waiting for input ends too. A second
/// SIGINT ends the process at once; the other signals may arrive twice when a terminal closes or a service is
/// stopped. SIGPIPE is ignored: a pipe or connection without a reader is an error of the write.
void catch_stop_signals();

/// "SIGTERM"; empty when none was received.
std::string stop_signal_name();

}  // namespace mw

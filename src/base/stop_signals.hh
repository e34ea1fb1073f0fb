// SPDX-License-Identifier: GPL-2.0-or-later
// SIGINT, SIGTERM, SIGHUP and SIGQUIT as a number that programs look at, for whatever must end in order.
#pragma once

#include <csignal>
#include <string>

namespace mw {

/// The first of them that came, 0 for none. Written by the handler, which has no other way to tell.
inline volatile std::sig_atomic_t stop_signal = 0;

/// From now on they set stop_signal. Without SA_RESTART, so that waiting for input ends too. A second SIGINT
/// ends the process at once; the others may come twice when a terminal closes or a service is stopped.
/// SIGPIPE ends nothing any more: a pipe or connection without a reader is an error of the write.
void catch_stop_signals();

/// "SIGTERM"; empty when none came.
std::string stop_signal_name();

}  // namespace mw

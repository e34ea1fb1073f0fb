// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/stop_signals.hh"

namespace mw {
namespace {

void on_stop_signal(int number) {
    if (stop_signal == SIGINT && number == SIGINT) {
        ::signal(SIGINT, SIG_DFL);
        ::raise(SIGINT);
    }
    if (stop_signal == 0) {
        stop_signal = number;
    }
}

}  // namespace

void catch_stop_signals() {
    stop_signal = 0;
    struct sigaction action{};
    action.sa_handler = on_stop_signal;
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        ::sigaction(number, &action, nullptr);
    }
    // A handler is reset to the default action in programs started later; an ignored signal would remain
    // ignored there.
    struct sigaction survive{};
    survive.sa_handler = [](int) {};
    survive.sa_flags = SA_RESTART;
    ::sigaction(SIGPIPE, &survive, nullptr);
}

std::string stop_signal_name() {
    switch (stop_signal) {
    case SIGINT: return "SIGINT";
    case SIGTERM: return "SIGTERM";
    case SIGHUP: return "SIGHUP";
    case SIGQUIT: return "SIGQUIT";
    default: return "";
    }
}

}  // namespace mw

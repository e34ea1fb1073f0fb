// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/own_place.hh"
#include "cli/stop_signals.hh"
#include "hal/view/commands.hh"

int main(int argc, char **argv) {
    mw::offer_own_programs();
    mw::cli::catch_stop_signals();
    return mw::hal::view::latency_test({argv + 1, argv + argc}, mw::cli::stop_requested);
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "hal_tools/view/meters.hh"

int main(int argc, char **argv) {
    mw::offer_own_programs();
    mw::catch_stop_signals();
    return mw::hal::view::halmeter({argv + 1, argv + argc}, mw::stop_signal);
}

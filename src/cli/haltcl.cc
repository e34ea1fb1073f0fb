// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/own_place.hh"
#include "hal_tools/programs/command_line.hh"

int main(int argc, char **argv) {
    mw::offer_own_programs();
    return mw::hal::tools::haltcl({argv + 1, argv + argc});
}

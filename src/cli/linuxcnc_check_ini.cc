// SPDX-License-Identifier: GPL-2.0-or-later
#include "app/commands.hh"
#include "base/own_place.hh"

int main(int argc, char **argv) {
    mw::offer_own_programs();
    return mw::app::command_check_ini({argv + 1, argv + argc});
}

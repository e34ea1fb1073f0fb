// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal_tools/programs/command_line.hh"

int main(int argc, char **argv) {
    return mw::hal::tools::halcmd_twopass({argv + 1, argv + argc});
}

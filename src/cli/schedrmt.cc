// SPDX-License-Identifier: GPL-2.0-or-later
#include "app/commands.hh"

int main(int argc, char **argv) {
    return mw::app::command_schedule({argv + 1, argv + argc});
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal_tools/view/meters.hh"

int main(int argc, char **argv) {
    return mw::hal::view::halscope({argv + 1, argv + argc});
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include "hal/halcompile/program.hh"

int main(int argc, char **argv) {
    char path[4096];
    const ssize_t length = ::readlink("/proc/self/exe", path, sizeof path - 1);
    const std::string program(path, length > 0 ? static_cast<std::size_t>(length) : 0);
    return mw::halcompile::run(program, {argv + 1, argv + argc});
}

// SPDX-License-Identifier: GPL-2.0-or-later
// The words behind the program's name.
#pragma once

#include <string>
#include <vector>

namespace mw::cli {

/// A first word --help becomes -h, which every program knows.
inline std::vector<std::string> arguments(int argc, char **argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && words[0] == "--help") {
        words[0] = "-h";
    }
    return words;
}

}  // namespace mw::cli

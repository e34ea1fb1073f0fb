// SPDX-License-Identifier: GPL-2.0-or-later
// inivar: a value of an INI file, for scripts.
#include <cstdio>
#include <string>
#include <vector>

#include "config/ini_programs.hh"

int main(int argc, char **argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && (words[0] == "-h" || words[0] == "--help")) {
        std::fputs(mw::config::run_inivar({}).err.c_str(), stdout);  // without words it says how it is used
        return 0;
    }
    const mw::config::ProgramOutput result = mw::config::run_inivar(words);
    std::fputs(result.out.c_str(), stdout);
    std::fputs(result.err.c_str(), stderr);
    return result.status;
}

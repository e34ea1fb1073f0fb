// SPDX-License-Identifier: GPL-2.0-or-later
// inivalue: a value of an INI file, for scripts.
#include <cstdio>
#include <string_view>

#include "base/ini/ini_programs.hh"
#include "base/language/language.hh"

int main(int argc, char **argv) {
    const mw::ini::ProgramOutput result = mw::ini::run_inivalue({argv + 1, argv + argc});
    std::fputs(result.err.c_str(), stderr);  // warnings first, because they qualify the value
    const bool is_help = argc == 2 && std::string_view(argv[1]) == "--help";
    std::fputs(is_help ? mw::language::shown(result.out).c_str() : result.out.c_str(), stdout);
    return result.status;
}

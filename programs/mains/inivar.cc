// SPDX-License-Identifier: GPL-2.0-or-later
// inivar: a value of an INI file, for scripts.
#include <cstdio>
#include <string>
#include <vector>

#include "base/ini/ini_programs.hh"
#include "base/language/language.hh"

namespace {

constexpr const char *USAGE = R"(usage: inivar -var NAME [-sec SECTION] [-num N] [-tildeexpand] [-ini FILE]

Prints a value of an INI file.

  -var NAME     the variable
  -sec SECTION  its section (default: any)
  -num N        its N-th value, from 1 (default: 1)
  -tildeexpand  replace a leading ~ by the home folder
  -ini FILE     the INI file (default: emc.ini)

exit status: 0 printed, 1 not found or wrong usage, 255 the file cannot be read
)";

}  // namespace

int main(int argc, char **argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && (words[0] == "-h" || words[0] == "--help")) {
        std::fputs(mw::language::shown(USAGE).c_str(), stdout);
        return 0;
    }
    const mw::ini::ProgramOutput result = mw::ini::run_inivar(words);
    std::fputs(result.out.c_str(), stdout);
    std::fputs(result.err.c_str(), stderr);
    return result.status;
}

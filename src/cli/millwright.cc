// SPDX-License-Identifier: GPL-2.0-or-later
// millwright: the one command that people meet.
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "base/own_place.hh"
#include "cli/stop_signals.hh"
#include "hal/view/commands.hh"
#include "interp/commands.hh"
#include "machine/commands.hh"

namespace {

constexpr const char *USAGE =
    "usage: millwright COMMAND ...\n"
    "\n"
    "  run MACHINE.ini PROGRAM.ngc   start the machine that the INI describes, home it, run the program\n"
    "      --realtime                by the clock, in two processes (default: virtual time, as fast as "
    "possible)\n"
    "      --trace FILE.csv          write the commanded positions of every servo cycle\n"
    "      --plot FILE.png|FILE.svg  draw the tool path\n"
    "      --patience SECONDS        give up after so long without progress (default 60, in the machine's "
    "time)\n"
    "      --no-estimate             do not ask the planner for the expected time first\n"
    "      --strict                  unknown INI keys are errors\n"
    "  check PROGRAM.ngc --ini MACHINE.ini [--statements N]\n"
    "                                interpret the program and check its moves against the limits, moving "
    "nothing;\n"
    "                                a loop may take N statements, 0: any number\n"
    "  format [--check | --in-place] PROGRAM.ngc ...\n"
    "                                write programs in one form, without a change of meaning\n"
    "  explain [--before LINES] LINE say in words what a line of G-code does\n"
    "  hal [watch|capture|graph|latency] ...\n"
    "                                look at the running HAL; see millwright hal --help\n"
    "  --help, --version\n"
    "\n"
    "exit status: 0 done, 1 refused or failed, 2 wrong usage\n";

}  // namespace

int main(int argc, char **argv) {
    mw::offer_own_programs();
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.empty()) {
        std::fputs(USAGE, stderr);
        return 2;
    }
    if (words[0] == "--help" || words[0] == "-h") {
        std::fputs(USAGE, stdout);
        return 0;
    }
    if (words[0] == "--version") {
        std::puts("millwright " MW_VERSION);
        return 0;
    }
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    if (words[0] == "run") {
        return mw::machine::command_run(rest);
    }
    if (words[0] == "check") {
        return mw::machine::command_check(rest);
    }
    if (words[0] == "format") {
        return mw::interp::command_format(rest);
    }
    if (words[0] == "explain") {
        return mw::interp::command_explain(rest);
    }
    if (words[0] == "hal") {
        mw::cli::catch_stop_signals();
        return mw::hal::view::command_hal(rest, mw::cli::stop_requested);
    }
    std::fprintf(stderr, "millwright: unknown command '%s'; see millwright --help\n", words[0].c_str());
    return 2;
}

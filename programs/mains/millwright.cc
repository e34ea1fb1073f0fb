// SPDX-License-Identifier: GPL-2.0-or-later
// millwright: the main command.
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "base/language/language.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "gcode/analysis/commands.hh"
#include "hal/core/command_hints.hh"
#include "hal/tools/view/commands.hh"
#include "programs/commands.hh"

namespace {

constexpr const char *USAGE =
    "usage: millwright COMMAND ...\n"
    "\n"
    "  run MACHINE.ini PROGRAM.ngc          start the machine that the INI file describes, home it, run the "
    "program;\n"
    "                                       in virtual time, or with --realtime in real time\n"
    "  start MACHINE.ini                    run the machine for clients until a signal or its display ends "
    "it\n"
    "  recover                              continue a program after a power cut\n"
    "  ui MACHINE.ini                       serve the operator's screen of the running machine, to "
    "browsers\n"
    "  nml FILE.nml                         serve the NML channels of the running machine, also over the "
    "network\n"
    "  publish MACHINE.ini                  publish the machine's values by Sparkplug B and MTConnect\n"
    "  shop SHOP.ini                        store and show the values of all machines of a shop\n"
    "  doctor MACHINE.ini                   check a machine's files and this computer before the start\n"
    "  boards [ADDRESS ...]                 list Mesa boards on the network, their pins and firmware\n"
    "  select                               choose a configuration and start it\n"
    "  setup FOLDER                         write the configuration of a new machine, and try it\n"
    "  commission PART ...                  describe, write, check and tune a machine, step by step\n"
    "  check PROGRAM.ngc --ini MACHINE.ini  check a program against a machine's limits, estimate its time\n"
    "  format PROGRAM.ngc ...               write programs in one form, without a change of meaning\n"
    "  explain LINE                         explain a line of G-code\n"
    "  hal watch|capture|graph|latency      show the running HAL\n"
    "  --help, --version\n"
    "\n"
    "Each command has its own --help.\n"
    "exit status: 0 done, 1 rejected or failed, 2 wrong usage\n";

/// Replaces this process by another of our programs; returns only if that does not exist. `arguments`: its
/// name and its words.
int start_beside(const std::string &program, char **arguments) {
    ::execv((mw::program_folder() + "/" + program).c_str(), arguments);
    mw::language::tell(
        "millwright",
        mw::Error{"cannot start " + program + ": " + std::strerror(errno),
                  {},
                  "install the package millwright-shop; builds contain it after script/bootstrap --shop"});
    return 1;
}

}  // namespace

int main(int argc, char **argv) {
    mw::offer_own_programs();
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.empty()) {
        std::fputs(mw::language::shown(USAGE).c_str(), stderr);
        return 2;
    }
    if (words[0] == "--help" || words[0] == "-h") {
        std::fputs(mw::language::shown(USAGE).c_str(), stdout);
        return 0;
    }
    if (words[0] == "--version") {
        std::puts("millwright " MW_VERSION);
        return 0;
    }
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    if (words[0] == "start") {
        return mw::programs::command_start(rest);
    }
    if (words[0] == "run") {
        return mw::programs::command_run(rest);
    }
    if (words[0] == "recover") {
        return mw::programs::command_recover(rest);
    }
    if (words[0] == "ui") {
        return mw::programs::command_ui(rest);
    }
    if (words[0] == "nml") {
        return mw::programs::command_nml(rest);
    }
    if (words[0] == "publish") {
        return mw::programs::command_publish(rest);
    }
    if (words[0] == "shop") {
        return start_beside("millwright-shop", argv + 1);
    }
    if (words[0] == "doctor") {
        return mw::programs::command_doctor(rest);
    }
    if (words[0] == "boards") {
        return mw::programs::command_boards(rest);
    }
    if (words[0] == "select") {
        return mw::programs::command_select(rest);
    }
    if (words[0] == "setup") {
        return mw::programs::command_setup(rest);
    }
    if (words[0] == "commission") {
        return mw::programs::command_commission(rest);
    }
    if (words[0] == "check") {
        return mw::programs::command_check(rest);
    }
    if (words[0] == "format") {
        return mw::gcode::command_format(rest);
    }
    if (words[0] == "explain") {
        return mw::gcode::command_explain(rest);
    }
    if (words[0] == "hal") {
        mw::catch_stop_signals();
        return mw::hal::view::command_hal(rest, mw::stop_signal);
    }
    const std::string instead = mw::hal::hint_for_absent(words[0]);
    mw::language::tell("millwright", mw::Error{"unknown command '" + words[0] + "'; " +
                                               (instead.empty() ? "see millwright --help" : instead)});
    return 2;
}

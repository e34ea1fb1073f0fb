// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/run_words.hh"

#include "base/options/command_line.hh"

namespace mw::programs {
namespace {

constexpr double MOST_PATIENCE_S = 1e9;
constexpr int MOST_LINES = 1000000000;

options::CommandLine run_line(RunWords &run, options::Words &rest) {
    options::CommandLine line(
        "millwright run MACHINE.ini PROGRAM.ngc [options]",
        "Starts the machine that the INI file describes, homes it and runs the program. The program is "
        "interpreted before\nthe first move, for at most 5 s, and rejected if it would stop in the middle of "
        "a cut. Displays of the INI file\nare not started. With --realtime and a machine that 'millwright "
        "start' runs, the program runs on that machine,\nwhich stays on and homed.\n\nIn virtual time (the "
        "default) a simulated operator confirms tool changes and program stops, and prints each.\nWith "
        "--realtime a person confirms them, by keys or by HAL pins (halui, hal_manualtoolchange):\n  y start "
        "   h or space hold    r resume    a abort    t the tool is changed\n");
    line.flag("--realtime",
              "run in real time, in two processes; the terminal asks before the machine is switched on",
              run.realtime);
    line.flag("--yes",
              "start without confirmation and without a terminal; later confirmations are still required",
              run.confirmed);
    line.text("--trace", "FILE.csv", "write the commanded positions of every servo cycle", run.trace);
    line.text("--certificate", "FILE.json",
              "write the maximum use of each limit and the path deviation, with line numbers",
              run.certificate);
    line.text("--plot", "FILE", "draw the tool path, as .png or .svg; also for a rejected program", run.plot);
    line.number("--from-line", "N",
                "start at this line: earlier lines are calculated, and the operator confirms the approach",
                run.from_line, 1, MOST_LINES);
    line.number("--patience", "SECONDS",
                "stop after this time without progress (default 60; in a simulation, virtual time)",
                run.patience_s, 0.001, MOST_PATIENCE_S);
    line.on_or_off("--optional-stop", "M1 stops (on)", run.switches.optional_stop_on);
    line.on_or_off("--block-delete", "block delete: skip lines that begin with / (on)",
                   run.switches.block_delete_on);
    line.flag("--no-estimate", "do not calculate the expected time", run.estimated, false);
    line.flag("--no-check", "start the program even if the check finds errors", run.checked, false);
    line.text("--homemod", "NAME", "a homing module and its parameters, instead of [EMCMOT]HOMEMOD",
              run.homing_module);
    line.text("--tpmod", "NAME", "a planner module and its parameters, instead of [TRAJ]TPMOD",
              run.planner_module);
    line.flag("--strict", "unknown INI keys are errors", run.strict);
    line.rest(rest);
    line.footer("exit status: 0 the program ran to its end, 1 rejected, failed or stopped, 2 wrong usage\n");
    return line;
}

}  // namespace

std::string run_help() {
    RunWords run;
    options::Words rest;
    return run_line(run, rest).help();
}

Result<RunWords> parse_run(const std::vector<std::string> &words) {
    RunWords run;
    options::Words rest;
    const auto parsed = run_line(run, rest).parse(words);
    if (!parsed.has_value()) {
        return std::unexpected(parsed.error());
    }
    if (rest.size() != 2) {
        return fail("run needs a machine's INI file and a program", {},
                    "millwright run MACHINE.ini PROGRAM.ngc");
    }
    run.ini = rest[0];
    run.program = rest[1];
    return run;
}

}  // namespace mw::programs

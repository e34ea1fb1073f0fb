// SPDX-License-Identifier: GPL-2.0-or-later
#include "app/run_words.hh"

#include "app/options.hh"
#include "base/text.hh"

namespace mw::app {

const char *const RUN_USAGE =
    "usage: millwright run MACHINE.ini PROGRAM.ngc [options]\n"
    "\n"
    "Starts the machine that the INI file describes, homes it and runs the program. Before anything moves "
    "the\n"
    "program is interpreted, for at most 5 s: one that is known to stop in the middle of a cut is refused.\n"
    "Displays that the INI file names are not started. With --realtime, where 'millwright start' keeps the "
    "machine\n"
    "up, the program runs there, and the machine stays on and homed.\n"
    "\n"
    "In virtual time (the default) a simulated operator confirms tool changes and passes program stops, and "
    "says\n"
    "so. With --realtime a person does, by keys or by HAL pins (halui, hal_manualtoolchange):\n"
    "  y start    h or space hold    r resume    a abort    t the tool is changed\n"
    "\n"
    "  --realtime            by the clock, in two processes; asks at the terminal before it switches on\n"
    "  --yes                 do not ask before the start, and start without a terminal; confirms nothing "
    "else\n"
    "  --trace FILE.csv      write the commanded positions of every servo cycle\n"
    "  --plot FILE           draw the tool path, as .png or .svg; of a refused program too\n"
    "  --patience SECONDS    give up after so long without progress (default 60, in the machine's time)\n"
    "  --optional-stop on|off, --block-delete on|off\n"
    "                        M1 stops; lines that begin with / are left out (both on)\n"
    "  --no-estimate         do not reckon the time that the planner expects\n"
    "  --no-check            start even a program that is known to fail\n"
    "  --strict              unknown INI keys are errors\n"
    "\n"
    "exit status: 0 the program ran to its end, 1 refused, failed or stopped, 2 wrong usage\n";

Result<RunWords> parse_run(const std::vector<std::string> &words) {
    const auto options =
        parse_options(words, {{"--realtime", "--strict", "--no-estimate", "--no-check", "--yes"},
                              {"--trace", "--plot", "--patience", "--optional-stop", "--block-delete"}});
    if (!options.has_value()) {
        return std::unexpected(options.error());
    }
    if (options->rest.size() != 2) {
        return fail("run needs a machine's INI file and a program", {},
                    "millwright run MACHINE.ini PROGRAM.ngc");
    }
    RunWords run;
    run.ini = options->rest[0];
    run.program = options->rest[1];
    run.trace = options->value("--trace");
    run.plot = options->value("--plot");
    run.isRealtime = options->has("--realtime");
    run.isStrict = options->has("--strict");
    run.isEstimated = !options->has("--no-estimate");
    run.isChecked = !options->has("--no-check");
    run.isConfirmed = options->has("--yes");
    const auto patience = parse_double(options->value("--patience", to_text(RunWords{}.patience_s)));
    if (!patience.has_value() || *patience <= 0) {
        return fail("--patience needs a number of seconds above 0");
    }
    run.patience_s = *patience;
    const auto optional_stop = options->on_or_off("--optional-stop", true);
    const auto block_delete = options->on_or_off("--block-delete", true);
    if (!optional_stop.has_value() || !block_delete.has_value()) {
        return std::unexpected(optional_stop.has_value() ? block_delete.error() : optional_stop.error());
    }
    run.switches.isOptionalStopOn = *optional_stop;
    run.switches.isBlockDeleteOn = *block_delete;
    return run;
}

}  // namespace mw::app

// SPDX-License-Identifier: GPL-2.0-or-later
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "hal/host/host_client.hh"
#include "hal/tools/programs/command_line.hh"
#include "hal/tools/programs/host_watch.hh"

namespace mw::hal::tools {

namespace {

constexpr const char *USAGE = R"(usage: halrun [-I|-T] [OPTIONS] [[-f] FILE]
       halrun -U

Starts a realtime process, runs the commands of FILE in it, and ends it. FILE is a HAL file, a Tcl script (NAME.tcl,
followed by its arguments), or an INI file with [HAL]TWOPASS. Without FILE, or after it with -I or -T, reads commands
from standard input: HAL commands, or Tcl with -T.

  -i INI  take [SECTION]NAME from this INI file   -k  continue after failed commands
  -s      answers for scripts                     -q -Q -v -V  fewer or more messages (see halcmd -h)
  -U      ends a realtime process that was left running
)";

volatile std::sig_atomic_t stop_requested = 0;

int fail_with(const Error &error) {
    language::tell("halrun", error);
    return 1;
}

Result<> tell(const Error &error) {
    (void)fail_with(error);
    return std::unexpected(error);
}

void handle_signals() {
    // Without SA_RESTART, so that a signal also ends waiting.
    struct sigaction action{};
    action.sa_handler = [](int) { stop_requested = 1; };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        sigaction(signal, &action, nullptr);
    }
}

/// Runs files in order; the words after a Tcl file are its arguments.
Result<> run_files(const CommandLine &line, script::Session &session) {
    Result<> first;
    for (std::size_t i = 0; i < line.words.size(); ++i) {
        std::vector<std::string> arguments;
        if (line.words[i].ends_with(".tcl")) {
            arguments.assign(line.words.begin() + static_cast<std::ptrdiff_t>(i) + 1, line.words.end());
        }
        const Result<> result = session.run_file(line.words[i], arguments);
        first = first ? result : first;
        if (session.hasEnded() || (!result && !line.session.keepsGoing)) {
            break;
        }
        i += arguments.size();
    }
    return first;
}

Result<> run_tcl_input(script::Session &session) {
    const Result<script::ScriptRunner *> tcl = session.tcl();
    if (!tcl) {
        return tell(tcl.error());
    }
    return (*tcl)->run_standard_input();
}

Result<> run(const CommandLine &line, script::Session &session, const ini::IniFile *two_pass) {
    Result<> first;
    if (two_pass != nullptr) {
        first = run_two_pass_ini(session, *two_pass);
    } else {
        first = run_files(line, session);
    }
    // Reads input also after a failure, so that the user can inspect the state.
    const bool readsInput = line.words.empty() || line.interactive || line.wants_tcl;
    if (!readsInput || session.hasEnded() || stop_requested != 0) {
        return first;
    }
    const Result<> input = line.wants_tcl ? run_tcl_input(session) : run_standard_input(session);
    return first ? input : first;
}

/// Ends programs, threads, modules and the realtime process in any state.
Result<> tear_down(script::ProgramHost &programs, HostClient &host) {
    Result<> first = programs.stop_all();
    const Result<> ended = host.shut_down();
    return first ? ended : first;
}

}  // namespace

int end_running(const char *program) {
    const auto fail_with = [program](const Error &error) {
        language::tell(program, error);
        return 1;
    };
    const std::string instance = default_instance();
    if (!isHostAlive(instance)) {
        remove_leftovers(instance);
        return 0;
    }
    const auto host = HostClient::connect(instance);
    if (!host) {
        return fail_with(host.error());
    }
    script::SystemProgramHost programs((*host)->hal());
    const Result<> stopped = programs.stop_all();
    const Result<> ended = (*host)->shut_down();
    if (!ended) {
        return fail_with(ended.error());
    }
    return stopped ? 0 : fail_with(stopped.error());
}

int halrun(const std::vector<std::string> &arguments) {
    Result<CommandLine> line = parse_command_line(arguments);
    if (!line) {
        std::fputs(language::shown(USAGE).c_str(), stderr);
        return fail_with(line.error());
    }
    if (line->wants_help) {
        std::fputs(language::shown(USAGE).c_str(), stdout);
        return 0;
    }
    if (line->killing) {
        return end_running("halrun");
    }
    // The file itself may be an INI file: runs its HAL files in two passes.
    const bool is_two_pass = line->words.size() == 1 && line->words[0].ends_with(".ini");
    IniOption ini;
    const Result<> loaded = ini.load(is_two_pass ? line->words[0] : line->ini_path);
    if (!loaded) {
        return fail_with(loaded.error());
    }
    if (is_two_pass && ini.file()->find("HAL", "TWOPASS") == nullptr) {
        return fail_with(Error{"an INI file can only be run when it has [HAL]TWOPASS",
                               ini.file()->place_of_section("HAL"),
                               "millwright run starts a whole machine from it"});
    }
    line->session.ini = ini.lookup();
    line->session.stop = &stop_requested;
    const std::string instance = default_instance();
    if (isHostAlive(instance)) {
        return fail_with(Error{fmt::format("a realtime process is already running (instance '{}')", instance),
                               {},
                               "use it with halcmd, or end it with halrun -U"});
    }
    handle_signals();
    const auto host = HostClient::start(instance, MessagesTo::STDERR, Lifetime::STARTER);
    if (!host) {
        return fail_with(host.error());
    }
    const Result<> controlled = (*host)->control();
    if (!controlled) {
        return fail_with(controlled.error());
    }
    script::StandardOutput output;
    script::SystemProgramHost programs((*host)->hal(), &stop_requested);
    Result<> result;
    {
        const HostWatch watch(**host, [] { stop_requested = 1; });
        script::Session session(**host, programs, output, line->session);
        result = run(*line, session, is_two_pass ? ini.file() : nullptr);
    }
    if (const auto death = (*host)->death()) {
        result = tell(*death);
    }
    const Result<> ended = tear_down(programs, **host);
    if (!ended) {
        return fail_with(ended.error());
    }
    return result && stop_requested == 0 ? 0 : 1;
}

}  // namespace mw::hal::tools

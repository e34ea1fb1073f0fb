// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "hal/host/host_client.hh"
#include "hal/script/commands.hh"
#include "hal/tools/programs/command_line.hh"
#include "hal/tools/programs/host_watch.hh"

namespace mw::hal::tools {

namespace {

constexpr const char *USAGE = R"(usage: halcmd [OPTIONS] [COMMAND [WORD...]]
       halcmd [OPTIONS] -f [FILE]

Runs HAL commands in the running realtime process.

  -f [FILE]  run the commands of FILE, or of standard input
  -i INI     take [SECTION]NAME from this INI file
  -k         continue after failed commands
  -q         print only errors (default)         -Q  print nothing
  -v         print the result of each command    -V  also each command before it runs
  -s         answers for scripts: no titles, names instead of numbers
  -e         repeat each command                 -R  accepted: the lock of HAL frees itself
  -h [COMMAND]  this help, or that of a command

Without a command, reads commands from standard input.
)";

int fail_with(const Error &error) {
    language::tell("halcmd", error);
    return 1;
}

int show_help(const CommandLine &line) {
    if (line.words.empty()) {
        fmt::print("{}\n{}\n{}", language::shown(USAGE), language::shown("Commands:"),
                   script::help_overview());
        return 0;
    }
    const script::CommandSpec *spec = script::find_command(line.words[0]);
    if (spec == nullptr) {
        return fail_with(script::unknown_command({line.words[0], line.words[0], {}}));
    }
    fmt::print("{}", script::help_text(*spec));
    return 0;
}

/// Joins the running realtime process; a command that loads something may start a persistent one.
/// True if there is no module, signal or thread, and no component of a running process.
bool isEmpty(HostClient &host) {
    Instance &hal = host.hal();
    const auto modules = host.modules();
    const bool hasModules = !modules.has_value() || !modules->empty();
    return !hasModules && hal.signals().list().empty() && hal.threads().list().empty() &&
           std::ranges::none_of(hal.components().list(),
                                [](const CompInfo &comp) { return comp.pid != 0 && comp.pid != getpid(); });
}

Result<JoinedHost> join(const CommandLine &line) {
    const std::string instance = default_instance();
    if (isHostAlive(instance)) {
        return join_or_start();
    }
    const bool may_load = line.readsInput || line.words.empty() || line.words[0].starts_with("load") ||
                          line.words[0] == "source";
    if (!may_load) {
        return fail(fmt::format("no realtime process is running (instance '{}')", instance), {},
                    "start the realtime process with halrun or halcmd loadrt");
    }
    return join_or_start();
}

Result<> run(const CommandLine &line, script::Session &session) {
    if (line.readsInput && !line.words.empty()) {
        return session.run_file(line.words[0], {line.words.begin() + 1, line.words.end()});
    }
    if (line.readsInput || line.words.empty()) {
        return run_standard_input(session);
    }
    return session.run_words(line.words);
}

}  // namespace

JoinedHost::~JoinedHost() {
    if (host_ != nullptr && started_here_ && !host_->death() && isEmpty(*host_)) {
        if (const Result<> ended = host_->shut_down(); !ended) {
            language::tell("halcmd", ended.error());
        }
    }
}

Result<JoinedHost> join_or_start() {
    const std::string instance = default_instance();
    const bool isRunning = isHostAlive(instance);
    Result<std::unique_ptr<HostClient>> host =
        isRunning ? HostClient::connect(instance) : HostClient::start(instance, MessagesTo::FILE);
    if (!host) {
        return std::unexpected(host.error());
    }
    return JoinedHost(std::move(*host), !isRunning);
}

int halcmd(const std::vector<std::string> &arguments) {
    Result<CommandLine> line = parse_command_line(arguments);
    if (!line) {
        std::fputs(language::shown(USAGE).c_str(), stderr);
        return fail_with(line.error());
    }
    if (line->wants_help) {
        return show_help(*line);
    }
    if (line->interactive || line->killing || line->wants_tcl) {
        return fail_with(Error{"options -I, -U and -T belong to halrun", {}, {}});
    }
    IniOption ini;
    const Result<> loaded = ini.load(line->ini_path);
    if (!loaded) {
        return fail_with(loaded.error());
    }
    line->session.ini = ini.lookup();
    Result<JoinedHost> host = join(*line);
    if (!host) {
        return fail_with(host.error());
    }
    script::StandardOutput output;
    script::SystemProgramHost programs((*host)->hal());
    script::Session session(**host, programs, output, line->session);
    // The realtime process has ended, so this command ends, even while it waits.
    const HostWatch watch(**host, [&host] {
        (void)fail_with(*(*host)->death());
        std::fflush(stdout);
        ::_exit(1);
    });
    const Result<> result = run(*line, session);
    if (programs.hasStarted()) {
        host->keep();
    }
    return result ? 0 : 1;
}

}  // namespace mw::hal::tools

// SPDX-License-Identifier: GPL-2.0-or-later
// millwright ui: serves a running machine to browsers.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/memory_killer.hh"
#include "base/options/command_line.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "base/thread_priority.hh"
#include "base/whole_path.hh"
#include "clients/screen/access/remote_access.hh"
#include "clients/screen/assembly/machine_screen.hh"
#include "clients/screen/facts/tabs.hh"
#include "clients/screen/server/descriptors.hh"
#include "hal/core/instance.hh"
#include "programs/command_words.hh"
#include "programs/commands.hh"
#include "programs/screen/ui_offers.hh"
#include "programs/setup/first_steps.hh"
#include "programs/setup/ui_browser.hh"
#include "programs/start/side_programs.hh"

namespace mw::programs {
namespace {

struct UiWords {
    std::string ini, screen;
    int port = SCREEN_PORT;
    bool opening = false, is_display = false;
    screen::DoorWords door;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright ui MACHINE.ini [options]",
            "Serves the operator's screen of a machine that 'millwright start' runs to browsers on this "
            "computer, with\n--listen also to other computers. It is a client: the machine runs without it. "
            "It waits for a machine that is not running yet. Ends at SIGINT or SIGTERM.\n");
        line.number("--port", "N", "listen on 127.0.0.1:N (default 8850; 0: a free port)", port, 0, 65535);
        line.flag("--open", "open the screen in the browser of the desktop", opening);
        line.flag("--display",
                  "the machine's display: starts the programs of EMBED_TAB_COMMAND, and runs POSTGUI_HALFILE "
                  "and _HALCMD",
                  is_display);
        line.text("--screen", "FOLDER", "folder of the files of the screen", screen);
        line.text(
            "--listen", "ADDRESS[:PORT]",
            "also accept other computers, with TLS and a token; 0.0.0.0: all addresses; default port 8851",
            door.listen);
        line.texts("--name", "NAME", "additional host name of this computer for --listen", door.names);
        line.text("--unprotected", "ROLE",
                  "no TLS and no token: anyone who reaches --listen may view, operate or configure; the "
                  "screen shows a warning",
                  door.unprotected);
        line.rest(rest);
        line.footer("exit status: 0 normal end, 1 rejected or failed, 2 wrong usage\n");
        return line;
    }
    Result<> parse(const std::vector<std::string> &words) {
        const auto parsed = line().parse(words);
        if (parsed.has_value() && rest.size() != 1) {
            return fail("ui needs a machine's INI file", {}, "millwright ui MACHINE.ini");
        }
        ini = parsed.has_value() ? rest[0] : "";
        return parsed;
    }
};

std::int64_t now_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

screen::MachineScreenOptions options_of(const UiWords &words) {
    return {.ini = whole_path(words.ini),
            .instance = hal::default_instance(),
            .version = MW_VERSION,
            .screen_folder = screen_folder(words.screen),
            .programs = program_folder(),
            .is_display = words.is_display};
}

/// Runs until a signal.
void run(screen::Server &server, const UiWords &words, const machine::LoadedConfig &loaded,
         screen::ApiSetup setup, diagnostics::Sink &sink) {
    const std::string address = fmt::format("http://127.0.0.1:{}/", server.port());
    const bool has_screen = check_screen(setup.screen_folder).has_value();
    SidePrograms programs(words.is_display ? screen::tab_programs(setup.facts.tabs)
                                           : std::vector<std::string>{},
                          setup.facts.ini, 0);
    screen::MachineScreen machine_screen(server, loaded, std::move(setup));
    Browser browser;
    if (words.opening && has_screen && std::getenv(BROWSER_WAITS) == nullptr) {
        browser.open(address);
    }
    raise_priority();
    while (stop_signal == 0) {
        machine_screen.run();
        programs.step(now_ns(), sink);
        browser.look();
    }
    programs.ask_to_end();
}

/// Prints the address; without a screen the server is useful only for programs.
void print_address(const std::string &machine, int port, const std::string &folder, diagnostics::Sink &sink) {
    if (const auto found = check_screen(folder); !found.has_value()) {
        sink.error(found.error());
        fmt::print("{}", language::shown(fmt::format(
                             "Web interface of {} for programs: http://127.0.0.1:{}/api/\n", machine, port)));
        return;
    }
    fmt::print("{}", language::shown(fmt::format("screen of {}: http://127.0.0.1:{}/\n", machine, port)));
}

int serve(const UiWords &words, const machine::LoadedConfig &loaded, diagnostics::Sink &sink) {
    // Its folder is needed only if other computers may connect.
    const auto folder_of_secrets = screen::secrets_folder();
    if (!words.door.listen.empty() && !folder_of_secrets.has_value()) {
        sink.error(folder_of_secrets.error());
        return 1;
    }
    const std::string secrets = folder_of_secrets.value_or("");
    auto door = screen::remote_door(words.door, secrets);
    if (!door.has_value()) {
        sink.error(door.error());
        return 1;
    }
    screen::ApiSetup setup = screen::api_setup(options_of(words), loaded, sink);
    setup.offers_folder = offers_folder(loaded.ini);
    auto server = screen::Server::listen(
        {.port = words.port,
         .limits = {},
         .remote = *door,
         .frames = screen::frames_of(setup.facts),
         .local_tokens = screen::local_tokens(secrets, sink),
         .report = [&sink](const std::string &why) { screen::report_unknown(why, sink); }});
    if (!server.has_value()) {
        sink.error(server.error());
        return 1;
    }
    setup.screens.status_note = screen::status_note((*server)->port(), secrets);
    print_address(loaded.machine.name, (*server)->port(), setup.screen_folder, sink);
    if (door->has_value()) {
        fmt::print("{}", language::shown(screen::door_text(**door, (*server)->remote_port(), secrets)));
    }
    std::fflush(stdout);
    run(**server, words, loaded, std::move(setup), sink);
    return 0;
}

}  // namespace

int command_ui(const std::vector<std::string> &arguments) {
    UiWords words;
    if (const auto ended = ended_by_words("ui", words, arguments)) {
        return *ended;
    }
    catch_stop_signals();
    screen::raise_descriptor_limit();
    static_cast<void>(raise_oom_score(SCREENS_OOM_STEP));
    diagnostics::Sink sink = standard_error_sink();
    const auto loaded = machine::LoadedConfig::load(words.ini, sink);
    return loaded == nullptr ? 1 : serve(words, *loaded, sink);
}

}  // namespace mw::programs

// SPDX-License-Identifier: GPL-2.0-or-later
// millwright ui: serves a running machine to browsers.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "base/duration.hh"
#include "base/language/language.hh"
#include "base/memory_killer.hh"
#include "base/options/command_line.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "base/thread_priority.hh"
#include "base/whole_path.hh"
#include "clients/screen/routes/api.hh"
#include "clients/screen/server/descriptors.hh"
#include "clients/screen/server/server.hh"
#include "hal/core/instance.hh"
#include "hal/host/host_client.hh"
#include "programs/command_words.hh"
#include "programs/commands.hh"
#include "programs/run/machine_access.hh"
#include "programs/run/ui_filter.hh"
#include "programs/screen/ui_dialogs.hh"
#include "programs/screen/ui_door.hh"
#include "programs/screen/ui_facts.hh"
#include "programs/screen/ui_path.hh"
#include "programs/screen/ui_tabs.hh"
#include "programs/setup/first_steps.hh"
#include "programs/setup/ui_browser.hh"
#include "programs/start/side_programs.hh"

namespace mw::programs {
namespace {

/// Interval of checks for outcomes while a screen is open, and for the machine otherwise.
constexpr auto TICK = std::chrono::milliseconds(10), IDLE_TICK = std::chrono::milliseconds(100);

struct UiWords {
    std::string ini, screen;
    int port = SCREEN_PORT;
    bool opening = false, is_display = false;
    DoorWords door;
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

/// Connects to the running machine, if it uses this INI file.
Result<client::Client> connect(const std::string &instance, const std::string &ini,
                               client::Places places = client::Places::ORDINARY) {
    auto client = client::Client::connect(instance, client::Role::OPERATOR, places);
    if (!client.has_value()) {
        return client;
    }
    const mailbox::Identity identity = client->identity();
    if (identity.ini.empty()) {
        return fail("the machine starts");
    }
    if (!identity.isLasting) {
        return fail("'millwright run' runs a program on its own machine");
    }
    if (identity.ini.str() != ini) {
        return fail("the running machine was started from " + identity.ini.str() + ", not from " + ini);
    }
    return client;
}

std::int64_t now_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Data for the screens, except the paths of programs.
screen::ApiSetup setup_of(const UiWords &words, const machine::LoadedConfig &loaded,
                          diagnostics::Sink &sink) {
    const std::string ini = whole_path(words.ini), instance = hal::default_instance();
    screen::ApiSetup setup;
    setup.facts = machine_facts(loaded, sink);
    setup.facts.ini = ini;
    setup.facts.instance = instance;
    setup.facts.filters.folder = filtered_folder(instance);
    setup.screens.connect = [instance, ini] { return connect(instance, ini); };
    setup.screens.connect_for_all = [instance, ini] {
        return connect(instance, ini, client::Places::RESERVED);
    };
    setup.screens.version = MW_VERSION;
    setup.screens.status_period_ns = to_ns(status_period_s(loaded.ini, sink));
    setup.screen_folder = screen_folder(words.screen);
    setup.dialogs = dialog_facts(loaded.ini, sink);
    setup.connect_hal = [instance]() -> Result<std::unique_ptr<hal::Host>> {
        auto joined = hal::HostClient::connect(instance);
        return joined.has_value() ? Result<std::unique_ptr<hal::Host>>(std::move(*joined))
                                  : std::unexpected(joined.error());
    };
    const auto commands = postgui_commands(loaded.ini, program_folder());
    if (words.is_display && !commands.empty()) {
        const std::string folder = std::filesystem::path(ini).parent_path().string();
        setup.begin_hal = [commands, folder] { return run_postgui(commands, folder); };
    }
    return setup;
}

/// Runs until a signal.
void run(screen::Server &server, const UiWords &words, const machine::LoadedConfig &loaded,
         screen::ApiSetup setup, diagnostics::Sink &sink) {
    const std::string address = fmt::format("http://127.0.0.1:{}/", server.port());
    const bool has_screen = check_screen(setup.screen_folder).has_value();
    SidePrograms programs(words.is_display ? tab_programs(setup.facts.tabs) : std::vector<std::string>{},
                          setup.facts.ini, 0);
    PathReaders readers(loaded, path_look(setup.facts));
    setup.read_path = [&readers](const std::string &path, const screen::Requester &by) {
        return readers.read(path, by);
    };
    setup.read_times = [&readers](const std::string &path, const screen::TimeOverrides &overrides,
                                  const screen::Requester &by) {
        return readers.read_times(path, overrides, by);
    };
    setup.run_filter = [&readers, filters = filters_of(loaded.ini),
                        folder = std::filesystem::path(setup.facts.ini).parent_path().string()](
                           const std::string &path, const std::string &made, const screen::Requester &by) {
        const std::string lower = to_lower(path);
        const auto filter =
            std::ranges::find_if(filters, [&](const auto &one) { return lower.ends_with(one.first); });
        if (filter == filters.end()) {
            return Result<std::shared_ptr<screen::PieceQueue>>(fail("[FILTER] has no program for " + path));
        }
        return readers.run(
            [command = filter->second, folder, path, made](screen::PieceQueue &pieces) {
                run_filter({command, folder, path, made}, pieces);
            },
            by);
    };
    const auto post = [&server](std::function<void()> act) { server.post(std::move(act)); };
    screen::Worker disk(post), hal_looks(post);
    screen::Api api(server, {disk, hal_looks}, std::move(setup), now_ns);
    Browser browser;
    if (words.opening && has_screen && std::getenv(BROWSER_WAITS) == nullptr) {
        browser.open(address);
    }
    raise_priority();
    while (stop_signal == 0) {
        server.run_for(api, api.count_screens() > 0 ? TICK : IDLE_TICK);
        api.tick();
        programs.step(now_ns(), sink);
        browser.look();
    }
    readers.cancel();
    programs.ask_to_end();
    disk.end();
    hal_looks.end();
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
    const auto folder_of_secrets = secrets_folder();
    if (!words.door.listen.empty() && !folder_of_secrets.has_value()) {
        sink.error(folder_of_secrets.error());
        return 1;
    }
    const std::string secrets = folder_of_secrets.value_or("");
    auto door = remote_door(words.door, secrets);
    if (!door.has_value()) {
        sink.error(door.error());
        return 1;
    }
    screen::ApiSetup setup = setup_of(words, loaded, sink);
    std::vector<std::string> frames;
    for (const screen::Tab &tab : setup.facts.tabs) {
        if (tab.kind == screen::Tab::Kind::FRAME) {
            frames.push_back(tab.content);
        }
    }
    auto server =
        screen::Server::listen({.port = words.port,
                                .limits = {},
                                .remote = *door,
                                .frames = std::move(frames),
                                .local_tokens = local_tokens(secrets, sink),
                                .report = [&sink](const std::string &why) { report_unknown(why, sink); }});
    if (!server.has_value()) {
        sink.error(server.error());
        return 1;
    }
    setup.screens.status_note = status_note((*server)->port(), secrets);
    print_address(loaded.machine.name, (*server)->port(), setup.screen_folder, sink);
    if (door->has_value()) {
        fmt::print("{}", language::shown(door_text(**door, (*server)->remote_port(), secrets)));
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

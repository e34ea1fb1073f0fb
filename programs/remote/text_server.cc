// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/remote/text_server.hh"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "hal/core/instance.hh"

namespace mw::programs {
namespace {

using rsh::Dialect;

/// Interval for checking the machine without new bytes.
constexpr double IDLE_S = 0.05;
/// Maximum wait for a machine that is starting. [s]
constexpr double PATIENCE_S = 10;

/// Waits for a machine that is starting.
Result<client::Viewer> attach_patiently(const std::string &instance) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(PATIENCE_S);
    while (true) {
        auto viewer = client::Viewer::attach(instance);
        const bool ready =
            viewer.has_value() && !viewer->identity().ini.empty() && viewer->read_status().has_value();
        if (ready || stop_signal != 0 || std::chrono::steady_clock::now() > end) {
            return ready || !viewer.has_value() ? std::move(viewer) : fail("the machine does not start");
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

double task_period(const ini::IniFile &ini) {
    constexpr double PRESET_S = 0.001;
    const ini::IniEntry *const entry = ini.find("TASK", "CYCLE_TIME");
    return entry == nullptr ? PRESET_S : parse_double(entry->value).value_or(PRESET_S);
}

Result<> serve(TextServerWords &words, TextServiceMaking make, diagnostics::Sink &sink) {
    const std::string instance = hal::default_instance();
    auto viewer = attach_patiently(instance);
    if (!viewer.has_value()) {
        return std::unexpected(viewer.error());
    }
    const std::string path = words.ini.empty() ? viewer->identity().ini.str() : words.ini;
    auto ini = ini::IniFile::load(std::filesystem::absolute(path).string(), sink);
    if (!ini.has_value()) {
        return std::unexpected(ini.error());
    }
    rsh::SharedView shared(std::move(*viewer));
    words.settings.ini = &*ini;
    words.settings.task_period_s = task_period(*ini);
    words.settings.num_joints = shared.status().trajectory.num_joints;
    words.settings.num_spindles = shared.status().trajectory.num_spindles;
    const auto service = make({words.settings, shared, instance});
    auto server = rsh::Server::listen(words.server, [&service] { return service->begin(); });
    if (!server.has_value()) {
        return std::unexpected(server.error());
    }
    if (words.server.port == 0) {
        fmt::print("port {}\n", (*server)->port());
        std::fflush(stdout);
    }
    (*server)->run(
        [&shared, &service] {
            // If the status cannot be read, the machine is ending.
            const bool up = stop_signal == 0 && shared.isMachineAlive() && shared.read().has_value();
            if (up) {
                service->step(shared.status());
            }
            return up;
        },
        IDLE_S);
    return {};
}

}  // namespace

options::CommandLine TextServerWords::line() {
    options::CommandLine line(program + " [options] [-- -ini MACHINE.ini]", what);
    line.number("-p,--port", "N", "TCP port (default 5007; 0: a free port)", server.port, 0, 65535);
    line.text("-n,--name", "NAME", "name of the server (default EMCNETSVR)", settings.name);
    line.text("-w,--connectpw", "PASSWORD", "password of HELLO (default EMC)", settings.connect_password);
    line.text("-e,--enablepw", "PASSWORD", "password of SET ENABLE (default EMCTOO)",
              settings.enable_password);
    line.number("-s,--sessions", "N", "maximum number of connections (default -1: no limit)",
                server.max_sessions, -1, 100000);
    line.text("-d,--path", "FOLDER", "folder of the programs (default: that of the INI file)",
              settings.program_folder);
    line.text("-b,--bind", "ADDRESS",
              "listen at this address for other computers; requires your own passwords", server.address);
    line.flag("-4,--ipv4", "listen on IPv4 only", server.isIpv4Only);
    if (has_dialects) {
        line.text("--dialect", "2.9|2.10", "LinuxCNC version of the replies (default 2.10)", dialect);
    }
    line.flag("-q,--quiet", "no effect: connections are never reported", isQuiet);
    line.footer("exit status: 0 normal end, 1 rejected or failed, 2 wrong usage\n");
    return line;
}

Result<> TextServerWords::parse(std::vector<std::string> words) {
    const auto dashes = std::ranges::find(words, "--");
    std::vector<std::string> behind(dashes == words.end() ? dashes : dashes + 1, words.end());
    words.erase(dashes, words.end());
    if (auto parsed = line().parse(words); !parsed.has_value()) {
        return parsed;
    }
    for (std::size_t i = 0; i < behind.size(); ++i) {
        if ((behind[i] == "-ini" || behind[i] == "--ini") && i + 1 < behind.size()) {
            ini = behind[++i];
        } else {
            return fail("'" + behind[i] + "' after -- is unknown", {}, "-- -ini MACHINE.ini");
        }
    }
    if (dialect != "2.9" && dialect != "2.10") {
        return fail("unknown dialect '" + dialect + "'", {}, "2.9 or 2.10");
    }
    settings.dialect = dialect == "2.9" ? Dialect::OLD : Dialect::NEWER;
    return check_passwords();
}

/// The default passwords are public and protect nothing.
Result<> TextServerWords::check_passwords() const {
    const rsh::Settings preset;
    const bool open =
        !server.address.empty() && server.address != "::1" && !server.address.starts_with("127.");
    if (open && (settings.connect_password == preset.connect_password ||
                 settings.enable_password == preset.enable_password)) {
        return fail("--bind allows other computers to move this machine: set your own passwords", {},
                    "--connectpw and --enablepw");
    }
    return {};
}

int serve_text(TextServerWords words, const std::vector<std::string> &arguments, TextServiceMaking make) {
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    if (const auto parsed = words.parse(arguments); !parsed.has_value()) {
        fmt::print(stderr, "{}: {}\n", words.program, language::shown(parsed.error().str()));
        return 2;
    }
    catch_stop_signals();
    diagnostics::Sink sink([&words](const diagnostics::Diagnostic &d) {
        fmt::print(stderr, "{}: {}\n", words.program, language::shown(d.str()));
    });
    const auto ended = serve(words, make, sink);
    if (!ended.has_value()) {
        sink.failure(ended.error());
    }
    return ended.has_value() ? 0 : 1;
}

}  // namespace mw::programs

// SPDX-License-Identifier: GPL-2.0-or-later
// hm2-board [options]: a simulated Mesa board on a UDP port.
#include <cstdio>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "drivers/mesa/board/udp_server.hh"

namespace {

using mw::Result;
namespace board = mw::mesa::board;

struct Settings {
    std::string model = "7i76e", physics_file, faults_file, log_file;
    double period_us = 1000;
    board::ServerSettings server;
};

/// The contents of a text table; an empty path is an empty table.
template <class Parse>
auto read_table(const std::string &path, Parse parse) -> decltype(parse(std::string{})) {
    if (path.empty()) {
        return parse(std::string{});
    }
    const auto text = mw::read_file(path);
    return text.has_value() ? parse(*text) : std::unexpected(text.error());
}

Result<> run(const Settings &settings) {
    const auto model = board::load_model(settings.model);
    if (!model.has_value()) {
        return std::unexpected(model.error());
    }
    auto physics = read_table(settings.physics_file, [&](const std::string &text) {
        return board::parse_physics(text, settings.physics_file, model->idrom);
    });
    if (!physics.has_value()) {
        return std::unexpected(physics.error());
    }
    auto faults = read_table(settings.faults_file, [&](const std::string &text) {
        return board::parse_faults(text, settings.faults_file);
    });
    if (!faults.has_value()) {
        return std::unexpected(faults.error());
    }
    board::Board simulated(*model, std::move(*physics));
    std::ofstream log;
    if (!settings.log_file.empty()) {
        log.open(settings.log_file);
        if (!log) {
            return mw::fail(fmt::format("Cannot write the log '{}'.", settings.log_file));
        }
        simulated.set_log([&](const board::ExecutedCommand &one) { log << board::log_line(one) << '\n'; });
    }
    board::Link link(simulated, std::move(*faults));
    board::ServerSettings server = settings.server;
    server.listening = [&] {
        fmt::print("hm2-board: {} at {}:{}\n", model->card_name, server.address, server.port);
        std::fflush(stdout);
    };
    return board::serve(link, server, mw::stop_signal);
}

}  // namespace

int main(int argc, char **argv) {
    mw::tell_when_memory_ends();
    Settings settings;
    mw::options::CommandLine options("hm2-board [OPTION ...]",
                                     "A simulated Mesa board with HostMot2 on a UDP port.");
    options.take("--listen", 1, "ADDRESS[:PORT]", "address and port of the board (127.0.0.1:27181)",
                 [&](const mw::options::Words &words) {
                     return board::read_listen_address(words[0], settings.server);
                 });
    options.text("--model", "NAME|FILE",
                 "type of board: 7i76e, 7i80, 7i92, 7i95, 7i96s, 7i97 or a file (7i76e)", settings.model);
    options.text("--physics", "FILE", "simulated motors, encoders and switches", settings.physics_file);
    options.text("--faults", "FILE", "faults of the link and of the board", settings.faults_file);
    options.text("--log", "FILE", "writes each command with its time in nanoseconds", settings.log_file);
    options.flag("--virtual-time", "the time advances by one period with each request of the host",
                 settings.server.virtual_time);
    options.number("--period-us", "US", "period of the virtual time (1000)", settings.period_us, 1, 1e6);
    const mw::options::Words words(argv + 1, argv + argc);
    if (mw::options::wantsHelp(words)) {
        std::fputs(options.help().c_str(), stdout);
        return 0;
    }
    if (const Result<> parsed = options.parse(words); !parsed) {
        mw::language::tell("hm2-board", parsed.error());
        return 2;
    }
    settings.server.period_ns = static_cast<std::int64_t>(settings.period_us * 1000.0);
    mw::catch_stop_signals();
    const Result<> done = run(settings);
    if (!done) {
        mw::language::tell("hm2-board", done.error());
    }
    return done ? 0 : 1;
}

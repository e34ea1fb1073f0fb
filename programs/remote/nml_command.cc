// SPDX-License-Identifier: GPL-2.0-or-later
// millwright nml: the channels of an NML configuration for a running machine.
#include <cstdio>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "clients/nml/bridge/bridge.hh"
#include "clients/nml/config/config_file.hh"
#include "clients/nml/net/server.hh"
#include "hal/core/instance.hh"
#include "programs/command_words.hh"
#include "programs/commands.hh"
#include "programs/remote/remote_client.hh"

namespace mw::programs {
namespace {

/// Interval for checking the channels without a new status.
constexpr double TICK_S = 0.01;

struct NmlWords {
    std::string file, process = "emc", server = "emcsvr";
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright nml FILE.nml [options]",
            "Creates the channels emcCommand, emcStatus and emcError of an NML configuration for the machine "
            "that 'millwright\nstart' runs, and serves them to other programs, over the network if a B line "
            "has a port. It is a\nclient: the machine continues without it. Ends with the machine, or at "
            "SIGINT or SIGTERM.\n");
        line.text("--process", "NAME",
                  "process whose P lines define the channels of the machine (default emc)", process);
        line.text("--server", "NAME",
                  "process whose P lines define the buffers to create and serve (default emcsvr)", server);
        line.rest(rest);
        line.footer("exit status: 0 normal end, 1 rejected or failed, 2 wrong usage\n");
        return line;
    }
    Result<> parse(const std::vector<std::string> &words) {
        const auto parsed = line().parse(words);
        if (parsed.has_value() && rest.size() != 1) {
            return fail("nml needs an NML configuration file", {}, "millwright nml FILE.nml");
        }
        file = parsed.has_value() ? rest[0] : "";
        return parsed;
    }
};

/// True for an address that only this computer can reach.
bool isLoopback(const std::string &host) {
    return host == "localhost" || host.starts_with("127.") || host == "::1";
}

/// Creates the buffers of the server process.
Result<std::vector<std::unique_ptr<nml::Buffer>>> make_buffers(const nml::Connections &connections) {
    std::vector<std::unique_ptr<nml::Buffer>> made;
    for (const nml::BufferSettings &buffer : connections.config.buffers) {
        const nml::ProcessSettings *line = connections.config.find_process(connections.process, buffer.name);
        if (line == nullptr || !line->isMaster) {
            continue;
        }
        auto opened = nml::open_buffer(buffer, *line, connections.instance, connections.local);
        if (!opened.has_value()) {
            return std::unexpected(opened.error());
        }
        made.push_back(std::move(*opened));
    }
    return made;
}

void tell_where(const nml::Config &config, const nml::Server &server, diagnostics::Sink &sink) {
    for (const nml::BufferSettings &buffer : config.buffers) {
        const bool served =
            buffer.tcp_port.has_value() || buffer.stcp_port.has_value() || buffer.udp_port.has_value();
        if (served && !isLoopback(buffer.host) && buffer.password_file.empty()) {
            sink.warning(fmt::format("any computer that reaches {} over the network can use buffer '{}'",
                                     buffer.host, buffer.name),
                         buffer.place, "require a password: passwd=FILE");
        }
    }
    fmt::print("NML channels are up{}{}\n",
               server.tcp_port() != 0 ? fmt::format(", TCP port {}", server.tcp_port()) : "",
               server.udp_port() != 0 ? fmt::format(", UDP port {}", server.udp_port()) : "");
    std::fflush(stdout);
}

Result<> run_channels(const NmlWords &words, const nml::Config &config, diagnostics::Sink &sink) {
    const std::string instance = hal::default_instance();
    const nml::Vocabulary vocabulary = nml::Vocabulary::standard();
    nml::LocalPlaces local;
    auto client = connect_to_operate(instance);
    if (!client.has_value()) {
        return std::unexpected(client.error());
    }
    const auto buffers = make_buffers({config, words.server, instance, vocabulary, local});
    if (!buffers.has_value()) {
        return std::unexpected(buffers.error());
    }
    auto bridge = nml::Bridge::open({config, words.process, instance, vocabulary, local}, *client);
    if (!bridge.has_value()) {
        return std::unexpected(bridge.error());
    }
    const auto server = nml::Server::start(config, words.server, instance, vocabulary, local);
    if (!server.has_value()) {
        return std::unexpected(server.error());
    }
    tell_where(config, **server, sink);
    std::string last_trouble;
    while (stop_signal == 0) {
        if (!client->isMachineAlive()) {
            return fail("the machine has ended");
        }
        // Commands are also read without a newer status.
        static_cast<void>(client->wait_status(TICK_S));
        (*bridge)->add((*server)->take_left_jogs());
        const auto stepped = (*bridge)->step();
        const std::string trouble = stepped.has_value() ? "" : stepped.error().str();
        if (!trouble.empty() && trouble != last_trouble) {
            sink.warning(trouble);
        }
        last_trouble = trouble;
    }
    return {};
}

}  // namespace

int command_nml(const std::vector<std::string> &arguments) {
    NmlWords words;
    if (const auto ended = ended_by_words("nml", words, arguments)) {
        return *ended;
    }
    catch_stop_signals();
    diagnostics::Sink sink = standard_error_sink();
    const auto config = nml::load_config(words.file, sink);
    if (!config.has_value()) {
        return 1;
    }
    const auto ended = run_channels(words, *config, sink);
    if (!ended.has_value()) {
        sink.failure(ended.error());
    }
    return ended.has_value() ? 0 : 1;
}

}  // namespace mw::programs

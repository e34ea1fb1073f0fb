// SPDX-License-Identifier: GPL-2.0-or-later
// millwright publish: publishes the machine's values to a shop, by Sparkplug B and MTConnect.
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/language/language.hh"
#include "base/memory_killer.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "base/whole_path.hh"
#include "clients/publish/assembly/machine_reader.hh"
#include "clients/publish/assembly/settings.hh"
#include "clients/publish/mtconnect/service.hh"
#include "clients/screen/server/server.hh"
#include "hal/core/instance.hh"
#include "programs/command_words.hh"
#include "programs/commands.hh"

namespace mw::programs {
namespace {

using namespace publish;

/// Maximum sleep between two checks of signals; period of the broker's thread.
constexpr auto SLEEP = std::chrono::milliseconds(250), BROKER_TICK = std::chrono::milliseconds(50);
constexpr auto STREAM_TICK = std::chrono::milliseconds(10), HTTP_TICK = std::chrono::milliseconds(100);
/// Interval of syncs of the log, which are only necessary for power cuts. [s]
constexpr double SYNC_S = 5;

struct PublishWords {
    std::string ini;
    bool isCheck = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line("millwright publish MACHINE.ini [--check]",
                                  "Publishes the values of a machine that 'millwright start' runs, as its "
                                  "section [PUBLISH] sets: to an MQTT "
                                  "broker\nby Sparkplug B, and to clients of MTConnect. It reads the machine "
                                  "and cannot command it. It waits "
                                  "for a machine that\nis not running yet. Ends at SIGINT or SIGTERM.\n");
        line.flag("--check", "check the section and exit", isCheck);
        line.rest(rest);
        line.footer("exit status: 0 normal end, 1 rejected or failed, 2 wrong usage\n");
        return line;
    }
    Result<> parse(const std::vector<std::string> &words) {
        const auto parsed = line().parse(words);
        if (parsed.has_value() && rest.size() != 1) {
            return fail("publish needs a machine's INI file", {}, "millwright publish MACHINE.ini");
        }
        ini = parsed.has_value() ? rest[0] : "";
        return parsed;
    }
};

TimeMs utc_ms() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<TimeMs>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}
std::int64_t steady_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}
double steady_s() {
    return static_cast<double>(steady_ns()) * 1e-9;
}

Result<client::Viewer> attach(const std::string &instance, const std::string &ini) {
    auto viewer = client::Viewer::attach(instance);
    if (viewer.has_value() && (viewer->identity().ini.str() != ini || !viewer->isMachineAlive())) {
        return fail("the running machine was started from another INI file");
    }
    return viewer;
}

/// The file with the next bdSeq number.
std::uint64_t next_bdseq(const std::string &file) {
    constexpr std::size_t MOST = 32;
    const auto text = read_file(file, MOST);
    return text.has_value() ? parse_uint(trim(*text)).value_or(0) : 0;
}

/// The file with the last published message.
MachineReader::Mark read_mark(const std::string &file) {
    constexpr std::size_t MOST = 64;
    const auto text = read_file(file, MOST);
    const auto words = text.has_value() ? split_words(*text) : std::vector<std::string>{};
    return words.size() == 2
               ? MachineReader::Mark{parse_uint(words[0]).value_or(0), parse_uint(words[1]).value_or(0)}
               : MachineReader::Mark{};
}

/// A thread that a program ends with a flag.
class Worker {
  public:
    template <class Run>
    explicit Worker(Run run) : thread_([this, run] { run(isEnded_); }) {}
    ~Worker() {
        isEnded_ = true;
        thread_.join();
    }
    Worker(const Worker &) = delete;
    Worker &operator=(const Worker &) = delete;

  private:
    std::atomic<bool> isEnded_{false};
    std::thread thread_;
};

void run_node(const Settings &settings, LiveData &data, const std::atomic<bool> &isEnded) {
    MosquittoLink link(*settings.link);
    const std::string file = settings.store + "/bdseq";
    EdgeNode node(
        settings.node, data, link, next_bdseq(file),
        [&file](std::uint64_t next) {
            static_cast<void>(write_file_atomically(file, fmt::format("{}\n", next)));
        },
        [](const std::string &what) { language::tell(what); });
    while (!isEnded) {
        link.wait(BROKER_TICK);
        node.step({utc_ms(), steady_s()});
    }
    node.end({utc_ms(), steady_s()});
}

void run_offers(const Settings &settings, offers::OfferBox &box, const std::atomic<bool> &isEnded) {
    LinkSettings own = *settings.link;
    own.client_id += "/offers";
    MosquittoLink link(own);
    OfferSession session(*settings.offers, box, link, [](const std::string &what) { language::tell(what); });
    while (!isEnded) {
        link.wait(BROKER_TICK);
        session.step({utc_ms(), steady_s()});
    }
    session.end();
}

void run_agent(screen::Server &server, const mtconnect::Agent &agent, const std::atomic<bool> &isEnded) {
    mtconnect::Service service(agent, {utc_ms, steady_s});
    bool isStreaming = false;
    while (!isEnded) {
        server.run_for(service, isStreaming ? STREAM_TICK : HTTP_TICK);
        isStreaming = service.tick();
    }
}

Result<std::unique_ptr<screen::Server>> listen(const Settings &settings, const Surroundings &around) {
    const AgentPort &port = *settings.agent_port;
    screen::ServerOptions options;
    options.port = port.address.empty() ? port.port : 0;
    options.limits.foreign_connections = options.limits.connections;
    if (!port.address.empty()) {
        std::vector<std::string> names = port.names;
        names.push_back(to_lower(around.host));
        names.push_back(to_lower(around.host) + ".local");
        options.remote =
            screen::RemoteDoor{port.address, port.port, names,
                               screen::Access(screen::Protection::NONE, screen::Role::STATUS), std::nullopt};
    }
    return screen::Server::listen(options);
}

/// If a clock was set back by less than this, it is corrected gradually.
constexpr TimeMs MS_PER_S = 1000, MOST_AHEAD_MS = 60 * MS_PER_S;

void sleep_until(double end_s) {
    while (stop_signal == 0 && steady_s() < end_s) {
        const auto left = std::chrono::duration<double>(end_s - steady_s());
        const auto part = std::min(std::chrono::ceil<std::chrono::milliseconds>(left), SLEEP);
        ::poll(nullptr, 0, static_cast<int>(part.count()));
    }
}

/// Runs until a signal.
void read_machine(MachineReader &reader, const Settings &settings, LiveData *data) {
    std::string trouble;
    bool isAhead = false;
    double next_s = steady_s(), sync_s = next_s + SYNC_S;
    while (stop_signal == 0) {
        reader.step(utc_ms(), steady_ns());
        if (data != nullptr && steady_s() >= sync_s) {
            sync_s = steady_s() + SYNC_S;
            const std::string now = data->sync();
            if (!now.empty() && now != trouble) {
                language::tell(fmt::format("Cannot store values on the disk: {}.", now));
            }
            trouble = now;
            const TimeMs ahead_ms = data->ahead_ms(utc_ms());
            const bool wasAhead = std::exchange(isAhead, ahead_ms > MOST_AHEAD_MS);
            if (isAhead && !wasAhead) {
                language::tell(fmt::format("The clock of this computer was set back: time stamps of values "
                                           "are {} s ahead until the clock catches up.",
                                           ahead_ms / MS_PER_S));
            }
        }
        next_s = std::max(next_s + settings.interval_s, steady_s());
        sleep_until(next_s);
    }
}

Result<> publish_machine(const PublishWords &words, const Settings &settings, const Surroundings &around) {
    std::optional<LiveData> data;
    std::optional<mtconnect::Agent> agent;
    std::unique_ptr<screen::Server> server;
    if (settings.link.has_value()) {
        auto log = DataLog::open(settings.store, settings.store_limits);
        if (!log.has_value()) {
            return std::unexpected(log.error());
        }
        if (log->damaged() > 0) {
            language::tell(fmt::format("{} files in {} have a damaged end: values after it are lost.",
                                       log->damaged(), settings.store));
        }
        data.emplace(std::move(*log));
    }
    if (settings.agent_port.has_value()) {
        auto listening = listen(settings, around);
        if (!listening.has_value()) {
            return std::unexpected(listening.error());
        }
        server = std::move(*listening);
        agent.emplace(settings.agent, utc_ms());
        const int remote = server->remote_port();
        fmt::print("MTConnect agent of {}: port {}\n", settings.agent.device,
                   remote != 0 ? remote : server->port());
    }
    std::fflush(stdout);
    std::optional<offers::OfferBox> box;
    if (settings.offers.has_value()) {
        auto opened = offers::OfferBox::open(settings.offers_folder());
        if (!opened.has_value()) {
            return std::unexpected(opened.error());
        }
        box.emplace(std::move(*opened));
    }
    std::optional<Worker> node, desk, door;
    if (data.has_value()) {
        node.emplace([&](const std::atomic<bool> &isEnded) { run_node(settings, *data, isEnded); });
    }
    if (box.has_value()) {
        desk.emplace([&](const std::atomic<bool> &isEnded) { run_offers(settings, *box, isEnded); });
    }
    if (agent.has_value()) {
        door.emplace([&](const std::atomic<bool> &isEnded) { run_agent(*server, *agent, isEnded); });
    }
    const std::string instance = hal::default_instance(), ini = whole_path(words.ini);
    MachineReader reader([&] { return attach(instance, ini); }, settings.deadbands,
                         data.has_value() ? &*data : nullptr, agent.has_value() ? &*agent : nullptr);
    if (data.has_value()) {
        const std::string file = settings.store + "/messages";
        reader.set_mark(read_mark(file), [file](const MachineReader::Mark &mark) {
            const auto written = write_file_atomically(file, fmt::format("{} {}\n", mark.run, mark.number));
            if (!written.has_value()) {
                language::tell(written.error().str());
            }
        });
    }
    read_machine(reader, settings, data.has_value() ? &*data : nullptr);
    return {};
}

}  // namespace

int command_publish(const std::vector<std::string> &arguments) {
    PublishWords words;
    if (const auto ended = ended_by_words("publish", words, arguments)) {
        return *ended;
    }
    catch_stop_signals();
    diagnostics::Sink sink = standard_error_sink();
    const auto file = ini::IniFile::load(words.ini, sink);
    if (!file.has_value()) {
        sink.failure(file.error());
        return 1;
    }
    const Surroundings around = this_computer();
    auto settings = read_settings(*file, around, sink);
    if (!settings.has_value() || words.isCheck) {
        return settings.has_value() ? 0 : 1;
    }
    settings->node.software = "Millwright " MW_VERSION;
    const auto ended = publish_machine(words, *settings, around);
    if (!ended.has_value()) {
        sink.failure(ended.error());
    }
    return ended.has_value() ? 0 : 1;
}

}  // namespace mw::programs

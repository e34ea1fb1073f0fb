// SPDX-License-Identifier: GPL-2.0-or-later
// millwright shop: collects the values of all machines of a shop in PostgreSQL.
#include "programs/shop/shop_command.hh"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "clients/publish/assembly/settings.hh"
#include "clients/screen/access/secrets.hh"
#include "clients/screen/server/server.hh"
#include "clients/shop/assembly/collector.hh"
#include "clients/shop/assembly/settings.hh"
#include "clients/shop/notify/notifier.hh"
#include "clients/shop/offers/offer_desk.hh"
#include "clients/shop/store/offer_store.hh"
#include "clients/shop/web/shop_page.hh"
#include "programs/command_words.hh"

namespace mw::programs {
namespace {

using namespace shop;

constexpr auto TICK = std::chrono::milliseconds(20), OFFER_TICK = std::chrono::milliseconds(50),
               HTTP_TICK = std::chrono::milliseconds(100);
/// Maximum wait at the end for a batch that the database has not committed.
constexpr double END_S = 5;
/// Interval of attempts to connect to the database. [s]
constexpr double OPEN_S = 1;

struct ShopWords {
    std::string ini;
    bool isCheck = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright shop SHOP.ini [--check]",
            "Stores the values that 'millwright publish' sends from all machines of a shop in PostgreSQL, as "
            "section [SHOP] sets,\nserves a page of the machines, and sends notifications. It offers "
            "programs to "
            "operators and cannot command a "
            "machine. Ends at SIGINT or SIGTERM.\n");
        line.flag("--check", "check the section and exit", isCheck);
        line.rest(rest);
        line.footer("exit status: 0 normal end, 1 rejected or failed, 2 wrong usage\n");
        return line;
    }
    Result<> parse(const std::vector<std::string> &words) {
        const auto parsed = line().parse(words);
        if (parsed.has_value() && rest.size() != 1) {
            return fail("shop needs an INI file", {}, "millwright shop SHOP.ini");
        }
        ini = parsed.has_value() ? rest[0] : "";
        return parsed;
    }
};

HostApplication::Moment now() {
    const auto utc = std::chrono::system_clock::now().time_since_epoch();
    const auto steady = std::chrono::steady_clock::now().time_since_epoch();
    return {static_cast<TimeMs>(std::chrono::duration_cast<std::chrono::milliseconds>(utc).count()),
            std::chrono::duration<double>(steady).count()};
}

/// May be called from any thread.
void report(const std::string &what) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    language::tell(what);
}

/// The port for other computers: read-only, or with TLS and tokens.
Result<screen::RemoteDoor> remote_door(const PagePort &port, const std::optional<screen::Tokens> &tokens) {
    std::vector<std::string> names = port.names;
    const std::string own = to_lower(publish::this_computer().host);
    names.insert(names.end(), {own, own + ".local"});
    if (!tokens.has_value()) {
        return screen::RemoteDoor{port.address, port.port, names,
                                  screen::Access(screen::Protection::NONE, screen::Role::STATUS),
                                  std::nullopt};
    }
    std::vector<std::string> certified = names;
    certified.push_back(port.address);
    auto certificate = screen::read_or_make_certificate(port.secrets, certified);
    if (!certificate.has_value()) {
        return std::unexpected(certificate.error());
    }
    return screen::RemoteDoor{port.address, port.port, names, screen::Access(*tokens),
                              std::move(*certificate)};
}

Result<std::unique_ptr<screen::Server>> listen(const PagePort &port) {
    screen::ServerOptions options;
    options.limits.body_bytes = MOST_REQUEST_BYTES;
    std::optional<screen::Tokens> tokens;
    if (!port.secrets.empty()) {
        auto found = screen::Tokens::read_or_make(port.secrets + "/tokens");
        if (!found.has_value()) {
            return std::unexpected(found.error());
        }
        tokens = options.local_tokens = std::move(*found);
    }
    options.port = port.address.empty() ? port.port : 0;
    options.limits.foreign_connections = options.limits.connections;
    if (!port.address.empty()) {
        auto door = remote_door(port, tokens);
        if (!door.has_value()) {
            return std::unexpected(door.error());
        }
        options.remote = std::move(*door);
    }
    return screen::Server::listen(options);
}

/// The page has a separate thread, so that a long query delays no values.
class PageThread {
  public:
    PageThread(std::unique_ptr<screen::Server> server, const std::string &database)
        : server_(std::move(server)), page_(database, [] { return now().at_s; }), thread_([this] {
              while (!isEnded_) {
                  server_->run_for(page_, HTTP_TICK);
              }
          }) {}
    ~PageThread() {
        isEnded_ = true;
        thread_.join();
    }
    PageThread(const PageThread &) = delete;
    PageThread &operator=(const PageThread &) = delete;

  private:
    std::unique_ptr<screen::Server> server_;
    ShopPage page_;
    std::atomic<bool> isEnded_{false};
    std::thread thread_;
};

/// Offers have a separate connection and thread, so that a large program delays no values.
class OfferThread {
  public:
    explicit OfferThread(const Settings &settings) : thread_([this, settings] { run(settings); }) {}
    ~OfferThread() {
        isEnded_ = true;
        thread_.join();
    }
    void ask_to_end() { isEnded_ = true; }
    /// False while it waits for the database.
    bool hasEnded() const { return hasEnded_; }
    OfferThread(const OfferThread &) = delete;
    OfferThread &operator=(const OfferThread &) = delete;

  private:
    void run(const Settings &settings) {
        publish::LinkSettings own = settings.link;
        own.client_id += "/offers";
        publish::MosquittoLink link(own);
        OfferStore store(settings.store.database, settings.host.name);
        OfferDesk desk(
            {.name = settings.host.name, .groups = settings.host.groups, .brokers = own.brokers.size()}, link,
            store, report);
        double open_s = now().at_s;
        while (!isEnded_) {
            link.wait(OFFER_TICK);
            if (store.isOpen()) {
                desk.step(now().at_s);
            } else if (now().at_s >= open_s) {
                // The collector reports a database that does not answer.
                desk.end();
                static_cast<void>(store.open());
                open_s = now().at_s + OPEN_S;
            }
        }
        desk.end();
        hasEnded_ = true;
    }

    std::atomic<bool> isEnded_{false}, hasEnded_{false};
    std::thread thread_;
};

Result<> collect(const Settings &settings) {
    std::optional<PageThread> page;
    if (settings.page.has_value()) {
        auto server = listen(*settings.page);
        if (!server.has_value()) {
            return std::unexpected(server.error());
        }
        const int remote = (*server)->remote_port();
        fmt::print("Shop page: port {}\n", remote != 0 ? remote : (*server)->port());
        std::fflush(stdout);
        page.emplace(std::move(*server), settings.store.database);
    }
    publish::MosquittoLink link(settings.link);
    StoreThread store(settings.store, report);
    OfferThread offers(settings);
    std::optional<Notifier> notifier;
    if (settings.notify.isUsed()) {
        notifier.emplace(settings.store.database, settings.notify, report);
    }
    Collector collector({.brokers = settings.link.brokers.size()}, settings.host, link, store, report);
    while (stop_signal == 0) {
        link.wait(TICK);
        collector.step(now());
    }
    collector.end();
    offers.ask_to_end();
    const double end_s = now().at_s + END_S;
    while (store.state() == StoreThread::State::BUSY || !offers.hasEnded()) {
        if (now().at_s > end_s) {
            report("The database does not answer. The program ends. The machines store their values.");
            std::fflush(nullptr);
            std::_Exit(0);
        }
        link.wait(TICK);
    }
    return {};
}

}  // namespace

int command_shop(const std::vector<std::string> &arguments) {
    ShopWords words;
    if (const auto ended = ended_by_words("shop", words, arguments)) {
        return *ended;
    }
    catch_stop_signals();
    diagnostics::Sink sink = standard_error_sink();
    const auto file = ini::IniFile::load(words.ini, sink);
    if (!file.has_value()) {
        sink.failure(file.error());
        return 1;
    }
    const auto settings = read_settings(*file, sink);
    if (!settings.has_value() || words.isCheck) {
        return settings.has_value() ? 0 : 1;
    }
    const auto ended = collect(*settings);
    if (!ended.has_value()) {
        sink.failure(ended.error());
    }
    return ended.has_value() ? 0 : 1;
}

}  // namespace mw::programs

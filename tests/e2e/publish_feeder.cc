// SPDX-License-Identifier: GPL-2.0-or-later
// publish-feeder STORE PORT FIRST NODE [WINDOW PERIOD_MS]: an edge node of Sparkplug whose machine counts,
// for tests that kill it or lose its messages. At most WINDOW messages are in transit. Prints each accepted
// number. Waits for the primary host "shop".
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "clients/publish/sparkplug/edge_node.hh"
#include "clients/publish/sparkplug/mosquitto_link.hh"

namespace {

using namespace mw::publish;

TimeMs utc_ms() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<TimeMs>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

EdgeNode::Moment now() {
    const auto steady = std::chrono::steady_clock::now().time_since_epoch();
    return {utc_ms(), std::chrono::duration<double>(steady).count()};
}

}  // namespace

int main(int count, char **words) {
    if (count != 5 && count != 7) {
        std::fputs("usage: publish-feeder STORE PORT FIRST NODE [WINDOW PERIOD_MS]\n", stderr);
        return 2;
    }
    const std::string store = words[1];
    auto log = DataLog::open(store);
    if (!log.has_value()) {
        std::fprintf(stderr, "%s\n", log.error().str().c_str());
        return 1;
    }
    LiveData data(std::move(*log));
    const Metric counter{.name = "Count", .type = DataType::UINT64};
    data.born({counter}, {std::uint64_t{0}}, utc_ms());
    MosquittoLink link({.brokers = {{"127.0.0.1", std::atoi(words[2])}},
                        .client_id = words[4],
                        .user = "",
                        .password = "",
                        .authorities = "",
                        .certificate = "",
                        .key = "",
                        .not_delivered_topic = "spBv1.0/test/DCMD/none/counter"});
    const auto text = mw::read_file(store + "/bdseq");
    NodeSettings settings{
        .primary_host = "shop", .first_retry_s = 0.05, .longest_retry_s = 0.2, .answer_s = 2};
    settings.group = "test";
    settings.node = words[4];
    settings.device = "counter";
    if (count == 7) {
        settings.delivery.window = std::atoi(words[5]);
    }
    const std::chrono::milliseconds period(count == 7 ? std::atoi(words[6]) : 10);
    EdgeNode node(
        settings, data, link, text.has_value() ? mw::parse_uint(mw::trim(*text)).value_or(0) : 0,
        [&store](std::uint64_t next) {
            static_cast<void>(mw::write_file_atomically(store + "/bdseq", std::to_string(next)));
        },
        [](const std::string &what) { std::fprintf(stderr, "%s\n", what.c_str()); });
    const std::uint64_t first = std::strtoull(words[3], nullptr, 10);
    std::thread broker([&] {
        while (true) {
            link.wait(std::chrono::milliseconds(10));
            node.step(now());
        }
    });
    for (std::uint64_t number = first;; ++number) {
        data.add({{0, number}}, utc_ms());
        std::printf("%llu\n", static_cast<unsigned long long>(number));
        std::fflush(stdout);
        std::this_thread::sleep_for(period);
    }
}

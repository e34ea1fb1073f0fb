// SPDX-License-Identifier: GPL-2.0-or-later
// shop-load PORT MACHINES VALUES SECONDS JOB_S: edge nodes of Sparkplug for the load test of a shop, over one
// connection. Each machine sends ten messages per second with VALUES values per second in total, and runs a
// program for half of each JOB_S seconds; every tenth program has an alarm. Prints the sent data, and the
// time from a message to its receipt.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "clients/publish/sparkplug/host_state.hh"
#include "clients/publish/sparkplug/mosquitto_link.hh"
#include "clients/publish/sparkplug/payload.hh"

namespace {

using namespace mw::publish;

constexpr unsigned METRICS = 20, EXECUTION = 120, ENDED = 121, ALARM = 122;  // aliases, from 100 on
constexpr int MESSAGES_PER_S = 10, JOBS_PER_ALARM = 10;

TimeMs utc_ms() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<TimeMs>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

struct Machine {
    std::string name;
    std::uint8_t seq = 0;
    TimeMs birth = 0, last = 0;
    std::uint64_t count = 0;                            ///< messages since the birth
    std::deque<std::pair<std::uint64_t, TimeMs>> open;  ///< without receipt
    std::vector<double> values = std::vector<double>(METRICS);
};

class Load {
  public:
    Load(int port, int machines, int values, int job_s)
        : values_(values), job_ticks_(job_s * MESSAGES_PER_S), machines_(static_cast<std::size_t>(machines)),
          link_({.brokers = {{"127.0.0.1", port}},
                 .client_id = "shop-load",
                 .user = "",
                 .password = "",
                 .authorities = "",
                 .certificate = "",
                 .key = "",
                 .not_delivered_topic = "millwright/none"}) {
        for (std::size_t i = 0; i < machines_.size(); ++i) {
            machines_[i].name = fmt::format("m{:05}", i);
        }
        link_.connect(0, {"spBv1.0/load/NDEATH/load", "", 0, false});
    }
    bool isOnline() const { return isOnline_; }
    void wait() {
        link_.wait(std::chrono::milliseconds(1));
        while (const auto event = link_.next_event()) {
            if (std::holds_alternative<Connected>(*event)) {
                link_.subscribe("spBv1.0/STATE/shop");
                link_.subscribe("spBv1.0/load/NCMD/#");
                link_.subscribe("millwright/stored/shop/load/#");
            } else if (const auto *const message = std::get_if<Publication>(&*event)) {
                take(*message);
            } else if (const auto *const lost = std::get_if<Disconnected>(&*event)) {
                std::fprintf(stderr, "%s\n", lost->reason.c_str());
                std::exit(1);
            }
        }
    }
    void send_data(std::size_t from, std::size_t end, int tick) {
        const int each = values_ / MESSAGES_PER_S;
        for (std::size_t i = from; i < end; ++i) {
            Machine &machine = machines_[i];
            machine.last = std::max(machine.last + 1, utc_ms());
            Payload payload{.at = machine.last};
            for (int k = 0; k < each; ++k) {
                const unsigned metric = static_cast<unsigned>(tick * each + k) % METRICS;
                machine.values[metric] += step_(random_);
                payload.metrics.push_back(
                    {.alias = 100U + metric, .at = machine.last, .value = machine.values[metric]});
            }
            add_job(tick, static_cast<int>(i), machine.last, payload);
            sent_ += payload.metrics.size();
            send(machine, "DDATA", true, payload);
        }
    }
    /// Messages without receipt.
    std::size_t open() const {
        std::size_t count = 0;
        for (const Machine &machine : machines_) {
            count += machine.open.size();
        }
        return count;
    }
    void report() {
        std::ranges::sort(times_);
        const auto part = [this](double share) {
            return times_.empty()
                       ? TimeMs{0}
                       : times_[static_cast<std::size_t>(share * static_cast<double>(times_.size() - 1))];
        };
        fmt::print(
            R"({{"values":{},"programs":{},"alarms":{},"messages":{},"rebirths":{},"open":{},"receipt_p50_ms":{},"receipt_p99_ms":{},"receipt_max_ms":{}}})"
            "\n",
            sent_, programs_, alarms_, messages_, rebirths_, open(), part(0.5), part(0.99), part(1));
    }

  private:
    /// Start and end of a program. The machines start at different times.
    void add_job(int now, int number, TimeMs at, Payload &payload) {
        const int tick = now + number;
        if (job_ticks_ == 0 || tick % (job_ticks_ / 2) != 0) {
            return;
        }
        const bool isBegin = tick % job_ticks_ == 0;
        payload.metrics.push_back(
            {.alias = EXECUTION, .at = at, .value = std::string(isBegin ? "ACTIVE" : "READY")});
        programs_ += isBegin ? 1 : 0;
        if (!isBegin) {
            payload.metrics.push_back({.alias = ENDED, .at = at, .value = static_cast<std::uint64_t>(tick)});
        }
        if (isBegin && (tick / job_ticks_ + number) % JOBS_PER_ALARM == 0) {
            ++alarms_;
            payload.metrics.push_back({.alias = ALARM, .at = at, .value = fmt::format("Alarm {}.", tick)});
        }
    }
    void take(const Publication &message) {
        if (message.topic == "spBv1.0/STATE/shop") {
            const auto state = read_host_state(message.payload);
            if (!isOnline_ && state.has_value() && state->isOnline) {
                isOnline_ = true;
                for (Machine &machine : machines_) {
                    bear(machine);
                }
            }
            return;
        }
        const std::string node = message.topic.substr(message.topic.rfind('/') + 1);
        Machine &machine = machines_[static_cast<std::size_t>(std::atoi(node.c_str() + 1))];
        const auto receipt = read_receipt(message.payload);
        if (!receipt.has_value()) {
            ++rebirths_;
            bear(machine);
            return;
        }
        const TimeMs now = utc_ms();
        while (receipt->birth == machine.birth && !machine.open.empty() &&
               machine.open.front().first <= receipt->count) {
            times_.push_back(now - machine.open.front().second);
            machine.open.pop_front();
        }
    }
    void bear(Machine &machine) {
        machine.seq = 0;
        machine.count = 0;
        machine.open.clear();
        machine.birth = machine.last = std::max(machine.last + 1, utc_ms());
        Payload node{.at = machine.birth};
        node.metrics.push_back(
            {.name = "bdSeq", .at = machine.birth, .type = DataType::INT64, .value = std::int64_t{0}});
        send(machine, "NBIRTH", false, node);
        Payload device{.at = machine.birth};
        for (unsigned i = 0; i < METRICS; ++i) {
            device.metrics.push_back({.name = fmt::format("Value {}", i),
                                      .alias = 100 + i,
                                      .at = machine.birth,
                                      .type = DataType::DOUBLE,
                                      .value = machine.values[i]});
        }
        for (const auto &[name, alias, value] :
             {std::tuple("Execution", EXECUTION, Value(std::string("READY"))),
              std::tuple("Program/Ended", ENDED, Value(std::int64_t{0})),
              std::tuple("Alarms/Drives", ALARM, Value(std::string()))}) {
            const DataType type = alias == ENDED ? DataType::INT64 : DataType::STRING;
            device.metrics.push_back(
                {.name = name, .alias = alias, .at = machine.birth, .type = type, .value = value});
        }
        sent_ += device.metrics.size();
        send(machine, "DBIRTH", true, device);
    }
    void send(Machine &machine, const char *type, bool isOfDevice, Payload &payload) {
        payload.seq = machine.seq++;
        payload.position = Position{machine.birth, ++machine.count};
        link_.publish({fmt::format("spBv1.0/load/{}/{}{}", type, machine.name, isOfDevice ? "/machine" : ""),
                       encode(payload), 0, false});
        ++messages_;
        machine.open.emplace_back(machine.count, utc_ms());
    }

    int values_, job_ticks_;
    std::vector<Machine> machines_;
    MosquittoLink link_;
    bool isOnline_ = false;
    std::uint64_t sent_ = 0, programs_ = 0, alarms_ = 0, messages_ = 0, rebirths_ = 0;
    std::vector<TimeMs> times_;
    std::mt19937 random_{1};
    std::normal_distribution<double> step_{0, 1};
};

}  // namespace

int main(int count, char **words) {
    if (count != 6) {
        std::fputs("usage: shop-load PORT MACHINES VALUES SECONDS JOB_S\n", stderr);
        return 2;
    }
    const int machines = std::atoi(words[2]);
    const double seconds = std::atof(words[4]);
    Load load(std::atoi(words[1]), machines, std::atoi(words[3]), std::atoi(words[5]));
    using Clock = std::chrono::steady_clock;
    while (!load.isOnline()) {
        load.wait();
    }
    // The machines are distributed over the period.
    constexpr int PARTS = 20;
    const auto begin = Clock::now();
    const auto part = std::chrono::duration<double>(1.0 / MESSAGES_PER_S / PARTS);
    const int all = static_cast<int>(seconds * MESSAGES_PER_S * PARTS);
    for (int i = 0; i < all; ++i) {
        const auto end = begin + part * i;
        do {
            load.wait();
        } while (Clock::now() < end);
        const auto edge = [&](int of) {
            return static_cast<std::size_t>(machines) * static_cast<std::size_t>(of) / PARTS;
        };
        load.send_data(edge(i % PARTS), edge(i % PARTS + 1), i / PARTS);
    }
    const auto last = Clock::now() + std::chrono::seconds(30);
    while (load.open() > 0 && Clock::now() < last) {
        load.wait();
    }
    load.report();
    return load.open() == 0 ? 0 : 1;
}

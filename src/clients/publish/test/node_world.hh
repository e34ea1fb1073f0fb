// SPDX-License-Identifier: GPL-2.0-or-later
// An edge node with a simulated machine and a simulated broker, in virtual time.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "clients/publish/sparkplug/edge_node.hh"

namespace mw::publish {

/// A packet that the node sends.
struct Packet {
    enum class Type { CONNECT, SUBSCRIBE, PUBLISH, BARRIER, DISCONNECT, DROP };
    Type type = Type::PUBLISH;
    Publication message{};  ///< CONNECT: the will
    std::size_t broker = 0;

    /// "NBIRTH"; empty for other packets.
    std::string verb() const {
        const std::size_t second = message.topic.find('/', message.topic.find('/') + 1);
        return type != Type::PUBLISH
                   ? ""
                   : message.topic.substr(second + 1, message.topic.find('/', second + 1) - second - 1);
    }
    Payload payload() const { return decode_payload(message.payload).value(); }
};

/// A broker that records packets, and answers as set by the test.
class PlayedBroker final : public BrokerLink {
  public:
    void connect(std::size_t broker, const Publication &will) override {
        packets.push_back({Packet::Type::CONNECT, will, broker});
        if (isThere) {
            events.emplace_back(Connected{});
        }
    }
    void subscribe(const std::string &topic) override {
        packets.push_back({Packet::Type::SUBSCRIBE, {topic, "", 1, false}});
        if (topic.find("/STATE/") != std::string::npos && !state.empty()) {
            events.emplace_back(Publication{topic, state, 1, true});
        }
    }
    void publish(const Publication &message) override { packets.push_back({Packet::Type::PUBLISH, message}); }
    int barrier() override {
        packets.push_back({Packet::Type::BARRIER});
        if (isAnswering) {
            events.emplace_back(BarrierPassed{++barriers_});
        }
        return isAnswering ? barriers_ : -1;
    }
    void disconnect() override { packets.push_back({Packet::Type::DISCONNECT}); }
    void drop() override { packets.push_back({Packet::Type::DROP}); }
    std::optional<LinkEvent> next_event() override {
        if (events.empty()) {
            return std::nullopt;
        }
        LinkEvent event = events.front();
        events.pop_front();
        return event;
    }

    bool isThere = true, isAnswering = true;
    std::string state;  ///< retained STATE of the primary host
    std::vector<Packet> packets;
    std::deque<LinkEvent> events;

  private:
    int barriers_ = 0;
};

/// A temporary folder, removed at the end.
class OwnFolder {
  public:
    OwnFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "mw-publish-XXXXXX").string();
        EXPECT_NE(::mkdtemp(name.data()), nullptr);
        path_ = name;
    }
    ~OwnFolder() { std::filesystem::remove_all(path_); }
    OwnFolder(const OwnFolder &) = delete;
    OwnFolder &operator=(const OwnFolder &) = delete;
    const std::string &path() const { return path_; }

  private:
    std::string path_;
};

/// Three metrics of a machine: a position, a state and a counter.
inline std::vector<Metric> played_metrics() {
    return {{.name = "Axes/X/Position", .type = DataType::DOUBLE, .unit = "mm"},
            {.name = "State", .type = DataType::STRING},
            {.name = "Count", .type = DataType::INT64}};
}

class NodeWorld {
  public:
    explicit NodeWorld(NodeSettings changed = {}) : settings(std::move(changed)) {
        settings.group = "shop";
        settings.node = "mill-1";
        settings.device = "Mill";
        settings.software = "Millwright test";
        start();
    }
    /// Starts a process; also after kill().
    void start() {
        data.emplace(std::move(*DataLog::open(folder.path())));
        node.emplace(
            settings, *data, broker, bdseq, [this](std::uint64_t next) { bdseq = next; },
            [this](const std::string &what) { reports.push_back(what); });
    }
    void kill() {
        node.reset();
        data.reset();
        broker.events.clear();
    }
    void bear_machine() { data->born(played_metrics(), {1.0, std::string("ON"), std::int64_t{-1}}, utc()); }
    void count(std::int64_t number) { data->add({{2, number}}, utc()); }
    void run(double seconds, double step_s = 0.05) {
        const double end = now_s + seconds;
        while (now_s < end) {
            now_s += step_s;
            node->step({utc(), now_s});
        }
    }
    void lose() { broker.events.emplace_back(Disconnected{"The connection is lost."}); }
    void command(const std::string &name, const Value &value) {
        Payload payload{.at = utc()};
        payload.metrics.push_back({.name = name, .value = value});
        broker.events.emplace_back(Publication{"spBv1.0/shop/NCMD/mill-1", encode(payload), 0, false});
    }
    TimeMs utc() const { return 1'700'000'000'000 + static_cast<TimeMs>(now_s * 1000); }

    std::vector<Packet> of(const std::string &verb) const {
        std::vector<Packet> found;
        for (const Packet &packet : broker.packets) {
            if (packet.verb() == verb) {
                found.push_back(packet);
            }
        }
        return found;
    }
    std::vector<std::string> verbs() const {
        std::vector<std::string> all;
        for (const Packet &packet : broker.packets) {
            if (packet.type == Packet::Type::PUBLISH) {
                all.push_back(packet.verb());
            }
        }
        return all;
    }

    OwnFolder folder;
    NodeSettings settings;
    PlayedBroker broker;
    double now_s = 100;
    std::uint64_t bdseq = 0;
    std::vector<std::string> reports;
    std::optional<LiveData> data;
    std::optional<EdgeNode> node;
};

}  // namespace mw::publish

// SPDX-License-Identifier: GPL-2.0-or-later
// The host application against edge nodes, over a broker that loses messages, in virtual time.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "clients/publish/test/node_world.hh"
#include "clients/shop/host/host_application.hh"

namespace mw::shop {
namespace {

using publish::DataType;
using publish::NodeSettings;
using publish::NodeWorld;
using publish::Packet;
using publish::Payload;
using publish::PayloadMetric;
using publish::PlayedBroker;
using publish::Publication;

class HostWorld {
  public:
    explicit HostWorld(std::size_t batch_readings = 1000)
        : host({.name = "shop", .groups = {}, .batch_readings = batch_readings}, broker,
               [this](const std::string &what) { reports.push_back(what); }) {
        host.connected();
    }
    void take(const Publication &message) { host.take(message, now()); }
    void take(const std::string &type, Payload payload, const std::string &device = "") {
        const std::string topic = "spBv1.0/shop/" + type + "/mill-1" + (device.empty() ? "" : "/" + device);
        take(Publication{topic, encode(payload), 0, false});
    }
    /// A node with the device Mill and its metric Count, alias 100.
    void bear(TimeMs birth, DataType type = DataType::INT64) {
        Payload node{.at = birth, .seq = 0};
        node.metrics.push_back(
            {.name = "bdSeq", .at = birth, .type = DataType::INT64, .value = std::int64_t{7}});
        take("NBIRTH", node);
        Payload device{.at = birth, .seq = 1};
        device.metrics.push_back(
            {.name = "Count", .alias = 100, .at = birth, .type = type, .value = std::int64_t{0}});
        take("DBIRTH", device, "Mill");
    }
    void count(std::uint64_t seq, TimeMs at, std::uint64_t value) {
        Payload data{.at = at, .seq = seq};
        data.metrics.push_back({.alias = 100, .at = at, .value = value});
        take("DDATA", data, "Mill");
    }
    HostApplication::Moment now() const {
        return {1'700'000'000'000 + static_cast<TimeMs>(now_s * 1000), now_s};
    }
    /// As a store that works. The receipts that were sent.
    std::vector<Receipt> store() {
        batches.push_back(host.take_batch());
        broker.packets.clear();
        now_s += 1;
        host.stored(batches.back().receipts);
        host.step(now());
        std::vector<Receipt> sent;
        for (const Packet &packet : broker.packets) {
            if (packet.message.topic == "millwright/stored/shop/shop/mill-1") {
                sent.push_back(publish::read_receipt(packet.message.payload).value());
            }
        }
        return sent;
    }
    std::size_t births_requested() const {
        return static_cast<std::size_t>(std::ranges::count_if(
            broker.packets, [](const Packet &packet) { return packet.verb() == "NCMD"; }));
    }

    PlayedBroker broker;
    std::vector<std::string> reports;
    HostApplication host;
    std::vector<Batch> batches;
    double now_s = 100;
};

TEST(HostApplication, SendsAReceiptForWhatIsStored) {
    HostWorld world;
    world.bear(1000);
    world.count(2, 1001, 5);
    EXPECT_EQ(world.store(), std::vector<Receipt>{(Receipt{7, 1000, 3})});
    ASSERT_EQ(world.batches.back().readings.size(), 2U);
    EXPECT_EQ(world.batches.back().readings.back().value, Value(std::int64_t{5}));
    EXPECT_TRUE(world.store().empty()) << "nothing new";
}

TEST(HostApplication, SendsNoReceiptBeyondAMissingMessage) {
    HostWorld world;
    world.bear(1000);
    world.count(2, 1001, 5);
    world.broker.packets.clear();
    world.count(4, 1003, 7);
    world.count(5, 1004, 8);
    EXPECT_EQ(world.births_requested(), 1U);
    EXPECT_EQ(world.store(), std::vector<Receipt>{(Receipt{7, 1000, 3})});
    EXPECT_EQ(world.batches.back().readings.size(), 4U) << "values with a key are stored in any order";
    world.bear(2000);
    world.count(2, 2001, 9);
    EXPECT_EQ(world.store(), std::vector<Receipt>{(Receipt{7, 2000, 3})});
}

TEST(HostApplication, DividesALargeBatchAndSendsTheReceiptWithItsEnd) {
    HostWorld world(2);
    world.bear(1000);
    world.count(2, 1001, 5);
    world.count(3, 1002, 6);
    world.count(4, 1003, 7);
    world.count(5, 1004, 8);
    EXPECT_TRUE(world.store().empty());
    EXPECT_EQ(world.batches.back().readings.size(), 2U);
    EXPECT_EQ(world.batches.back().new_series.size(), 1U);
    EXPECT_TRUE(world.host.hasBatch());
    EXPECT_TRUE(world.store().empty());
    EXPECT_EQ(world.store(), std::vector<Receipt>{(Receipt{7, 1000, 6})});
    std::vector<TimeMs> times;
    for (const Batch &batch : world.batches) {
        for (const Reading &reading : batch.readings) {
            times.push_back(reading.at);
        }
    }
    EXPECT_EQ(times, (std::vector<TimeMs>{1000, 1001, 1002, 1003, 1004}));
    EXPECT_FALSE(world.host.hasBatch());
}

TEST(HostApplication, RequestsABirthFromANodeThatItDoesNotKnow) {
    HostWorld world;
    world.broker.packets.clear();
    for (std::uint64_t i = 0; i < 100; ++i) {
        world.count(i, 1000 + i, i);
    }
    EXPECT_EQ(world.births_requested(), 1U);
    EXPECT_TRUE(world.store().empty());
}

TEST(HostApplication, ForgetsWhatWasNotStored) {
    HostWorld world;
    world.bear(1000);
    world.host.forget();
    world.host.connected();
    EXPECT_TRUE(world.store().empty());
    EXPECT_TRUE(world.batches.back().readings.empty());
    EXPECT_EQ(world.batches.back().new_series.size(), 1U)
        << "numbers of series are for the life of the process";
}

TEST(HostApplication, IgnoresReceiptsOfAnEarlierBirth) {
    HostWorld world;
    world.bear(1000);
    const Batch old = world.host.take_batch();
    world.bear(2000);
    world.host.stored(old.receipts);
    world.broker.packets.clear();
    world.host.step(world.now());
    EXPECT_TRUE(world.broker.packets.empty());
}

TEST(HostApplication, ReadsSignedNumbersAsTheirTypeIs) {
    EXPECT_EQ(typed(std::uint64_t{0xFFFFFFFB}, 3), Value(std::int64_t{-5}));
    EXPECT_EQ(typed(std::uint64_t{0xFB}, 1), Value(std::int64_t{-5}));
    EXPECT_EQ(typed(std::uint64_t{0xFFFFFFFFFFFFFFFB}, 4), Value(std::int64_t{-5}));
    EXPECT_EQ(typed(std::uint64_t{0xFFFFFFFFFFFFFFFB}, 8), Value(std::uint64_t{0xFFFFFFFFFFFFFFFB}));
}

TEST(HostApplication, FollowsDeaths) {
    HostWorld world;
    world.bear(1000);
    static_cast<void>(world.store());
    Payload old{.at = 1000};
    old.metrics.push_back({.name = "bdSeq", .type = DataType::INT64, .value = std::int64_t{6}});
    world.take("NDEATH", old);
    EXPECT_TRUE(world.host.take_batch().presences.empty()) << "the will of an earlier connection";
    old.metrics[0].value = std::int64_t{7};
    world.take("NDEATH", old);
    const Batch batch = world.host.take_batch();
    EXPECT_EQ(std::ranges::count_if(batch.presences, [](const Presence &one) { return !one.isAlive; }), 2)
        << "the node and its device";
}

TEST(HostApplication, CountsTheMachinesThatAreThere) {
    HostWorld world;
    world.bear(1000);
    static_cast<void>(world.store());
    EXPECT_FALSE(world.batches.back().census.has_value()) << "others may still be on their way";
    world.now_s += 100;
    static_cast<void>(world.store());
    static_cast<void>(world.store());
    ASSERT_TRUE(world.batches.back().census.has_value());
    EXPECT_EQ(world.batches.back().census->present,
              (std::vector<MachineName>{{{"shop", "mill-1"}, ""}, {{"shop", "mill-1"}, "Mill"}}));
    static_cast<void>(world.store());
    EXPECT_FALSE(world.batches.back().census.has_value()) << "once for each connection";
}

TEST(HostApplication, SendsNoCommandButARequestForABirth) {
    HostWorld world;
    std::mt19937 random(20261130);
    const std::vector<std::string> types{"NBIRTH", "NDEATH", "NDATA", "NCMD", "DBIRTH",
                                         "DDEATH", "DDATA",  "DCMD",  "STATE"};
    for (int i = 0; i < 20000; ++i) {
        Payload payload{.at = random() % 3 == 0 ? std::nullopt : std::optional<TimeMs>(random()),
                        .seq = random() % 256};
        for (auto left = random() % 4; left > 0; --left) {
            payload.metrics.push_back({.name = random() % 2 == 0 ? "" : "Node Control/Rebirth",
                                       .alias = random() % 5,
                                       .type = DataType::BOOLEAN,
                                       .value = random() % 2 == 0});
        }
        std::string bytes = encode(payload);
        bytes.resize(random() % 4 == 0 ? bytes.size() / 2 : bytes.size());
        const std::string type = types[random() % types.size()];
        world.take(Publication{"spBv1.0/shop/" + type + "/mill-" + std::to_string(random() % 3) +
                                   (type.starts_with('D') ? "/Mill" : ""),
                               bytes, 0, false});
        world.now_s += 0.1;
        if (random() % 10 == 0) {
            world.host.stored(world.host.take_batch().receipts);
        }
        world.host.step(world.now());
    }
    std::size_t requests = 0;
    for (const Packet &packet : world.broker.packets) {
        if (packet.type != Packet::Type::PUBLISH || packet.message.topic == "spBv1.0/STATE/shop" ||
            packet.message.topic.starts_with("millwright/stored/shop/")) {
            continue;
        }
        ASSERT_EQ(packet.verb(), "NCMD") << packet.message.topic;
        const Payload sent = packet.payload();
        ASSERT_EQ(sent.metrics.size(), 1U);
        EXPECT_EQ(sent.metrics[0].name, "Node Control/Rebirth");
        EXPECT_EQ(sent.metrics[0].value, Value(true));
        ++requests;
    }
    EXPECT_GT(requests, 100U);
}

/// A node, a host and a broker that drops messages in both directions at random, and a store that fails.
TEST(HostApplication, LosesNothingOfANodeWhenMessagesAndBatchesAreLost) {
    const unsigned seed = 4711;
    std::mt19937 random(seed);
    NodeWorld node(NodeSettings{.primary_host = "shop"});
    HostWorld world;
    node.broker.state = publish::write_host_state({true, 1, true});
    node.bear_machine();
    std::map<TimeMs, std::set<std::int64_t>> stored;
    std::vector<SeriesId> counts;
    const auto store = [&](bool isFailing) {
        Batch batch = world.host.take_batch();
        for (const Series &one : batch.new_series) {
            world.batches.emplace_back().new_series.push_back(one);
            if (one.metric == "Count") {
                counts.push_back(static_cast<SeriesId>(world.batches.size() - 1));
            }
        }
        if (isFailing) {
            // The batch is gone: the collector begins again.
            world.host.forget();
            world.host.connected();
            return;
        }
        for (const Reading &one : batch.readings) {
            if (std::ranges::find(counts, one.series) != counts.end()) {
                stored[one.at].insert(std::get<std::int64_t>(one.value));
            }
        }
        world.host.stored(batch.receipts);
    };
    const auto exchange = [&](int loss_percent) {
        const auto isLost = [&] { return static_cast<int>(random() % 100) < loss_percent; };
        for (const Packet &packet : std::exchange(node.broker.packets, {})) {
            if (packet.type == Packet::Type::PUBLISH && !isLost()) {
                world.take(packet.message);
            }
        }
        world.now_s = node.now_s;
        world.host.step(world.now());
        for (const Packet &packet : std::exchange(world.broker.packets, {})) {
            const bool isForNode = packet.verb() == "NCMD" || packet.message.topic.starts_with("millwright/");
            if (packet.type == Packet::Type::PUBLISH && isForNode && !isLost()) {
                node.broker.events.emplace_back(packet.message);
            }
        }
    };
    std::int64_t number = 0;
    for (int round = 0; round < 3000; ++round) {
        node.count(++number);
        node.run(0.1);
        exchange(round % 500 < 250 ? 5 : 0);
        if (random() % 3 == 0) {
            store(random() % 10 == 0);
        }
        if (random() % 200 == 0) {
            world.host.forget();
            world.host.connected();
        }
    }
    for (int round = 0; round < 600; ++round) {
        node.run(0.1);
        exchange(0);
        store(false);
    }
    std::map<std::int64_t, int> times;
    for (const auto &[at, values] : stored) {
        EXPECT_EQ(values.size(), 1U) << "two values have one key";
        ++times[*values.begin()];
    }
    for (std::int64_t i = 1; i <= number; ++i) {
        EXPECT_EQ(times[i], 1) << i;
    }
    EXPECT_EQ(node.data->state().confirmed, node.data->state().next) << "the node keeps nothing";
}

}  // namespace
}  // namespace mw::shop

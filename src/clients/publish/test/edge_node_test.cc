// SPDX-License-Identifier: GPL-2.0-or-later
// Tests how the edge node keeps values while brokers and its own process are lost.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "clients/publish/sparkplug/host_state.hh"
#include "clients/publish/test/node_world.hh"

namespace mw::publish {
namespace {

/// A store with the key metric and time: value of the counter by time. It reports a second value that
/// differs.
class PlayedStore {
  public:
    void take(const std::vector<Packet> &packets) {
        for (const Packet &packet : packets) {
            if (packet.verb() == "DBIRTH") {
                for (const PayloadMetric &metric : packet.payload().metrics) {
                    names_[*metric.alias] = metric.name;
                    put(metric);
                }
            } else if (packet.verb() == "DDATA") {
                for (const PayloadMetric &metric : packet.payload().metrics) {
                    put(metric);
                }
            }
        }
    }
    const std::map<TimeMs, std::uint64_t> &counts() const { return counts_; }
    int differing() const { return differing_; }

  private:
    void put(const PayloadMetric &metric) {
        if (names_[*metric.alias] != "Count") {
            return;
        }
        // Data have no type, so a number arrives as its bits.
        const auto *const plain = std::get_if<std::uint64_t>(&metric.value);
        const std::uint64_t bits =
            plain != nullptr ? *plain : static_cast<std::uint64_t>(std::get<std::int64_t>(metric.value));
        const auto [at, isNew] = counts_.emplace(*metric.at, bits);
        differing_ += !isNew && at->second != bits ? 1 : 0;
    }
    std::map<std::uint64_t, std::string> names_;
    std::map<TimeMs, std::uint64_t> counts_;
    int differing_ = 0;
};

TEST(EdgeNode, LosesAndDoublesNothingWhileBrokerAndProcessAreKilled) {
    const unsigned seed = 20261130;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    NodeWorld world;
    PlayedStore store;
    world.bear_machine();
    std::set<std::uint64_t> accepted;
    std::int64_t number = 0;
    const auto receive = [&](std::size_t lost) {
        // The last messages before a kill may not have reached a subscriber.
        world.broker.packets.resize(world.broker.packets.size() -
                                    std::min(lost, world.broker.packets.size()));
        store.take(world.broker.packets);
        world.broker.packets.clear();
    };
    for (int round = 0; round < 200; ++round) {
        for (int i = 0; i < 20; ++i) {
            world.count(++number);
            accepted.insert(static_cast<std::uint64_t>(number));
            world.run(0.1);
        }
        const auto what = random() % 3;
        const std::size_t lost = random() % 14;
        if (what == 0) {
            receive(lost);
            world.broker.isThere = false;
            world.lose();
        } else if (what == 1) {
            receive(0);
            world.kill();
            world.start();
            world.bear_machine();
        } else {
            world.broker.isThere = true;
        }
    }
    world.broker.isThere = true;
    world.run(120);
    receive(0);
    std::set<std::uint64_t> stored;
    std::map<std::uint64_t, int> times;
    for (const auto &[at, count] : store.counts()) {
        stored.insert(count);
        ++times[count];
    }
    for (const std::uint64_t count : accepted) {
        EXPECT_TRUE(stored.contains(count)) << count << " is lost";
        EXPECT_EQ(times[count], 1) << count << " is doubled";
    }
    EXPECT_EQ(store.differing(), 0) << "two values have one key";
}

TEST(EdgeNode, SendsAValueAgainThatABrokerMayHaveLost) {
    NodeWorld world;
    world.bear_machine();
    world.run(1);
    world.count(7);
    world.run(0.1);
    world.lose();
    world.run(0.1);
    world.broker.packets.clear();
    world.run(3);
    PlayedStore store;
    store.take(world.broker.packets);
    EXPECT_TRUE(std::ranges::any_of(store.counts(), [](const auto &one) { return one.second == 7; }));
}

TEST(EdgeNode, SendsNothingAgainThatIsDelivered) {
    NodeWorld world;
    world.bear_machine();
    world.count(7);
    world.run(10);
    world.lose();
    world.run(0.1);
    world.broker.packets.clear();
    world.run(5);
    EXPECT_EQ(world.verbs(), (std::vector<std::string>{"NBIRTH", "DBIRTH"}));
}

TEST(EdgeNode, KeepsWhatAHostHasNotStored) {
    NodeWorld world(NodeSettings{.primary_host = "scada"});
    world.broker.state = R"({"online":true,"timestamp":1,"receipts":true})";
    world.bear_machine();
    world.count(7);
    world.run(8);
    EXPECT_EQ(world.data->state().confirmed, 1U) << "time alone confirms nothing";
    const auto birth = world.of("NBIRTH").back().payload();
    const auto receipt = [&](std::uint64_t count) {
        world.broker.events.emplace_back(Publication{"millwright/stored/scada/shop/mill-1",
                                                     write_receipt({0, *birth.at, count}), 0, false});
        world.run(0.1);
    };
    receipt(3);
    world.count(8);
    world.run(0.1);
    EXPECT_EQ(world.data->state().confirmed, world.data->state().next - 1) << "the last has no receipt";
    receipt(4);
    EXPECT_EQ(world.data->state().confirmed, world.data->state().next);
}

TEST(EdgeNode, IgnoresReceiptsThatAreNotOfItsBirth) {
    NodeWorld world(NodeSettings{.primary_host = "scada"});
    world.broker.state = R"({"online":true,"timestamp":1,"receipts":true})";
    world.bear_machine();
    world.run(1);
    const TimeMs birth = *world.of("NBIRTH").back().payload().at;
    for (const std::string &text :
         {write_receipt({0, birth - 1, 99}), write_receipt({1, birth, 99}), std::string("{}"),
          std::string(R"({"bdSeq":0,"birth":-1,"count":3})"), std::string("[1]")}) {
        world.broker.events.emplace_back(Publication{"millwright/stored/scada/shop/mill-1", text, 0, false});
    }
    world.run(1);
    EXPECT_EQ(world.data->state().confirmed, 1U);
}

TEST(EdgeNode, LeavesABrokerThatHangs) {
    NodeWorld world;
    world.bear_machine();
    world.run(1);
    world.broker.isAnswering = false;
    for (int i = 0; i < 2000; ++i) {
        world.count(i);
    }
    world.run(5);
    EXPECT_LE(world.of("DDATA").size(), 2U * 200U + 1U) << "what is on the way is bounded";
    world.run(8);
    EXPECT_TRUE(std::ranges::any_of(world.broker.packets,
                                    [](const Packet &packet) { return packet.type == Packet::Type::DROP; }));
    EXPECT_FALSE(world.reports.empty());
    world.broker.isAnswering = true;
    world.broker.packets.clear();
    world.run(60);
    PlayedStore store;
    store.take(world.broker.packets);
    for (std::uint64_t i = 0; i < 2000; ++i) {
        EXPECT_TRUE(std::ranges::any_of(store.counts(), [i](const auto &one) { return one.second == i; }))
            << i;
    }
}

TEST(EdgeNode, TriesBrokersLessOften) {
    NodeWorld world;
    world.broker.isThere = false;
    world.bear_machine();
    int refused = 0;
    for (int i = 0; i < 6000; ++i) {
        const bool isTried = !world.broker.packets.empty();
        world.broker.packets.clear();
        if (isTried) {
            ++refused;
            world.lose();
        }
        world.run(0.05);
    }
    EXPECT_GE(refused, 10) << "in five minutes";
    EXPECT_LE(refused, 20);
    EXPECT_EQ(world.reports.size(), 1U) << "reported once";
}

TEST(EdgeNode, TakesValuesWhileTheMachineIsAway) {
    NodeWorld world;
    world.run(1);
    EXPECT_EQ(world.verbs(), std::vector<std::string>{"NBIRTH"});
    world.bear_machine();
    world.run(1);
    world.data->gone();
    world.run(1);
    EXPECT_EQ(world.verbs().back(), "DDEATH");
    world.lose();
    world.run(5);
    EXPECT_EQ(world.verbs().back(), "NBIRTH") << "the node is there without the machine";
}

TEST(EdgeNode, AcceptsARebirthByAliasAndFlood) {
    NodeWorld world;
    world.bear_machine();
    world.run(1);
    world.broker.packets.clear();
    for (int i = 0; i < 1000; ++i) {
        Payload payload;
        payload.metrics.push_back({.alias = 2, .value = true});
        world.broker.events.emplace_back(Publication{"spBv1.0/shop/NCMD/mill-1", encode(payload), 0, false});
    }
    world.run(0.05);
    EXPECT_EQ(world.of("NBIRTH").size(), 1U);
}

TEST(EdgeNode, KeepsHistoryUntilItIsSent) {
    NodeWorld world(NodeSettings{.batch = 1});
    world.broker.isThere = false;
    world.bear_machine();
    world.run(1);
    constexpr std::uint64_t COUNT = 8000;  // takes longer than the hold-back time
    for (std::uint64_t i = 1; i <= COUNT; ++i) {
        world.count(static_cast<std::int64_t>(i));
    }
    world.broker.isThere = true;
    world.run(60);
    PlayedStore store;
    store.take(world.broker.packets);
    std::set<std::uint64_t> stored;
    for (const auto &[at, count] : store.counts()) {
        stored.insert(count);
    }
    for (std::uint64_t i = 1; i <= COUNT; ++i) {
        ASSERT_TRUE(stored.contains(i)) << i;
    }
}

TEST(EdgeNode, WritesTypesOfDataOnRequest) {
    NodeWorld world(NodeSettings{.isTyped = true});
    world.bear_machine();
    world.run(1);
    world.count(-5);
    world.run(1);
    const PayloadMetric last = world.of("DDATA").back().payload().metrics.back();
    EXPECT_EQ(last.type, DataType::INT64);
    EXPECT_EQ(last.value, Value(std::int64_t{-5}));
}

TEST(EdgeNode, DropsMetricsThatTheMachineNoLongerHas) {
    NodeWorld world;
    world.broker.isThere = false;
    world.bear_machine();
    world.run(1);
    world.count(5);
    world.kill();
    world.start();
    world.data->born({{.name = "State", .type = DataType::STRING}}, {std::string("ON")}, world.utc());
    world.broker.isThere = true;
    world.run(60);
    for (const Packet &packet : world.of("DDATA")) {
        for (const PayloadMetric &metric : packet.payload().metrics) {
            EXPECT_EQ(metric.alias, 100U);
        }
    }
}

}  // namespace
}  // namespace mw::publish

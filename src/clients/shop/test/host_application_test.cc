// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the host application with messages written by the test, in virtual time.
#include <algorithm>
#include <random>

#include "clients/shop/test/host_world.hh"

namespace mw::shop {
namespace {

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
    EXPECT_EQ(world.batches.back().readings.size(), 2U) << "the others come again after the birth";
    world.bear(2000);
    world.count(2, 2001, 9);
    EXPECT_EQ(world.store(), std::vector<Receipt>{(Receipt{7, 2000, 3})});
}

/// A publisher without receipts does not repeat messages, so its first message is stored.
TEST(HostApplication, StoresAllOfANodeThatDoesNotCountItsMessages) {
    HostWorld world;
    Payload birth{.at = 1000, .seq = 0};
    birth.metrics.push_back(
        {.name = "Count", .alias = 1, .at = 1000, .type = DataType::INT64, .value = std::int64_t{0}});
    world.take("NBIRTH", birth);
    for (const std::uint64_t seq : {1U, 2U, 4U, 5U}) {
        Payload data{.at = 1000 + seq, .seq = seq};
        data.metrics.push_back({.alias = 1, .at = 1000 + seq, .value = seq});
        world.take("NDATA", data);
    }
    EXPECT_EQ(world.births_requested(), 1U);
    EXPECT_TRUE(world.store().empty()) << "a receipt would confirm what was not counted";
    EXPECT_EQ(world.batches.back().readings.size(), 5U);
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

/// The death of the device was lost with other messages; the next birth of the node does not contain it.
TEST(HostApplication, MissesADeviceAfterABirthWithoutIt) {
    HostWorld world;
    world.bear(1000);
    static_cast<void>(world.store());
    Payload node{.at = 2000, .seq = 0};
    node.metrics.push_back({.name = "bdSeq", .at = 2000, .type = DataType::INT64, .value = std::int64_t{7}});
    world.take_counted("NBIRTH", node);
    const auto gone = [&world] {
        static_cast<void>(world.store());
        std::vector<MachineName> names;
        for (const Presence &one : world.batches.back().presences) {
            if (!one.isAlive) {
                names.push_back(one.machine);
            }
        }
        return names;
    };
    EXPECT_TRUE(gone().empty()) << "its birth may be on the way";
    world.now_s += 10;
    static_cast<void>(gone());
    EXPECT_EQ(gone(), (std::vector<MachineName>{{{"shop", "mill-1"}, "Mill"}}));
    world.bear(3000);
    world.now_s += 10;
    static_cast<void>(gone());
    EXPECT_TRUE(gone().empty());
}

TEST(HostApplication, AwaitsADeviceWhoseBirthIsLost) {
    HostWorld world;
    world.bear(1000);
    static_cast<void>(world.store());
    Payload node{.at = 2000, .seq = 0};
    node.metrics.push_back({.name = "bdSeq", .at = 2000, .type = DataType::INT64, .value = std::int64_t{7}});
    world.take_counted("NBIRTH", node);
    world.count(3, 2001, 5);
    world.now_s += 10;
    static_cast<void>(world.store());
    static_cast<void>(world.store());
    EXPECT_TRUE(world.batches.back().presences.empty()) << "another birth is requested";
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

}  // namespace
}  // namespace mw::shop

// SPDX-License-Identifier: GPL-2.0-or-later
// Tests a node, a host, a broker that loses messages in both directions, and a store that fails: data that
// the node no longer keeps are stored once, in their series. Virtual time.
#include <functional>
#include <map>
#include <random>
#include <set>

#include "clients/shop/test/host_world.hh"

namespace mw::shop {
namespace {

class ShopWorld {
  public:
    using IsLost = std::function<bool(const Publication &message)>;

    explicit ShopWorld(NodeSettings settings = {.primary_host = "shop"}) : node(std::move(settings)) {
        node.broker.state = publish::write_host_state({true, 1, true});
        node.bear_machine();
    }
    /// Transfers messages in both directions.
    void exchange(const IsLost &isLost) {
        for (const Packet &packet : std::exchange(node.broker.packets, {})) {
            if (packet.type == Packet::Type::PUBLISH && !isLost(packet.message)) {
                world.take(packet.message);
            }
        }
        world.now_s = node.now_s;
        world.host.step(world.now());
        for (const Packet &packet : std::exchange(world.broker.packets, {})) {
            const bool isForNode = packet.verb() == "NCMD" || packet.message.topic.starts_with("millwright/");
            if (packet.type == Packet::Type::PUBLISH && isForNode && !isLost(packet.message)) {
                node.broker.events.emplace_back(packet.message);
            }
        }
    }
    void store() {
        const Batch batch = take();
        for (const Reading &one : batch.readings) {
            stored[names_[one.series]][one.at].push_back(one.value);
        }
        world.host.stored(batch.receipts);
    }
    /// The batch is lost, and the collector starts again.
    void fail_to_store() {
        static_cast<void>(take());
        forget();
    }
    void forget() {
        world.host.forget();
        world.host.connected();
    }
    /// Continues without losses, for at most a minute.
    void complete() {
        for (int round = 0; round < 600; ++round) {
            node.run(0.1);
            exchange([](const Publication &) { return false; });
            store();
        }
    }
    /// Numbers of Count that are not stored exactly once; a repetition under the same key is permitted.
    std::set<std::int64_t> lost_or_doubled(std::int64_t newest) {
        std::map<std::int64_t, int> times;
        for (const auto &[at, values] : stored["Count"]) {
            const std::set<Value> different(values.begin(), values.end());
            for (const Value &value : different) {
                ++times[std::get<std::int64_t>(value)];
            }
        }
        std::set<std::int64_t> wrong;
        for (std::int64_t i = 1; i <= newest; ++i) {
            if (times[i] != 1) {
                wrong.insert(i);
            }
        }
        return wrong;
    }

    NodeWorld node;
    HostWorld world;
    std::map<std::string, std::map<TimeMs, std::vector<Value>>> stored;  ///< values by metric

  private:
    Batch take() {
        Batch batch = world.host.take_batch();
        for (const Series &one : batch.new_series) {
            names_.push_back(one.metric);
        }
        return batch;
    }
    std::vector<std::string> names_;  ///< names of series
};

TEST(Delivery, LosesNothingWhenMessagesAndBatchesAreLost) {
    const unsigned seed = 4711;
    std::mt19937 random(seed);
    ShopWorld shop;
    std::int64_t number = 0;
    for (int round = 0; round < 3000; ++round) {
        shop.node.count(++number);
        shop.node.run(0.1);
        const unsigned loss_percent = round % 500 < 250 ? 5 : 0;
        shop.exchange([&](const Publication &) { return random() % 100 < loss_percent; });
        if (random() % 3 == 0) {
            random() % 10 == 0 ? shop.fail_to_store() : shop.store();
        }
        if (random() % 200 == 0) {
            shop.forget();
        }
    }
    shop.complete();
    EXPECT_EQ(shop.lost_or_doubled(number), std::set<std::int64_t>{});
    EXPECT_EQ(shop.node.data->state().confirmed, shop.node.data->state().next) << "the node keeps nothing";
}

/// The sequence number of Sparkplug repeats after 256 messages.
TEST(Delivery, LosesNothingWhenAllNumbersOfASequenceAreLost) {
    for (const int lost : {255, 256, 257, 512, 768}) {
        SCOPED_TRACE(lost);
        NodeSettings settings{.primary_host = "shop"};
        settings.delivery.window = 2000;
        ShopWorld shop(settings);
        shop.complete();
        int left = lost;
        for (std::int64_t number = 1; number <= 1000; ++number) {
            shop.node.count(number);
            shop.node.run(0.005, 0.005);
            shop.exchange([&](const Publication &message) {
                return number > 10 && message.topic.find("/DDATA/") != std::string::npos && left-- > 0;
            });
        }
        ASSERT_LT(left, 1);
        shop.complete();
        EXPECT_EQ(shop.lost_or_doubled(1000), std::set<std::int64_t>{});
    }
}

/// The host has the aliases of one birth, and receives data of the next birth with the expected sequence
/// number.
TEST(Delivery, StoresNoValueUnderTheAliasesOfAnotherBirth) {
    ShopWorld shop;
    shop.complete();
    // The births, and the record of the machine's birth.
    const std::uint64_t next = 3;
    shop.node.kill();
    shop.node.start();
    shop.node.data->born({{.name = "Temperature", .type = DataType::INT64}}, {std::int64_t{0}},
                         shop.node.utc());
    const auto isPosition = [](const Value &value) { return value == Value(1.0); };
    for (std::int64_t number = 5000; number < 5400; ++number) {
        shop.node.data->add({{0, number}}, shop.node.utc());
        shop.node.run(0.005, 0.005);
        shop.exchange([&](const Publication &message) {
            return message.topic.starts_with("spBv1.0/shop/") &&
                   publish::decode_payload(message.payload)->seq != next;
        });
        shop.store();
    }
    for (const auto &[at, values] : shop.stored["Axes/X/Position"]) {
        EXPECT_TRUE(std::ranges::all_of(values, isPosition)) << at;
    }
    shop.complete();
    EXPECT_GE(shop.stored["Temperature"].size(), 400U);
}

}  // namespace
}  // namespace mw::shop

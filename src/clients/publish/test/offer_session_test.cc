// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the session for offers of a machine in virtual time, with a simulated broker.
#include <gtest/gtest.h>

#include "clients/publish/offers/offer_session.hh"
#include "clients/publish/test/node_world.hh"

namespace mw::publish {
namespace {

const std::string ID = "0d9b0f6e-6f3f-4c39-9b53-2f6c5d2f3a10";

offers::Offer offer(const std::string &id = ID) {
    offers::Offer made{
        .id = id, .from = "Eva", .note = "", .parts = 0, .sha256 = {}, .files = {{"a.ngc", "M2\n"}}};
    made.sha256 = offers::sha256_of(made.files);
    return made;
}

class SessionWorld {
  public:
    explicit SessionWorld(std::size_t brokers = 1)
        : box(offers::OfferBox::open(folder.path()).value()),
          session({.host = "shop", .group = "g", .node = "mill-1", .device = "Mill", .brokers = brokers}, box,
                  broker, [this](const std::string &what) { told.push_back(what); }) {}
    void run(double seconds) {
        for (const double end = now_s + seconds; now_s < end; now_s += 0.05) {
            session.step({1'700'000'000'000 + static_cast<offers::TimeMs>(now_s * 1000), now_s});
        }
    }
    void send(const std::string &payload, bool isRetained = false) {
        broker.events.emplace_back(
            Publication{"millwright/offer/shop/g/mill-1/Mill", payload, 1, isRetained});
        run(0.2);
    }
    std::vector<offers::Report> reports() const {
        std::vector<offers::Report> found;
        for (const Packet &one : broker.packets) {
            if (one.type == Packet::Type::PUBLISH) {
                found.push_back(offers::decode_report(one.message.payload).value());
            }
        }
        return found;
    }
    offers::State state() const {
        const auto entries = box.entries().value();
        return entries.empty() ? offers::State::SENT : entries.front().standing.state;
    }

    OwnFolder folder;
    PlayedBroker broker;
    std::vector<std::string> told;
    double now_s = 100;
    offers::OfferBox box;
    OfferSession session;
};

TEST(OfferSession, SubscribesItsTopicAndReports) {
    SessionWorld world;
    world.run(21);
    ASSERT_GE(world.broker.packets.size(), 3);
    EXPECT_EQ(world.broker.packets[0].type, Packet::Type::CONNECT);
    EXPECT_EQ(world.broker.packets[0].message.topic, "") << "no will";
    EXPECT_EQ(world.broker.packets[1].message.topic, "millwright/offer/shop/g/mill-1/Mill");
    EXPECT_EQ(world.broker.packets[2].message.topic, "millwright/report/shop/g/mill-1/Mill");
    EXPECT_EQ(world.reports().size(), 5) << "one every five seconds";
    EXPECT_EQ(world.reports().at(0), offers::Report{});
}

TEST(OfferSession, StoresAnOfferAndReportsItAtOnce) {
    SessionWorld world;
    world.run(1);
    world.send(encode(offers::Reply{.noted = {}, .withdrawn = {}, .offer = offer()}));
    EXPECT_EQ(world.box.read(ID).value(), offer());
    ASSERT_EQ(world.reports().size(), 2);
    EXPECT_EQ(world.reports()[1].changes.at(0).state, offers::State::RECEIVED);
    EXPECT_EQ(world.reports()[1].open, std::vector{ID});
    world.send(encode(offers::Reply{.noted = {{ID, offers::State::RECEIVED}}, .withdrawn = {}, .offer = {}}));
    EXPECT_TRUE(world.reports().back().changes.empty());
    ASSERT_TRUE(
        world.box.accept(ID, "Jo", 1, [](const offers::Offer &) -> Result<> { return {}; }).has_value());
    world.run(0.2);
    EXPECT_EQ(world.reports().back().changes.at(0).state, offers::State::ACCEPTED);
    EXPECT_TRUE(world.reports().back().open.empty());
}

TEST(OfferSession, RepeatsAStateUntilItIsNoted) {
    SessionWorld world;
    world.run(1);
    world.send(encode(offers::Reply{.noted = {}, .withdrawn = {}, .offer = offer()}));
    world.run(30);
    EXPECT_EQ(world.reports().back().changes.size(), 1);
    world.broker.events.emplace_back(Disconnected{"gone"});
    world.broker.packets.clear();
    world.run(5);
    EXPECT_EQ(world.reports().at(0).changes.size(), 1);
}

TEST(OfferSession, RejectsABrokenOfferAndTellsWhy) {
    SessionWorld world;
    world.run(1);
    auto broken = offer();
    broken.files[0].name = "../a.ngc";
    world.send(encode(offers::Reply{.noted = {}, .withdrawn = {}, .offer = broken}));
    ASSERT_EQ(world.told.size(), 1);
    EXPECT_NE(world.told[0].find("not a plain file name"), std::string::npos);
    EXPECT_EQ(world.state(), offers::State::REJECTED);
    EXPECT_NE(world.reports().back().changes.at(0).reason.find("plain file name"), std::string::npos);
}

TEST(OfferSession, IgnoresOtherMessages) {
    SessionWorld world;
    world.run(1);
    for (const std::string &text :
         {std::string("run"), std::string("\xff"), std::string("{}"), std::string(10'000'000, 'x')}) {
        world.send(text);
    }
    EXPECT_EQ(world.told.size(), 3) << "one error for each, and equal ones once";
    world.send(encode(offers::Reply{.noted = {}, .withdrawn = {}, .offer = offer()}), true);
    EXPECT_TRUE(world.box.entries().value().empty()) << "retained messages are of an unknown time";
}

TEST(OfferSession, WithdrawsAnOffer) {
    SessionWorld world;
    world.run(1);
    world.send(encode(offers::Reply{.noted = {}, .withdrawn = {}, .offer = offer()}));
    world.send(encode(offers::Reply{.noted = {}, .withdrawn = {ID}, .offer = {}}));
    EXPECT_EQ(world.state(), offers::State::WITHDRAWN);
    EXPECT_EQ(world.reports().back().changes.at(0).state, offers::State::WITHDRAWN);
}

TEST(OfferSession, LooksForTheShopAtTheNextBroker) {
    SessionWorld world(2);
    world.run(130);
    std::vector<std::size_t> brokers;
    for (const Packet &one : world.broker.packets) {
        if (one.type == Packet::Type::CONNECT) {
            brokers.push_back(one.broker);
        }
    }
    EXPECT_EQ(brokers, (std::vector<std::size_t>{0, 1, 0}));
}

TEST(OfferSession, WaitsLongerForABrokerThatIsAway) {
    SessionWorld world;
    world.broker.isThere = false;
    world.run(600);
    const auto connects = std::ranges::count_if(
        world.broker.packets, [](const Packet &one) { return one.type == Packet::Type::CONNECT; });
    EXPECT_GT(connects, 10);
    EXPECT_LT(connects, 25);
    world.broker.isThere = true;
    world.run(45);
    EXPECT_FALSE(world.reports().empty());
}

}  // namespace
}  // namespace mw::publish

// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the desk of a shop with machines in virtual time. Messages between them are lost and repeated at
// random, and both sides restart at random.
#include <map>
#include <memory>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "clients/publish/offers/offer_session.hh"
#include "clients/publish/test/node_world.hh"
#include "clients/shop/offers/offer_desk.hh"

namespace mw::shop {
namespace {

using offers::Offer;
using offers::State;
using publish::OfferSession;
using publish::OwnFolder;
using publish::Packet;
using publish::PlayedBroker;
using publish::Publication;

Offer offer(int number) {
    std::string id = "00000000-0000-4000-8000-000000000000", text = std::to_string(number);
    id.replace(id.size() - text.size(), text.size(), text);
    Offer made{.id = id,
               .from = "Eva",
               .note = "",
               .parts = 1,
               .sha256 = {},
               .files = {{"part" + text + ".ngc", "M2\n"}}};
    made.sha256 = offers::sha256_of(made.files);
    return made;
}

/// The rules of the database in memory.
class PlayedLedger final : public OfferLedger {
  public:
    struct Row {
        Offer offer;
        MachineName machine;
        State state = State::SENT;
        bool isWithdrawn = false;
    };
    Result<offers::Reply> take(const MachineName &machine, const offers::Report &report) override {
        if (!isThere) {
            return fail("the database does not answer");
        }
        offers::Reply reply;
        for (const offers::Standing &one : report.changes) {
            for (Row &row : rows) {
                if (row.offer.id == one.id && row.machine == machine && !offers::isFinal(row.state)) {
                    row.state = one.state;
                }
            }
            reply.noted.push_back({one.id, one.state});
        }
        for (const Row &row : rows) {
            if (row.machine != machine || offers::isFinal(row.state)) {
                continue;
            }
            if (row.isWithdrawn) {
                reply.withdrawn.push_back(row.offer.id);
            } else if (row.state == State::SENT && report.hasRoom && !reply.offer.has_value() &&
                       std::ranges::find(report.open, row.offer.id) == report.open.end()) {
                reply.offer = row.offer;
            }
        }
        return reply;
    }
    Result<> take(const MachineName &, const offers::Copy &copy) override {
        copies.push_back(copy);
        return {};
    }
    bool isThere = true;
    std::vector<Row> rows;
    std::vector<offers::Copy> copies;
};

const MachineName MILL{{"g", "mill-1"}, "Mill"};

std::vector<Publication> published(const PlayedBroker &broker) {
    std::vector<Publication> found;
    for (const Packet &one : broker.packets) {
        if (one.type == Packet::Type::PUBLISH) {
            found.push_back(one.message);
        }
    }
    return found;
}

class DeskWorld {
  public:
    DeskWorld() { start(); }
    void start(const std::vector<std::string> &groups = {}) {
        desk = std::make_unique<OfferDesk>(DeskSettings{.name = "shop", .groups = groups}, broker, ledger,
                                           [this](const std::string &what) { told.push_back(what); });
        step();
        step();
    }
    void step(double seconds = 0.1) { desk->step(now_s += seconds); }
    void send(const std::string &topic, const std::string &payload) {
        broker.events.emplace_back(Publication{topic, payload, 1, false});
        step();
    }
    void report(const offers::Report &report) {
        send("millwright/report/shop/g/mill-1/Mill", encode(report));
    }

    PlayedBroker broker;
    PlayedLedger ledger;
    std::vector<std::string> told;
    double now_s = 100;
    std::unique_ptr<OfferDesk> desk;
};

TEST(OfferDesk, RepliesToReports) {
    DeskWorld world;
    world.ledger.rows.push_back({offer(1), MILL});
    EXPECT_EQ(world.broker.packets.at(1).message.topic, "millwright/report/shop/+/+/+");
    world.report({});
    const auto sent = published(world.broker);
    ASSERT_EQ(sent.size(), 1);
    EXPECT_EQ(sent[0].topic, "millwright/offer/shop/g/mill-1/Mill");
    EXPECT_FALSE(sent[0].isRetained);
    EXPECT_EQ(offers::decode_reply(sent[0].payload).value().offer, offer(1));
}

TEST(OfferDesk, SendsAnUnconfirmedOfferAgainOnlyLater) {
    DeskWorld world;
    world.ledger.rows.push_back({offer(1), MILL});
    int sent = 0;
    for (int second = 0; second < 61; second += 5) {
        world.broker.packets.clear();
        world.report({});
        sent += offers::decode_reply(published(world.broker).at(0).payload).value().offer.has_value() ? 1 : 0;
        world.step(5);
    }
    EXPECT_EQ(sent, 3);
}

TEST(OfferDesk, SendsNothingWithoutAReport) {
    DeskWorld world;
    world.ledger.rows.push_back({offer(1), MILL});
    for (int i = 0; i < 1000; ++i) {
        world.step();
    }
    EXPECT_TRUE(published(world.broker).empty());
}

TEST(OfferDesk, SendsNothingForOtherMessages) {
    DeskWorld world;
    const std::string good = encode(offers::Report{});
    for (const char *topic : {"millwright/report/shop/g/mill-1", "millwright/report/shop/g/mill-1/Mill/x",
                              "millwright/report/other/g/mill-1/Mill", "spBv1.0/g/DDATA/mill-1/Mill",
                              "millwright/report/shop/"}) {
        world.send(topic, good);
    }
    world.send("millwright/report/shop/g/mill-1/Mill", "\xff");
    world.send("millwright/report/shop/g/mill-1/Mill", "{}");
    world.ledger.isThere = false;
    world.report({});
    EXPECT_TRUE(published(world.broker).empty());
    EXPECT_EQ(world.told.size(), 3);
}

/// The desk has no other words than those of a reply, on no other topic.
TEST(OfferDesk, SendsOnlyReplies) {
    DeskWorld world;
    world.ledger.rows.push_back({offer(1), MILL});
    world.ledger.rows.push_back({offer(2), MILL, State::SENT, true});
    for (int i = 0; i < 50; ++i) {
        world.report(
            {.changes = {{.id = offer(2).id, .state = State::DECLINED, .at = 1, .by = {}, .reason = {}}},
             .open = {},
             .hasRoom = i % 2 == 0});
        world.step(7);
    }
    for (const Publication &one : published(world.broker)) {
        EXPECT_EQ(one.topic, "millwright/offer/shop/g/mill-1/Mill");
        EXPECT_TRUE(offers::decode_reply(one.payload).has_value());
    }
}

TEST(OfferDesk, CollectsItsGroups) {
    DeskWorld world;
    world.broker.packets.clear();
    world.start({"a", "b"});
    EXPECT_EQ(world.broker.packets.at(1).message.topic, "millwright/report/shop/a/+/+");
    EXPECT_EQ(world.broker.packets.at(3).message.topic, "millwright/report/shop/b/+/+");
}

TEST(OfferDesk, StoresOnlyCopiesWhoseHashFits) {
    DeskWorld world;
    offers::Copy copy{{"tools", offers::sha256_of_bytes("T1 P1\n"), 5}, "tool.tbl", "T1 P1\n"};
    world.send("millwright/copy/shop/g/mill-1/Mill", encode(copy));
    EXPECT_EQ(world.ledger.copies, std::vector{copy});
    copy.bytes = "T2 P1\n";
    world.send("millwright/copy/shop/g/mill-1/Mill", encode(copy));
    world.send("millwright/copy/shop/g/mill-1/Mill", "{}");
    EXPECT_EQ(world.ledger.copies.size(), 1);
    EXPECT_EQ(world.told.size(), 2);
    EXPECT_TRUE(published(world.broker).empty()) << "a copy has no answer";
}

/// A desk and a machine; a network that loses and repeats messages.
class PairWorld {
  public:
    explicit PairWorld(unsigned number) : random(number), box(offers::OfferBox::open(folder.path()).value()) {
        start_desk();
        start_session();
    }
    void start_desk() {
        shop_end.events.clear();
        desk = std::make_unique<OfferDesk>(DeskSettings{.name = "shop", .groups = {}}, shop_end, ledger,
                                           [](const std::string &) {});
    }
    void start_session() {
        machine_end.events.clear();
        session = std::make_unique<OfferSession>(
            publish::OfferSettings{.host = "shop", .group = "g", .node = "mill-1", .device = "Mill"}, box,
            machine_end, [](const std::string &) {});
    }
    /// Carries messages of one end to the other one.
    void carry(PlayedBroker &from, PlayedBroker &to, bool isGood) {
        for (const Publication &one : published(from)) {
            const std::size_t copies = isGood ? 1 : random() % 3;
            for (std::size_t i = 0; i < copies; ++i) {
                to.events.emplace_back(one);
            }
        }
        from.packets.clear();
    }
    void step(bool isGood) {
        now_s += 0.5;
        session->step({1'700'000'000'000 + static_cast<offers::TimeMs>(now_s * 1000), now_s});
        desk->step(now_s);
        carry(machine_end, shop_end, isGood);
        carry(shop_end, machine_end, isGood);
    }
    void disturb() {
        switch (random() % 12) {
        case 0: start_desk(); break;
        case 1: start_session(); break;
        case 2: ledger.isThere = !ledger.isThere; break;
        case 3: machine_end.events.emplace_back(publish::Disconnected{"gone"}); break;
        case 4: shop_end.events.emplace_back(publish::Disconnected{"gone"}); break;
        case 5: withdraw(); break;
        case 6: decide(); break;
        case 7: ledger.rows.push_back({offer(static_cast<int>(ledger.rows.size())), MILL}); break;
        default: break;
        }
    }
    void withdraw() {
        if (!ledger.rows.empty()) {
            PlayedLedger::Row &row = ledger.rows[random() % ledger.rows.size()];
            row.isWithdrawn = row.isWithdrawn || !offers::isFinal(row.state);
        }
    }
    void decide() {
        const auto entries = box.entries().value();
        for (const offers::Entry &one : entries) {
            if (one.standing.state == State::RECEIVED && random() % 2 == 0) {
                const auto put = [this](const Offer &accepted) -> Result<> {
                    ++written[accepted.id];
                    return {};
                };
                ASSERT_TRUE((random() % 2 == 0 ? box.accept(one.standing.id, "Jo", 1, put)
                                               : box.decline(one.standing.id, "Jo", "", 1))
                                .has_value());
            }
        }
    }

    std::mt19937 random;
    OwnFolder folder;
    PlayedBroker shop_end, machine_end;
    PlayedLedger ledger;
    offers::OfferBox box;
    double now_s = 100;
    std::map<std::string, int> written;
    std::unique_ptr<OfferDesk> desk;
    std::unique_ptr<OfferSession> session;
};

TEST(Offers, AreNeitherLostNorDoubled) {
    for (unsigned number = 0; number < 5; ++number) {
        PairWorld world(number);
        for (int i = 0; i < 250; ++i) {
            world.disturb();
            world.step(false);
        }
        world.ledger.isThere = true;
        for (int i = 0; i < 400; ++i) {
            world.step(true);
        }
        std::map<std::string, State> at_machine;
        const auto entries = world.box.entries().value();
        for (const offers::Entry &one : entries) {
            EXPECT_TRUE(at_machine.emplace(one.standing.id, one.standing.state).second) << "twice";
        }
        ASSERT_GT(world.ledger.rows.size(), 5);
        for (const PlayedLedger::Row &row : world.ledger.rows) {
            ASSERT_TRUE(at_machine.contains(row.offer.id)) << "lost, run " << number;
            EXPECT_EQ(row.state, at_machine[row.offer.id]) << "shop and machine differ";
            EXPECT_EQ(world.written[row.offer.id], row.state == State::ACCEPTED ? 1 : 0);
            EXPECT_TRUE(!row.isWithdrawn || offers::isFinal(row.state));
        }
        EXPECT_EQ(at_machine.size(), world.ledger.rows.size());
    }
}

}  // namespace
}  // namespace mw::shop

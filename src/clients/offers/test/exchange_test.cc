// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the messages between machine and shop, also against random changes.
#include <nlohmann/json.hpp>
#include <random>

#include <gtest/gtest.h>

#include "clients/offers/exchange.hh"

namespace mw::offers {
namespace {

const std::string ID = "0d9b0f6e-6f3f-4c39-9b53-2f6c5d2f3a10", OTHER = "1d9b0f6e-6f3f-4c39-9b53-2f6c5d2f3a10";

Report report() {
    return {.changes = {{.id = ID,
                         .state = State::DECLINED,
                         .at = 1'700'000'000'000,
                         .by = "Jo (10.0.0.7)",
                         .reason = "no stock"}},
            .open = {OTHER},
            .hasRoom = false};
}

Reply reply() {
    Offer offer{.id = ID, .from = "Eva", .note = "", .parts = 0, .sha256 = {}, .files = {{"a.ngc", "M2\n"}}};
    offer.sha256 = sha256_of(offer.files);
    return {.noted = {{OTHER, State::ACCEPTED}}, .withdrawn = {OTHER}, .offer = offer};
}

TEST(Exchange, KeepsBothMessages) {
    EXPECT_EQ(decode_report(encode(report())).value(), report());
    const Reply back = decode_reply(encode(reply())).value();
    EXPECT_EQ(back.noted, reply().noted);
    EXPECT_EQ(back.withdrawn, reply().withdrawn);
    EXPECT_EQ(back.offer, reply().offer);
    EXPECT_TRUE(decode_reply(encode(Reply{})).value().isEmpty());
}

TEST(Exchange, ReportsABrokenOfferWithItsId) {
    auto document = nlohmann::json::parse(encode(reply()));
    document["offer"]["files"][0]["name"] = "../a.ngc";
    const Reply found = decode_reply(document.dump()).value();
    EXPECT_FALSE(found.offer.has_value());
    ASSERT_TRUE(found.broken.has_value());
    EXPECT_EQ(found.broken->id, ID);
    EXPECT_NE(found.broken->why.find("plain file name"), std::string::npos);
    document["offer"]["id"] = "../..";
    EXPECT_FALSE(decode_reply(document.dump()).has_value());
}

TEST(Exchange, RejectsOtherMessages) {
    for (const char *text :
         {"", "{}", "[]", "\xff", R"({"changes":[],"open":[]})", R"({"changes":[{}],"open":[],"room":true})",
          R"({"changes":[],"open":["x"],"room":true})", R"({"changes":[],"open":[1],"room":true})"}) {
        EXPECT_FALSE(decode_report(text).has_value()) << text;
    }
    auto document = nlohmann::json::parse(encode(report()));
    for (const auto &[name, value] :
         std::initializer_list<std::pair<const char *, nlohmann::json>>{{"state", "sent"},
                                                                        {"state", "started"},
                                                                        {"at", -1},
                                                                        {"at", 1e18},
                                                                        {"by", "a\nb"},
                                                                        {"id", "x"},
                                                                        {"reason", std::string(3000, 'x')}}) {
        auto changed = document;
        changed["changes"][0][name] = value;
        EXPECT_FALSE(decode_report(changed.dump()).has_value()) << name << value;
    }
    document["open"] = std::vector<std::string>(MOST_ENTRIES + 1, ID);
    EXPECT_FALSE(decode_report(document.dump()).has_value());
}

/// The topics contain all parts, so no two machines have the same one.
TEST(Exchange, HasTopicsOutsideOfSparkplug) {
    EXPECT_EQ(report_topic("shop", "g", "n", "d"), "millwright/report/shop/g/n/d");
    EXPECT_EQ(reply_topic("shop", "g", "n", "d"), "millwright/offer/shop/g/n/d");
}

/// Decodes `text`; what is accepted is the same after its way.
void expect_stable(const std::string &text) {
    if (const auto found = decode_reply(text); found.has_value() && !found->broken.has_value()) {
        const auto again = decode_reply(encode(*found));
        ASSERT_TRUE(again.has_value()) << text;
        EXPECT_EQ(again->offer, found->offer);
        EXPECT_TRUE(!found->offer.has_value() || check(*found->offer).has_value());
    }
    if (const auto found = decode_report(text); found.has_value()) {
        EXPECT_EQ(decode_report(encode(*found)).value(), *found);
    }
}

TEST(ExchangeProperty, AnyTextIsRejectedOrStable) {
    constexpr int RUNS = 40'000;
    std::mt19937 random(43);
    const std::string texts[] = {encode(report()), encode(reply())};
    for (int run = 0; run < RUNS; ++run) {
        std::string text = texts[run % 2];
        const auto changes = 1 + random() % 4;
        for (std::size_t i = 0; i < changes; ++i) {
            const std::size_t at = random() % (text.size() + 1);
            switch (random() % 4) {
            case 0: text.erase(at, random() % 8); break;
            case 1: text.insert(at, 1, static_cast<char>(random())); break;
            case 2: text.insert(at, text.substr(random() % text.size(), random() % 30)); break;
            default:
                if (at < text.size()) {
                    text[at] = static_cast<char>(random());
                }
            }
            if (text.empty()) {
                text = "x";
            }
        }
        expect_stable(text);
    }
}

}  // namespace
}  // namespace mw::offers

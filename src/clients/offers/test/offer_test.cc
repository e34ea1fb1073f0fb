// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the rules of an offer, and that each broken rule gives one error.
#include <functional>
#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include "clients/offers/offer.hh"

namespace mw::offers {
namespace {

Offer good() {
    Offer offer{.id = "0d9b0f6e-6f3f-4c39-9b53-2f6c5d2f3a10",
                .from = "Eva Müller",
                .note = "First article only.\nCall me.",
                .parts = 20,
                .sha256 = {},
                .files = {{"bracket.ngc", "o<pocket> call [2]\nM2\n"},
                          {"pocket.ngc", "o<pocket> sub\no<pocket> endsub\n"}}};
    offer.sha256 = sha256_of(offer.files);
    return offer;
}

TEST(Offer, IsTheSameAfterItsWay) {
    const auto back = decode_offer(encode(good()));
    ASSERT_TRUE(back.has_value()) << back.error().message;
    EXPECT_EQ(*back, good());
    EXPECT_EQ(back->name(), "bracket.ngc");
}

/// sha256sum of 'a.ngc\0' '3\0' 'M2\n'.
TEST(Offer, HasTheHashOfTheBook) {
    EXPECT_EQ(sha256_of({{"a.ngc", "M2\n"}}),
              "539ba66747fe2f4f63171ef30f252ab94bd754a9729ee9b02e15535a2b81f71a");
}

TEST(Offer, OfEachBrokenRuleGivesOneError) {
    const std::string large(MOST_TEXT_BYTES + 1, ' ');
    struct Case {
        const char *what;
        std::function<void(Offer &)> change;
        bool isHashed = true;
    };
    const Case cases[] = {
        {"id", [](Offer &o) { o.id = "../../etc/passwd"; }},
        {"id", [](Offer &o) { o.id = "0D9B0F6E-6F3F-4C39-9B53-2F6C5D2F3A10"; }},
        {"sender", [](Offer &o) { o.from = ""; }},
        {"sender", [](Offer &o) { o.from = "a\nb"; }},
        {"sender", [](Offer &o) { o.from = std::string(101, 'x'); }},
        {"note", [](Offer &o) { o.note = std::string(2001, 'x'); }},
        {"note", [](Offer &o) { o.note = "\x1b[2J"; }},
        {"parts", [](Offer &o) { o.parts = -1; }},
        {"parts", [](Offer &o) { o.parts = MOST_PARTS + 1; }},
        {"1 to 32 files", [](Offer &o) { o.files.clear(); }},
        {"at most 32", [](Offer &o) { o.files.resize(MOST_FILES + 1, o.files[0]); }},
        {"plain file name", [](Offer &o) { o.files[0].name = "../a.ngc"; }},
        {"plain file name", [](Offer &o) { o.files[0].name = "/etc/a.ngc"; }},
        {"plain file name", [](Offer &o) { o.files[0].name = "..\\a.ngc"; }},
        {"plain file name", [](Offer &o) { o.files[1].name = ".a.ngc"; }},
        {"control characters", [](Offer &o) { o.files[0].name = "a\nb.ngc"; }},
        {"control characters", [](Offer &o) { o.files[0].name = std::string("a\0b.ngc", 7); }},
        {"direction", [](Offer &o) { o.files[0].name = "a\u202Ecgn.ngc"; }},
        {"is not a program", [](Offer &o) { o.files[0].name = "a.py"; }},
        {"is not a program", [](Offer &o) { o.files[0].name = "a.ngc.sh"; }},
        {"is not a program", [](Offer &o) { o.files[0].name = "ngc"; }},
        {"1 to 200 bytes", [](Offer &o) { o.files[0].name = std::string(200, 'a') + ".ngc"; }},
        {"two files", [](Offer &o) { o.files[1].name = "BRACKET.NGC"; }},
        {"maximum is", [&](Offer &o) { o.files[1].text = large; }},
        {"line 2 of bracket.ngc", [](Offer &o) { o.files[0].text = std::string("G0\nG1 X\0 M2", 11); }},
        {"SHA-256", [](Offer &o) { o.files[0].text += "G0 Z-10\n"; }, false},
        {"SHA-256", [](Offer &o) { o.sha256 = ""; }, false},
        {"SHA-256", [](Offer &o) { std::swap(o.files[0].text, o.files[1].text); }, false},
    };
    for (const Case &one : cases) {
        Offer offer = good();
        one.change(offer);
        if (one.isHashed) {
            offer.sha256 = sha256_of(offer.files);
        }
        const auto found = decode_offer(encode(offer));
        ASSERT_FALSE(found.has_value()) << one.what;
        EXPECT_NE(found.error().message.find(one.what), std::string::npos) << found.error().message;
        EXPECT_EQ(check(offer).has_value(), false) << one.what;
    }
}

TEST(Offer, OfOtherFormIsRejected) {
    const std::string text = encode(good());
    for (const std::string &broken :
         {std::string(), std::string("[]"), std::string("null"), text.substr(0, text.size() / 2),
          std::string("{\"id\":\"\xff\"}"), std::string(MOST_MESSAGE_BYTES + 1, ' ')}) {
        EXPECT_FALSE(decode_offer(broken).has_value()) << broken.substr(0, 40);
    }
    for (const char *name : {"id", "from", "note", "parts", "sha256", "files"}) {
        for (const nlohmann::json &value :
             {nlohmann::json(), nlohmann::json(1e300), nlohmann::json(-1), nlohmann::json::array({1}),
              nlohmann::json{{"a", 1}}, nlohmann::json(true)}) {
            auto document = nlohmann::json::parse(text);
            document[name] = value;
            EXPECT_FALSE(decode_offer(document.dump()).has_value()) << name << value;
            document.erase(name);
            EXPECT_FALSE(decode_offer(document.dump()).has_value()) << name;
        }
    }
}

TEST(Offer, TextMayHaveAnyUtf8) {
    Offer offer = good();
    offer.files[0].text = "(Größe Ø 20, \U0001F529)\r\n\tM2\n";
    offer.sha256 = sha256_of(offer.files);
    EXPECT_TRUE(check(offer).has_value());
    for (const char *bad :
         {"\xc3", "\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x7f", "\xc2\x85"}) {
        offer.files[0].text = bad;
        EXPECT_FALSE(check(offer).has_value());
    }
}

TEST(OfferState, HasANameInBothDirections) {
    for (const State state : {State::SENT, State::RECEIVED, State::ACCEPTED, State::DECLINED,
                              State::WITHDRAWN, State::REJECTED}) {
        EXPECT_EQ(state_of(name_of(state)), state);
        EXPECT_EQ(isFinal(state), state != State::SENT && state != State::RECEIVED);
    }
    EXPECT_FALSE(state_of("started").has_value());
}

}  // namespace
}  // namespace mw::offers

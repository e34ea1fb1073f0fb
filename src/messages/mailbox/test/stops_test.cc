// SPDX-License-Identifier: GPL-2.0-or-later
#include <set>

#include <gtest/gtest.h>

#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/stops.hh"

namespace mw::mailbox {
namespace {

TEST(Stops, EachHasAPlaceOfItsOwn) {
    std::set<std::string> different;
    for (int place = 0; place < STOP_PLACES; ++place) {
        const messages::Command stop = stop_at(place);
        EXPECT_TRUE(isStop(stop)) << place;
        EXPECT_TRUE(messages::check(stop).has_value()) << place;
        EXPECT_EQ(stop_place(stop), place);
        different.insert(messages::encode(stop));
    }
    EXPECT_EQ(different.size(), static_cast<std::size_t>(STOP_PLACES));
}

template <std::size_t... I>
void expect_places(std::index_sequence<I...>) {
    const auto expect = [](const messages::Command &command) {
        EXPECT_EQ(stop_place(command).has_value(), isStop(command)) << command.index();
    };
    (expect(std::variant_alternative_t<I, messages::CommandVariant>{}), ...);
}

TEST(Stops, OfTheWholeVocabularyHavePlacesAndNothingElseHas) {
    expect_places(std::make_index_sequence<std::variant_size_v<messages::CommandVariant>>{});
    for (int i = 0; i < 16; ++i) {
        EXPECT_TRUE(stop_place(messages::JogStop{true, i}).has_value());
        EXPECT_TRUE(stop_place(messages::JogStop{false, i}).has_value());
    }
    EXPECT_TRUE(stop_place(messages::SetState{messages::State::ESTOP}).has_value());
    EXPECT_TRUE(stop_place(messages::SetState{messages::State::OFF}).has_value());
    EXPECT_FALSE(stop_place(messages::SetState{messages::State::ON}).has_value());
}

}  // namespace
}  // namespace mw::mailbox

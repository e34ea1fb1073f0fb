// SPDX-License-Identifier: GPL-2.0-or-later
#include <set>

#include <gtest/gtest.h>

#include "mailbox/stops.hh"
#include "msgs/catalogue.hh"

namespace mw::mailbox {
namespace {

TEST(Stops, EachHasAPlaceOfItsOwn_D1) {
    std::set<std::string> different;
    for (int place = 0; place < STOP_PLACES; ++place) {
        const msgs::Command stop = stop_at(place);
        EXPECT_TRUE(isStop(stop)) << place;
        EXPECT_TRUE(msgs::check(stop).has_value()) << place;
        EXPECT_EQ(stop_place(stop), place);
        different.insert(msgs::encode(stop));
    }
    EXPECT_EQ(different.size(), static_cast<std::size_t>(STOP_PLACES));
}

template <std::size_t... I>
void expect_places(std::index_sequence<I...>) {
    const auto expect = [](const msgs::Command &command) {
        EXPECT_EQ(stop_place(command).has_value(), isStop(command)) << command.index();
    };
    (expect(std::variant_alternative_t<I, msgs::CommandVariant>{}), ...);
}

TEST(Stops, OfTheWholeVocabularyHavePlacesAndNothingElseHas_D1) {
    expect_places(std::make_index_sequence<std::variant_size_v<msgs::CommandVariant>>{});
    for (int i = 0; i < 16; ++i) {
        EXPECT_TRUE(stop_place(msgs::JogStop{true, i}).has_value());
        EXPECT_TRUE(stop_place(msgs::JogStop{false, i}).has_value());
        EXPECT_TRUE(stop_place(msgs::AbortJoint{i}).has_value());
    }
    EXPECT_TRUE(stop_place(msgs::SetState{msgs::State::ESTOP}).has_value());
    EXPECT_TRUE(stop_place(msgs::SetState{msgs::State::OFF}).has_value());
    EXPECT_FALSE(stop_place(msgs::SetState{msgs::State::ON}).has_value());
}

}  // namespace
}  // namespace mw::mailbox

// SPDX-License-Identifier: GPL-2.0-or-later
// Modes saved by M70 to M73.
#include <gtest/gtest.h>

#include "gcode/interpreter/codes/saved_modes.hh"

namespace mw::gcode::detail {
namespace {

State with_feed(double feed) {
    State out;
    out.feed = feed;
    return out;
}

TEST(SavedModes, KeepsOneSetForEachLevelOfCall) {
    SavedModes modes;
    EXPECT_EQ(modes.saved(), nullptr);
    modes.save(with_feed(1));
    modes.push_call();
    EXPECT_EQ(modes.depth(), 1u);
    EXPECT_EQ(modes.saved(), nullptr) << "a subroutine begins with none";
    modes.save(with_feed(2));
    EXPECT_EQ(modes.saved()->feed, 2);
    EXPECT_FALSE(modes.pop_call()) << "M70 does not act at the return";
    EXPECT_EQ(modes.saved()->feed, 1);
    EXPECT_EQ(modes.depth(), 0u);
}

TEST(SavedModes, GivesBackAtTheReturnWhatM73Saved) {
    SavedModes modes;
    modes.push_call();
    modes.save_until_return(with_feed(3));
    modes.push_call();
    EXPECT_FALSE(modes.pop_call());
    const std::optional<State> restored = modes.pop_call();
    ASSERT_TRUE(restored);
    EXPECT_EQ(restored->feed, 3);
}

TEST(SavedModes, TheLastToSaveDecidesAndM71Forgets) {
    SavedModes modes;
    modes.push_call();
    modes.save_until_return(with_feed(3));
    modes.save(with_feed(4));
    EXPECT_FALSE(modes.pop_call());
    modes.push_call();
    modes.save_until_return(with_feed(5));
    modes.forget();
    EXPECT_EQ(modes.saved(), nullptr);
    EXPECT_FALSE(modes.pop_call());
}

TEST(SavedModes, DropsLevelsWithoutGivingAnythingBack) {
    SavedModes modes;
    modes.save(with_feed(1));
    for (int i = 0; i < 3; ++i) {
        modes.push_call();
        modes.save_until_return(with_feed(9));
    }
    modes.drop_calls(2);
    EXPECT_EQ(modes.depth(), 2u);
    EXPECT_EQ(modes.saved()->feed, 9);
    modes.drop_calls(0);
    EXPECT_EQ(modes.saved()->feed, 1);
    modes.push_call();
    EXPECT_EQ(modes.saved(), nullptr) << "a new level holds nothing of an old one";
}

TEST(SavedModes, TellsScriptsTheStatusOfALevel) {
    SavedModes modes;
    EXPECT_EQ(modes.status(0), 0);
    modes.save({});
    EXPECT_EQ(modes.status(0), 1);
    modes.push_call();
    modes.save_until_return({});
    EXPECT_EQ(modes.status(1), 3);
    EXPECT_EQ(modes.status(0), 1);
}

TEST(SavedModes, TakesBackWhatABlockThatFailsHasSavedOrForgotten) {
    SavedModes modes;
    modes.save(with_feed(1));
    modes.rollback();
    EXPECT_EQ(modes.saved(), nullptr) << "nothing was saved before";

    modes.save(with_feed(2));
    modes.commit();
    modes.save_until_return(with_feed(3));
    modes.rollback();
    ASSERT_NE(modes.saved(), nullptr);
    EXPECT_EQ(modes.saved()->feed, 2);
    EXPECT_EQ(modes.status(0), 1) << "nor is it restored at the return";

    modes.forget();
    modes.rollback();
    ASSERT_NE(modes.saved(), nullptr);
    EXPECT_EQ(modes.saved()->feed, 2);

    modes.forget();
    modes.save(with_feed(4));
    modes.save(with_feed(5));
    modes.rollback();
    ASSERT_NE(modes.saved(), nullptr);
    EXPECT_EQ(modes.saved()->feed, 2) << "back to where the block found it";

    modes.save(with_feed(6));
    modes.commit();
    modes.rollback();
    EXPECT_EQ(modes.saved()->feed, 6) << "a block that is done is done";
}

TEST(SavedModes, TakesNothingBackOfALevelThatIsGone) {
    SavedModes modes;
    modes.save(with_feed(1));
    modes.push_call();
    modes.save(with_feed(2));
    modes.pop_call();
    modes.push_call();
    modes.rollback();
    EXPECT_EQ(modes.saved(), nullptr) << "the new level is another";
    modes.drop_calls(0);
    EXPECT_EQ(modes.saved(), nullptr) << "the main program's save was of the block that failed";
}

}  // namespace
}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// Lathe cycles in isolation: blocks of a profile in, moves of a cycle out.
#include <algorithm>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/lathe/lathe_cycles.hh"
#include "gcode/interpreter/test/code_parts.hh"

namespace mw::gcode::detail {
namespace {

using test::block;
using test::code;
using test::CodeParts;

/// A block with a programmed motion code.
BlockValues moving(int motion, std::initializer_list<std::pair<char, double>> words) {
    BlockValues values = block(words);
    values.motion = &code('g', motion);
    values.codes.push_back({values.motion, 1});
    return values;
}

class LatheCyclesAlone : public ::testing::Test {
  protected:
    LatheCyclesAlone() {
        parts.state.plane = Plane::XZ;
        parts.state.feed = 100;
        parts.state.position[geometry::AXIS_X] = 20;
        parts.state.position[geometry::AXIS_Z] = 2;
    }
    bool begin(int number, std::initializer_list<std::pair<char, double>> words) {
        return begin_lathe_cycle(code('g', number), block(words), parts.machine, lathe, parts.state,
                                 parts.canon, parts.fault, parts.outcome);
    }
    bool record(const BlockValues &values) {
        return lathe.record(values, parts.settings, parts.state, parts.fault);
    }
    bool finish() { return lathe.finish(parts.state, parts.canon, parts.fault); }
    /// To X10, along Z to -10, out to X20.
    void record_step() {
        ASSERT_TRUE(record(moving(10, {{'x', 10}, {'z', 0}})));
        ASSERT_TRUE(record(block({{'z', -10}})));
        ASSERT_TRUE(record(block({{'x', 20}})));
    }

    CodeParts parts;
    LatheCycles lathe;
};

TEST_F(LatheCyclesAlone, ACycleAsksForItsProfileFirst) {
    EXPECT_EQ(lathe.request(), nullptr);
    ASSERT_TRUE(begin(710, {{'q', 100}, {'i', 2}}));
    EXPECT_EQ(parts.outcome, Outcome::PROFILE);
    ASSERT_NE(lathe.request(), nullptr);
    EXPECT_EQ(lathe.request()->label, 100);
    EXPECT_TRUE(parts.canon.empty());
    lathe.drop();
    EXPECT_EQ(lathe.request(), nullptr);
}

TEST_F(LatheCyclesAlone, RefusesWhatCannotBeCutBeforeTheProfileIsRead) {
    EXPECT_FALSE(begin(710, {{'q', 100}, {'i', 0}}));
    EXPECT_EQ(parts.fault.message, "g71 needs a cutting increment I above 0");
    parts.state.plane = Plane::XY;
    EXPECT_FALSE(begin(710, {{'q', 100}}));
    EXPECT_EQ(parts.fault.message, "g71 needs the plane G18");
    EXPECT_EQ(lathe.request(), nullptr);
}

TEST_F(LatheCyclesAlone, MovesOfTheProfileAreKeptAndNotMade) {
    ASSERT_TRUE(begin(700, {{'q', 100}}));
    record_step();
    EXPECT_EQ(lathe.request()->profile.size(), 3U);
    EXPECT_TRUE(parts.canon.empty());
    EXPECT_EQ(parts.state.position[geometry::AXIS_X], 20);
}

TEST_F(LatheCyclesAlone, ArcsAndCornersOfTheProfileAreKept) {
    ASSERT_TRUE(begin(700, {{'q', 100}}));
    ASSERT_TRUE(record(moving(10, {{'x', 10}, {'z', 0}})));
    ASSERT_TRUE(record(block({{'z', -5}, {'a', 1}})));
    EXPECT_EQ(lathe.request()->profile.back().fillet, 1);
    ASSERT_TRUE(record(moving(20, {{'x', 15}, {'z', -10}, {'r', 5}})));
    EXPECT_TRUE(lathe.request()->profile.back().isArc);
    EXPECT_FALSE(record(moving(10, {{'z', -20}, {'a', 1}, {'c', 1}})));
    EXPECT_EQ(parts.fault.message, "A corner of the profile has either a fillet A or a chamfer C");
}

TEST_F(LatheCyclesAlone, FinishingFollowsTheProfile) {
    ASSERT_TRUE(begin(700, {{'q', 100}}));
    record_step();
    ASSERT_TRUE(finish());
    EXPECT_EQ(lathe.request(), nullptr);
    const test::Calls calls = parts.calls();
    EXPECT_TRUE(
        std::ranges::count(calls, "STRAIGHT_FEED(10.0000, 0.0000, -10.0000, 0.0000, 0.0000, 0.0000)") > 0);
    EXPECT_EQ(parts.state.motion, 10);
}

TEST_F(LatheCyclesAlone, RoughingGoesDownInLayersNoDeeperThanTheIncrement) {
    ASSERT_TRUE(begin(710, {{'q', 100}, {'i', 4}, {'r', 1}}));
    record_step();
    ASSERT_TRUE(finish());
    const test::Calls calls = parts.calls();
    for (const std::string layer : {"16.0000", "12.0000", "10.0000"}) {
        EXPECT_TRUE(std::ranges::any_of(calls, [&layer](const std::string &call) {
            return call.starts_with("STRAIGHT_FEED(" + layer + ", 0.0000, -10.0000");
        })) << layer;
    }
}

TEST_F(LatheCyclesAlone, FinishingTakesTheSideOfTheLastRoughingUntilTheProgramEnds) {
    // A bore that widens inwards, for G71 or G72; a distance lies on opposite sides then.
    const auto profile = [&] {
        ASSERT_TRUE(record(moving(10, {{'x', 20}, {'z', 0}})));
        ASSERT_TRUE(record(block({{'x', 30}, {'z', -10}})));
    };
    const auto finishing = [&] {
        parts.state.position[geometry::AXIS_X] = 10;
        parts.state.position[geometry::AXIS_Z] = 2;
        ASSERT_TRUE(begin(700, {{'q', 100}, {'d', 1}}));
        profile();
    };
    parts.state.position[geometry::AXIS_X] = 10;
    ASSERT_TRUE(begin(720, {{'q', 100}, {'i', 4}}));
    profile();
    ASSERT_TRUE(finish()) << parts.fault.message;
    finishing();
    const bool done_after_roughing = finish();
    EXPECT_TRUE(done_after_roughing) << parts.fault.message;
    lathe.forget_roughing();
    finishing();
    const bool done_alone = finish();
    EXPECT_FALSE(done_alone);
    EXPECT_NE(parts.fault.message.find("rough it in this program"), std::string::npos);
}

}  // namespace
}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// Lathe cycles in isolation: blocks of a profile in, moves of a cycle out.
#include <algorithm>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/lathe/lathe_cycles.hh"
#include "gcode/interpreter/test/code_rig.hh"

namespace mw::gcode::detail {
namespace {

using test::CodeRig;

class LatheCyclesAlone : public ::testing::Test {
  protected:
    LatheCyclesAlone() {
        p.state.plane = Plane::XZ;
        p.state.feed = 100;
        p.state.position[geometry::AXIS_X] = 20;
        p.state.position[geometry::AXIS_Z] = 2;
    }
    bool record(test::Words words) { return record(p.block(words)); }
    bool record(const BlockValues &values) { return p.lathe.record(values, p.settings, p.state); }
    /// A block with a programmed motion code.
    bool record(GCode motion, test::Words words) {
        BlockValues values = p.block(words);
        values.motion = find_code(motion);
        values.codes.push_back({values.motion, 1});
        return record(values);
    }
    bool finish() { return p.lathe.finish(p.state, p.canon, p.fault); }
    /// Records the step: to X10, along Z to -10, out to X20.
    void record_step() {
        ASSERT_TRUE(record(G(1), {{'x', 10}, {'z', 0}}));
        ASSERT_TRUE(record({{'z', -10}}));
        ASSERT_TRUE(record({{'x', 20}}));
    }

    CodeRig p;
};

TEST_F(LatheCyclesAlone, ACycleAsksForItsProfileFirst) {
    EXPECT_EQ(p.lathe.request(), nullptr);
    ASSERT_TRUE(p.run(G(71), {{'q', 100}, {'i', 2}}));
    EXPECT_EQ(p.outcome, Outcome::PROFILE);
    ASSERT_NE(p.lathe.request(), nullptr);
    EXPECT_EQ(p.lathe.request()->label, 100);
    EXPECT_TRUE(p.canon.empty());
    p.lathe.drop();
    EXPECT_EQ(p.lathe.request(), nullptr);
}

TEST_F(LatheCyclesAlone, RefusesWhatCannotBeCutBeforeTheProfileIsRead) {
    EXPECT_FALSE(p.run(G(71), {{'q', 100}, {'i', 0}}));
    EXPECT_EQ(p.fault.message, "g71 needs a cutting increment I above 0");
    p.state.plane = Plane::XY;
    EXPECT_FALSE(p.run(G(71), {{'q', 100}}));
    EXPECT_EQ(p.fault.message, "g71 needs the plane G18");
    EXPECT_EQ(p.lathe.request(), nullptr);
}

TEST_F(LatheCyclesAlone, MovesOfTheProfileAreKeptAndNotMade) {
    ASSERT_TRUE(p.run(G(70), {{'q', 100}}));
    record_step();
    EXPECT_EQ(p.lathe.request()->profile.size(), 3U);
    EXPECT_TRUE(p.canon.empty());
    EXPECT_EQ(p.state.position[geometry::AXIS_X], 20);
}

TEST_F(LatheCyclesAlone, ArcsAndCornersOfTheProfileAreKept) {
    ASSERT_TRUE(p.run(G(70), {{'q', 100}}));
    ASSERT_TRUE(record(G(1), {{'x', 10}, {'z', 0}}));
    ASSERT_TRUE(record({{'z', -5}, {'a', 1}}));
    EXPECT_EQ(p.lathe.request()->profile.back().fillet, 1);
    ASSERT_TRUE(record(G(2), {{'x', 15}, {'z', -10}, {'r', 5}}));
    EXPECT_TRUE(p.lathe.request()->profile.back().isArc);
    EXPECT_FALSE(record(G(1), {{'z', -20}, {'a', 1}, {'c', 1}}));
    EXPECT_EQ(p.fault.message, "A corner of the profile has either a fillet A or a chamfer C");
}

TEST_F(LatheCyclesAlone, FinishingFollowsTheProfile) {
    ASSERT_TRUE(p.run(G(70), {{'q', 100}}));
    record_step();
    ASSERT_TRUE(finish());
    EXPECT_EQ(p.lathe.request(), nullptr);
    const test::Calls calls = p.calls();
    EXPECT_TRUE(
        std::ranges::count(calls, "STRAIGHT_FEED(10.0000, 0.0000, -10.0000, 0.0000, 0.0000, 0.0000)") > 0);
    EXPECT_EQ(p.state.motion, G(1));
}

TEST_F(LatheCyclesAlone, RoughingGoesDownInLayersNoDeeperThanTheIncrement) {
    ASSERT_TRUE(p.run(G(71), {{'q', 100}, {'i', 4}, {'r', 1}}));
    record_step();
    ASSERT_TRUE(finish());
    const test::Calls calls = p.calls();
    for (const std::string layer : {"16.0000", "12.0000", "10.0000"}) {
        EXPECT_TRUE(std::ranges::any_of(calls, [&layer](const std::string &call) {
            return call.starts_with("STRAIGHT_FEED(" + layer + ", 0.0000, -10.0000");
        })) << layer;
    }
}

TEST_F(LatheCyclesAlone, FinishingTakesTheSideOfTheLastRoughingUntilTheProgramEnds) {
    // A bore that widens inwards. The distance D of G71 and that of G72 are on opposite sides.
    const auto profile = [&] {
        ASSERT_TRUE(record(G(1), {{'x', 20}, {'z', 0}}));
        ASSERT_TRUE(record({{'x', 30}, {'z', -10}}));
    };
    const auto finishing = [&] {
        p.state.position[geometry::AXIS_X] = 10;
        p.state.position[geometry::AXIS_Z] = 2;
        ASSERT_TRUE(p.run(G(70), {{'q', 100}, {'d', 1}}));
        profile();
    };
    p.state.position[geometry::AXIS_X] = 10;
    ASSERT_TRUE(p.run(G(72), {{'q', 100}, {'i', 4}}));
    profile();
    ASSERT_TRUE(finish()) << p.fault.message;
    finishing();
    const bool done_after_roughing = finish();
    EXPECT_TRUE(done_after_roughing) << p.fault.message;
    p.lathe.forget_roughing();
    finishing();
    const bool done_alone = finish();
    EXPECT_FALSE(done_alone);
    EXPECT_NE(p.fault.message.find("rough it in this program"), std::string::npos);
}

}  // namespace
}  // namespace mw::gcode::detail

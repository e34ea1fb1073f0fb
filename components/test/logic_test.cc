// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

struct TruthTable {
    const char *component;
    bool out[4];  ///< for in1 in0 = 00, 01, 10, 11
};

class TwoInputGate : public ::testing::TestWithParam<TruthTable> {};

TEST_P(TwoInputGate, FollowsItsTruthTable) {
    const TruthTable &table = GetParam();
    const std::string name = table.component;
    Bench bench("loadrt " + name + " names=g\naddf g t");
    for (int i = 0; i < 4; ++i) {
        bench.set("g.in0", i & 1);
        bench.set("g.in1", i >> 1 & 1);
        bench.pass();
        EXPECT_EQ(bench.get("g.out"), table.out[i] ? 1.0 : 0.0) << name << " " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(All, TwoInputGate,
                         ::testing::Values(TruthTable{"and2", {false, false, false, true}},
                                           TruthTable{"or2", {false, true, true, true}},
                                           TruthTable{"xor2", {false, true, true, false}}));

TEST(Not, Inverts) {
    Bench bench("loadrt not\naddf not.0 t");
    EXPECT_EQ(bench.after("not.0.in", 0, "not.0.out"), 1.0);
    EXPECT_EQ(bench.after("not.0.in", 1, "not.0.out"), 0.0);
}

TEST(Logic, PersonalityChoosesInputsAndOutputs) {
    Bench bench("loadrt logic count=2 personality=0x1f03,0x102\naddf logic.0 t\naddf logic.1 t");
    EXPECT_FALSE(bench.hal().pins().find("logic.0.in-03").has_value());
    EXPECT_FALSE(bench.hal().pins().find("logic.1.or").has_value());
    for (int i = 0; i < 8; ++i) {
        bench.set("logic.0.in-00", i & 1);
        bench.set("logic.0.in-01", i >> 1 & 1);
        bench.set("logic.0.in-02", i >> 2 & 1);
        bench.pass();
        const int trues = (i & 1) + (i >> 1 & 1) + (i >> 2 & 1);
        EXPECT_EQ(bench.get("logic.0.and"), trues == 3 ? 1.0 : 0.0) << i;
        EXPECT_EQ(bench.get("logic.0.or"), trues > 0 ? 1.0 : 0.0) << i;
        EXPECT_EQ(bench.get("logic.0.xor"), trues % 2) << i;
        EXPECT_EQ(bench.get("logic.0.nand"), trues == 3 ? 0.0 : 1.0) << i;
        EXPECT_EQ(bench.get("logic.0.nor"), trues > 0 ? 0.0 : 1.0) << i;
    }
}

TEST(Logic, LoadsInputsWithoutOutputs) {
    Bench bench("loadrt logic personality=0x3\naddf logic.0 t");
    EXPECT_EQ(bench.hal().pins().list("logic.0.in-*").size(), 3U);
    EXPECT_FALSE(bench.hal().pins().find("logic.0.and").has_value());
}

/// `and` of no inputs would be TRUE.
TEST(Logic, RejectsAPersonalityWithoutInputs) {
    for (const char *personality : {"0", "0x100", "0x111", "0x1ff", "-1"}) {
        Bench bench("");
        bench.run(fmt::format("loadrt logic personality={}", personality));
        EXPECT_NE(bench.output.errors.find("of instance 0 needs 1 to 16 inputs"), std::string::npos)
            << bench.output.errors;
        EXPECT_TRUE(bench.hal().pins().list("logic*").empty()) << personality;
    }
}

TEST(Lincurve, LoadsWithAnyNumberOfPoints) {
    for (const auto &[personality, points] :
         {std::pair{0, 2}, {1, 2}, {-1, 2}, {3, 3}, {16, 16}, {100, 16}}) {
        Bench bench(fmt::format("loadrt lincurve personality={}\naddf lincurve.0 t", personality));
        EXPECT_EQ(bench.hal().params().list("lincurve.0.?-val-*").size(), 2U * static_cast<unsigned>(points))
            << personality;
    }
}

TEST(Flipflop, LoadsOnRisingClockAndResetWins) {
    Bench bench("loadrt flipflop\naddf flipflop.0 t");
    bench.set("flipflop.0.data", 1);
    EXPECT_EQ(bench.after("flipflop.0.clk", 1, "flipflop.0.out"), 1.0);
    bench.set("flipflop.0.data", 0);
    bench.pass();
    EXPECT_EQ(bench.get("flipflop.0.out"), 1.0) << "a level is no edge";
    EXPECT_EQ(bench.get("flipflop.0.out-not"), 0.0);
    EXPECT_EQ(bench.after("flipflop.0.reset", 1, "flipflop.0.out"), 0.0);
    EXPECT_EQ(bench.after("flipflop.0.set", 1, "flipflop.0.out"), 0.0) << "reset overrides set";
    EXPECT_EQ(bench.after("flipflop.0.reset", 0, "flipflop.0.out"), 1.0);
}

TEST(Select8, MakesOneOutputTrue) {
    Bench bench("loadrt select8\naddf select8.0 t");
    EXPECT_EQ(bench.after("select8.0.sel", 5, "select8.0.out5"), 1.0);
    EXPECT_EQ(bench.get("select8.0.out0"), 0.0);
    EXPECT_EQ(bench.after("select8.0.sel", 8, "select8.0.out5"), 0.0) << "no such output";
    EXPECT_EQ(bench.after("select8.0.sel", 0, "select8.0.out0"), 1.0);
    EXPECT_EQ(bench.after("select8.0.enable", 0, "select8.0.out0"), 0.0);
}

TEST(EstopLatch, StaysFaultedUntilResetAndToggleswhileOk) {
    Bench bench("loadrt estop_latch\naddf estop-latch.0 t");
    bench.pass();
    EXPECT_EQ(bench.get("estop-latch.0.ok-out"), 0.0) << "faulted at start";
    EXPECT_EQ(bench.get("estop-latch.0.fault-out"), 1.0);
    EXPECT_EQ(bench.after("estop-latch.0.reset", 1, "estop-latch.0.ok-out"), 1.0);
    const double watchdog = bench.get("estop-latch.0.watchdog");
    bench.pass();
    EXPECT_NE(bench.get("estop-latch.0.watchdog"), watchdog);
    EXPECT_EQ(bench.after("estop-latch.0.fault-in", 1, "estop-latch.0.ok-out"), 0.0);
    EXPECT_EQ(bench.after("estop-latch.0.fault-in", 0, "estop-latch.0.ok-out"), 0.0)
        << "reset held is no edge";
    bench.after("estop-latch.0.reset", 0, "estop-latch.0.ok-out");
    EXPECT_EQ(bench.after("estop-latch.0.reset", 1, "estop-latch.0.ok-out"), 1.0);
    EXPECT_EQ(bench.after("estop-latch.0.ok-in", 0, "estop-latch.0.fault-out"), 1.0);
}

TEST(ChargePump, TogglesWhileEnabled) {
    Bench bench("loadrt charge_pump\naddf charge-pump t");
    const double before = bench.get("charge-pump.out");
    bench.pass();
    EXPECT_NE(bench.get("charge-pump.out"), before);
    bench.pass();
    EXPECT_EQ(bench.get("charge-pump.out"), before);
    EXPECT_EQ(bench.after("charge-pump.enable", 0, "charge-pump.out"), 0.0);
}

}  // namespace
}  // namespace mw::components::test

// SPDX-License-Identifier: GPL-2.0-or-later
// Pins and parameters of the canonical devices, in the example driver examples/driver/loop_board.cc.
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::hal {
namespace {

constexpr std::int64_t PERIOD_NS = 1'000'000;

class CanonicalDevices : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(machine.load("threads2"), "ok");
        ASSERT_EQ(machine.load("loop_board"), "ok");
        ASSERT_TRUE(machine.hal().threads().add_function("loop-board.0.read", "fast"));
        ASSERT_TRUE(machine.hal().threads().add_function("loop-board.0.write", "fast"));
        ASSERT_TRUE(machine.hal().threads().start());
        run();
    }
    void run(int steps = 1) {
        for (int i = 0; i < steps; ++i) {
            machine.clock.step();
        }
    }
    void set(const std::string &name, const std::string &value) {
        ASSERT_EQ(text_of(machine.hal().values().set("loop-board.0." + name, value)), "ok") << name;
    }
    double get(const std::string &name) { return machine.value("loop-board.0." + name).as_number(); }

    TestMachine machine;
};

TEST_F(CanonicalDevices, HaveTheirPinsAndParameters) {
    using Kind = std::pair<Type, Dir>;
    const std::map<std::string, Kind> expected{
        {"digin-00.in", {Type::BIT, Dir::OUT}},
        {"digin-00.in-not", {Type::BIT, Dir::OUT}},
        {"digout-00.out", {Type::BIT, Dir::IN}},
        {"digout-00.invert", {Type::BIT, Dir::RW}},
        {"adcin-00.value", {Type::FLOAT, Dir::OUT}},
        {"adcin-00.scale", {Type::FLOAT, Dir::RW}},
        {"adcin-00.offset", {Type::FLOAT, Dir::RW}},
        {"adcin-00.bit-weight", {Type::FLOAT, Dir::RW}},
        {"adcin-00.hw-offset", {Type::FLOAT, Dir::RW}},
        {"adcout-00.value", {Type::FLOAT, Dir::IN}},
        {"adcout-00.enable", {Type::BIT, Dir::IN}},
        {"adcout-00.scale", {Type::FLOAT, Dir::RW}},
        {"adcout-00.offset", {Type::FLOAT, Dir::RW}},
        {"adcout-00.high-limit", {Type::FLOAT, Dir::RW}},
        {"adcout-00.low-limit", {Type::FLOAT, Dir::RW}},
        {"adcout-00.bit-weight", {Type::FLOAT, Dir::RW}},
        {"adcout-00.hw-offset", {Type::FLOAT, Dir::RW}},
        {"encoder-00.count", {Type::S32, Dir::OUT}},
        {"encoder-00.rawcounts", {Type::S32, Dir::OUT}},
        {"encoder-00.position", {Type::FLOAT, Dir::OUT}},
        {"encoder-00.velocity", {Type::FLOAT, Dir::OUT}},
        {"encoder-00.reset", {Type::BIT, Dir::IN}},
        {"encoder-00.index-enable", {Type::BIT, Dir::IO}},
        {"encoder-00.scale", {Type::FLOAT, Dir::RW}},
        {"encoder-00.max-index-vel", {Type::FLOAT, Dir::RO}},
        {"encoder-00.velocity-resolution", {Type::FLOAT, Dir::RO}},
    };
    std::map<std::string, Kind> found;
    const std::string prefix = "loop-board.0.";
    for (const PinInfo &pin : machine.hal().pins().list(prefix + "*-00.*")) {
        found[pin.name.substr(prefix.size())] = {pin.type, pin.dir};
    }
    for (const ParamInfo &param : machine.hal().params().list(prefix + "*-00.*")) {
        found[param.name.substr(prefix.size())] = {param.type, param.dir};
    }
    EXPECT_EQ(found, expected);
}

TEST_F(CanonicalDevices, DigitalOutputIsInvertedAndInputHasItsInverse) {
    set("digout-00.out", "1");
    run(4);
    EXPECT_EQ(get("digin-00.in"), 1.0);
    EXPECT_EQ(get("digin-00.in-not"), 0.0);
    set("digout-00.invert", "1");
    run(4);
    EXPECT_EQ(get("digin-00.in"), 0.0);
    EXPECT_EQ(get("digin-00.in-not"), 1.0);
}

TEST_F(CanonicalDevices, AnalogOutputIsZeroUntilEnabledAndStaysWithinItsLimits) {
    const double bit = get("adcout-00.bit-weight");
    set("adcout-00.value", "3");
    set("adcout-00.offset", "1");
    set("adcout-00.scale", "2");
    run(4);
    EXPECT_NEAR(get("adcin-00.value"), 0.0, bit);
    set("adcout-00.enable", "1");
    run(4);
    EXPECT_NEAR(get("adcin-00.value"), 7.0, bit);
    set("adcout-00.high-limit", "5");
    run(4);
    EXPECT_NEAR(get("adcin-00.value"), 5.0, bit);
    set("adcout-00.high-limit", "500");
    set("adcout-00.value", "30");
    run(4);
    EXPECT_NEAR(get("adcin-00.value"), 10.0, bit) << "the hardware has no more";
    ASSERT_TRUE(machine.hal().values().set("loop-board.0.adcout-00.value",
                                           Value::of_float(std::numeric_limits<double>::quiet_NaN())));
    run(4);
    EXPECT_NEAR(get("adcin-00.value"), 0.0, bit);
    set("adcin-00.offset", "1.5");
    run(4);
    EXPECT_NEAR(get("adcin-00.value"), -1.5, bit);
}

TEST_F(CanonicalDevices, EncoderStartsAtTheIndexAndClearsIndexEnable) {
    set("encoder-00.scale", "100");
    set("adcout-00.enable", "1");
    set("adcout-00.value", "10");  // 10 counts in each period of 1 ms
    run(40);
    EXPECT_GT(get("encoder-00.count"), 0.0);
    EXPECT_NEAR(get("encoder-00.position"), get("encoder-00.count") / 100, 1e-12);
    EXPECT_NEAR(get("encoder-00.velocity"), 100.0, 1.0);
    set("encoder-00.index-enable", "1");
    for (int i = 0; i < 2000 && get("encoder-00.index-enable") != 0.0; ++i) {
        run();
    }
    EXPECT_EQ(get("encoder-00.index-enable"), 0.0);
    EXPECT_GE(get("encoder-00.count"), 0.0);
    EXPECT_LE(get("encoder-00.count"), 10.0) << "at most one period after the index";
    EXPECT_NEAR(get("encoder-00.velocity"), 100.0, 1.0) << "the index is no movement";
    set("encoder-00.reset", "1");
    run(4);
    EXPECT_EQ(get("encoder-00.count"), 0.0);
    EXPECT_EQ(get("encoder-00.position"), 0.0);
    EXPECT_NEAR(get("encoder-00.velocity"), 100.0, 1.0) << "reset leaves the velocity";
    set("encoder-00.reset", "0");
    set("encoder-00.scale", "0");
    run(4);
    EXPECT_EQ(get("encoder-00.position"), get("encoder-00.count")) << "a scale of 0 counts as 1";
}

TEST_F(CanonicalDevices, NeitherAllocateNorWait) {
    set("adcout-00.enable", "1");
    set("adcout-00.value", "10");
    set("encoder-00.index-enable", "1");
    mw::testing::AllocationGuard guard;
    machine.clock.run_until(machine.clock.now_ns() + 20'000 * PERIOD_NS);
    EXPECT_EQ(guard.calls(), 0U);
    EXPECT_GT(get("encoder-00.position"), 65536.0) << "outside the range of the 16-bit counter";
}

TEST(CanonicalNames, OverlongNameEndsTheLoad) {
    TestMachine machine;
    EXPECT_NE(machine.load("loop_board", {"names=" + std::string(100, 'n')}), "ok");
    EXPECT_TRUE(machine.hal().pins().list().empty());
}

}  // namespace
}  // namespace mw::hal

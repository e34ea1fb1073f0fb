// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the component with simulated ports, as a HAL file uses it.
#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

TEST(HalParport, HasPinsOfEachPort) {
    Bench bench{"loadrt hal_parport backend=simulated cfg=\"0x378 out 0x278 in\"\naddf parport.read-all "
                "t\naddf parport.write-all t"};
    const auto has_pin = [&](const std::string &name) { return bench.hal().pins().list(name).size() == 1; };
    for (const char *name : {"parport.0.pin-01-out", "parport.0.pin-09-out", "parport.0.pin-15-in",
                             "parport.0.pin-15-in-not", "parport.1.pin-02-in", "parport.1.pin-17-out"}) {
        EXPECT_TRUE(has_pin(name)) << name;
    }
    EXPECT_FALSE(has_pin("parport.1.pin-02-out"));
    EXPECT_FALSE(has_pin("parport.0.pin-02-in"));
    const auto params = bench.hal().params().list("parport.*.reset-time");
    ASSERT_EQ(params.size(), 1U) << "the port with inputs has no data pins to reset";
    EXPECT_EQ(params[0].type, hal::Type::U32);
}

TEST(HalParport, TouchesNoPortUnderTheVirtualClock) {
    Bench bench{"loadrt hal_parport cfg=\"0x378 out\"\naddf parport.0.write t"};
    bench.set("parport.0.pin-02-out", 1);
    bench.pass();
    EXPECT_EQ(bench.get("parport.0.pin-02-out-fake"), 1.0) << "a simulated port";
}

TEST(HalParport, CopiesLevelsBothWays) {
    Bench bench{
        "loadrt hal_parport backend=simulated cfg=0x378\naddf parport.0.read t\naddf parport.0.write t"};
    bench.set("parport.0.pin-11-in-fake", 1);
    bench.set("parport.0.pin-17-out", 1);
    bench.set("parport.0.pin-05-out-invert", 1);
    bench.pass();
    EXPECT_EQ(bench.get("parport.0.pin-11-in"), 1.0);
    EXPECT_EQ(bench.get("parport.0.pin-11-in-not"), 0.0);
    EXPECT_EQ(bench.get("parport.0.pin-10-in"), 0.0);
    EXPECT_EQ(bench.get("parport.0.pin-17-out-fake"), 1.0);
    EXPECT_EQ(bench.get("parport.0.pin-01-out-fake"), 0.0);
    EXPECT_EQ(bench.get("parport.0.pin-05-out-fake"), 1.0);
}

TEST(HalParport, TheResetEndsAStepAndKeepsOtherPins) {
    Bench bench{
        "loadrt hal_parport backend=simulated cfg=0x378\naddf parport.0.write t\naddf parport.0.reset t"};
    bench.set("parport.0.reset-time", 5000);
    bench.set("parport.0.pin-02-out-reset", 1);
    bench.set("parport.0.pin-02-out", 1);
    bench.set("parport.0.pin-03-out", 1);
    bench.pass();
    EXPECT_EQ(bench.get("parport.0.pin-02-out-fake"), 0.0);
    EXPECT_EQ(bench.get("parport.0.pin-03-out-fake"), 1.0);
    bench.set("parport.0.pin-02-out-invert", 1);
    bench.pass();
    EXPECT_EQ(bench.get("parport.0.pin-02-out-fake"), 1.0) << "an inverted step pin rests high";
}

}  // namespace
}  // namespace mw::components::test

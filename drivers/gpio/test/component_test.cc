// SPDX-License-Identifier: GPL-2.0-or-later
// The components with simulated lines, as a HAL file uses them.
#include <cstdlib>

#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

class GpioTest : public ::testing::Test {
  protected:
    GpioTest() { ::setenv("MILLWRIGHT_GPIO", "simulated", 1); }
    ~GpioTest() override { ::unsetenv("MILLWRIGHT_GPIO"); }
};

using HalGpio = GpioTest;
using HalPiGpio = GpioTest;

TEST_F(HalGpio, CopiesStatesBothWays) {
    Bench bench{"loadrt hal_gpio inputs=GPIO5,GPIO6 outputs=GPIO20,GPIO21 invert=GPIO6,GPIO21\naddf "
                "hal_gpio.read t\naddf hal_gpio.write t"};
    bench.set("hal_gpio.GPIO5-in-fake", 1);
    bench.set("hal_gpio.GPIO20-out", 1);
    bench.pass();
    EXPECT_EQ(bench.get("hal_gpio.GPIO5-in"), 1.0);
    EXPECT_EQ(bench.get("hal_gpio.GPIO5-in-not"), 0.0);
    EXPECT_EQ(bench.get("hal_gpio.GPIO6-in"), 1.0) << "inverted, and its line is low";
    EXPECT_EQ(bench.get("hal_gpio.GPIO20-out-fake"), 1.0);
    EXPECT_EQ(bench.get("hal_gpio.GPIO21-out-fake"), 1.0) << "inverted, and its pin is false";
    EXPECT_EQ(bench.get("hal_gpio.fault"), 0.0);
}

TEST(HalGpioLines, AreNotTouchedUnderTheVirtualClock) {
    Bench bench{"loadrt hal_gpio inputs=GPIO5 outputs=GPIO20\naddf hal_gpio.read t\naddf hal_gpio.write t"};
    bench.set("hal_gpio.GPIO20-out", 1);
    bench.pass();
    EXPECT_EQ(bench.get("hal_gpio.GPIO20-out-fake"), 1.0) << "a simulated line";
}

TEST_F(HalGpio, TheResetEndsAStep) {
    Bench bench{
        "loadrt hal_gpio outputs=GPIO20,GPIO21 reset=GPIO20\naddf hal_gpio.write t\naddf hal_gpio.reset t"};
    bench.set("hal_gpio.reset_ns", 5000);
    bench.set("hal_gpio.GPIO20-out", 1);
    bench.set("hal_gpio.GPIO21-out", 1);
    bench.pass();
    EXPECT_EQ(bench.get("hal_gpio.GPIO20-out-fake"), 0.0);
    EXPECT_EQ(bench.get("hal_gpio.GPIO21-out-fake"), 1.0);
}

TEST_F(HalGpio, RejectsListsThatContradict) {
    Bench bench{""};
    for (const char *words : {"", "inputs=GPIO5 outputs=GPIO5", "inputs=GPIO5 invert=GPIO6",
                              "inputs=GPIO5 reset=GPIO5", "inputs=A_NAME_THAT_IS_LONGER_THAN_LINUX_ALLOWS"}) {
        bench.output.errors.clear();
        bench.run(std::string("loadrt hal_gpio ") + words);
        EXPECT_NE(bench.output.errors, "") << words;
    }
}

TEST_F(HalPiGpio, NamesPinsByTheHeader) {
    Bench bench{
        "loadrt hal_pi_gpio dir=0x1 exclude=0x3fffffc\naddf hal_pi_gpio.read t\naddf hal_pi_gpio.write t"};
    bench.set("hal_pi_gpio.pin-03-out", 1);
    bench.set("hal_pi_gpio.pin-05-in-fake", 1);
    bench.pass();
    EXPECT_EQ(bench.get("hal_pi_gpio.pin-03-out-fake"), 1.0);
    EXPECT_EQ(bench.get("hal_pi_gpio.pin-05-in"), 1.0);
    EXPECT_TRUE(bench.hal().pins().list("hal_pi_gpio.pin-07-*").empty());
}

TEST_F(HalPiGpio, AMaskThatIsNoneIsAnError) {
    Bench bench{""};
    for (const char *words : {"dir=0x4000000", "dir=x", "exclude=0x3ffffff"}) {
        bench.output.errors.clear();
        bench.run(std::string("loadrt hal_pi_gpio ") + words);
        EXPECT_NE(bench.output.errors, "") << words;
    }
}

}  // namespace
}  // namespace mw::components::test

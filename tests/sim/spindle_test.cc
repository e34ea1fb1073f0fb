// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine in virtual time: constant surface speed (G96).
#include <numbers>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class SurfaceSpeedTest : public VirtualMachineTest {
  protected:
    void SetUp() override { switch_on(); }
    double rpm() const { return machine_->hal().values().get("spindle.0.speed-out")->as_number(); }
    void say(const std::string &line) {
        ASSERT_EQ(mdi(line), task::Progress::DONE) << line << ": " << messages();
        cycles(20);
    }
    /// [rev/min], of a surface speed in machine units a minute
    static double turning(double surface_speed, double radius) {
        return surface_speed / (2.0 * std::numbers::pi * radius);
    }
};

TEST_F(SurfaceSpeedTest, FollowsTheDistanceFromTheProgramsOrigin) {
    say("G21 G90 G10 L2 P1 X-50");
    say("G54 G0 X20");
    say("G96 D3000 S100 M3");
    EXPECT_NEAR(rpm(), turning(100000, 20), 1e-3);
    say("G0 X10");
    EXPECT_NEAR(rpm(), turning(100000, 10), 1e-3);
    say("G0 X0.1");
    EXPECT_NEAR(rpm(), 3000, 1e-3);
}

TEST_F(SurfaceSpeedTest, CountsFeetWhereTheProgramIsInInches) {
    say("G20 G90 G0 X1");
    say("G96 D3000 S300 M4");
    EXPECT_NEAR(rpm(), -turning(300 * 12 * 25.4, 25.4), 1e-3);
    say("G21 G0 X50.8");
    EXPECT_NEAR(rpm(), -turning(300 * 12 * 25.4, 50.8), 1e-3);
    say("S100");
    EXPECT_NEAR(rpm(), -turning(100000, 50.8), 1e-3);
}

TEST_F(SurfaceSpeedTest, OffsetsThatChangeChangeTheRadius) {
    say("G21 G90 G10 L2 P1 X-50");
    say("G10 L2 P2 X-30");
    say("G54 G96 D5000 S100 M3");
    say("G43.1 X5");
    say("G0 X20");
    EXPECT_NEAR(rpm(), turning(100000, 20), 1e-3);
    say("G92 X25");
    EXPECT_NEAR(rpm(), turning(100000, 25), 1e-3);
    say("G92.1 G49");
    EXPECT_NEAR(rpm(), turning(100000, 25), 1e-3);
    say("G55");
    EXPECT_NEAR(rpm(), turning(100000, 5), 1e-3);
    say("G97 S500");
    say("G54");
    EXPECT_NEAR(rpm(), 500, 1e-3);
}

}  // namespace
}  // namespace mw::machine

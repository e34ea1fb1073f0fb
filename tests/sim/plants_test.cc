// SPDX-License-Identifier: GPL-2.0-or-later
// The simulated mill with plant models (configs/sim/plants.ini): the values of motion agree with the models,
// and faults are detected. The true values are read at pins of the models that motion does not use.
#include <cmath>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class PlantsTest : public VirtualMachineTest {
  protected:
    void SetUp() override { switch_on_config(MW_SOURCE_DIR "/configs/sim/plants.ini"); }
    double pin(const std::string &name) {
        const auto value = machine_->hal().values().get(name);
        EXPECT_TRUE(value.has_value()) << name;
        return value.has_value() ? value->as_number() : NAN;
    }
};

/// Backlash of 0.02 between motor and load, counts of 0.001.
constexpr double PLAY = 0.011, COUNT = 0.001;

TEST_F(PlantsTest, HomesToTheIndexMarksAndGoesWhereItSays) {
    for (const char *axis : {"x", "y", "z"}) {
        EXPECT_NEAR(pin(std::string(axis) + "-axis.load"), 0, PLAY + COUNT) << axis;
    }
    ASSERT_EQ(mdi("G21 G90 G1 X30 Y-20 Z-10 F2000"), task::Progress::DONE) << messages();
    cycles(300);
    EXPECT_NEAR(pin("x-axis.load"), 30, PLAY + COUNT);
    EXPECT_NEAR(pin("y-axis.load"), -20, PLAY + COUNT);
    EXPECT_NEAR(pin("z-axis.load"), -10, PLAY + COUNT);
    // From the other direction: the backlash is compensated.
    ASSERT_EQ(mdi("G1 X25"), task::Progress::DONE) << messages();
    cycles(300);
    EXPECT_NEAR(pin("x-axis.load"), 25, PLAY + COUNT);
}

TEST_F(PlantsTest, AProbeFindsTheTable) {
    ASSERT_EQ(mdi("G21 G90 G38.2 Z-65 F300"), task::Progress::DONE) << messages();
    // At 5 mm/s: travel of a servo period and one count, in addition to the backlash.
    EXPECT_NEAR(motion().probed_pos[geometry::AXIS_Z], -60.05, 0.005 + COUNT + 2 * PLAY);
    set_pin("probe.stuck-open", "1");
    cycles(5);
    ASSERT_EQ(mdi("G0 Z0"), task::Progress::DONE) << messages();
    EXPECT_NE(mdi("G38.2 Z-50 F3000"), task::Progress::DONE);
    EXPECT_NE(messages().find("without making contact"), std::string::npos) << messages();
}

TEST_F(PlantsTest, ADriveThatFailsSwitchesTheMachineOff) {
    start("G21 G90 G1 X100 F3000\nM2\n");
    cycles(600);
    ASSERT_TRUE(motion().isEnabled);
    set_pin("y-amp.trip", "1");
    cycles(3);
    EXPECT_FALSE(motion().isEnabled);
    EXPECT_NE(messages().find("amp"), std::string::npos) << messages();
    EXPECT_EQ(pin("x-amp.powered"), 0);
}

TEST_F(PlantsTest, AnEncoderWithoutItsCableIsAFollowingError) {
    start("G21 G90 G1 X100 F3000\nM2\n");
    cycles(600);
    set_pin("x-encoder.lost", "1");
    cycles(200);
    EXPECT_FALSE(motion().isEnabled);
    EXPECT_NE(messages().find("following error"), std::string::npos) << messages();
}

TEST_F(PlantsTest, TheSpindleComesToItsSpeedBeforeTheCut) {
    start("G21 G90 M3 S1200\nG1 X20 F1000\nM2\n");
    // 20 turns/s at 40 turns/s^2 take half a second.
    cycles(400);
    EXPECT_NEAR(motion().joint[0].pos_cmd, 0, 1e-9);
    EXPECT_GT(pin("spindle.true-speed-rps"), 5);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_NEAR(motion().joint[0].pos_cmd, 20, 1e-9);
}

}  // namespace
}  // namespace mw::machine

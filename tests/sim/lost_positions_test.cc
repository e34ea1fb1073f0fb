// SPDX-License-Identifier: GPL-2.0-or-later
// A machine with a simulated Mesa board whose positions are lost.
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class LostPositionsTest : public VirtualMachineTest {
  protected:
    void expect_nothing_known(const std::string &when) const {
        EXPECT_FALSE(motion().isEnabled) << when;
        EXPECT_FALSE(motion().isAllHomed) << when;
        for (std::size_t joint = 0; joint < 3; ++joint) {
            EXPECT_FALSE(motion().joint[joint].isHomed) << when << ": joint " << joint;
        }
    }
};

TEST_F(LostPositionsTest, AfterABoardWasNotFollowedTheMachineIsOffAndNotHomed) {
    switch_on_config(MW_SOURCE_DIR "/configs/mesa/7i76e.ini");
    ASSERT_NE(machine_, nullptr);
    cycles(10);
    ASSERT_TRUE(motion().isAllHomed);
    start("G21 G90\nF600\nG1 X100\nM2\n");
    cycles(1000);
    ASSERT_TRUE(motion().isEnabled) << messages();
    messages();
    const std::string board = "hm2_7i76e.0.";
    set_pin(board + "io_error", "TRUE");
    cycles(20);
    expect_nothing_known("stopped");
    const std::string told = messages();
    EXPECT_NE(told.find("home all joints"), std::string::npos) << told;

    // The board answers again, which is not an action of an operator at the machine.
    set_pin(board + "io_error", "FALSE");
    cycles(50);
    ASSERT_TRUE(machine_->hal().signals().set("watchdog-bit", "FALSE").has_value());  // the signal of
                                                                                      // watchdog.has_bit
    cycles(2000);
    expect_nothing_known("followed again");

    programs::OwnMachine own(*machine_);
    programs::RunSession person(own, loaded_->machine, sink_, {});
    ASSERT_TRUE(person.switch_on().has_value());
    cycles(500);
    EXPECT_FALSE(motion().isAllHomed) << "switching on is not homing";
    ASSERT_TRUE(person.home_all().has_value());
    EXPECT_TRUE(motion().isAllHomed);
}

}  // namespace
}  // namespace mw::machine

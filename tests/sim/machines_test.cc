// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the simulated machines of configs/sim whose joints are not axes: each executes its program, and each
// axis is jogged in both directions. The judge of VirtualMachineTest checks every joint in every cycle.
#include <string>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

struct SampleMachine {
    const char *ini, *program;
    double step;  ///< of a jog [machine units, degrees]
};

class MachinesTest : public VirtualMachineTest, public ::testing::WithParamInterface<SampleMachine> {
  protected:
    void jog(int axis, double distance) {
        const client::Serial id = post(task::JogIncrement{false, axis, 20, distance});
        cycles(20);
        for (int i = 0; i < 60000 && !motion().isInPosition; ++i) {
            cycles(1);
        }
        EXPECT_EQ(progress(id), task::Progress::DONE)
            << geometry::AXIS_LETTERS[static_cast<std::size_t>(axis)] << ": " << reason(id);
    }
};

TEST_P(MachinesTest, DrivesItsProgramAndEachOfItsAxesIsJogged) {
    const SampleMachine &machine = GetParam();
    switch_on_config(std::string(MW_SOURCE_DIR "/configs/sim/") + machine.ini + ".ini");
    ask(task::SetMode{task::Mode::AUTO});
    ask(task::OpenProgram{std::string(MW_SOURCE_DIR "/nc_files/") + machine.program + ".ngc"});
    run_ = post(task::RunProgram{});
    cycles(1);
    ASSERT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_GT(loaded_->machine.isTrivial ? samples_.size() : judge_.count(), 15000U);
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{true});
    cycles(20);
    ASSERT_EQ(motion().mode, motion::Mode::TELEOP) << messages();
    const geometry::Pose start = motion().carte_pos_cmd;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((loaded_->machine.axis_mask & 1U << axis) == 0) {
            continue;
        }
        for (const double distance : {machine.step, -2 * machine.step, machine.step}) {
            const double before = motion().carte_pos_cmd[axis];
            jog(axis, distance);
            EXPECT_NEAR(motion().carte_pos_cmd[axis], before + distance, 1e-6)
                << geometry::AXIS_LETTERS[static_cast<std::size_t>(axis)] << ": " << messages();
        }
    }
    EXPECT_NEAR(geometry::norm(motion().carte_pos_cmd - start), 0, 1e-6);
    EXPECT_TRUE(motion().isEnabled);
}

INSTANTIATE_TEST_SUITE_P(
    All, MachinesTest,
    ::testing::Values(SampleMachine{"corexy", "figure", 10}, SampleMachine{"delta", "figure", 10},
                      SampleMachine{"hexapod", "figure", 0.5}, SampleMachine{"scara", "figure", 10},
                      SampleMachine{"puma", "figure", 10}, SampleMachine{"gantry_xyyz", "contour", 10},
                      SampleMachine{"table_xyzac", "tilted_table", 10},
                      SampleMachine{"head_xyzbcw", "tilted_head", 10},
                      SampleMachine{"mill_turn", "mill_turn", 10}),
    [](const auto &one) { return std::string(one.param.ini); });

}  // namespace
}  // namespace mw::machine

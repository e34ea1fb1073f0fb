// SPDX-License-Identifier: GPL-2.0-or-later
// Every machine of configs/sim homes repeatedly: already homed, unhomed, and from any position in its range.
#include <algorithm>
#include <string>
#include <vector>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

std::vector<std::string> sample_machines() {
    std::vector<std::string> names;
    for (const auto &file : std::filesystem::directory_iterator(MW_SOURCE_DIR "/configs/sim")) {
        if (file.path().extension() == ".ini") {
            names.push_back(file.path().stem().string());
        }
    }
    std::ranges::sort(names);
    return names;
}

class HomingSamplesTest : public VirtualMachineTest, public ::testing::WithParamInterface<std::string> {
  protected:
    task::Progress wait(client::Serial command) {
        for (int i = 0; i < 400000 && (i < 20 || progress(command) == task::Progress::STARTED ||
                                       motion().isHoming || !motion().isInPosition);
             ++i) {
            cycles(1);
        }
        return progress(command);
    }
    void expect_homes(const char *when) {
        ASSERT_EQ(wait(ask(task::SetMode{task::Mode::MANUAL})), task::Progress::DONE);
        ASSERT_EQ(wait(ask(task::SetTeleop{false})), task::Progress::DONE) << messages();
        const auto homing = ask(task::HomeJoint{-1});
        EXPECT_EQ(wait(homing), task::Progress::DONE) << when << ": " << reason(homing) << '\n' << messages();
        for (int joint = 0; joint < loaded_->machine.num_joints; ++joint) {
            const motion::JointStatus &one = motion().joint[static_cast<std::size_t>(joint)];
            EXPECT_TRUE(one.isHomed) << when << ": joint " << joint;
            EXPECT_NEAR(one.pos_cmd, home_of(joint), 1e-6) << when << ": joint " << joint;
        }
    }
    double home_of(int joint) const {
        return machine_->task().motion_settings().get(motion::Parameter::JOINT_HOME, joint);
    }
    void unhome() {
        ASSERT_EQ(wait(ask(task::SetTeleop{false})), task::Progress::DONE);
        const auto id = ask(task::UnhomeJoint{-1});
        ASSERT_EQ(wait(id), task::Progress::DONE) << reason(id);
    }
    /// Jogs all joints by a fraction of the distance to one of their limits; joints of one axis move
    /// together.
    void move_joints(double part) {
        ASSERT_EQ(wait(ask(task::SetTeleop{false})), task::Progress::DONE);
        const motion::Settings &settings = machine_->task().motion_settings();
        for (int joint = 0; joint < loaded_->machine.num_joints; ++joint) {
            const motion::JointStatus &now = motion().joint[static_cast<std::size_t>(joint)];
            if (settings.get(motion::Parameter::JOINT_HOME_SEQUENCE, joint) < 0) {
                continue;  // not jogged alone
            }
            const auto limit =
                part > 0 ? motion::Parameter::JOINT_MAX_LIMIT : motion::Parameter::JOINT_MIN_LIMIT;
            const double reach = std::abs(settings.get(limit, joint) - now.pos_cmd);
            const double velocity = settings.get(motion::Parameter::JOINT_MAX_VELOCITY, joint);
            wait(ask(task::JogIncrement{true, joint, velocity, part * std::min(reach, 100.0)}));
        }
    }
};

TEST_P(HomingSamplesTest, HomesThreeTimesInARowAfterUnhomingAndFromAnywhere) {
    switch_on_config(MW_SOURCE_DIR "/configs/sim/" + GetParam() + ".ini");
    ASSERT_NE(machine_, nullptr);
    expect_homes("second time");
    expect_homes("third time");
    for (const double part : {0.0, 0.3, 0.9, -0.3, -0.9}) {
        const std::string from = "from " + std::to_string(part);
        move_joints(part);
        expect_homes((from + ", homed").c_str());
        move_joints(part);
        unhome();
        expect_homes((from + ", unhomed").c_str());
    }
}

INSTANTIATE_TEST_SUITE_P(All, HomingSamplesTest, ::testing::ValuesIn(sample_machines()),
                         [](const auto &one) { return one.param; });

}  // namespace
}  // namespace mw::machine

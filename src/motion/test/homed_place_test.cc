// SPDX-License-Identifier: GPL-2.0-or-later
// The start pose of iterative kinematics after the joints have been homed.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

/// Joints are X Y Z. A pose is found only from a start less than 10 away.
class ShortSighted final : public kinematics::Kinematics {
  public:
    kinematics::Kind kind() const noexcept override { return kinematics::Kind::BOTH; }
    kinematics::Status forward(const double *joints, geometry::Pose &pose) const noexcept override {
        for (int i = 0; i < 3; ++i) {
            if (!(std::abs(joints[i] - pose[i]) < 10)) {
                return kinematics::Status::UNREACHABLE;
            }
        }
        for (int i = 0; i < 3; ++i) {
            pose[i] = joints[i];
        }
        return kinematics::Status::OK;
    }
    kinematics::Status inverse(const geometry::Pose &pose, double *joints) const noexcept override {
        for (int i = 0; i < 3; ++i) {
            joints[i] = pose[i];
        }
        return kinematics::Status::OK;
    }
};

TEST(HomedPlace, ThePoseIsFoundFromTheFirstPositionAfterHoming) {
    ShortSighted kinematics;
    MotionRig rig{kinematics, 3, 100, 1000};
    for (int j = 0; j < 3; ++j) {
        rig.set(Parameter::JOINT_HOME, j, 500);
        rig.set(Parameter::JOINT_HOME_OFFSET, j, 500);
        rig.set(Parameter::AXIS_FIRST_PLACE, j, 503);
    }
    rig.step(5);
    rig.send(Enable{});
    rig.step(5);
    const auto home = [&] {
        rig.send(Unhome{-1});
        rig.send(Home{-1});
        return rig.run_until([&] { return rig.status().isAllHomed; }, 5);
    };
    ASSERT_TRUE(home());
    rig.step(5);
    EXPECT_EQ(rig.status().carte_pos_cmd[0], 500);
    rig.send(JogAbsolute{{true, 0}, 20, 550});
    rig.step(4000);
    EXPECT_EQ(rig.status().carte_pos_cmd[0], 550);
    rig.send(Disable{});
    rig.step(5);
    rig.in.joint[1].motor_pos_fb += 40;  // the encoder jumps
    rig.step(5);
    const CommandId on = rig.send(Enable{});
    rig.step(5);
    ASSERT_TRUE(rig.isDone(on));
    const CommandId lost = rig.send(SetMode{Mode::COORD});
    rig.step(5);
    EXPECT_EQ(rig.refusal(lost), Reason::POSE_UNKNOWN);
    ASSERT_TRUE(home());
    rig.step(100);
    const CommandId found = rig.send(SetMode{Mode::COORD});
    rig.step(5);
    EXPECT_TRUE(rig.isDone(found));
    EXPECT_EQ(rig.status().carte_pos_cmd[0], 500);
    EXPECT_EQ(rig.status().carte_pos_fb[1], 500);
}

}  // namespace
}  // namespace mw::motion

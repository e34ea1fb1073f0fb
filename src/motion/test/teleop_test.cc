// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes on machines whose joints are not axes: joints within their limits of speed, acceleration and
// place at every sample. MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST choose the seeds.
#include <random>

#include <gtest/gtest.h>

#include "kins/corexy.hh"
#include "kins/linear_delta.hh"
#include "kins/rotary_table.hh"
#include "testing/campaign_seeds.hh"
#include "testing/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

class TeleopCampaign {
  public:
    TeleopCampaign(const kins::Kinematics &model, int joints, const char *axes, unsigned seed)
        : random_(seed), rig_(model, joints, 100, 1000), axes_(axes) {
        for (int j = 0; j < joints; ++j) {
            rig_.set(Parameter::JOINT_MAX_VELOCITY, j, std::pow(10.0, real(1, 2.3)));
            rig_.set(Parameter::JOINT_MAX_ACCELERATION, j, std::pow(10.0, real(2, 3.5)));
            rig_.set(Parameter::JOINT_MIN_LIMIT, j, -real(20, 200));
            rig_.set(Parameter::JOINT_MAX_LIMIT, j, real(20, 200));
        }
        rig_.ready(Mode::TELEOP);
        EXPECT_EQ(rig_.status().mode, Mode::TELEOP);
    }
    /// Jogs of up to three axes at a time, begun, changed and stopped at random.
    void run() {
        double way = 0;
        geom::Pose last = rig_.status().carte_pos_cmd;
        for (int n = 0; n < 8000; ++n) {
            if (chance(0.004)) {
                const int axis = geom::axis_of_letter(axes_[static_cast<std::size_t>(whole(0, most() - 1))]);
                const double v = std::pow(10.0, real(0, 2.5)) * (chance(0.5) ? 1 : -1);
                rig_.send(JogContinuous{{false, axis}, v});
            }
            if (chance(0.003)) {
                const int axis = geom::axis_of_letter(axes_[static_cast<std::size_t>(whole(0, most() - 1))]);
                rig_.send(JogStop{{false, axis}});
            }
            rig_.step();
            way += geom::norm(rig_.status().carte_pos_cmd - last);
            last = rig_.status().carte_pos_cmd;
        }
        EXPECT_GT(way, 10) << "the jogs did move";
        EXPECT_TRUE(rig_.status().isEnabled);
        for (const Fault &f : rig_.faults) {
            EXPECT_EQ(f.kind, FaultKind::JOG_JOINT_LIMIT);
        }
        EXPECT_EQ(rig_.joint_report(), "");
        rig_.forgive_joints();
    }

  private:
    int most() const { return static_cast<int>(axes_.size()); }
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    bool chance(double p) { return real(0, 1) < p; }

    std::mt19937 random_;
    MotionRig rig_;
    std::string axes_;
};

void jog_all(const kins::Kinematics &model, int joints, const char *axes) {
    const auto [first, count] = testing::campaign_seeds(20);
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        const int seed = first + i;
        SCOPED_TRACE("seed " + std::to_string(seed));
        TeleopCampaign(model, joints, axes, static_cast<unsigned>(seed)).run();
    }
}

TEST(Teleop, CoreXyKeepsJointLimits_C13) {
    jog_all(kins::CoreXy{}, 3, "XYZ");
}

TEST(Teleop, RotaryTableKeepsJointLimits_C13) {
    jog_all(kins::RotaryTable{}, 5, "XYZAC");
}

TEST(Teleop, TiltedRotaryTableKeepsJointLimits_C13) {
    kins::RotaryTable table;
    table.set_tilt_axis(5, -40);
    jog_all(table, 5, "XYZAC");
}

/// Machines with random limits; both ways along one of two axes, to its soft limit and not beyond.
struct ToSoftLimits {
    const kins::Kinematics &model;
    int joints;
    std::array<int, 2> axes;
    bool isJerkLimited;
};

void jog_to_soft_limits(const ToSoftLimits &machine) {
    const auto [first, count] = testing::campaign_seeds(60);
    int reached = 0;
    for (int seed = first; seed < first + count && !::testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(static_cast<unsigned>(seed));
        const auto real = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        MotionRig rig(machine.model, machine.joints, 100, 1000);
        for (int j = 0; j < machine.joints; ++j) {
            const double a = std::pow(10.0, real(2, 3.5));
            rig.set(Parameter::JOINT_MAX_VELOCITY, j, std::pow(10.0, real(1.5, 2.5)));
            rig.set(Parameter::JOINT_MAX_ACCELERATION, j, a);
            rig.set(Parameter::JOINT_MIN_LIMIT, j, -900);
            rig.set(Parameter::JOINT_MAX_LIMIT, j, 900);
            if (machine.isJerkLimited) {
                rig.set(Parameter::JOINT_MAX_JERK, j, a * std::pow(10.0, real(1, 2)));
            }
        }
        const double limit = real(20, 90);
        for (const int i : machine.axes) {
            rig.set(Parameter::AXIS_MAX_ACCELERATION, i, std::pow(10.0, real(2.5, 3.7)));
            rig.set(Parameter::AXIS_MIN_LIMIT, i, -limit);
            rig.set(Parameter::AXIS_MAX_LIMIT, i, limit);
        }
        if (machine.isJerkLimited) {
            rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
        }
        // Away from its centre a table has to move along with what turns.
        for (int j = 0; machine.isJerkLimited && j < 3; ++j) {
            rig.in.joint[static_cast<std::size_t>(j)].motor_pos_fb = 40;
            rig.set(Parameter::JOINT_HOME_OFFSET, j, 40);
            rig.set(Parameter::JOINT_HOME, j, 40);
        }
        rig.step(4);
        rig.ready(Mode::TELEOP);
        const int axis = machine.axes[real(0, 1) < 0.5 ? 0 : 1];
        for (const double sense : {1.0, -1.0}) {
            rig.send(JogContinuous{{false, axis}, sense * 300});
            double farthest = 0;
            for (int n = 0; n < 6000; ++n) {
                rig.step();
                farthest = std::max(farthest, sense * rig.status().carte_pos_cmd[axis]);
            }
            ASSERT_LE(farthest, limit + 1e-6);
            reached += farthest > limit - 1e-6 ? 1 : 0;
        }
        EXPECT_EQ(rig.joint_report(), "");
        rig.forgive_joints();
    }
    EXPECT_GT(reached, count);
}

TEST(Teleop, ADeltaComesToRestAtTheSoftLimitsOfItsAxes_C13) {
    const kins::LinearDelta delta;
    jog_to_soft_limits({delta, 3, {0, 1}, false});
}

TEST(Teleop, ATableComesToRestAtItsSoftLimitsWithJerkLimits_C13) {
    kins::RotaryTable table;
    table.set_tilt_axis(5, -40);
    jog_to_soft_limits({table, 5, {geom::AXIS_A, geom::AXIS_C}, true});
}

TEST(Teleop, ACoreXyJogGoesAsFastAsItsJointsAllow) {
    kins::CoreXy model;
    MotionRig rig(model, 3, 100, 1000);
    rig.ready(Mode::TELEOP);
    rig.send(JogContinuous{{false, 0}, 1000});
    rig.step(500);
    EXPECT_NEAR(rig.status().current_velocity, 100, 6);
    EXPECT_EQ(rig.joint_report(), "");
}

/// Keeps how far out in X the joints of a pose were asked for.
class AskedKinematics final : public kins::Kinematics {
  public:
    mutable double farthest = 0;

    kins::Kind kind() const noexcept override { return kins::Kind::BOTH; }
    kins::Status forward(const double *joints, kins::Pose &pose) const noexcept override {
        return model_.forward(joints, pose);
    }
    kins::Status inverse(const kins::Pose &pose, double *joints) const noexcept override {
        farthest = std::max(farthest, pose[0]);
        return model_.inverse(pose, joints);
    }

  private:
    kins::CoreXy model_;
};

/// What that costs is paid once, and no place out there matters to an axis that has its mean.
TEST(Teleop, OnlyAJogThatBeginsIsLookedAtWhereItIsSent_C9) {
    constexpr double SENT = 400, NEAR = 20;
    AskedKinematics model;
    MotionRig rig(model, 3, 100, 1000);
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
    for (int j = 0; j < 3; ++j) {
        rig.set(Parameter::JOINT_MAX_JERK, j, 20000);
    }
    rig.step(4);
    rig.ready(Mode::TELEOP);
    model.farthest = 0;
    rig.send(JogAbsolute{{false, geom::AXIS_X}, 50, SENT});
    rig.step();
    EXPECT_GT(model.farthest, SENT - 1);
    model.farthest = 0;
    rig.step(500);
    EXPECT_GT(rig.status().carte_pos_cmd[0], NEAR);
    EXPECT_LT(model.farthest, rig.status().carte_pos_cmd[0] + NEAR);
}

}  // namespace
}  // namespace mw::motion

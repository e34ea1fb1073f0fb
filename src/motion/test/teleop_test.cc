// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes on machines whose joints are not axes: joints stay within their limits of speed, acceleration
// and position at every sample. MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST select the seeds.
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "kinematics/linear_delta.hh"
#include "kinematics/rotary_table.hh"
#include "kinematics/tilting_head.hh"
#include "tests/support/campaign_seeds.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

class TeleopCampaign {
  public:
    TeleopCampaign(const kinematics::Kinematics &model, int joints, const char *axes, unsigned seed)
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
    /// Jogs of up to three axes at a time, started, changed and stopped at random.
    void run() {
        double way = 0;
        geometry::Pose last = rig_.status().carte_pos_cmd;
        for (int n = 0; n < 8000; ++n) {
            if (chance(0.004)) {
                const int axis =
                    geometry::axis_of_letter(axes_[static_cast<std::size_t>(whole(0, most() - 1))]);
                const double v = std::pow(10.0, real(0, 2.5)) * (chance(0.5) ? 1 : -1);
                rig_.send(JogContinuous{{false, axis}, v});
            }
            if (chance(0.003)) {
                const int axis =
                    geometry::axis_of_letter(axes_[static_cast<std::size_t>(whole(0, most() - 1))]);
                rig_.send(JogStop{{false, axis}});
            }
            rig_.step();
            way += geometry::norm(rig_.status().carte_pos_cmd - last);
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

void jog_all(const kinematics::Kinematics &model, int joints, const char *axes) {
    const auto [first, count] = testing::campaign_seeds(20);
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        const int seed = first + i;
        SCOPED_TRACE("seed " + std::to_string(seed));
        TeleopCampaign(model, joints, axes, static_cast<unsigned>(seed)).run();
    }
}

TEST(Teleop, CoreXyKeepsJointLimits) {
    jog_all(kinematics::CoreXy{}, 3, "XYZ");
}

TEST(Teleop, RotaryTableKeepsJointLimits) {
    jog_all(kinematics::RotaryTable{}, 5, "XYZAC");
}

TEST(Teleop, TiltedRotaryTableKeepsJointLimits) {
    kinematics::RotaryTable table;
    table.set_tilt_axis(5, -40);
    jog_all(table, 5, "XYZAC");
}

/// Machines with random limits: in both directions of one of two axes, up to its soft limit and not past it.
struct ToSoftLimits {
    const kinematics::Kinematics &model;
    int joints;
    std::array<int, 2> axes;
    bool isJerkLimited;
    int before_first = 0;  ///< number of skipped seeds
};

void jog_to_soft_limits(const ToSoftLimits &machine) {
    const auto [first, count] = testing::campaign_seeds(60);
    int reached = 0;
    for (int seed = first; seed < first + count && !::testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(static_cast<unsigned>(machine.before_first + seed));
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
        // Away from its centre a rotary table must move along with the rotation.
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
            ASSERT_LE(farthest, limit + 1e-9);
            reached += farthest > limit - 1e-6 ? 1 : 0;
        }
        EXPECT_EQ(rig.joint_report(), "");
        rig.forgive_joints();
    }
    EXPECT_GT(reached, count);
}

TEST(Teleop, ADeltaStopsAtTheSoftLimitsOfItsAxes) {
    const kinematics::LinearDelta delta;
    jog_to_soft_limits({delta, 3, {0, 1}, false});
}

TEST(Teleop, ADeltaStopsAtTheSoftLimitsOfItsAxesWithJerkLimits) {
    const kinematics::LinearDelta delta;
    jog_to_soft_limits({delta, 3, {0, 1}, true, 850});
}

TEST(Teleop, AHeadStopsAtTheSoftLimitsOfItsAxes) {
    const kinematics::TiltingHead head;
    jog_to_soft_limits({head, 6, {geometry::AXIS_B, geometry::AXIS_W}, false});
}

TEST(Teleop, ATableStopsAtItsSoftLimitsWithJerkLimits) {
    kinematics::RotaryTable table;
    table.set_tilt_axis(5, -40);
    jog_to_soft_limits({table, 5, {geometry::AXIS_A, geometry::AXIS_C}, true});
}

/// A wheel that turns slowly commands small steps, so the axis brakes and accelerates at the same average
/// speed. It never moves backwards.
TEST(Teleop, AnAxisThatFollowsAWheelSlowlyDoesNotReverse) {
    const kinematics::TiltingHead head;
    MotionRig rig(head, 6, 60, 630);
    constexpr std::array<double, 6> VELOCITY{211, 60, 126, 185, 60, 252};
    constexpr std::array<double, 6> ACCELERATION{758, 2210, 1096, 274.36, 632, 289};
    constexpr std::array<double, 6> JERK{67676, 74226, 24777, 1e6, 97500, 3504};
    for (int j = 0; j < 6; ++j) {
        rig.set(Parameter::JOINT_MAX_VELOCITY, j, VELOCITY[static_cast<std::size_t>(j)]);
        rig.set(Parameter::JOINT_MAX_ACCELERATION, j, ACCELERATION[static_cast<std::size_t>(j)]);
        rig.set(Parameter::JOINT_MAX_JERK, j, JERK[static_cast<std::size_t>(j)]);
    }
    rig.set(Parameter::AXIS_MAX_VELOCITY, geometry::AXIS_B, 170);
    rig.set(Parameter::AXIS_MAX_ACCELERATION, geometry::AXIS_B, 3600);
    rig.set(Parameter::AXIS_MIN_LIMIT, geometry::AXIS_B, -400);
    rig.set(Parameter::AXIS_MAX_LIMIT, geometry::AXIS_B, 400);
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
    rig.step(4);
    rig.ready(Mode::TELEOP);
    WheelInput &wheel = rig.in.axis_wheel[geometry::AXIS_B];
    wheel.isEnabled = true;
    wheel.scale = 3.8e-3;
    const auto place = [&] { return rig.status().carte_pos_cmd[geometry::AXIS_B]; };
    // With more tilt of the tool, the rotation uses more of the slides' acceleration.
    for (const double from : {-302.4, -250.0, -50.0, 20.0, 70.0, 140.0, 280.0, 301.5, 302.362476}) {
        rig.send(JogAbsolute{{false, geometry::AXIS_B}, 100, from});
        ASSERT_TRUE(rig.run_until([&] { return std::abs(place() - from) < 1e-9; }, 60));
        rig.step(500);
        for (int cycles = 1; cycles <= 12; ++cycles) {
            wheel.scale = -wheel.scale;
            SCOPED_TRACE(fmt::format("from {}, a count each {} cycles", from, cycles));
            const double begin = place();
            double before = begin;
            for (int n = 0; n < 1000; ++n) {
                wheel.counts += n % cycles == 0 && n < 500 ? 1 : 0;
                rig.step();
                ASSERT_GE((place() - before) / wheel.scale, -1e-9) << "cycle " << n;
                before = place();
            }
            const int counts = (499 / cycles) + 1;
            EXPECT_NEAR(before - begin, wheel.scale * counts, 1e-9);
        }
    }
    EXPECT_EQ(rig.joint_report(), "");
    rig.forgive_joints();
}

TEST(Teleop, ACoreXyJogUsesTheFullSpeedOfItsJoints) {
    kinematics::CoreXy model;
    MotionRig rig(model, 3, 100, 1000);
    rig.ready(Mode::TELEOP);
    rig.send(JogContinuous{{false, 0}, 1000});
    rig.step(500);
    EXPECT_NEAR(rig.status().current_velocity, 100, 6);
    EXPECT_EQ(rig.joint_report(), "");
}

/// Records the maximum X for which joints were requested.
class AskedKinematics final : public kinematics::Kinematics {
  public:
    mutable double farthest = 0;

    kinematics::Kind kind() const noexcept override { return kinematics::Kind::BOTH; }
    kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept override {
        return model_.forward(joints, pose);
    }
    kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept override {
        farthest = std::max(farthest, pose[0]);
        return model_.inverse(pose, joints);
    }

  private:
    kinematics::CoreXy model_;
};

/// The edge of the workspace past the stopping point does not affect a jog.
TEST(Teleop, JointsAreEvaluatedOnlyNearTheJog) {
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
    rig.send(JogAbsolute{{false, geometry::AXIS_X}, 50, SENT});
    rig.step(500);
    EXPECT_GT(rig.status().carte_pos_cmd[0], NEAR);
    EXPECT_LT(model.farthest, rig.status().carte_pos_cmd[0] + NEAR);
}

}  // namespace
}  // namespace mw::motion

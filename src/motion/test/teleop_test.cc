// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes on machines whose joints are not axes: joints within their limits of speed, acceleration and
// place at every sample. MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST choose the seeds.
#include <random>

#include <gtest/gtest.h>

#include "kins/corexy.hh"
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

TEST(Teleop, ACoreXyJogGoesAsFastAsItsJointsAllow) {
    kins::CoreXy model;
    MotionRig rig(model, 3, 100, 1000);
    rig.ready(Mode::TELEOP);
    rig.send(JogContinuous{{false, 0}, 1000});
    rig.step(500);
    EXPECT_NEAR(rig.status().current_velocity, 100, 6);
    EXPECT_EQ(rig.joint_report(), "");
}

}  // namespace
}  // namespace mw::motion

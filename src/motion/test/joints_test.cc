// SPDX-License-Identifier: GPL-2.0-or-later
// Machines whose joints are not axes: every joint is within its limits at every sample of random programs,
// with and without jerk limits. MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST select the seeds.
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "kinematics/rotary_table.hh"
#include "tests/support/campaign_seeds.hh"
#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

struct Machine {
    const kinematics::Kinematics &model;
    int joints;
    std::string axes;
    bool isJerkLimited;
    bool areAxesJerkLimited = true;  ///< or joints alone
};

class Drive {
  public:
    Drive(const Machine &machine, unsigned seed)
        : machine_(machine), random_(seed), rig_(machine.model, machine.joints, 100, 1000) {
        for (int j = 0; j < machine.joints; ++j) {
            const double v = std::pow(10.0, real(1, 2.3));
            const double a = std::pow(10.0, real(2, 3.5));
            const double jerk = machine.isJerkLimited ? a * std::pow(10.0, real(1, 2)) : 1e300;
            rig_.set(Parameter::JOINT_MAX_VELOCITY, j, v);
            rig_.set(Parameter::JOINT_MAX_ACCELERATION, j, a);
            rig_.set(Parameter::JOINT_MAX_JERK, j, std::min(jerk, 1e9));
            rig_.set(Parameter::JOINT_MIN_LIMIT, j, -1e6);
            rig_.set(Parameter::JOINT_MAX_LIMIT, j, 1e6);
            limits_.push_back({v, a, jerk});
        }
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            // The joint limits must be the tightest.
            const bool isSet = machine.isJerkLimited && !geometry::isAngular(i);
            rig_.set(Parameter::AXIS_MAX_ACCELERATION, i, isSet ? 2000 : 1e6);
            rig_.set(Parameter::AXIS_MAX_JERK, i, isSet && machine.areAxesJerkLimited ? 50000 : 1e9);
        }
        rig_.set(Parameter::TRAJ_PLANNER_TYPE, 0, machine.isJerkLimited ? 1 : 0);
        rig_.ready();
    }

    void run() {
        testing::LimitChecker checker(limits_, MotionRig::T);
        geometry::Pose at = rig_.status().carte_pos_cmd;
        const double size = std::pow(10.0, real(-0.5, 1.5));
        const double tolerance = std::pow(10.0, real(-2, -0.5));
        const int count = whole(5, 40);
        for (int n = 0; n < count; ++n) {
            for (const char letter : machine_.axes) {
                const int axis = geometry::axis_of_letter(letter);
                at[axis] += whole(0, 2) > 0 ? size * real(-1, 1) : 0.0;
            }
            rig_.line(at, real(5, 200), PathMode::BLEND, tolerance);
        }
        const CommandId flush = rig_.send_path(Flush{});
        for (int n = 0; n < 400000 && !rig_.isDone(flush); ++n) {
            rig_.step();
            double q[MAX_JOINTS];
            for (std::size_t j = 0; j < static_cast<std::size_t>(machine_.joints); ++j) {
                q[j] = rig_.out->joint[j].motor_pos_cmd;
            }
            checker.sample(q);
        }
        EXPECT_TRUE(rig_.isDone(flush));
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        EXPECT_GT(checker.worst_acceleration(), 0.1);
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            EXPECT_NEAR(rig_.status().carte_pos_cmd[i], at[i], 1e-9);
        }
    }

  private:
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

    Machine machine_;
    std::mt19937 random_;
    MotionRig rig_;
    std::vector<testing::AxisLimit> limits_;
};

void drive_all(const Machine &machine) {
    const auto [first, count] = testing::campaign_seeds(15);
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        const auto seed = static_cast<unsigned>(first + i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        Drive(machine, seed).run();
    }
}

TEST(Joints, CoreXyKeepsJointLimits) {
    drive_all({kinematics::CoreXy{}, 3, "XYZ", false});
}

TEST(Joints, CoreXyKeepsJointJerkLimits) {
    drive_all({kinematics::CoreXy{}, 3, "XYZ", true});
}

TEST(Joints, RotaryTableKeepsJointLimits) {
    kinematics::RotaryTable table;
    table.set_tilt_axis(5, -40);
    drive_all({table, 5, "XYZAC", false});
}

TEST(Joints, RotaryTableKeepsJointJerkLimits) {
    kinematics::RotaryTable table;
    table.set_tilt_axis(5, -40);
    drive_all({table, 5, "XYZAC", true});
}

TEST(Joints, JerkLimitsOfJointsWithoutAxisLimitsAreKept) {
    kinematics::RotaryTable table;
    table.set_tilt_axis(5, -40);
    drive_all({kinematics::CoreXy{}, 3, "XYZ", true, false});
    drive_all({table, 5, "XYZAC", true, false});
}

}  // namespace
}  // namespace mw::motion

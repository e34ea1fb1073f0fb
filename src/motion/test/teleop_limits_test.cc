// SPDX-License-Identifier: GPL-2.0-or-later
// Soft limits of axes on machines whose joints are not axes, while several axes are jogged, started, stopped
// and reversed at random: none exceeds its limits, with and without jerk limits, and all reach their targets.
// MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST select the seeds.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "kinematics/linear_delta.hh"
#include "kinematics/rotary_table.hh"
#include "tests/support/campaign_seeds.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

enum class Model { COREXY, DELTA, TABLE };

constexpr double ROUNDING = 1e-6;  // [mm, degrees]

class JogsNearLimits {
  public:
    JogsNearLimits(const kinematics::Kinematics &model, std::string axes, int joints, bool isSmooth,
                   unsigned seed)
        : random_(seed), axes_(std::move(axes)), rig_(model, joints, 100, 1000) {
        for (int j = 0; j < joints; ++j) {
            const double a = std::pow(10.0, real(2, 3.3));
            rig_.set(Parameter::JOINT_MAX_VELOCITY, j, std::pow(10.0, real(1.5, 2.3)));
            rig_.set(Parameter::JOINT_MAX_ACCELERATION, j, a);
            if (isSmooth) {
                rig_.set(Parameter::JOINT_MAX_JERK, j, a * std::pow(10.0, real(0.7, 2)));
            }
        }
        if (isSmooth) {
            rig_.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            rig_.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
        }
        rig_.step(4);
        rig_.ready(Mode::TELEOP);
        for (const char letter : axes_) {
            const int axis = geometry::axis_of_letter(letter);
            const double here = rig_.status().carte_pos_cmd[axis];
            low_.push_back(here - real(2, 20));
            high_.push_back(here + real(2, 20));
            rig_.set(Parameter::AXIS_MAX_VELOCITY, axis, std::pow(10.0, real(1, 2.3)));
            rig_.set(Parameter::AXIS_MAX_ACCELERATION, axis, std::pow(10.0, real(2, 3.5)));
            rig_.set(Parameter::AXIS_MIN_LIMIT, axis, low_.back());
            rig_.set(Parameter::AXIS_MAX_LIMIT, axis, high_.back());
        }
    }
    void run() {
        double way = 0;
        for (int n = 0; n < 6000 && !::testing::Test::HasFailure(); ++n) {
            if (real(0, 1) < 0.01) {
                command();
            }
            rig_.step();
            way += expect_within(n);
        }
        EXPECT_GT(way, 1) << "the jogs did move";
        EXPECT_TRUE(rig_.status().isEnabled);
        EXPECT_EQ(rig_.joint_report(), "");
        rig_.forgive_joints();
    }

  private:
    void command() {
        const auto i = static_cast<std::size_t>(
            std::uniform_int_distribution<int>(0, static_cast<int>(axes_.size()) - 1)(random_));
        const int axis = geometry::axis_of_letter(axes_[i]);
        const double speed = std::pow(10.0, real(1, 2.5));
        const double choice = real(0, 1);
        if (choice < 0.5) {
            rig_.send(JogContinuous{{false, axis}, real(0, 1) < 0.5 ? speed : -speed});
        } else if (choice < 0.8) {
            rig_.send(JogAbsolute{{false, axis}, speed, real(low_[i], high_[i])});
        } else {
            rig_.send(JogStop{{false, axis}});
        }
    }
    /// Travel of the axes in the cycle.
    double expect_within(int n) {
        double way = 0;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            const int axis = geometry::axis_of_letter(axes_[i]);
            const double at = rig_.status().carte_pos_cmd[axis];
            EXPECT_GE(at, low_[i] - ROUNDING) << axes_[i] << " in cycle " << n;
            EXPECT_LE(at, high_[i] + ROUNDING) << axes_[i] << " in cycle " << n;
            way += n > 0 ? std::abs(at - last_[i]) : 0.0;
            last_[i] = at;
        }
        return way;
    }
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }

    std::mt19937 random_;
    std::string axes_;
    MotionRig rig_;
    std::vector<double> low_, high_;
    std::array<double, MAX_AXES> last_{};
};

class TeleopLimits : public ::testing::TestWithParam<std::tuple<Model, bool>> {};

TEST_P(TeleopLimits, AreKeptWhileSeveralAxesAreJogged) {
    const auto [which, isSmooth] = GetParam();
    kinematics::CoreXy corexy;
    kinematics::LinearDelta delta;
    delta.set(0, 130.25);
    delta.set(1, 269);
    kinematics::RotaryTable table;
    const kinematics::Kinematics &model =
        which == Model::COREXY  ? static_cast<const kinematics::Kinematics &>(corexy)
        : which == Model::DELTA ? static_cast<const kinematics::Kinematics &>(delta)
                                : static_cast<const kinematics::Kinematics &>(table);
    const bool hasRotary = which == Model::TABLE;
    const auto [first, count] = testing::campaign_seeds(10);
    for (int i = 0; i < count && !HasFailure(); ++i) {
        SCOPED_TRACE("seed " + std::to_string(first + i));
        JogsNearLimits(model, hasRotary ? "XYZAC" : "XYZ", hasRotary ? 5 : 3, isSmooth,
                       static_cast<unsigned>(first + i))
            .run();
    }
}
INSTANTIATE_TEST_SUITE_P(Machines, TeleopLimits,
                         ::testing::Combine(::testing::Values(Model::COREXY, Model::DELTA, Model::TABLE),
                                            ::testing::Bool()));

}  // namespace
}  // namespace mw::motion

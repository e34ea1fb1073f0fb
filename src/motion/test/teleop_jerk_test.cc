// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes with jerk limits on machines whose joints are not axes: checks velocity, acceleration and jerk
// of every joint at every sample, for starts, changes and ends of jogs of all types, and that jogs reach
// their targets. MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST select the seeds.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "kinematics/hexapod.hh"
#include "kinematics/linear_delta.hh"
#include "kinematics/puma.hh"
#include "kinematics/rotary_table.hh"
#include "kinematics/scara.hh"
#include "kinematics/tilting_head.hh"
#include "tests/support/campaign_seeds.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

/// A machine and its start position.
struct JerkyMachine {
    const kinematics::Kinematics &model;
    const char *axes;
    std::vector<double> start;
    double reach = 100;  ///< distance of jogs to a target [machine units, degrees]
};

/// Joints with random limits.
class JerkLimitedTeleop {
  public:
    JerkLimitedTeleop(const JerkyMachine &machine, unsigned seed)
        : random_(seed), axes_(machine.axes), reach_(machine.reach),
          rig_(machine.model, static_cast<int>(machine.start.size()), 100, 1000) {
        std::vector<testing::AxisLimit> limits;
        for (std::size_t j = 0; j < machine.start.size(); ++j) {
            const double v = std::pow(10.0, real(1.5, 2.3));
            const double a = std::pow(10.0, real(2, 3.5));
            const double jerk = a * std::pow(10.0, real(0.7, 2));
            limits.push_back({v, a, jerk});
            const int n = static_cast<int>(j);
            rig_.set(Parameter::JOINT_MAX_VELOCITY, n, v);
            rig_.set(Parameter::JOINT_MAX_ACCELERATION, n, a);
            rig_.set(Parameter::JOINT_MAX_JERK, n, jerk);
            rig_.in.joint[j].motor_pos_fb = machine.start[j];
            rig_.set(Parameter::JOINT_HOME_OFFSET, n, machine.start[j]);  // homed at its start position
            rig_.set(Parameter::JOINT_HOME, n, machine.start[j]);
        }
        const bool isAxisLimited = chance(0.5);
        for (const char letter : axes_) {
            const int axis = geometry::axis_of_letter(letter);
            rig_.set(Parameter::AXIS_MAX_VELOCITY, axis, std::pow(10.0, real(1, 2.3)));
            rig_.set(Parameter::AXIS_MAX_ACCELERATION, axis, std::pow(10.0, real(2, 3.5)));
            if (isAxisLimited) {
                rig_.set(Parameter::AXIS_MAX_JERK, axis, std::pow(10.0, real(3, 5)));
            }
        }
        rig_.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
        rig_.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
        rig_.step(4);
        rig_.ready(Mode::TELEOP);
        EXPECT_EQ(rig_.status().mode, Mode::TELEOP);
        judge_ = std::make_unique<testing::LimitChecker>(limits, MotionRig::T);
    }
    void run(int cycles) {
        double way = 0;
        geometry::Pose last = rig_.status().carte_pos_cmd;
        for (int n = 0; n < cycles && judge_->isWithin() && rig_.status().isEnabled; ++n) {
            command();
            step();
            way += geometry::norm(rig_.status().carte_pos_cmd - last);
            last = rig_.status().carte_pos_cmd;
        }
        EXPECT_TRUE(rig_.status().isEnabled);
        EXPECT_GT(way, 1) << "the jogs did move";
        EXPECT_EQ(judge_->report(), "");
        for (const Fault &f : rig_.faults) {
            EXPECT_TRUE(f.kind == FaultKind::JOG_JOINT_LIMIT || f.kind == FaultKind::JOG_UNREACHABLE)
                << static_cast<int>(f.kind);
        }
        rig_.in.axis_wheel = {};
        expect_stop();
        expect_arrival();
        EXPECT_EQ(judge_->report(), "");
        rig_.forgive_joints();
    }

  private:
    void step() {
        rig_.step();
        std::array<double, MAX_JOINTS> joints{};
        for (std::size_t j = 0; j < joints.size(); ++j) {
            joints[j] = rig_.out->joint[j].motor_pos_cmd;
        }
        judge_->sample(joints.data());
    }
    bool isAtRest() const {
        bool isResting = true;
        for (const AxisOutputs &axis : rig_.out->axis) {
            isResting = isResting && !axis.isTeleopPlanning;
        }
        return isResting;
    }
    int axis() { return geometry::axis_of_letter(axes_[static_cast<std::size_t>(whole(0, most() - 1))]); }
    double speed() { return std::pow(10.0, real(0, 2.5)); }
    void command() {
        const auto signed_speed = [this] { return speed() * (chance(0.5) ? 1 : -1); };
        const auto place = [this](int n) {
            return rig_.status().carte_pos_cmd[n] + real(-reach_, reach_) * std::pow(10.0, real(-2, 0));
        };
        if (chance(0.003)) {
            rig_.send(JogContinuous{{false, axis()}, signed_speed()});
        }
        if (chance(0.002)) {
            rig_.send(JogIncremental{{false, axis()}, speed(), real(-0.1, 0.1) * reach_});
        }
        if (chance(0.002)) {
            const int n = axis();
            rig_.send(JogAbsolute{{false, n}, speed(), place(n)});
        }
        if (chance(0.003)) {
            rig_.send(JogStop{{false, axis()}});
        }
        if (chance(0.0005)) {
            SetTeleopVector all;
            all.velocity[axis()] = signed_speed();
            all.velocity[axis()] = signed_speed();
            rig_.send(all);
        }
        if (chance(0.0005)) {
            rig_.send(SetScale{Scale::FEED, 0, real(0, 1.2)});
        }
        if (chance(0.001)) {
            wheel_ = axis();
            rig_.in.axis_wheel = {};
            rig_.in.axis_wheel[static_cast<std::size_t>(wheel_)].isEnabled = true;
            rig_.in.axis_wheel[static_cast<std::size_t>(wheel_)].isVelocityMode = chance(0.3);
            rig_.in.axis_wheel[static_cast<std::size_t>(wheel_)].scale = 0.01;
        }
        if (chance(0.01) && wheel_ >= 0) {
            rig_.in.axis_wheel[static_cast<std::size_t>(wheel_)].counts += whole(-10, 20);
        }
    }
    /// Expects a stop of all motion.
    void expect_stop() {
        rig_.send(SetScale{Scale::FEED, 0, 1});
        rig_.send(Abort{++rig_.epoch});
        for (int n = 0; n < 20000 && (n < 5 || !isAtRest()); ++n) {
            step();
        }
        EXPECT_TRUE(isAtRest());
    }
    /// Expects that jogs reach their targets.
    void expect_arrival() {
        const int n = axis();
        const double from = rig_.status().carte_pos_cmd[n];
        const double to = from + (chance(0.5) ? 0.02 : -0.02) * reach_;
        rig_.faults.clear();
        const CommandId id = rig_.send(JogAbsolute{{false, n}, 200, to});
        for (int i = 0; i < 60000 && (i < 5 || !isAtRest()); ++i) {
            step();
        }
        EXPECT_TRUE(isAtRest());
        EXPECT_TRUE(rig_.isDone(id));
        if (rig_.faults.empty()) {
            EXPECT_EQ(rig_.out->axis[static_cast<std::size_t>(n)].teleop_position, to);
            EXPECT_NEAR(rig_.status().carte_pos_cmd[n], to, 1e-9);
        }
    }

    int most() const { return static_cast<int>(axes_.size()); }
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    bool chance(double p) { return real(0, 1) < p; }

    std::mt19937 random_;
    std::string axes_;
    double reach_;
    MotionRig rig_;
    std::unique_ptr<testing::LimitChecker> judge_;
    int wheel_ = -1;
};

void jog_smoothly(const JerkyMachine &machine, int seeds = 6) {
    const auto [first, count] = testing::campaign_seeds(seeds);
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        const int seed = first + i;
        SCOPED_TRACE("seed " + std::to_string(seed));
        JerkLimitedTeleop(machine, static_cast<unsigned>(seed)).run(6000);
    }
}

TEST(TeleopJerk, ACoreXyKeepsJointJerk) {
    jog_smoothly({kinematics::CoreXy{}, "XYZ", {10, -20, 5}});
}

TEST(TeleopJerk, ARotaryTableKeepsJointJerk) {
    jog_smoothly({kinematics::RotaryTable{}, "XYZAC", {30, 10, -20, 20, 30}});
}

TEST(TeleopJerk, ATiltedRotaryTableKeepsJointJerk) {
    kinematics::RotaryTable table;
    table.set_tilt_axis(5, -40);
    jog_smoothly({table, "XYZAC", {30, 10, -20, 20, 30}});
}

TEST(TeleopJerk, AFiveAxisHeadKeepsJointJerk) {
    kinematics::TiltingHead head;
    head.set(0, 120);
    jog_smoothly({head, "XYZABC", {0, 0, 0, 5, 20, 30, 0, 0, 0}});
}

TEST(TeleopJerk, ALinearDeltaKeepsJointJerk) {
    kinematics::LinearDelta delta;
    delta.set(0, 130.25);
    delta.set(1, 269);
    jog_smoothly({delta, "XYZ", {0, 0, 0}, 50});
}

TEST(TeleopJerk, AScaraKeepsJointJerk) {
    kinematics::Scara scara;
    std::size_t i = 0;
    for (const double value : {490.0, 340.0, 50.0, 250.0, 50.0, 50.0}) {
        scara.set(i++, value);
    }
    jog_smoothly({scara, "XYZC", {20, -70, 10, 30}, 50});
}

TEST(TeleopJerk, APumaKeepsJointJerk) {
    kinematics::Puma puma;
    std::size_t i = 0;
    for (const double value : {300.0, 50.0, 70.0, 400.0, 70.0}) {
        puma.set(i++, value);
    }
    jog_smoothly({puma, "XYZABC", {0, -45, 10, 20, 40, 40}, 50}, 2);
}

TEST(TeleopJerk, AHexapodKeepsJointJerk) {
    kinematics::Hexapod hexapod;
    for (std::size_t strut = 0; strut < kinematics::Hexapod::STRUTS; ++strut) {
        hexapod.set(kinematics::Hexapod::index_of(kinematics::Hexapod::BASE, strut) + 2, -20);
    }
    std::vector<double> start(MAX_JOINTS, 30.0);
    ASSERT_EQ(hexapod.inverse({}, start.data()), kinematics::Status::OK);
    start.resize(kinematics::Hexapod::STRUTS);
    jog_smoothly({hexapod, "XYZABC", start, 4}, 1);
}

/// The joint limit is lowered while two axes move at maximum speed: they slow down to equal shares.
TEST(TeleopJerk, AxesShareALimitThatIsLoweredWhileTheyMove) {
    kinematics::CoreXy model;
    MotionRig rig(model, 3, 100, 1000);
    for (int j = 0; j < 3; ++j) {
        rig.set(Parameter::JOINT_MAX_JERK, j, 20000);
    }
    rig.set(Parameter::AXIS_MAX_ACCELERATION, 0, 100);
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
    rig.step(4);
    rig.ready(Mode::TELEOP);
    const auto speed = [&](std::size_t axis) { return std::abs(rig.out->axis[axis].teleop_velocity); };
    rig.send(JogContinuous{{false, 0}, 1000});
    ASSERT_TRUE(rig.run_until([&] { return speed(0) > 90; }, 5));
    rig.send(JogContinuous{{false, 1}, 1000});
    ASSERT_TRUE(rig.run_until([&] { return speed(1) > 0; }, 5));
    EXPECT_EQ(rig.joint_report(), "");
    for (int j = 0; j < 3; ++j) {
        rig.set(Parameter::JOINT_MAX_VELOCITY, j, 60);
    }
    rig.step(1000);
    rig.forgive_joints();
    rig.step(1000);
    EXPECT_NEAR(speed(0), 30, 0.01);
    EXPECT_NEAR(speed(1), speed(0), 1e-9) << "an even share";
    EXPECT_EQ(rig.joint_report(), "");
}

/// An axis that arrives with all of its acceleration keeps it; the other axis starts later.
class NoOvershoot : public ::testing::TestWithParam<bool> {};

TEST_P(NoOvershoot, WhenAJogReplacesAnother) {
    kinematics::CoreXy model;
    for (int begin = 600; begin < 1000; begin += 8) {
        MotionRig rig(model, 3, 100, 1000);
        if (GetParam()) {
            for (int j = 0; j < 3; ++j) {
                rig.set(Parameter::JOINT_MAX_JERK, j, 20000);
            }
            rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
        }
        rig.step(4);
        rig.ready(Mode::TELEOP);
        rig.send(JogAbsolute{{false, 1}, 20, 1});  // both axes have moved before
        rig.send(JogAbsolute{{false, 0}, 20, 1});
        rig.step(1000);
        rig.send(JogAbsolute{{false, 0}, 1000, 80});
        rig.step(begin);
        rig.send(JogAbsolute{{false, 1}, 1000, 30});
        double farthest = 0;
        for (int n = 0; n < 4000; ++n) {
            rig.step();
            farthest = std::max(farthest, rig.status().carte_pos_cmd[0]);
        }
        EXPECT_LE(farthest, 80 + 1e-9) << begin;
        EXPECT_NEAR(rig.status().carte_pos_cmd[0], 80, 1e-9) << begin;
        EXPECT_NEAR(rig.status().carte_pos_cmd[1], 30, 1e-9) << begin;
    }
}
INSTANTIATE_TEST_SUITE_P(TeleopJerk, NoOvershoot, ::testing::Bool());

/// Minimum time from standstill to a speed; the travel is half of the speed multiplied by it.
double ramp_s(double to, double a, double j) {
    return to > a * a / j ? to / a + a / j : 2.0 * std::sqrt(to / j);
}

/// Minimum time from standstill to standstill over `way` within v, a, j.
double least_time_s(double way, double v, double a, double j) {
    if (v * ramp_s(v, a, j) <= way) {
        return ramp_s(v, a, j) + way / v;
    }
    double low = 0;
    double high = v;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (middle * ramp_s(middle, a, j) <= way ? low : high) = middle;
    }
    return 2.0 * ramp_s(low, a, j);
}

/// Tower 0 of a delta is perpendicular to X. Its joint hardly moves where the jog begins, and a quarter as
/// fast as X where it stops.
TEST(TeleopJerk, AJogStopsSoonWhereASlowJointStartsToMove) {
    kinematics::LinearDelta delta;
    delta.set(0, 130.25);
    delta.set(1, 269);
    MotionRig rig(delta, 3, 400, 3000);
    constexpr double JERK = 1500;
    rig.set(Parameter::JOINT_MAX_ACCELERATION, 0, 200);
    rig.set(Parameter::JOINT_MAX_JERK, 0, JERK);
    rig.set(Parameter::AXIS_MAX_VELOCITY, 0, 60);
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
    rig.step(4);
    rig.ready(Mode::TELEOP);
    const double from = rig.status().carte_pos_cmd[0];
    rig.send(JogContinuous{{false, 0}, 60});
    ASSERT_TRUE(rig.run_until([&] { return rig.status().carte_pos_cmd[0] > from + 70; }, 5));
    rig.send(JogStop{{false, 0}});
    int cycles = 0;
    for (rig.step(2); cycles < 10000 && rig.out->axis[0].isTeleopPlanning; ++cycles) {
        rig.step();
    }
    constexpr double JOINT_PER_X = 0.36, SPEED = 60;  // at most this within the distance
    EXPECT_LE(cycles * MotionRig::T, 2.2 * ramp_s(SPEED, 200 / JOINT_PER_X, JERK / JOINT_PER_X) + 0.02);
    EXPECT_EQ(rig.joint_report(), "");
    rig.forgive_joints();
}

/// Along X of a CoreXY both belts move like the axis, so the minimum time is known.
TEST(TeleopJerk, AJogAlongOneJointTakesTheMinimumTime) {
    for (const double acceleration : {200.0, 1000.0, 3000.0}) {
        for (const double per_s : {3.0, 10.0, 50.0}) {
            kinematics::CoreXy model;
            MotionRig rig(model, 3, 100, acceleration);
            const double jerk = per_s * acceleration;
            for (int j = 0; j < 3; ++j) {
                rig.set(Parameter::JOINT_MAX_JERK, j, jerk);
            }
            rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
            rig.step(4);
            rig.ready(Mode::TELEOP);
            for (const double way : {200.0, 20.0, 2.0}) {
                const double from = rig.status().carte_pos_cmd[0];
                rig.send(JogAbsolute{{false, 0}, 1000, from + way});
                int cycles = 0;
                while (cycles < 60000 && (cycles < 3 || rig.out->axis[0].isTeleopPlanning)) {
                    rig.step();
                    ++cycles;
                }
                ASSERT_EQ(rig.status().carte_pos_cmd[0], from + way);
                const double least_s = least_time_s(way, 100, acceleration, jerk);
                const double slack_s = 0.004 + 1e-3 * least_s;
                EXPECT_LE(cycles * MotionRig::T, least_s + slack_s)
                    << "a " << acceleration << " j " << jerk << " way " << way << " least " << least_s;
            }
        }
    }
}

}  // namespace
}  // namespace mw::motion

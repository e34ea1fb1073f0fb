// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "kinematics/rotary_table.hh"
#include "motion/servo/jogs/jogs.hh"
#include "motion/servo/jogs/joint_load.hh"

namespace mw::motion {
namespace {

constexpr double T = 1e-3;
constexpr JogTarget JOINT{true, 0};
constexpr JogTarget AXIS{false, geometry::AXIS_X};

Jogs make() {
    Jogs jogs;
    jogs.use_joints(2);
    return jogs;
}

JogSituation free_mode() {
    JogSituation s;
    s.isReady = s.isMovable = true;
    s.limits = {50, 500, 0};
    s.range = {-10, 10};
    return s;
}

void run(Jogs &jogs, const JogTarget &target, int cycles) {
    for (int n = 0; n < cycles; ++n) {
        jogs.at(target).step(T);
    }
}

TEST(JogsPart, EachReasonAgainstAJogIsReported) {
    Jogs jogs = make();
    const auto reason = [&](auto change, JogTarget target = JOINT) {
        JogSituation s = free_mode();
        change(s);
        return jogs.take(JogContinuous{target, 5}, s).reason;
    };
    EXPECT_EQ(reason([](JogSituation &) {}, {true, 2}), Reason::NO_SUCH_JOINT);
    EXPECT_EQ(reason([](JogSituation &) {}, {false, 9}), Reason::NO_SUCH_AXIS);
    EXPECT_EQ(reason([](JogSituation &s) { s.isReady = false; }), Reason::NOT_ENABLED);
    EXPECT_EQ(reason([](JogSituation &s) { s.mode = Mode::COORD; }), Reason::WRONG_MODE);
    EXPECT_EQ(reason([](JogSituation &s) { s.isHoming = true; }), Reason::HOMING);
    EXPECT_EQ(reason([](JogSituation &s) { s.isInhibited = true; }), Reason::JOG_INHIBITED);
    EXPECT_EQ(reason([](JogSituation &s) { s.isMovable = false; }), Reason::JOINT_INACTIVE);
    EXPECT_EQ(reason([](JogSituation &s) { s.isSynchronised = true; }), Reason::SYNCHRONISED_JOINT);
    EXPECT_EQ(reason([](JogSituation &s) { s.isOnPosLimit = true; }), Reason::ON_HARD_LIMIT);
    EXPECT_EQ(reason([](JogSituation &s) { s.isOnNegLimit = true; }), Reason::NONE) << "off the limit";
}

TEST(JogsPart, AContinuousJogEndsAtTheSoftLimit) {
    Jogs jogs = make();
    ASSERT_EQ(jogs.take(JogContinuous{JOINT, 80}, free_mode()).reason, Reason::NONE);
    EXPECT_EQ(jogs.at(JOINT).motion().max_velocity, 50) << "no faster than the joint";
    run(jogs, JOINT, 1000);
    EXPECT_EQ(jogs.at(JOINT).motion().position, 10);
    EXPECT_EQ(jogs.take(JogContinuous{JOINT, 80}, free_mode()).reason, Reason::BEYOND_SOFT_LIMIT);
    EXPECT_EQ(jogs.take(JogContinuous{JOINT, -80}, free_mode()).reason, Reason::NONE);
}

TEST(JogsPart, ALeaseIsRenewedByTheSameCommandAndEndsOnce) {
    constexpr std::int64_t MS = 1000000;
    Jogs jogs = make();
    JogSituation s = free_mode();
    s.time_ns = 5 * MS;
    EXPECT_EQ(jogs.take(JogContinuous{JOINT, 5, 0.1, true}, s).reason, Reason::NO_JOG_TO_RENEW);
    for (const double lease_s : {-1.0, 0.019, 10.1, double{NAN}, double{INFINITY}}) {
        EXPECT_EQ(jogs.take(JogContinuous{JOINT, 5, lease_s}, s).reason, Reason::OUT_OF_RANGE) << lease_s;
    }
    EXPECT_EQ(jogs.take(JogContinuous{JOINT, 5, 0, true}, s).reason, Reason::OUT_OF_RANGE);
    EXPECT_TRUE(jogs.at(JOINT).isAtRest()) << "a rejected command moves nothing";
    ASSERT_EQ(jogs.take(JogContinuous{JOINT, 5, 0.1}, s).reason, Reason::NONE);
    run(jogs, JOINT, 50);
    EXPECT_LT(jogs.end_lease(104 * MS).index, 0);
    s.time_ns = 104 * MS;
    EXPECT_EQ(jogs.take(JogContinuous{JOINT, 8, 0.2, true}, s).reason, Reason::NONE);
    EXPECT_EQ(jogs.at(JOINT).wanted().velocity, 8);
    EXPECT_LT(jogs.end_lease(303 * MS).index, 0);
    const JogTarget over = jogs.end_lease(304 * MS);
    EXPECT_TRUE(over.isJoint);
    EXPECT_EQ(over.index, 0);
    EXPECT_LT(jogs.end_lease(304 * MS).index, 0) << "told once";
    EXPECT_LT(jogs.at(JOINT).motion().target, 1) << "it brakes";
    s.time_ns = 305 * MS;
    EXPECT_EQ(jogs.take(JogContinuous{JOINT, 8, 0.2, true}, s).reason, Reason::NO_JOG_TO_RENEW);
}

TEST(JogsPart, AStopOrANewJogEndsTheLease) {
    const auto isLeft = [](auto change) {
        Jogs jogs = make();
        EXPECT_EQ(jogs.take(JogContinuous{JOINT, 5, 0.1}, free_mode()).reason, Reason::NONE);
        run(jogs, JOINT, 20);
        change(jogs);
        return jogs.take(JogContinuous{JOINT, 5, 0.1, true}, free_mode()).reason == Reason::NONE;
    };
    EXPECT_TRUE(isLeft([](Jogs &) {}));
    EXPECT_TRUE(isLeft([](Jogs &j) { j.take(JogStop{{true, 1}}); })) << "another joint's";
    EXPECT_FALSE(isLeft([](Jogs &j) { j.take(JogStop{JOINT}); }));
    EXPECT_FALSE(isLeft([](Jogs &j) { j.stop(); }));
    EXPECT_FALSE(isLeft([](Jogs &j) { j.stop_at_once(); }));
    EXPECT_FALSE(isLeft([](Jogs &j) { j.forget_sources(); }));
    EXPECT_FALSE(isLeft([](Jogs &j) { j.take(JogIncremental{JOINT, 5, -1}, free_mode()); }));
    EXPECT_FALSE(isLeft([](Jogs &j) { j.take(JogAbsolute{JOINT, 5, 1}, free_mode()); }));
    EXPECT_FALSE(isLeft([](Jogs &j) { j.take(JogContinuous{JOINT, 5}, free_mode()); }));
    EXPECT_FALSE(isLeft([](Jogs &j) { j.take(JogContinuous{JOINT, -5, 0.1}, free_mode()); })) << "turned";
}

TEST(JogsPart, IncrementsAddUpAndStayWithinTheRange) {
    Jogs jogs = make();
    EXPECT_EQ(jogs.take(JogIncremental{JOINT, 20, 4}, free_mode()).reason, Reason::NONE);
    EXPECT_EQ(jogs.take(JogIncremental{JOINT, 20, 4}, free_mode()).reason, Reason::NONE);
    EXPECT_EQ(jogs.take(JogIncremental{JOINT, 20, 4}, free_mode()).reason, Reason::BEYOND_SOFT_LIMIT);
    EXPECT_EQ(jogs.take(JogIncremental{JOINT, -1, 1}, free_mode()).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(jogs.take(JogAbsolute{JOINT, 20, NAN}, free_mode()).reason, Reason::NOT_A_NUMBER);
    run(jogs, JOINT, 2000);
    EXPECT_EQ(jogs.at(JOINT).motion().position, 8);
}

TEST(JogsPart, AJogFromOutsideTheLimitsMovesBackInside) {
    Jogs jogs = make();
    jogs.at(JOINT).reset(12);
    EXPECT_EQ(jogs.take(JogIncremental{JOINT, 20, 1}, free_mode()).reason, Reason::BEYOND_SOFT_LIMIT);
    EXPECT_EQ(jogs.take(JogIncremental{JOINT, 20, -1}, free_mode()).reason, Reason::NONE);
}

TEST(JogsPart, AWheelCountsAcrossTheWrapAndYieldsToKeys) {
    Jogs jogs = make();
    WheelInput wheel;
    wheel.isEnabled = true;
    wheel.scale = 0.5;
    wheel.counts = -2147483647;
    jogs.at(JOINT).set_wheel_counts(2147483647);
    EXPECT_EQ(jogs.at(JOINT).turned(wheel), 1.0) << "two counts over the wrap";
    jogs.jog_by_wheel(JOINT, 30, wheel, free_mode());
    EXPECT_EQ(jogs.at(JOINT).motion().target, 10)
        << "clamped: a wheel is not a command and cannot be rejected";
    EXPECT_EQ(jogs.at(JOINT).source(), JogSource::WHEEL);
    jogs.stop_at_once();
    jogs.take(JogContinuous{JOINT, -5}, free_mode());
    run(jogs, JOINT, 10);
    EXPECT_EQ(jogs.at(JOINT).turned(wheel), 0.0) << "a key is pressed";
}

TEST(JogsPart, AStopOfAWheelUsesTheFullAcceleration) {
    for (const double jerk : {0.0, 2e4}) {
        JogSituation s = free_mode();
        s.limits.jerk = jerk;
        const auto cycles_to_stop = [&](double fraction, bool isWheelAlone) {
            Jogs jogs = make();
            WheelInput wheel;
            wheel.isEnabled = wheel.isVelocityMode = true;
            wheel.accel_fraction = fraction;
            jogs.jog_by_wheel(JOINT, 15, wheel, s);
            run(jogs, JOINT, 300);
            if (isWheelAlone) {
                jogs.at(JOINT).turned(wheel);
            } else {
                jogs.stop();
            }
            const double v = jogs.at(JOINT).motion().velocity;
            int n = 0;
            for (; !jogs.at(JOINT).isAtRest() && n < 5000; ++n) {
                run(jogs, JOINT, 1);
            }
            return std::pair{n, v};
        };
        const auto [stopped, v] = cycles_to_stop(0.1, false);
        EXPECT_GT(v, 5);
        EXPECT_LE(stopped * T, v / 500 + (jerk > 0 ? 0.06 : 0.002));
        const auto [let_go, same] = cycles_to_stop(0.1, true);
        EXPECT_EQ(same, v);
        EXPECT_GE(let_go * T, v / 50 * (1 - 1e-9)) << "a stopped wheel is no stop";
    }
}

TEST(JogsPart, OverriddenLimitsEndWithTheJog) {
    Jogs jogs = make();
    Inputs in;
    jogs.take(OverrideLimits{true});
    jogs.settle(in);
    EXPECT_TRUE(jogs.areLimitsOverridden());
    jogs.take(JogIncremental{JOINT, 20, 0.1}, free_mode());
    jogs.settle(in);
    EXPECT_TRUE(jogs.areLimitsOverridden());
    run(jogs, JOINT, 500);
    jogs.settle(in);
    EXPECT_FALSE(jogs.areLimitsOverridden());
    EXPECT_EQ(jogs.at(JOINT).source(), JogSource::NONE);
}

TEST(JogsPart, OneJoggedJointOrAxisCountsAsAJog) {
    for (const bool isJoint : {true, false}) {
        Jogs jogs = make();
        jogs.set_axes(0b111);
        const JogTarget target = isJoint ? JOINT : AXIS;
        JogSituation situation = free_mode();
        situation.mode = isJoint ? Mode::FREE : Mode::TELEOP;
        const auto jog_is_active = [&] {
            Outputs out;
            jogs.settle({});
            jogs.fill(situation.mode, {}, out);
            return out.isJogging;
        };
        EXPECT_FALSE(jog_is_active());
        ASSERT_EQ(jogs.take(JogContinuous{target, 5}, situation).reason, Reason::NONE);
        run(jogs, target, 20);
        EXPECT_TRUE(jog_is_active());
        jogs.take(JogStop{target});
        run(jogs, target, 500);
        EXPECT_FALSE(jog_is_active());
    }
}

TEST(JogsPart, AJointIsInPositionUnlessItIsJogged) {
    Jogs jogs = make();
    const auto in_position = [&] {
        Outputs out;
        jogs.settle({});
        jogs.fill(Mode::FREE, {}, out);
        return std::pair(out.status.joint[0].isInPosition, out.status.joint[1].isInPosition);
    };
    EXPECT_EQ(in_position(), std::pair(true, true));
    ASSERT_EQ(jogs.take(JogContinuous{JOINT, 5}, free_mode()).reason, Reason::NONE);
    run(jogs, JOINT, 20);
    EXPECT_EQ(in_position(), std::pair(false, true));
    jogs.take(JogStop{JOINT});
    run(jogs, JOINT, 500);
    EXPECT_EQ(in_position(), std::pair(true, true));
}

TEST(JogsPart, JogsStopWithinTheirLimitsOrAtOnce) {
    Jogs jogs = make();
    jogs.take(JogContinuous{JOINT, 50}, free_mode());
    run(jogs, JOINT, 50);
    Jogs clone = jogs;
    jogs.stop();
    run(jogs, JOINT, 1);
    EXPECT_GT(jogs.at(JOINT).motion().velocity, 20);
    clone.stop_at_once();
    EXPECT_EQ(clone.at(JOINT).motion().velocity, 0);
    EXPECT_TRUE(clone.areJointsAtRest());
    EXPECT_FALSE(jogs.areJointsAtRest());
}

TEST(JogsPart, AxesAreJoggedInTeleopModeOnly) {
    Jogs jogs = make();
    JogSituation situations[MAX_AXES];
    const auto jog = [&](double velocity, Mode mode) {
        for (JogSituation &s : situations) {
            s = free_mode();
            s.mode = mode;
        }
        SetTeleopVector command;
        command.velocity[0] = velocity;
        return jogs.take(command, situations).reason;
    };
    EXPECT_EQ(jog(5, Mode::FREE), Reason::WRONG_MODE);
    EXPECT_EQ(jog(0, Mode::FREE), Reason::NONE) << "it stops";
    EXPECT_EQ(jog(NAN, Mode::TELEOP), Reason::NOT_A_NUMBER);
    EXPECT_EQ(jog(5, Mode::TELEOP), Reason::NONE);
    jogs.at(AXIS).limit(100, 0.5);
    EXPECT_EQ(jogs.at(AXIS).motion().max_velocity, 2.5);
    run(jogs, AXIS, 100);
    EXPECT_EQ(jog(0, Mode::TELEOP), Reason::NONE);
    run(jogs, AXIS, 100);
    EXPECT_TRUE(jogs.areAxesAtRest());
}

TEST(JogsPart, HomingMovesAJointNoFasterThanItCan) {
    Jogs jogs = make();
    homing::JointCommand command;
    command.move = homing::Move::BY;
    command.value = -4;
    command.velocity = 1000;
    jogs.at(JOINT).home(command, {50, 500, 900});
    EXPECT_EQ(jogs.at(JOINT).wanted().velocity, 50);
    EXPECT_EQ(jogs.at(JOINT).motion().target, -4);
    EXPECT_EQ(jogs.at(JOINT).motion().max_jerk, 0);
    jogs.at(JOINT).renumber(6, 6);
    EXPECT_EQ(jogs.at(JOINT).motion().target, 2);
}

/// Joint 0 is X cos C + Y sin C.
TEST(JointLoad, HasTheDerivativesOfJointsByTheAxes) {
    const kinematics::RotaryTable table;
    const FoldedLimits limits;
    TeleopMachine machine{table, limits, limits.path_joints};
    machine.num_joints = 5;
    constexpr double X_AT = 50, C_AT = 30, RAD = 3.14159265358979 / 180;
    geometry::Pose pose;
    pose[geometry::AXIS_X] = X_AT;
    pose[geometry::AXIS_C] = C_AT;
    ASSERT_EQ(table.inverse(pose, machine.joint_positions.data()), kinematics::Status::OK);
    const double sine = std::sin(C_AT * RAD);
    const double cosine = std::cos(C_AT * RAD);
    for (const bool hasJerk : {false, true}) {
        JointLoad load;
        load.axes = {geometry::AXIS_X, geometry::AXIS_C};
        load.count = 2;
        load.hasJerk = hasJerk;
        load.direction = {0.6, 0.8};
        ASSERT_TRUE(add_pose(machine, pose, load));
        EXPECT_NEAR(load.q1[0][0], cosine, 1e-6);
        EXPECT_NEAR(load.q1[1][0], X_AT * RAD * sine, 1e-3);
        EXPECT_NEAR(load.q2[0][1][0], RAD * sine, 1e-4);
        EXPECT_EQ(load.q2[1][0][0], load.q2[0][1][0]);
        EXPECT_NEAR(load.q2[1][1][0], X_AT * RAD * RAD * cosine, 1e-4);
        if (hasJerk) {
            const double c = 0.8 * RAD;
            EXPECT_NEAR(load.q3[1][0], X_AT * RAD * RAD * RAD * sine, 1e-6);
            EXPECT_NEAR(load.q3_together[0], std::abs(X_AT * c * c * c * sine - 3 * 0.6 * c * c * cosine),
                        1e-6);
        }
    }
}

/// An arm that reaches X with either sign of joint 0 and keeps the current sign; joint 1 does not move.
struct Elbow final : kinematics::Kinematics {
    kinematics::Kind kind() const noexcept override { return kinematics::Kind::BOTH; }
    kinematics::Status forward(const double *joints, geometry::Pose &pose) const noexcept override {
        pose[0] = joints[0] * joints[0];
        return kinematics::Status::OK;
    }
    kinematics::Status inverse(const geometry::Pose &pose, double *joints) const noexcept override {
        joints[0] = std::copysign(std::sqrt(pose[0]), joints[0]);
        return kinematics::Status::OK;
    }
};

TEST(TeleopPart, TheJointPositionsNearestToTheCurrentOnesAreUsed) {
    const Elbow elbow;
    const FoldedLimits limits;
    TeleopMachine machine{elbow, limits, limits.path_joints};
    machine.num_joints = 2;
    for (const double sense : {1.0, -1.0}) {
        machine.joint_positions = {3 * sense, 7};
        geometry::Pose pose;
        pose[0] = 16;
        JointsAt q{};
        ASSERT_TRUE(find_joints(machine, pose, q));
        EXPECT_EQ(q[0], 4 * sense);
        EXPECT_EQ(q[1], 7);
    }
}

TEST(TeleopPart, AJogOfATableStopsBeforeAJointExceedsItsRange) {
    const kinematics::RotaryTable table;
    Settings settings;
    const auto set = [&](Parameter p, int j, double v) {
        settings.set({static_cast<std::uint16_t>(p), static_cast<std::int16_t>(j), v}, 5, 1);
    };
    for (int j = 0; j < 5; ++j) {
        set(Parameter::JOINT_MAX_VELOCITY, j, 100);
        set(Parameter::JOINT_MAX_ACCELERATION, j, 1000);
        set(Parameter::JOINT_MIN_LIMIT, j, j < 3 ? -40 : -360);
        set(Parameter::JOINT_MAX_LIMIT, j, j < 3 ? 40 : 360);
    }
    const FoldedLimits limits = fold_limits(settings, axis_map(table, 5), ALL_HOMED);
    TeleopMachine machine{table, limits, limits.path_joints};
    machine.num_joints = 5;
    Jogs jogs = make();
    geometry::Pose pose;
    pose[0] = 39;  // C swings this towards Y and further to -39
    pose[1] = 15;
    jogs.reset_axes(pose);
    JogSituation s = free_mode();
    s.mode = Mode::TELEOP;
    s.limits = {1000, 10000, 0};
    s.range = {-1e9, 1e9};
    const JogTarget c{false, geometry::AXIS_C};
    ASSERT_EQ(table.inverse(pose, machine.joint_positions.data()), kinematics::Status::OK);
    ASSERT_EQ(jogs.take(JogContinuous{c, 90}, s).reason, Reason::NONE);
    int told = 0;
    for (int n = 0; n < 5000; ++n) {
        const TeleopStop stopped = jogs.step_teleop(machine);
        told += stopped.isNew ? 1 : 0;
        pose[geometry::AXIS_C] = jogs.at(c).motion().position;
        const auto last = machine.joint_positions;
        ASSERT_EQ(table.inverse(pose, machine.joint_positions.data()), kinematics::Status::OK);
        for (std::size_t j = 0; j < 3; ++j) {
            ASSERT_LE(std::abs(machine.joint_positions[j]), 40 + 1e-6) << "joint " << j;
            ASSERT_LE(std::abs(machine.joint_positions[j] - last[j]) / T, 100 * (1 + 1e-6)) << "joint " << j;
        }
    }
    EXPECT_EQ(told, 1);
    EXPECT_TRUE(jogs.at(c).isAtRest());
    EXPECT_GT(std::abs(pose[geometry::AXIS_C]), 0.01) << "it did move";
}

}  // namespace
}  // namespace mw::motion

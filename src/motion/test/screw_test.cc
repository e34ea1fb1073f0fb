// SPDX-License-Identifier: GPL-2.0-or-later
// A machine whose screw has errors and play, checked at its slide, which the controller cannot measure.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace screw_test {
namespace {

using ::mw::testing::LimitChecker;
using ::mw::testing::MotionRig;

constexpr double PI = 3.14159265358979323846;
constexpr double V = 100, A = 1000, J = 30000;

/// A nut with play on a screw with a long wave, a drift and an error per revolution.
struct Slide {
    double play = 0.03;
    double position = 0;

    static double error(double motor) {
        return 0.02 * std::sin(2 * PI * motor / 180) + 5e-5 * motor + 0.002 * std::sin(2 * PI * motor / 10);
    }
    void follow(double motor) {
        const double screw = motor + error(motor);
        position = std::clamp(position, screw - play / 2, screw + play / 2);
    }
    /// Maximum deviation of the error from a straight line between marks, and between two motor positions
    /// that are as far apart as the correction is large.
    double error_of_table(double pitch) const {
        double steepest = 0, most_bent = 0, largest = 0;
        constexpr double H = 0.01;
        for (double x = -400; x < 400; x += H) {
            const double before = error(x - H), here = error(x), after = error(x + H);
            steepest = std::max(steepest, std::abs(after - before) / (2 * H));
            most_bent = std::max(most_bent, std::abs(after - 2 * here + before) / (H * H));
            largest = std::max(largest, std::abs(here) + play / 2);
        }
        return most_bent * pitch * pitch / 8 + steepest * largest;
    }
};

/// Measures the slide at each mark, approached from below and above. `offset`: difference of joint and motor
/// positions.
std::vector<LoadCompensation> measure(double play, double pitch, double offset = 0) {
    std::vector<LoadCompensation> points;
    const int count = static_cast<int>(700 / pitch) + 1;
    for (int n = 0; n < count; ++n) {
        const double nominal = -350 + n * pitch;
        const double screw = nominal + Slide::error(nominal + offset);
        const double up = screw - play / 2, down = screw + play / 2;
        points.push_back({0, n, count, nominal, nominal - up, nominal - down});
    }
    return points;
}

struct ScrewRig : MotionRig {
    Slide slide;
    LimitChecker checker;

    explicit ScrewRig(bool isJerkLimited)
        : MotionRig("XYZ", V, A),
          checker({{1.5 * V, 1.5 * A, isJerkLimited ? 1.5 * J : 1e300}}, MotionRig::T) {
        if (isJerkLimited) {
            set(Parameter::TRAJ_MAX_JERK, 0, 10 * J);
            set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            set(Parameter::JOINT_MAX_JERK, 0, J);
        }
        before_step = [this](MotionRig &) { slide.follow(in.joint[0].motor_pos_fb); };
    }
    void load(const std::vector<LoadCompensation> &points) {
        for (const LoadCompensation &point : points) {
            while (channels->immediate.size() > 500) {
                step();
            }
            send(point);
        }
        step(20);
    }
    void go() {
        step();
        checker.sample(&out->joint[0].motor_pos_cmd);
    }
};

/// Deviation of the slide from its command, in motion and at standstill, except while backlash is compensated
/// after a reversal.
struct Judgement {
    double worst = 0, worst_at_rest = 0;
    int judged = 0, left_out = 0, at_rest = 0, reversals = 0;
};
Judgement judge(ScrewRig &rig, double zero, int moves) {
    constexpr int TAKING_UP = 150;  // cycles
    std::mt19937 random(7);
    std::uniform_real_distribution<double> to(-250, 250);
    Judgement out;
    int direction = 0;
    int since = 0;
    int standing = 0;
    double before = rig.status().joint[0].pos_cmd;
    for (int n = 0; n < moves; ++n) {
        const double target = n % 5 == 4 ? before + 0.2 * to(random) / 250 : to(random);
        rig.send(JogAbsolute{{true, 0}, n % 3 == 0 ? V : 12.0 + n, target});
        const int cycles = 100 + (n * 331) % 2500;
        for (int i = 0; i < cycles; ++i) {
            rig.go();
            // The slide follows the command of two cycles ago.
            const double now = rig.status().joint[0].pos_cmd;
            rig.slide.follow(rig.out->joint[0].motor_pos_cmd);
            const int way = now > before ? 1 : now < before ? -1 : direction;
            since = way != direction ? 0 : since + 1;
            out.reversals += way * direction < 0 ? 1 : 0;
            direction = way;
            standing = now == before ? standing + 1 : 0;
            before = now;
            const double off = std::abs(rig.slide.position - (now + zero));
            if (standing > TAKING_UP) {
                out.worst_at_rest = std::max(out.worst_at_rest, off);
                ++out.at_rest;
            }
            if (since > TAKING_UP) {
                out.worst = std::max(out.worst, off);
                ++out.judged;
            } else {
                ++out.left_out;
            }
        }
    }
    return out;
}

/// Bound during motion. With a jerk limit a change of slope takes time: half of the joint jerk is reserved
/// for it.
double bound_of(const Slide &slide, double pitch, bool isJerkLimited) {
    constexpr double STEEPEST = 2.1e-3;  // of the errors
    const double change = 2 * STEEPEST * V;
    return slide.error_of_table(pitch) + (isJerkLimited ? change * std::sqrt(change / (0.5 * J)) : 0.0);
}

class Screw : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutJerk, Screw, ::testing::Bool());

TEST_P(Screw, TheSlideIsAtItsPositionWithinTheErrorOfTheTable) {
    ScrewRig rig(GetParam());
    constexpr double PITCH = 1;
    rig.load(measure(rig.slide.play, PITCH));
    ASSERT_TRUE(rig.faults.empty());
    rig.ready(Mode::FREE);
    const Judgement j = judge(rig, 0, 150);
    EXPECT_LT(rig.slide.error_of_table(PITCH), 6e-4) << "of an error of more than 0.03";
    EXPECT_LT(j.worst, bound_of(rig.slide, PITCH, GetParam()));
    EXPECT_LT(j.worst_at_rest, rig.slide.error_of_table(PITCH));
    EXPECT_GT(j.reversals, 50);
    EXPECT_GT(j.at_rest, 10000);
    EXPECT_GT(j.judged, 4 * j.left_out);
    EXPECT_TRUE(rig.checker.isWithin()) << rig.checker.report();
    EXPECT_TRUE(rig.faults.empty());
    EXPECT_NEAR(rig.status().joint[0].pos_fb, rig.status().joint[0].pos_cmd, V * MotionRig::T + 1e-9);
}

TEST_P(Screw, WithoutATableTheSlideHasTheScrewError) {
    ScrewRig rig(GetParam());
    rig.ready(Mode::FREE);
    EXPECT_GT(judge(rig, 0, 40).worst, 0.03) << "else the judge sees nothing";
}

TEST_P(Screw, TheZeroIsAtTheHomeSwitchOnTheSlide) {
    ScrewRig rig(GetParam());
    constexpr double PITCH = 1, TRIP = -12, HOME_OFFSET = -5;
    constexpr double ZERO = TRIP - HOME_OFFSET;  // of the joint, measured at the slide
    rig.set(Parameter::JOINT_HOME_SEARCH_VEL, 0, -20);
    rig.set(Parameter::JOINT_HOME_LATCH_VEL, 0, -0.5);
    rig.set(Parameter::JOINT_HOME_OFFSET, 0, HOME_OFFSET);
    rig.set(Parameter::JOINT_HOME, 0, 3);
    rig.before_step = [&rig](MotionRig &r) {
        rig.slide.follow(r.in.joint[0].motor_pos_fb);
        r.in.joint[0].isHomeSwitchClosed = rig.slide.position <= TRIP;
    };
    rig.load(measure(rig.slide.play, PITCH, ZERO));
    rig.send(Enable{});
    rig.step(2);
    rig.send(Home{-1});
    // The jerk is not limited if a switch ends a move.
    LimitChecker homing({{1.5 * V, 1.5 * A}}, MotionRig::T);
    for (int i = 0; i < 30000 && !rig.status().isAllHomed; ++i) {
        rig.step();
        homing.sample(&rig.out->joint[0].motor_pos_cmd);
    }
    ASSERT_TRUE(rig.status().isAllHomed);
    EXPECT_TRUE(homing.isWithin()) << homing.report();
    const Judgement j = judge(rig, ZERO, 80);
    const double seen_late = 0.5 * 3 * MotionRig::T;
    EXPECT_LT(j.worst, rig.slide.error_of_table(PITCH) + seen_late);
    EXPECT_GT(j.judged, 4 * j.left_out);
    EXPECT_TRUE(rig.checker.isWithin()) << rig.checker.report();
}

TEST(ScrewTables, TenThousandPointsAreLoadedWhileTheMachineIsOff) {
    ScrewRig rig(false);
    std::vector<LoadCompensation> points;
    for (int n = 0; n < MAX_SCREW_POINTS; ++n) {
        points.push_back({0, n, MAX_SCREW_POINTS, -500 + 0.1 * n, 1e-4 * (n % 2), 0});
    }
    rig.load(points);
    rig.ready(Mode::FREE);
    rig.send(JogAbsolute{{true, 0}, V, 0.05});
    rig.step(200);
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, 0.05 + 0.5e-4, 1e-9);
    EXPECT_NEAR(rig.out->joint[0].backlash_raw, rig.out->joint[0].backlash_filtered, 1e-12);
    const CommandId id = rig.send(points[0]);
    rig.step(2);
    EXPECT_EQ(rig.refusal(id), Reason::SWITCHED_ON);
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, 0.05 + 0.5e-4, 1e-9) << "it stays active";
}

TEST(ScrewTables, ANewTableMovesNothing) {
    ScrewRig rig(false);
    rig.load(measure(0.03, 1));
    rig.ready(Mode::FREE);
    rig.send(JogAbsolute{{true, 0}, V, 30});
    rig.step(1500);
    rig.send(Disable{});
    rig.step(3);
    const double motor = rig.out->joint[0].motor_pos_cmd;
    const double place = rig.status().joint[0].pos_fb;
    EXPECT_NEAR(place, 30, 1e-9);
    rig.load(measure(0.05, 2));
    EXPECT_EQ(rig.status().joint[0].pos_fb, place);
    rig.send(Enable{});
    rig.step(500);
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, motor, 1e-12);
    EXPECT_NEAR(rig.status().joint[0].pos_cmd, place, 1e-12);
}

/// Parameter: table instead of play.
class TakeUp : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(OfPlayAndOfATable, TakeUp, ::testing::Bool());

TEST_P(TakeUp, AfterSwitchingOnAMotorWaitsUntilTheJointMoves) {
    ScrewRig rig(false);
    if (GetParam()) {
        rig.load(measure(0.4, 1));
    } else {
        rig.set(Parameter::JOINT_BACKLASH, 0, 0.4);
    }
    rig.ready(Mode::FREE);
    rig.send(JogAbsolute{{true, 0}, V, 30});
    rig.step(1500);
    rig.send(JogAbsolute{{true, 0}, V, 29.999});
    const double before = rig.out->joint[0].motor_pos_cmd;
    ASSERT_TRUE(rig.run_until([&] { return rig.out->joint[0].motor_pos_cmd < before - 0.1; }));
    rig.send(Disable{});
    rig.step(20);
    rig.send(Enable{});
    rig.step(3);
    const double motor = rig.out->joint[0].motor_pos_cmd;
    EXPECT_GT(motor, before - 0.39) << "in the middle of it";
    rig.step(500);
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, motor, 1e-12) << "no move was commanded";
    rig.send(JogAbsolute{{true, 0}, V, 20});
    rig.step(1500);
    const double at_20 = rig.out->joint[0].motor_pos_cmd;
    rig.send(JogAbsolute{{true, 0}, V, 10});
    rig.step(1500);
    rig.send(JogAbsolute{{true, 0}, V, 20});
    rig.step(1500);
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd - at_20, 0.4, 1e-9) << "the whole of it at either side";
}

}  // namespace
}  // namespace screw_test
}  // namespace mw::motion

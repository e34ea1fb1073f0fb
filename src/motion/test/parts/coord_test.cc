// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "kinematics/trivial.hh"
#include "motion/servo/coord/cartesian_position.hh"
#include "motion/servo/coord/heading.hh"
#include "motion/servo/coord/joint_continuity.hh"
#include "motion/servo/coord/retracing.hh"

namespace mw::motion {
namespace {

constexpr double T = 1e-3;

geometry::Pose at(double x) {
    geometry::Pose p;
    p[0] = x;
    return p;
}

TEST(CartesianPositionPart, ThePoseFollowsTheJointsOrTheJointsFollowThePose) {
    kinematics::Trivial kinematics;
    ASSERT_TRUE(kinematics.configure("XY"));
    CartesianPosition position;
    const double joints[MAX_JOINTS] = {3, 4};
    position.follow_joints(kinematics, joints, false);
    EXPECT_EQ(position.cmd()[0], 3);
    EXPECT_EQ(position.velocity(), 0);
    position.follow_pose(at(3.1), T);
    EXPECT_NEAR(position.velocity(), std::hypot(0.1, 4) / T, 1e-6);
    const double feedback[MAX_JOINTS] = {2.9, 4};
    position.read_feedback(kinematics, feedback, false);
    EXPECT_TRUE(position.isFbValid()) << "joints that are axes need no homing";
    EXPECT_EQ(position.fb()[0], 2.9);
}

/// Iterative models return to a position within 1e-4: no step, however slow the joints are.
TEST(LeadPart, APoseLeadsToTheJointPositionsWithinACycle) {
    const kinematics::CoreXy kinematics;
    for (const double velocity : {100.0, 0.001}) {
        std::array<double, MAX_JOINTS> most{};
        most.fill(velocity);
        const JointStepLimit stride{most.data(), T, 3};
        const double within = std::max(velocity * T, 1e-4);
        for (const double off : {0.0, 0.9 * within, 1.1 * within}) {
            for (const std::size_t j : {0U, 1U, 2U}) {
                JointValues here{5, 5};
                here[j] -= off;
                EXPECT_EQ(isWithinOneStep(kinematics, at(5), here, stride), off < within)
                    << velocity << ' ' << off;
            }
        }
    }
}

TEST(CartesianPositionPart, AnUnknownPoseKeepsTheLastValueAndIsNotValid) {
    const kinematics::CoreXy kinematics;
    CartesianPosition position;
    position.assume(0, 5);
    position.set_cmd(at(7));
    const double joints[MAX_JOINTS] = {3, 1};
    position.read_feedback(kinematics, joints, false);
    EXPECT_EQ(position.fb()[0], 5) << "not homed";
    EXPECT_FALSE(position.isFbValid());
    position.read_feedback(kinematics, joints, true);
    EXPECT_NEAR(position.fb()[0], 2, 1e-12);
    EXPECT_TRUE(position.isFbValid());
    position.follow_joints(kinematics, joints, false);
    EXPECT_EQ(position.cmd()[0], 7);
    position.follow_joints(kinematics, joints, true);
    EXPECT_NEAR(position.cmd()[0], 2, 1e-12);
}

/// A straight path at 20 unit/s that has just stopped.
struct RetracingPart : testing::Test {
    std::unique_ptr<Retracing> retracing = std::make_unique<Retracing>();
    FoldedLimits limits;
    double x = 0;

    RetracingPart() {
        limits.path.acceleration.fill(1000);
        for (int n = 0; n < 600; ++n) {
            x += n < 500 ? 0.02 * std::min(1.0, std::min(n / 100.0, (500 - n) / 100.0)) : 0.0;
            retracing->record(at(x), {limits, 0, T});
        }
    }
    struct Way {
        geometry::Pose pose;
        bool isNewStart = false;
    };
    Way go(bool isReverse, std::uint64_t drops = 0) { return go(*retracing, isReverse, drops); }
    Way go(Retracing &on, bool isReverse, std::uint64_t drops = 0) const {
        RetraceInputs in;
        in.isReverseWanted = isReverse;
        in.isPathHeld = true;
        in.rate = 0.5;
        in.drops = drops;
        Way way{at(x)};
        way.isNewStart = on.step(way.pose, in, {limits, 0, T});
        return way;
    }
};

TEST_F(RetracingPart, MovesBackAndForwardOnTheExecutedPath) {
    double least = x;
    for (int n = 0; n < 300; ++n) {
        least = std::min(least, go(true).pose[0]);
    }
    EXPECT_LT(least, x - 0.5);
    EXPECT_GT(least, 0);
    double last = least;
    for (int n = 0; n < 3000; ++n) {
        const double now = go(false).pose[0];
        ASSERT_LT(std::abs(now - last) / T, 20) << "no faster than it was driven";
        last = now;
    }
    EXPECT_EQ(last, x);
    EXPECT_FALSE(retracing->isAway());
}

TEST_F(RetracingPart, APathDroppedInReverseRunEndsWhereItStops) {
    for (int n = 0; n < 300; ++n) {
        go(true);
    }
    Way out;
    for (int n = 0; n < 2000 && !out.isNewStart; ++n) {
        out = go(true, 1);
    }
    EXPECT_TRUE(out.isNewStart);
    EXPECT_LT(out.pose[0], x);
    EXPECT_FALSE(retracing->isPathLeft());
    EXPECT_TRUE(retracing->isEmpty());
}

TEST_F(RetracingPart, AStopInASlowPartOfThePathIsShort) {
    // The path is driven at 20 units/s, then at 5; then it stops.
    constexpr double A = 100;
    limits.path.acceleration.fill(A);
    for (int n = 0; n < 3000; ++n) {
        x += n < 1000 ? 0.02 : n < 2990 ? 0.005 : 0;
        retracing->record(at(x), {limits, 0, T});
    }
    const auto cycles_to_stop = [&](int back) {
        const auto on = std::make_unique<Retracing>(*retracing);
        RetraceInputs in;
        in.isReverseWanted = in.isPathHeld = true;
        in.rate = 0.75;
        geometry::Pose pose = at(x);
        double last = x;
        for (int n = 0; n < back; ++n) {
            last = pose[0];
            on->step(pose, in, {limits, 0, T});
        }
        const double v = (last - pose[0]) / T;
        in.isStopping = true;
        int n = 0;
        for (double before = pose[0] + 1; pose[0] != before && n < 3000; ++n) {
            before = pose[0];
            on->step(pose, in, {limits, 0, T});
        }
        return std::pair{n, v};
    };
    const auto [slow, v] = cycles_to_stop(1500);
    EXPECT_NEAR(v, 0.75 * 5, 0.1);
    const auto [fast, high] = cycles_to_stop(3000);
    EXPECT_GT(high, 10);
    EXPECT_LE(slow * T, 1.5 * v / A) << "nearly as soon as can be";
    EXPECT_GT(fast, 2 * slow);
}

TEST_F(RetracingPart, ACopyMovesAlongTheSamePath) {
    for (int n = 0; n < 100; ++n) {
        go(true);
    }
    const auto clone = std::make_unique<Retracing>(*retracing);
    for (int n = 0; n < 500; ++n) {
        ASSERT_EQ(go(n < 200).pose, go(*clone, n < 200).pose);
    }
}

geometry::Pose place(double x, double y, double z = 0) {
    geometry::Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

trajectory::Primitive arc(const geometry::Pose &start, const geometry::Pose &end,
                          const geometry::Pose &centre, double angle_rad, int normal = geometry::AXIS_Z) {
    trajectory::ArcShape shape;
    shape.centre = centre;
    shape.normal[normal] = 1;
    shape.angle_rad = angle_rad;
    trajectory::Primitive out;
    EXPECT_EQ(trajectory::make_arc(start, end, shape, out), trajectory::ArcFault::NONE);
    return out;
}

TEST(HeadingPart, LinesPointAlongTheirDirection) {
    const auto line = trajectory::make_line(place(1, 1), place(1, 3));
    Heading h = heading_of(line, MotionType::FEED, place(1, 2), false, {});
    EXPECT_EQ(h.g_code, 10);
    EXPECT_NEAR(h.direction_deg, 90, 1e-9);
    EXPECT_NEAR(h.to_centre_deg, 180, 1e-9);
    EXPECT_FALSE(h.isArc);
    EXPECT_EQ(h.radius, 0);
    EXPECT_NEAR(heading_of(line, MotionType::FEED, place(1, 2), true, {}).direction_deg, 270, 1e-9);
    const auto down = trajectory::make_line(place(1, 3), place(1, 3, -5));
    h = heading_of(down, MotionType::TRAVERSE, place(1, 3, -1), false, h);
    EXPECT_EQ(h.g_code, 0);
    EXPECT_NEAR(h.direction_deg, 90, 1e-9) << "straight down it keeps what it was";
}

TEST(HeadingPart, ArcsPointAlongTheirTangentAndToTheirCentre) {
    constexpr double PI = 3.14159265358979323846;
    // G2 from three o'clock: first downwards, with the centre to the left.
    const auto clockwise = arc(place(75, 50), place(75, 50), place(50, 50), -2 * PI);
    Heading h = heading_of(clockwise, MotionType::ARC, place(75, 50), false, {});
    EXPECT_EQ(h.g_code, 20);
    EXPECT_TRUE(h.isArc);
    EXPECT_NEAR(h.radius, 25, 1e-9);
    EXPECT_NEAR(h.centre[0], 50, 1e-9);
    EXPECT_NEAR(h.centre[1], 50, 1e-9);
    EXPECT_NEAR(h.direction_deg, 270, 1e-9);
    EXPECT_NEAR(h.to_centre_deg, 180, 1e-9);
    const auto other = arc(place(50, 75), place(50, 75), place(75, 75), 2 * PI);
    h = heading_of(other, MotionType::ARC, place(50, 75), false, {});
    EXPECT_EQ(h.g_code, 30);
    EXPECT_NEAR(h.direction_deg, 270, 1e-9);
    EXPECT_NEAR(h.to_centre_deg, 0, 1e-9);
    const auto helix = arc(place(1, 0, 0), place(1, 0, -4), place(0, 0, 0), 2 * PI);
    h = heading_of(helix, MotionType::ARC, place(0, 1, -1), false, {});
    EXPECT_NEAR(h.centre[2], -1, 1e-9) << "a helix takes its centre along";
    EXPECT_NEAR(h.direction_deg, 180, 1e-9);
}

}  // namespace
}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are not axes: derivatives along curves, limits at every servo sample, poses without a solution.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/test/curve_rig.hh"
#include "trajectory/test/joint_rig.hh"

namespace mw::trajectory::test {
namespace {

using curve::JointCurve;
using curve::PerJoint;
using profile::CurveLimits;

Pose pose(double x, double y, double c) {
    Pose p;
    p[0] = x;
    p[1] = y;
    p[geometry::AXIS_C] = c;
    return p;
}

std::vector<curve::Span> spans_of(const std::vector<Primitive> &moves) {
    curve::ExactBuilder builder(3.0);
    for (const Primitive &p : moves) {
        builder.add(p);
    }
    return builder.spans();
}

TEST(JointCurve, HasTheDerivativesOfTheKinematics) {
    const TurningTable table(150);
    JointCurve joints;
    joints.begin(&table, joint_limits(300, 3000, 30000));
    const auto spans = spans_of({make_line(pose(10, -20, 0), pose(60, 15, 200))});
    joints.cover(spans);
    EXPECT_EQ(joints.drivable_s(), 1e300);
    // Along the line, x, y and c are linear in s. So the derivatives of the products have a closed form.
    const Pose step = spans[0].c[1] * (1 / spans[0].length), start = spans[0].c[0];
    const double w = step[geometry::AXIS_C] * std::numbers::pi / 180;
    for (double s = 0.05; s < spans.back().end_s(); s += 0.37) {
        const curve::JointPoint p = joints.point_at(joints.part_at(s), s);
        const double c = w * s, x = start[0] + 150 + step[0] * s, y = start[1] + step[1] * s;
        const double cs = std::cos(c), sn = std::sin(c);
        // j0 = x cos c - y sin c, j1 = x sin c + y cos c
        const double j0 = x * cs - y * sn, j1 = x * sn + y * cs, u = step[0] * cs - step[1] * sn,
                     v = step[0] * sn + step[1] * cs;
        EXPECT_NEAR(p.first[0], u - w * j1, 1e-8);
        EXPECT_NEAR(p.second[0], -2 * w * v - w * w * j0, 1e-6);
        EXPECT_NEAR(p.third[0], -3 * w * w * u + w * w * w * j1, 1e-4);
        EXPECT_NEAR(p.first[3], step[geometry::AXIS_C], 1e-9);
    }
}

TEST(JointCurve, IsCalculatedOnceWhileTheCurveGrows) {
    class Counting final : public JointMap {
      public:
        bool joints_at(const Pose &p, double *joints) const noexcept override {
            ++calls;
            return table.joints_at(p, joints);
        }
        TurningTable table{100};
        mutable int calls = 0;
    } map;
    auto spans =
        spans_of({make_line(pose(0, 0, 0), pose(60, 0, 90)), make_line(pose(60, 0, 90), pose(0, 9, 0))});
    const auto all = spans;
    JointCurve grown, whole;
    whole.begin(&map, joint_limits(300, 3000, 30000));
    whole.cover(all);
    const int once = map.calls;
    map.calls = 0;
    grown.begin(&map, joint_limits(300, 3000, 30000));
    spans.clear();
    for (std::size_t k = 0; k < all.size(); ++k) {
        spans.push_back(all[k]);
        grown.cover(spans);
        if (spans.size() > 5) {
            grown.drop_before(spans[2].start_s);
            spans.erase(spans.begin());
        }
    }
    EXPECT_EQ(map.calls, once);
    ASSERT_FALSE(grown.parts().empty());
    EXPECT_EQ(grown.parts().back().start_s, whole.parts().back().start_s);
    EXPECT_LT(grown.parts().size(), whole.parts().size());
}

/// For x above 40, the kinematics has no solution, or a joint jumps there.
class Broken final : public JointMap {
  public:
    explicit Broken(bool jumps) noexcept : jumps_(jumps) {}
    bool joints_at(const Pose &p, double *joints) const noexcept override {
        joints[0] = p[0] + (jumps_ && p[0] > 40 ? 360 : 0);
        joints[1] = p[1];
        joints[2] = p[2];
        joints[3] = p[geometry::AXIS_C];
        return jumps_ || p[0] <= 40;
    }

  private:
    bool jumps_;
};

TEST(JointProfile, StopsBeforePosesWithoutASolution) {
    for (const bool jumps : {false, true}) {
        const Broken map(jumps);
        const auto spans = spans_of({make_line(pose(0, 0, 0), pose(100, 0, 0))});
        std::vector<profile::FeedLimit> feeds{{100, 1e300}};
        CurveLimits limits;
        limits.axes.fill({100, 1000, 20000});
        profile::Run run{&spans, &feeds, limits};
        run.end_s = 100;
        run.has_stop = true;
        run.map = &map;
        run.joints = joint_limits(1000, 10000, 1e6);
        profile::Profile profile({});
        profile.begin(0);
        double end = 0;
        for (int n = 0; n < 1000 && !(profile.isComplete() && profile.cells() == 0); ++n) {
            profile.plan(run, 0);
            const std::size_t cells = std::min<std::size_t>(profile.cells(), 25);
            for (std::size_t k = 0; k < cells; ++k) {
                end = profile.cell(k).s_at(profile.cell(k).duration);
            }
            profile.drop(cells);
        }
        EXPECT_LE(profile.drivable_s(), 40);
        EXPECT_GT(profile.drivable_s(), 39.9);
        EXPECT_NEAR(end, profile.drivable_s(), 1e-9);
    }
}

TEST(JointProfile, KeepsTheLimitsOfJointsAtEverySample) {
    const auto [first, count] = testing::campaign_seeds(6);
    int limited = 0;
    for (int i = 0; i < count; ++i) {
        const auto seed = static_cast<unsigned>(first + i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        Maker maker(seed, true);
        const Program program = table_program(maker, seed);
        const CurveLimits limits = profile::limits_of(program.limits);
        const TurningTable table(maker.real(0, 200));
        const JointLimits joints = random_joint_limits(maker);
        const LaidCurve laid = CurveLayer(program, limits, &table, joints).lay();
        CurveDriver driver(laid, limits);
        driver.run().map = &table;
        driver.run().joints = joints;
        const DrivenCurve out = driver.drive();
        ASSERT_TRUE(out.is_done);
        EXPECT_LE(out.worst_start, 1 + 1e-6) << "a plan began from one that leaves a limit";
        limited += expect_joint_limits(out.samples, table, joints) > 0.9 ? 1 : 0;
        auto checker = make_checker(program.limits, CURVE_PERIOD_S);
        for (const Pose &sample : out.samples) {
            checker.sample(sample.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        for (const profile::StopEffort effort : {profile::StopEffort::QUICK, profile::StopEffort::SOONEST}) {
            CurveDriver stopped(laid, limits);
            stopped.run().map = &table;
            stopped.run().joints = joints;
            stopped.stop_after(1 + static_cast<int>(seed % 23), effort);
            expect_joint_limits(stopped.drive().samples, table, joints);
        }
    }
    EXPECT_GE(2 * limited, count) << "joints limit the motion";
}

/// A rotating arm with a radial joint. X0 Y0 is a singular pose.
class Polar final : public JointMap {
  public:
    bool joints_at(const Pose &p, double *joints) const noexcept override {
        joints[0] = std::hypot(p[0], p[1]);
        joints[1] = std::atan2(p[1], p[0]) * 180 / std::numbers::pi;
        joints[2] = p[2];
        joints[3] = p[geometry::AXIS_C];
        return joints[0] > 1e-4;
    }
};

TEST(JointProfile, SlowsDownNearASingularPose) {
    const Polar map;
    const JointLimits joints = joint_limits(90, 1000, 20000);
    for (const double distance : {10.0, 1.0, 0.1, 0.01}) {
        SCOPED_TRACE(distance);
        Program program;
        program.primitives = {make_line(pose(distance, -40, 0), pose(distance, 40, 0))};
        program.requests.resize(1);
        program.requests[0].isRapid = true;
        CurveLimits limits;
        limits.axes.fill({200, 2000, 40000});
        const LaidCurve laid = CurveLayer(program, limits, &map, joints).lay();
        CurveDriver driver(laid, limits);
        driver.run().map = &map;
        driver.run().joints = joints;
        const DrivenCurve out = driver.drive();
        ASSERT_TRUE(out.is_done);
        EXPECT_LE(out.worst_start, 1 + 1e-6);
        EXPECT_GT(expect_joint_limits(out.samples, map, joints), 0.9);
        // The arm rotates by 180 degrees in 2 s, and moves 40 units out and in.
        EXPECT_LT(out.time_s, 4.0);
    }
}

}  // namespace
}  // namespace mw::trajectory::test

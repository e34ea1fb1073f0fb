// SPDX-License-Identifier: GPL-2.0-or-later
// Machines whose joints are not axes: programs that planner and executor run along curves.
#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/test/joint_rig.hh"

namespace mw::trajectory::test {
namespace {

constexpr int SEEDS = 6;
using curve::PerJoint;

/// Range of the joints along a program.
struct JointSpan {
    PerJoint low, high;

    JointSpan() noexcept {
        low.fill(1e300);
        high.fill(-1e300);
    }
    void take(const JointMap &map, const Pose &pose) {
        PerJoint at{};
        EXPECT_TRUE(map.joints_at(pose, at.data()));
        for (std::size_t j = 0; j < at.size(); ++j) {
            low[j] = std::min(low[j], at[j]);
            high[j] = std::max(high[j], at[j]);
        }
    }
};

JointSpan span_of(const std::vector<Primitive> &path, const JointMap &map) {
    constexpr int PLACES = 400;
    JointSpan span;
    for (const Primitive &p : path) {
        for (int n = 0; n <= PLACES; ++n) {
            span.take(map, position_at(p, p.length * n / PLACES));
        }
    }
    return span;
}

/// The soft limits of the joints are their range along the path, so no deviation may exceed them.
TEST(MappedCurve, KeepsLimitsAndSoftLimitsOfJoints) {
    const auto [first_seed, count] = testing::campaign_seeds(SEEDS);
    int limited = 0;
    for (int seed = first_seed; seed < first_seed + count; ++seed) {
        SCOPED_TRACE(seed);
        Maker maker(static_cast<unsigned>(seed), true);
        const Program program = table_program(maker, static_cast<unsigned>(seed));
        const TurningTable table(maker.real(0, 200));
        JointLimits joints = random_joint_limits(maker);
        const JointSpan path = span_of(program.primitives, table);
        joints.low = path.low;
        joints.high = path.high;
        Outcome out;
        out.rig.planner.set_joints(&table, joints);
        drive(maker, program, out, seed % 3 == 1);
        EXPECT_TRUE(out.isFinished);
        limited += expect_joint_limits(out.rig.samples, table, joints) > 0.9 ? 1 : 0;
        JointSpan driven;
        for (const Pose &sample : out.rig.samples) {
            driven.take(table, sample);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            // Possible excess between the samples of the path.
            constexpr double BETWEEN = 1e-4;
            EXPECT_GE(driven.low[j], path.low[j] - BETWEEN) << "joint " << j;
            EXPECT_LE(driven.high[j], path.high[j] + BETWEEN) << "joint " << j;
        }
        if (seed % 3 != 1) {
            EXPECT_TRUE(isWithinProgram(out.rig.samples, program, allowed_deviation(program)));
        }
    }
    EXPECT_GE(2 * limited, count) << "joints limit the motion";
}

/// The number of samples along a move is bounded, however long the move is.
TEST(MappedCurve, AHelixOfManyRevolutionsHasATolerance) {
    const TurningTable table(100);
    Workspace workspace;
    workspace.map = &table;
    workspace.joints = joint_limits(50, 1000, 20000);
    ArcShape shape;
    shape.centre[0] = 5;
    shape.normal[2] = 1;
    shape.angle_rad = 1e12;
    Pose end;
    end[0] = 5 - 5 * std::cos(shape.angle_rad);
    end[1] = -5 * std::sin(shape.angle_rad);
    Primitive helix;
    ASSERT_EQ(make_arc(Pose{}, end, shape, helix), ArcFault::NONE);
    EXPECT_EQ(workspace.tolerance_within(helix, 0.1), 0.1) << "no joint has a soft limit";
    workspace.joints.low.fill(-1000);
    workspace.joints.high.fill(1000);
    const double kept = workspace.tolerance_within(helix, 0.1);
    EXPECT_GE(kept, 0);
    EXPECT_LE(kept, 0.1);
}

/// The rapid override also scales the velocity limits of joints.
TEST(MappedCurve, RapidOverrideScalesJoints) {
    const TurningTable table(100);
    JointLimits joints = joint_limits(50, 1000, 20000);
    Rig rig{Pose{}};
    Limits limits;
    limits.velocity.fill(1000);
    limits.acceleration.fill(5000);
    limits.jerk.fill(100000);
    limits.isJerkLimited = true;
    rig.planner.set_limits(limits);
    rig.planner.set_joints(&table, joints);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    Scales scales;
    scales.rapid = 0.25;
    rig.planner.set_scales(scales);
    Pose end;
    end[geometry::AXIS_C] = 90;
    MoveRequest request;
    request.isRapid = true;
    rig.planner.add(make_line(Pose{}, end), request);
    ASSERT_TRUE(rig.run(60));
    JointLimits quarter = joints;
    for (double &v : quarter.velocity) {
        v *= 0.25;
    }
    EXPECT_GE(expect_joint_limits(rig.samples, table, quarter), 0.99);
}

}  // namespace
}  // namespace mw::trajectory::test

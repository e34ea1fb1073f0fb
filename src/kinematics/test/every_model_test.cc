// SPDX-License-Identifier: GPL-2.0-or-later
// Properties of every model: inverse and forward kinematics return the original joints without a
// discontinuity; solutions exist, and rejected poses are out of reach. MW_KINS_POSES sets the number of
// random poses (a tenth of it for iterating models).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "kinematics/frame.hh"
#include "kinematics/jacobian.hh"
#include "kinematics/test/all_models.hh"

namespace mw::kinematics::test {
namespace {

using Joints = std::array<double, MAX_JOINTS>;
constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();

class EveryModel : public testing::TestWithParam<ModelCase> {
  protected:
    int draws() const {
        const char *wanted = std::getenv("MW_KINS_POSES");
        const int count = wanted != nullptr ? std::atoi(wanted) : 20000;
        return GetParam().iterating ? count / 10 : count;
    }
    double drawn(const Span &span) {
        return std::uniform_real_distribution<double>(span.low, span.high)(random_);
    }
    Pose drawn_pose() {
        Pose pose;
        for (std::size_t i = 0; i < GetParam().axes.size(); ++i) {
            pose[axis(i)] = drawn(GetParam().poses[i]);
        }
        return pose;
    }
    Joints drawn_joints() {
        Joints joints{};
        std::transform(GetParam().joints.begin(), GetParam().joints.end(), joints.begin(),
                       [this](const Span &span) { return drawn(span); });
        return joints;
    }
    Joints home() const {
        Joints joints{};
        std::copy(GetParam().home.begin(), GetParam().home.end(), joints.begin());
        return joints;
    }
    int axis(std::size_t i) const { return geometry::axis_of_letter(GetParam().axes[i]); }
    const Kinematics &model() const { return *GetParam().model; }

    /// Distance of two poses: lengths as they are, angles as arc length at the machine's size.
    double distance(const Pose &p, const Pose &q) const {
        double most = 0;
        for (std::size_t i = 0; i < GetParam().axes.size(); ++i) {
            const bool oriented = GetParam().are_angles_rpy && geometry::isAngular(axis(i));
            most = oriented ? most : std::max(most, std::abs(p[axis(i)] - q[axis(i)]));
        }
        if (GetParam().are_angles_rpy) {
            const Rotation one = rotation_of(p);
            const Rotation other = rotation_of(q);
            most = std::max(
                {most, GetParam().size * length(one.x - other.x), GetParam().size * length(one.z - other.z)});
        }
        return most;
    }
    std::string text(const Pose &pose) const {
        std::string out = "pose";
        for (const double c : pose.c) {
            out += " " + std::to_string(c);
        }
        return out;
    }

    /// The maximum derivative of a joint [its unit per unit of the axis].
    static double steepest(const Jacobian &by) {
        double most = 0;
        for (const auto &joint : by.of) {
            for (const double x : joint) {
                most = std::max(most, std::abs(x));
            }
        }
        return most;
    }
    /// True when the joints between two poses change continuously. Bisects the step until it is negligible.
    bool isSmooth(const Pose &from, const Joints &at_from, const Pose &to, int depth) const {
        Joints at_to = at_from;
        if (model().inverse(to, at_to.data()) != Status::OK) {
            return true;  // not reachable: no path passes through this pose
        }
        double most = 0;
        for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
            most = std::max(most, std::abs(at_to[j] - at_from[j]));
        }
        if (most < 5.0) {
            return true;
        }
        if (depth == 0) {
            return false;
        }
        const Pose middle = (from + to) * 0.5;
        Joints at_middle = at_from;
        if (model().inverse(middle, at_middle.data()) != Status::OK) {
            return true;
        }
        return isSmooth(from, at_from, middle, depth - 1) && isSmooth(middle, at_middle, to, depth - 1);
    }

    /// A pose on the same side, within `share` of the machine's size along each axis.
    Pose beside(const Pose &pose, double share) {
        Pose out = pose;
        for (int tries = 0; tries < 1000; ++tries) {
            out = pose;
            for (std::size_t i = 0; i < GetParam().axes.size(); ++i) {
                out[axis(i)] +=
                    drawn({-share, share}) * (geometry::isAngular(axis(i)) ? 20.0 : GetParam().size);
            }
            if (model().side(out) == model().side(pose)) {
                return out;
            }
        }
        return pose;
    }

    std::mt19937_64 random_{20251122};
};

TEST_P(EveryModel, UndoesItselfFromAPoseAndRefusesOnlyWhatIsOutOfReach) {
    int answered = 0, singular = 0, refused = 0, unknown = 0, too_far = 0;
    for (int n = 0; n < draws(); ++n) {
        const Pose pose = drawn_pose();
        Joints joints = home();
        const Status status = model().inverse(pose, joints.data());
        const Verdict verdict = GetParam().judge(pose);
        if (status == Status::UNREACHABLE) {
            ASSERT_NE(verdict, Verdict::REACHABLE) << text(pose);
            ASSERT_EQ(joints, home()) << "a rejected pose changed the joints";
            ++refused;
            unknown += verdict == Verdict::UNKNOWN ? 1 : 0;
            continue;
        }
        ASSERT_NE(verdict, Verdict::UNREACHABLE) << "success without a solution: " << text(pose);
        ASSERT_TRUE(areFinite(joints.data(), MAX_JOINTS)) << text(pose);
        Pose back = beside(pose, 0.01);
        Status returned = model().forward(joints.data(), back);
        if (returned == Status::UNREACHABLE && GetParam().iterating) {
            // Near a singular pose an iteration may not converge over a hundredth of the machine's size. The
            // travel of one servo cycle is much shorter.
            ++too_far;
            back = beside(pose, 1e-4);
            returned = model().forward(joints.data(), back);
        }
        if (status == Status::SINGULAR) {
            ++singular;
            continue;
        }
        ASSERT_EQ(returned, Status::OK) << text(pose);
        ASSERT_LT(distance(back, pose), 1e-7 * GetParam().size)
            << text(pose) << "\n came back as " << text(back);
        ++answered;
    }
    std::printf("%s: %d poses: %d came back (%d not from afar), %d singular, %d rejected (%d of them the "
                "judge does not "
                "know)\n",
                GetParam().name.c_str(), draws(), answered, too_far, singular, refused, unknown);
    EXPECT_LE(too_far, draws() / 50);
    EXPECT_GT(answered, draws() / 20) << "the work is not done";
}

TEST_P(EveryModel, UndoesItselfFromJointsOnTheirSide) {
    if (GetParam().joints.empty()) {
        GTEST_SKIP() << "joints of a closed loop cannot be drawn";
    }
    int answered = 0, singular = 0, refused = 0;
    for (int n = 0; n < draws(); ++n) {
        const Joints joints = drawn_joints();
        Pose pose;
        const Status status = model().forward(joints.data(), pose);
        if (status == Status::UNREACHABLE) {
            ++refused;
            continue;
        }
        ASSERT_TRUE(isFinite(pose));
        Joints back = joints;
        for (std::size_t j = 0; j < GetParam().joints.size(); ++j) {
            back[j] += drawn({-1e-4, 1e-4});
        }
        const Status returned = model().inverse(pose, back.data());
        if (status == Status::SINGULAR || returned != Status::OK) {
            ++singular;
            continue;
        }
        // Near a singular pose small rounding errors of the pose cause large errors of the joints, so the
        // pose is compared.
        Pose again = pose;
        ASSERT_EQ(model().forward(back.data(), again), Status::OK);
        ASSERT_LT(distance(again, pose), 1e-7 * GetParam().size);
        double most = 0;
        for (std::size_t j = 0; j < GetParam().joints.size(); ++j) {
            most = std::max(most, std::abs(back[j] - joints[j]));
        }
        const bool near = most < 1e-3 * std::max(1.0, 0.01 * GetParam().size);
        if (!near) {
            Jacobian by;
            const bool steep = joints_by_pose(model(), pose, back.data(), 0x1ff, 1e-6, by) != Status::OK ||
                               steepest(by) > 1e3;
            ASSERT_TRUE(steep) << "another side than that of the joints, " << text(pose);
            ++singular;
            continue;
        }
        ++answered;
    }
    std::printf("%s: %d joints: %d came back, %d at or near singular places, %d without a pose\n",
                GetParam().name.c_str(), draws(), answered, singular, refused);
    EXPECT_GT(answered, draws() / 20) << "the work is not done";
    EXPECT_LT(singular, draws() / 10 + 1);
}

TEST_P(EveryModel, FollowsALineWithoutAJump) {
    for (int n = 0; n < draws() / 200; ++n) {
        Pose from = drawn_pose();
        Joints joints = home();
        if (model().inverse(from, joints.data()) != Status::OK) {
            continue;
        }
        const Pose to = drawn_pose();
        constexpr int STEPS = 200;
        for (int i = 1; i <= STEPS; ++i) {
            const Pose next = from + (to - from) * (1.0 / (STEPS + 1 - i));
            // At 1e-12 of the step any change of 5 is a discontinuity.
            ASSERT_TRUE(isSmooth(from, joints, next, 30)) << text(from);
            if (model().inverse(next, joints.data()) != Status::OK) {
                break;
            }
            from = next;
        }
    }
}

TEST_P(EveryModel, SidesMeetAtSingularPoses) {
    int changes = 0;
    for (int n = 0; n < draws() / 20; ++n) {
        Pose from = drawn_pose();
        Pose to = drawn_pose();
        Joints joints = home();
        const bool reached = model().inverse(from, joints.data()) == Status::OK &&
                             model().inverse(to, joints.data()) == Status::OK;
        if (!reached || model().side(from) == model().side(to)) {
            continue;
        }
        ++changes;
        Status status = Status::OK;
        for (int halving = 0; halving < 60 && status == Status::OK; ++halving) {
            const Pose middle = (from + to) * 0.5;
            status = model().inverse(middle, joints.data());
            (model().side(middle) == model().side(from) ? from : to) = middle;
        }
        ASSERT_EQ(status, Status::SINGULAR) << text(from);
    }
    if (changes > 0) {
        std::printf("%s: %d of %d lines change the side\n", GetParam().name.c_str(), changes, draws() / 20);
    }
}

TEST_P(EveryModel, DerivativesOfBothWaysAreInverse) {
    const std::size_t count = GetParam().axes.size();
    unsigned axes = 0;
    for (std::size_t i = 0; i < count; ++i) {
        axes |= 1U << axis(i);
    }
    int checked = 0;
    for (int n = 0; n < draws() / 20; ++n) {
        const Pose pose = drawn_pose();
        Joints joints = home();
        Pose at = pose;
        if (model().inverse(pose, joints.data()) != Status::OK ||
            model().forward(joints.data(), at) != Status::OK) {
            continue;
        }
        Jacobian by_pose, by_joints;
        constexpr double STEP = 1e-4;
        const bool is_found = joints_by_pose(model(), at, joints.data(), axes, STEP, by_pose) == Status::OK &&
                              pose_by_joints(model(), joints.data(), static_cast<int>(GetParam().home.size()),
                                             at, STEP, by_joints) == Status::OK;
        if (!is_found || steepest(by_pose) > 30 || steepest(by_joints) > 30) {
            continue;  // the finite differences are inaccurate near a singular pose
        }
        ++checked;
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < count; ++k) {
                double sum = 0;
                for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
                    sum += by_joints.of[j][static_cast<std::size_t>(axis(i))] *
                           by_pose.of[j][static_cast<std::size_t>(axis(k))];
                }
                ASSERT_NEAR(sum, axis(i) == axis(k) ? 1.0 : 0.0, 1e-3)
                    << text(at) << " axes " << i << " " << k;
            }
        }
    }
    EXPECT_GT(checked, draws() / 400);
}

TEST_P(EveryModel, RefusesWhatIsNoNumber) {
    Joints joints = home();
    const Pose pose = drawn_pose();
    for (const double odd : {NOT_A_NUMBER, std::numeric_limits<double>::infinity()}) {
        for (std::size_t i = 0; i < GetParam().axes.size(); ++i) {
            Pose broken = pose;
            broken[axis(i)] = odd;
            Joints found = joints;
            EXPECT_EQ(model().inverse(broken, found.data()), Status::UNREACHABLE) << GetParam().axes[i];
            EXPECT_EQ(found, joints);
        }
        for (std::size_t j = 0; j < GetParam().home.size(); ++j) {
            Joints broken = joints;
            broken[j] = odd;
            Pose found = pose;
            EXPECT_EQ(model().forward(broken.data(), found), Status::UNREACHABLE) << "joint " << j;
            EXPECT_EQ(found, pose);
        }
    }
}

/// Uses corners, edges and centres of the ranges: grids contain round numbers that random poses miss.
TEST_P(EveryModel, UndoesItselfOnAGrid) {
    const std::size_t count = std::min<std::size_t>(GetParam().axes.size(), 6);
    constexpr int STEPS = 5;
    int total = 1;
    for (std::size_t i = 0; i < count; ++i) {
        total *= STEPS;
    }
    int answered = 0;
    for (int n = 0; n < total; ++n) {
        Pose pose;
        int rest = n;
        for (std::size_t i = 0; i < count; ++i, rest /= STEPS) {
            const Span &span = GetParam().poses[i];
            pose[axis(i)] = std::round(span.low + (span.high - span.low) * (rest % STEPS) / (STEPS - 1));
        }
        Joints joints = home();
        const Status status = model().inverse(pose, joints.data());
        const Verdict verdict = GetParam().judge(pose);
        ASSERT_FALSE(status == Status::UNREACHABLE && verdict == Verdict::REACHABLE) << text(pose);
        ASSERT_FALSE(status != Status::UNREACHABLE && verdict == Verdict::UNREACHABLE) << text(pose);
        Pose back = pose;
        if (status == Status::UNREACHABLE || model().forward(joints.data(), back) == Status::UNREACHABLE) {
            continue;
        }
        ASSERT_LT(distance(back, pose), 1e-6 * GetParam().size)
            << text(pose) << "\n came back as " << text(back);
        ++answered;
    }
    EXPECT_GT(answered, total / 50);
}

INSTANTIATE_TEST_SUITE_P(Kinematics, EveryModel, testing::ValuesIn(all_models()),
                         [](const auto &one) { return one.param.name; });

/// External offsets rely on linear joints: an offset adds the same value to these joints at every pose and
/// moves no other joints.
TEST_P(EveryModel, WhatItSaysIsLinearIsSo) {
    const LinearJoints linear = model().linear();
    for (int n = 0; n < draws() / 20; ++n) {
        const Pose pose = drawn_pose();
        Joints joints = home();
        if (model().inverse(pose, joints.data()) != Status::OK) {
            continue;
        }
        for (int j = 0; j < MAX_JOINTS; ++j) {
            const auto k = static_cast<std::size_t>(j);
            if ((linear.joints >> j & 1U) != 0) {
                ASSERT_NEAR(joints[k], geometry::dot(linear.slope[k], pose), 1e-9) << "joint " << j;
            }
        }
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            Pose other = pose;
            other[i] += 0.5;
            Joints moved = joints;
            const bool reported = (linear.axes >> i & 1U) != 0;
            if (!reported || model().inverse(other, moved.data()) != Status::OK) {
                continue;
            }
            for (int j = 0; j < MAX_JOINTS; ++j) {
                const auto k = static_cast<std::size_t>(j);
                const bool moved_by_axis = (linear.joints >> j & 1U) != 0;
                ASSERT_TRUE(moved_by_axis || moved[k] == joints[k]) << "axis " << i << " moves joint " << j;
            }
        }
    }
}

}  // namespace
}  // namespace mw::kinematics::test

// SPDX-License-Identifier: GPL-2.0-or-later
// Programs driven along curves by planner and executor.
#include <gtest/gtest.h>

#include "trajectory/test/campaign.hh"
#include "trajectory/test/profile_rig.hh"

namespace mw::trajectory::test {
namespace {

/// Of the limits, by which samples may exceed them.
constexpr double MARGIN = 1.01;

unsigned first_seed() {
    const char *text = std::getenv("MW_SEED");
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : 1;
}
unsigned seeds() {
    const char *text = std::getenv("MW_CAMPAIGN_SEEDS");
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : 8;
}

/// Worst ratios of velocity, acceleration and jerk of all axes and the norm.
double worst_of(const std::vector<Pose> &samples, const Limits &limits, std::array<double, 3> &by_order) {
    by_order = {};
    const auto ratio = [](double x, double limit) { return limit < UNLIMITED ? std::abs(x) / limit : 0.0; };
    constexpr double T = Rig::T;
    for (std::size_t n = 3; n < samples.size(); ++n) {
        const Pose d1 = samples[n] - samples[n - 1], d2 = samples[n - 1] - samples[n - 2],
                   d3 = samples[n - 2] - samples[n - 3];
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            const auto k = static_cast<std::size_t>(i);
            by_order[0] = std::max(by_order[0], ratio(d1[i] / T, limits.velocity[k]));
            by_order[1] = std::max(by_order[1], ratio((d1[i] - d2[i]) / (T * T), limits.acceleration[k]));
            by_order[2] =
                std::max(by_order[2], ratio((d1[i] - 2 * d2[i] + d3[i]) / (T * T * T), limits.jerk[k]));
        }
        by_order[0] = std::max(by_order[0], ratio(geometry::norm_xyz(d1) / T, limits.velocity[XYZ_NORM]));
        by_order[1] = std::max(by_order[1],
                               ratio(geometry::norm_xyz(d1 - d2) / (T * T), limits.acceleration[XYZ_NORM]));
        by_order[2] = std::max(
            by_order[2], ratio(geometry::norm_xyz(d1 - d2 * 2 + d3) / (T * T * T), limits.jerk[XYZ_NORM]));
    }
    return *std::max_element(by_order.begin(), by_order.end());
}

void expect_kept(const Rig &rig, const Program &program) {
    std::array<double, 3> by_order{};
    const double worst = worst_of(rig.samples, program.limits, by_order);
    EXPECT_LE(worst, MARGIN) << "velocity " << by_order[0] << " acceleration " << by_order[1] << " jerk "
                             << by_order[2];
}

Program program_of(unsigned seed, Maker &maker) {
    return seed % 3 == 0 ? maker.make_curve() : maker.make();
}

Rig third_order_rig() {
    return Rig(Pose{}, PlannerSettings{.third_order = true});
}

/// Without disturbances: the program is driven to its exact end, within limits and tolerance.
TEST(CurvePlanner, DrivesAProgram) {
    for (unsigned seed = first_seed(); seed < first_seed() + seeds(); ++seed) {
        SCOPED_TRACE(seed);
        Maker maker(seed, true);
        const Program program = program_of(seed, maker);
        Rig rig = third_order_rig();
        rig.planner.set_limits(program.limits);
        const Primitive &first = program.primitives.front();
        rig.planner.begin(Pose{}, rig.executor.snapshot(),
                          rig.planner.demand_of(program.requests.front(), first.start, first.end));
        for (std::size_t k = 0; k < program.primitives.size(); ++k) {
            while (!rig.planner.hasRoom(rig.executor.snapshot())) {
                rig.step();
            }
            rig.planner.add(program.primitives[k], program.requests[k]);
        }
        ASSERT_TRUE(rig.run(3000)) << "move " << rig.executor.snapshot().done_move << " of "
                                   << rig.planner.last_move();
        EXPECT_EQ(rig.samples.back(), program.primitives.back().end);
        expect_kept(rig, program);
        const double allowed = allowed_deviation(program);
        EXPECT_TRUE(isWithinProgram(rig.samples, program, allowed));
    }
}

/// With holds, overrides, a planner that is late, and in some programs a drop.
TEST(CurvePlanner, KeepsLimitsWithHoldsOverridesAndDrops) {
    for (unsigned seed = first_seed(); seed < first_seed() + seeds(); ++seed) {
        SCOPED_TRACE(seed);
        Maker maker(seed, true);
        const Program program = program_of(seed, maker);
        Outcome out{.rig = third_order_rig()};
        drive(maker, program, out, seed % 3 == 1);
        EXPECT_TRUE(out.isFinished);
        expect_kept(out.rig, program);
        if (seed % 3 != 1) {
            EXPECT_TRUE(isWithinProgram(out.rig.samples, program, allowed_deviation(program)));
        }
    }
}

}  // namespace
}  // namespace mw::trajectory::test

// SPDX-License-Identifier: GPL-2.0-or-later
// Speeds that a user's planner module chooses. A choice within the limits is executed. Any other choice stops
// the path within the limits. The checker of samples does not know the plan.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/test/part_rig.hh"
#include "trajectory/test/path_rig.hh"

namespace mw::trajectory::test {
namespace {

using Kind = Overreach::Kind;

/// A planner module with a function as its choice. It counts the calls.
struct Chooser final : SpeedChooser {
    using Rule = std::function<int(const SpeedStretch &, std::span<ChosenPhase>)>;
    Rule rule;
    int asked = 0;

    explicit Chooser(Rule r = {}) : rule(std::move(r)) {}

    int choose(const SpeedStretch &stretch, std::span<ChosenPhase> out) noexcept override {
        ++asked;
        return rule(stretch, out);
    }
};

/// Accelerates to a fraction of the maximum speed and decelerates, with a fraction of the maximum
/// acceleration at all speeds.
int gentle(const SpeedStretch &s, std::span<ChosenPhase> out, double speed_share, double share) {
    const double a = share * std::min(s.at_rest, s.at_cap);
    const double end = std::min(s.out, std::max(s.speed, speed_share * s.cap));
    const double reach = std::sqrt(s.speed * s.speed + 2 * a * s.length);
    const double last = std::min(end, reach);
    const double top2 = std::min(speed_share * s.cap * speed_share * s.cap,
                                 0.5 * (s.speed * s.speed + last * last) + a * s.length);
    const double top = std::sqrt(std::max({top2, last * last, s.speed * s.speed}));
    const double down_a = std::min(s.at_rest, s.at_cap);
    const double up = std::min(s.length, (top * top - s.speed * s.speed) / (2 * a));
    const double down = std::min(s.length - up, (top * top - last * last) / (2 * down_a));
    out[0] = {up, top};
    out[1] = {s.length - up - down, top};
    out[2] = {down, last};
    return 3;
}

struct Driven {
    double time_s = 0, fastest = 0;
    Pose end;
    Overreach overreach;
    testing::LimitChecker checker = make_checker(even_limits(100, 1000), PERIOD);
    bool isDone = false;
};

Driven drive(Chooser *chooser, const Limits &limits, double feed = 80) {
    Rig rig(at(0), chooser);
    rig.planner.set_limits(limits);
    rig.planner.begin(at(0), rig.executor.snapshot());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0, 60);
    Pose from = at(0);
    for (int n = 0; n < 12; ++n) {
        const Pose to = at(place(random), place(random), place(random));
        rig.planner.add(make_line(from, to), asking(feed, geometry::PathMode::BLEND, 0.1));
        from = to;
    }
    Driven out;
    out.checker = make_checker(limits, PERIOD);
    rig.planner.release_end();
    out.checker.sample(rig.samples.back().c.data());
    for (int i = 0; i < 60000 && !out.isDone; ++i) {
        rig.step();
        out.checker.sample(rig.samples.back().c.data());
        const Overreach told = rig.planner.take_trouble().overreach;
        out.overreach = told.kind != Kind::NONE ? told : out.overreach;
        out.fastest =
            std::max(out.fastest, geometry::norm_xyz(rig.samples.back() - rig.samples.end()[-2]) / PERIOD);
        out.isDone = rig.executor.isAtRest() && rig.executor.snapshot().done_move >= rig.planner.last_move();
        out.time_s = i * PERIOD;
    }
    out.end = rig.samples.back();
    return out;
}

TEST(SpeedChoice, AChoiceWithinTheLimitsIsExecuted) {
    const Limits limits = even_limits(100, 1000);
    const Driven ours = drive(nullptr, limits);
    ASSERT_TRUE(ours.isDone);
    Chooser all([](const SpeedStretch &s, std::span<ChosenPhase> out) { return gentle(s, out, 1, 1); });
    const Driven whole = drive(&all, limits);
    ASSERT_TRUE(whole.isDone) << static_cast<int>(whole.overreach.kind) << " " << whole.overreach.value;
    EXPECT_LT(whole.time_s, 1.1 * ours.time_s);
    Chooser half([](const SpeedStretch &s, std::span<ChosenPhase> out) { return gentle(s, out, 0.5, 0.5); });
    const Driven slow = drive(&half, limits);
    ASSERT_TRUE(slow.isDone) << static_cast<int>(slow.overreach.kind) << " " << slow.overreach.value;
    EXPECT_LE(slow.fastest, 40.01);
    EXPECT_GT(slow.fastest, 35);
    EXPECT_GT(slow.time_s, 1.5 * ours.time_s);
    EXPECT_EQ(half.asked, 12) << "once for each move";
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(slow.end[i], ours.end[i], 1e-9);
    }
    EXPECT_EQ(whole.checker.report(), "");
    EXPECT_EQ(slow.checker.report(), "");
}

TEST(SpeedChoice, AChoiceOutsideTheLimitsStopsThePathWithinTheLimits) {
    const auto spoil = [](Kind kind, const SpeedStretch &s, std::span<ChosenPhase> out) {
        const int count = gentle(s, out, 1, 1);
        switch (kind) {
        case Kind::TOO_FAST: out[0].speed = out[1].speed = 1.01 * s.cap; break;
        case Kind::TOO_HARD:
            out[0] = {1e-3 * s.length, s.cap};
            out[1] = {s.length * (1 - 2e-3), 0.5 * s.cap};
            out[2] = {1e-3 * s.length, s.out};
            return 3;
        case Kind::TOO_LATE: out[2].speed = s.out + 0.01 * s.cap; break;
        case Kind::NOT_THERE: out[1].length *= 0.99; break;
        case Kind::NO_ANSWER: return 9;
        case Kind::NONE: out[1].speed = NAN; break;
        }
        return count;
    };
    const Limits limits = even_limits(100, 1000);
    for (const Kind kind : {Kind::TOO_FAST, Kind::TOO_HARD, Kind::NOT_THERE, Kind::NO_ANSWER, Kind::NONE}) {
        // At different segments, at standstill and at speed.
        for (const int first : {1, 2, 5, 9}) {
            Chooser wrong;
            wrong.rule = [&](const SpeedStretch &s, std::span<ChosenPhase> out) {
                return wrong.asked >= first && s.length > 1 ? spoil(kind, s, out) : gentle(s, out, 1, 1);
            };
            const Driven driven = drive(&wrong, limits);
            EXPECT_FALSE(driven.isDone) << static_cast<int>(kind) << " from " << first;
            EXPECT_NE(driven.overreach.kind, Kind::NONE) << static_cast<int>(kind) << " from " << first;
            if (kind != Kind::NONE) {
                EXPECT_EQ(driven.overreach.kind, kind) << "from " << first;
            }
            EXPECT_EQ(driven.checker.report(), "") << static_cast<int>(kind) << " from " << first;
        }
    }
}

TEST(SpeedChoice, WithJerkLimitsTheMaximumChosenSpeedIsKept) {
    const Limits limits = even_limits(100, 1000, 20000);
    const Driven ours = drive(nullptr, limits);
    ASSERT_TRUE(ours.isDone);
    Chooser half([](const SpeedStretch &s, std::span<ChosenPhase> out) { return gentle(s, out, 0.4, 1); });
    const Driven slow = drive(&half, limits);
    ASSERT_TRUE(slow.isDone) << static_cast<int>(slow.overreach.kind) << " " << slow.overreach.value;
    EXPECT_LE(slow.fastest, 32.01);
    EXPECT_GT(slow.time_s, ours.time_s);
    EXPECT_EQ(slow.checker.report(), "");
    Chooser wrong;
    wrong.rule = [&](const SpeedStretch &s, std::span<ChosenPhase> out) {
        const int count = gentle(s, out, 1, 1);
        out[1].speed = wrong.asked > 10 ? 2 * s.cap : out[1].speed;
        return count;
    };
    const Driven stopped = drive(&wrong, limits);
    EXPECT_FALSE(stopped.isDone);
    EXPECT_EQ(stopped.overreach.kind, Kind::TOO_FAST);
    EXPECT_EQ(stopped.checker.report(), "");
}

}  // namespace
}  // namespace mw::trajectory::test

// SPDX-License-Identifier: GPL-2.0-or-later
// limit3 with random limits and inputs; the test checks only its output.
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/limit/limit_core.hh"
#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

constexpr double DT = 1e-3;  ///< [s]
constexpr int SAMPLES = 3000;
constexpr int STANDING = 1000;  ///< number of last samples in which the input does not change

/// One machine and the input that it follows.
struct Followed {
    limit::Limit3::Bounds bounds;
    std::vector<double> in, out;
};

/// Sine, triangle, steps, or a random walk, over more than the range between the limits.
double input_at(int kind, double t, double amplitude, double hertz, std::mt19937 &random, double last) {
    const double phase = t * hertz - std::floor(t * hertz);
    switch (kind) {
    case 0: return amplitude * std::sin(2.0 * M_PI * hertz * t);
    case 1: return amplitude * (phase < 0.5 ? 4.0 * phase - 1.0 : 3.0 - 4.0 * phase);
    case 2: return phase < 0.5 ? amplitude : -amplitude;
    default:
        return last +
               std::uniform_real_distribution<double>(-1.0, 1.0)(random) * amplitude * hertz * DT * 20.0;
    }
}

Followed make_run(unsigned seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double size = std::pow(10.0, between(-1.0, 3.0));
    Followed run;
    run.bounds = {-size * between(0.1, 1.0), size * between(0.1, 1.0), size * between(0.5, 20.0),
                  size * between(2.0, 200.0)};
    const int kind = static_cast<int>(seed % 4U);
    const double amplitude = size * between(0.2, 2.0);
    const double hertz = between(0.2, 4.0);
    limit::Limit3 block;
    double input = 0.0;
    for (int i = 0; i < SAMPLES; ++i) {
        input = i < SAMPLES - STANDING ? input_at(kind, i * DT, amplitude, hertz, random, input) : input;
        block.run(input, run.bounds, DT, 2);
        run.in.push_back(input);
        run.out.push_back(block.out);
    }
    return run;
}

/// Within 0.1 % of `place`, or of the change that one period makes at full acceleration; full steps cannot be
/// more accurate.
bool isNear(double out, double place, const limit::Limit3::Bounds &bounds) {
    return std::fabs(out - place) <= 1e-3 * std::fabs(out) ||
           std::fabs(out - place) <= 1.01 * bounds.max_accel * DT * DT;
}

/// Time to reach standstill anywhere between the limits from any state: a stop, then the whole range once.
double longest_way_s(const limit::Limit3::Bounds &b) {
    const double room = b.max - b.min;
    const double stop = b.max_vel / b.max_accel;
    return stop + 2.0 * std::sqrt(room / b.max_accel) + room / b.max_vel + stop + 0.01;
}

/// The error in the run, or nothing. `fractions` counts accelerations below the full one.
std::string judge(const Followed &run, int &fractions) {
    const auto &b = run.bounds;
    double v_last = 0.0;
    for (std::size_t i = 0; i < run.out.size(); ++i) {
        const double out = run.out[i];
        const double v = (out - (i == 0 ? 0.0 : run.out[i - 1])) / DT;
        const double a = (v - v_last) / DT;
        // Rounding error of differences between numbers of this size.
        const double v_slack = 1e-9 * (1.0 + b.max - b.min);
        const double a_slack = v_slack / DT;
        const std::string at = " at sample " + std::to_string(i) + ", out " + std::to_string(out);
        if (out < b.min || out > b.max) {
            return "outside of min and max" + at;
        }
        if (std::fabs(v) > b.max_vel + v_slack) {
            return "faster than maxv" + at;
        }
        if (std::fabs(a) > b.max_accel + a_slack) {
            return "more than maxa" + at;
        }
        const bool full = std::fabs(a) >= b.max_accel - a_slack;
        const bool fastest = std::fabs(v) >= b.max_vel - v_slack;
        const bool present = isNear(out, run.in[i], b) || isNear(out, b.min, b) || isNear(out, b.max, b);
        fractions += full || fastest ? 0 : 1;
        if (!full && !fastest && !present) {
            return "less than maxa without a reason" + at;
        }
        v_last = v;
    }
    const double goal = std::fmin(std::fmax(run.in.back(), b.min), b.max);
    if (longest_way_s(b) < STANDING * DT &&
        std::fabs(run.out.back() - goal) > 1e-9 * (1.0 + std::fabs(goal))) {
        return "does not arrive: " + std::to_string(run.out.back()) + " instead of " + std::to_string(goal);
    }
    return {};
}

TEST(Limit3, KeepsEveryLimitAndWastesNoPeriod) {
    constexpr unsigned RUNS = 2000;
    int arrivals_due = 0;
    int fractions = 0;
    for (unsigned seed = 1; seed <= RUNS; ++seed) {
        const Followed run = make_run(seed);
        arrivals_due += longest_way_s(run.bounds) < STANDING * DT ? 1 : 0;
        ASSERT_EQ(judge(run, fractions), "")
            << "seed " << seed << ": min " << run.bounds.min << ", max " << run.bounds.max << ", maxv "
            << run.bounds.max_vel << ", maxa " << run.bounds.max_accel;
    }
    EXPECT_GT(arrivals_due, static_cast<int>(RUNS / 4)) << "too few runs that must arrive";
    EXPECT_GT(fractions, 0) << "the judge has seen no landing";
}

TEST(Limit3, BrakesAheadOfMinAndMax) {
    Bench bench(
        "loadrt limit3\nloadrt siggen\naddf siggen.0.update t\naddf limit3.0 t\n"
        "setp siggen.0.amplitude 100\nnet in siggen.0.sine limit3.0.in\n"
        "setp limit3.0.min -50\nsetp limit3.0.max 50\nsetp limit3.0.maxv 4000\nsetp limit3.0.maxa 10000");
    double low = 0.0;
    double high = 0.0;
    for (int i = 0; i < 3000; ++i) {
        bench.pass();
        const double out = bench.get("limit3.0.out");
        low = std::fmin(low, out);
        high = std::fmax(high, out);
    }
    EXPECT_EQ(low, -50.0);
    EXPECT_EQ(high, 50.0);
}

TEST(Limit3, ComesBackWithinItsLimitsWhenMaxMovesBelowIt) {
    Bench bench("loadrt limit3\naddf limit3.0 t\nsetp limit3.0.maxv 20\nsetp limit3.0.maxa 300\n"
                "setp limit3.0.in 5");
    bench.pass(1000);
    EXPECT_DOUBLE_EQ(bench.get("limit3.0.out"), 5.0);
    bench.set("limit3.0.max", 4.0);
    double last = 5.0;
    double last_v = 0.0;
    for (int i = 0; i < 1000; ++i) {
        bench.pass();
        const double now = bench.get("limit3.0.out");
        const double v = (now - last) / DT;
        ASSERT_LE(std::fabs(v), 20.0 + 1e-9);
        ASSERT_LE(std::fabs(v - last_v) / DT, 300.0 + 1e-6);
        last = now;
        last_v = v;
    }
    EXPECT_NEAR(last, 4.0, 1e-12);
}

TEST(Limit3, LimitsThatAreNoNumbersMoveNothing) {
    limit::Limit3 block;
    const double nan = std::nan("");
    block.run(5.0, {-10.0, 10.0, 20.0, nan}, DT, 2);
    EXPECT_EQ(block.out, 0.0);
    block.run(5.0, {-10.0, 10.0, nan, 300.0}, DT, 2);
    EXPECT_EQ(block.out, 0.0);
    block.run(5.0, {-10.0, 10.0, 20.0, 0.0}, DT, 2);
    EXPECT_EQ(block.out, 0.0);
}

}  // namespace
}  // namespace mw::components::test

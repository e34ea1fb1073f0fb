// SPDX-License-Identifier: GPL-2.0-or-later
// Synchronized passes (G33, G76, G95) on a simulated spindle, compared in machine coordinates with the angle
// of the spindle's encoder, in every path mode, with and without jerk limits, in mm and inch.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"
#include "tests/support/limit_checker.hh"

namespace mw::machine {
namespace {

constexpr double T = 1e-3;
/// Fraction of the lead.
constexpr double TOLERANCE = 1e-3;
/// As above for feed per revolution, which follows the spindle speed and not its angle: the feed is within
/// 0.02 percent over the 62 revolutions of a pass.
constexpr double FEED_TOLERANCE = 1.25e-2;
constexpr double ACCELERATION = 1200;  ///< of both axes [mm/s^2]
constexpr double JERK = 24000;         ///< [mm/s^3], if limited

struct Sample {
    double x = 0, z = 0, turns = 0;
};
/// A pass as the machine executed it.
struct Pass {
    std::size_t first = 0, last = 0;  ///< samples
};
struct Judged {
    double run_in = 0, stop = 0;  ///< deviations from the helix along Z [mm]
    double phase = 0;             ///< of the helix [turns]
    double length = 0;
};

class ThreadsTest : public VirtualMachineTest {
  protected:
    void make(bool isJerkLimited, double velocity = 150) {
        SimMachine lathe;
        lathe.coordinates = "XZ";
        lathe.kinematics = "trivkins coordinates=XZ";
        lathe.hasSpindle = true;
        lathe.velocity = velocity_ = velocity;
        lathe.acceleration = ACCELERATION;
        lathe.joints.assign(2, {false, velocity, ACCELERATION, -500, 500, isJerkLimited ? JERK : 0});
        lathe.traj = isJerkLimited ? fmt::format("PLANNER_TYPE = 1\nMAX_LINEAR_JERK = {}\n", JERK) : "";
        isJerkLimited_ = isJerkLimited;
        switch_on_config(lathe.write(folder_));
    }
    /// Runs a program and records the positions of tool and spindle at the end of each cycle.
    void run(const std::string &text) {
        trace_.clear();
        start(text);
        for (int i = 0; i < 400000 && progress(run_) == task::Progress::STARTED; ++i) {
            cycle();
        }
        ASSERT_EQ(progress(run_), task::Progress::DONE) << messages();
        check_limits();
    }
    void check_limits() const {
        const double jerk = isJerkLimited_ ? JERK : 1e300;
        mw::testing::LimitChecker checker({{velocity_, ACCELERATION, jerk}, {velocity_, ACCELERATION, jerk}},
                                          T);
        for (const Sample &s : trace_) {
            const double axes[] = {s.x, s.z};
            checker.sample(axes);
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
    }
    void cycle() {
        cycles(1);
        const geometry::Pose p = motion().carte_pos_cmd;
        trace_.push_back({p.x(), p.z(), machine_->hal().values().get("spindle.0.revs")->as_number()});
    }
    /// The passes at the depth `x`: from the sample in which Z leaves `from` until Z is stopped at the end or
    /// X has retracted.
    std::vector<Pass> passes_at(double x, double from) const {
        std::vector<Pass> out;
        for (std::size_t i = 1; i < trace_.size(); ++i) {
            const bool isAtDepth = std::abs(trace_[i].x - x) < 1e-9;
            const bool isCutting = isAtDepth && trace_[i].z < from - 1e-9 && trace_[i].z < trace_[i - 1].z;
            if (!isCutting) {
                continue;
            }
            if (out.empty() || out.back().last + 1 != i) {
                out.push_back({i - 1, i});
            }
            out.back().last = i;
        }
        return out;
    }
    /// Compares a pass with the helix Z = c - lead * turns on which most of it lies.
    Judged judge(const Pass &pass, double lead, double tolerance = TOLERANCE) const {
        std::vector<double> offsets;
        for (std::size_t i = pass.first; i <= pass.last; ++i) {
            offsets.push_back(trace_[i].z / lead + trace_[i].turns);
        }
        std::vector<double> sorted = offsets;
        std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                         sorted.end());
        const double c = sorted[sorted.size() / 2];
        const auto isOn = [&](std::size_t i) { return std::abs(offsets[i] - c) <= tolerance; };
        std::size_t from = offsets.size() / 2;
        std::size_t to = from;
        EXPECT_TRUE(isOn(from));
        while (from > 0 && isOn(from - 1)) {
            --from;
        }
        while (to + 1 < offsets.size() && isOn(to + 1)) {
            ++to;
        }
        Judged out;
        out.run_in = trace_[pass.first].z - trace_[pass.first + from].z;
        out.stop = trace_[pass.first + to].z - trace_[pass.last].z;
        out.length = trace_[pass.first].z - trace_[pass.last].z;
        out.phase = c;
        return out;
    }
    /// The shortest travel in which the speed v is reached, plus two cycles.
    double shortest_way(double v) const {
        const double jerk_s = isJerkLimited_ ? ACCELERATION / JERK : 0.0;
        return v * v / (2 * ACCELERATION) + 0.5 * v * jerk_s + 2 * v * T;
    }
    bool isJerkLimited_ = false;
    double velocity_ = 0;
    std::vector<Sample> trace_;
};

constexpr const char *MODES[] = {"G61", "G61.1", "G64", "G64 P0.05"};
constexpr double RPMS[] = {300, 1000, 1800};

struct Units {
    const char *code;
    double mm;
};
constexpr Units UNITS[] = {{"G21", 1.0}, {"G20", 25.4}};

/// With jerk limits, the acceleration at the start reserves a part for following the spindle.
double allowed(bool isJerkLimited, double shortest) {
    return isJerkLimited ? 1.25 * shortest : shortest;
}

class ThreadModes : public ThreadsTest, public ::testing::WithParamInterface<bool> {};

TEST_P(ThreadModes, G33KeepsDepthAndLeadToItsEnd) {
    make(GetParam());
    double phase = NAN;
    for (const Units &unit : UNITS) {
        for (const char *mode : MODES) {
            for (const double rpm : RPMS) {
                SCOPED_TRACE(fmt::format("{} {} S{}", unit.code, mode, rpm));
                const double u = 1 / unit.mm;
                // The spindle turns at its speed when the pass begins.
                run(fmt::format("{} G90 G18 G40 G49 G94 {}\nM3 S{}\nG0 X{:.10f} Z{:.10f}\nG0 X{:.10f}\n"
                                "G4 P0.3\nG33 Z{:.10f} K{:.10f}\nG0 X{:.10f}\nG0 Z{:.10f}\nM5\nM2\n",
                                unit.code, mode, rpm, 14 * u, 5 * u, 10 * u, -20 * u, 1.5 * u, 14 * u,
                                5 * u));
                const auto passes = passes_at(10, 5);
                ASSERT_EQ(passes.size(), 1U);
                const double v = 1.5 * rpm / 60;
                const Judged j = judge(passes[0], 1.5);
                std::printf("G33 %s %s S%g%s: run-in %.4f, stop %.4f of %.4f\n", unit.code, mode, rpm,
                            GetParam() ? " jerk" : "", j.run_in, j.stop, shortest_way(v));
                EXPECT_LE(j.run_in, allowed(GetParam(), shortest_way(v)));
                EXPECT_LE(j.stop, allowed(GetParam(), shortest_way(v)));
                EXPECT_NEAR(j.length, 25, 1e-9) << "depth is kept to the programmed end";
                // The same thread at any speed, except for the delay of one encoder cycle.
                const double here = j.phase - std::floor(j.phase);
                phase = std::isnan(phase) ? here : phase;
                EXPECT_LE(std::abs(std::remainder(here - phase, 1.0)), 5e-3);
            }
        }
    }
}

TEST_P(ThreadModes, G76KeepsDepthAndLeadToItsEnd) {
    make(GetParam());
    for (const Units &unit : UNITS) {
        for (const char *mode : MODES) {
            for (const double rpm : RPMS) {
                SCOPED_TRACE(fmt::format("{} {} S{}", unit.code, mode, rpm));
                const double u = 1 / unit.mm;
                run(fmt::format("{} G90 G18 G40 G49 G94 G8 {}\nM3 S{}\nG0 X{:.10f} Z{:.10f}\n"
                                "G76 P{:.10f} Z{:.10f} I{:.10f} J{:.10f} K{:.10f} R1 Q0 H1\nM5\nM2\n",
                                unit.code, mode, rpm, 12 * u, 5 * u, 1.5 * u, -20 * u, -1 * u, 0.35 * u,
                                0.9 * u));
                const double v = 1.5 * rpm / 60;
                double phase = NAN, run_in = 0, stop = 0;
                int count = 0;
                for (const double depth : {0.35, 0.7, 0.9}) {
                    for (const Pass &pass : passes_at(11 - depth, 5)) {
                        ++count;
                        const Judged j = judge(pass, 1.5);
                        EXPECT_LE(j.run_in, allowed(GetParam(), shortest_way(v)));
                        EXPECT_LE(j.stop, allowed(GetParam(), shortest_way(v)));
                        run_in = std::max(run_in, j.run_in);
                        stop = std::max(stop, j.stop);
                        EXPECT_NEAR(j.length, 25, 1e-9) << "depth is kept to the programmed end";
                        const double here = j.phase - std::floor(j.phase);
                        phase = std::isnan(phase) ? here : phase;
                        EXPECT_LE(std::abs(std::remainder(here - phase, 1.0)), TOLERANCE);
                    }
                }
                EXPECT_EQ(count, 4) << "three depths and a spring pass";
                std::printf("G76 %s %s S%g%s: run-in %.4f, stop %.4f of %.4f\n", unit.code, mode, rpm,
                            GetParam() ? " jerk" : "", run_in, stop, shortest_way(v));
            }
        }
    }
}

TEST_P(ThreadModes, ThePullOutOfG76BeginsWhereItIsProgrammed) {
    make(GetParam());
    // With jerk limits X needs 50 ms to reach its speed; the taper must be long enough.
    const double rpm = GetParam() ? 300 : 600;
    const double v = 1.5 * rpm / 60;
    for (const char *mode : MODES) {
        SCOPED_TRACE(mode);
        // E2: a taper of 0.8 at the end.
        run(fmt::format("G21 G90 G18 G40 G49 G94 G8 {}\nM3 S{}\nG0 X12 Z5\n"
                        "G76 P1.5 Z-20 I-1 J0.5 K0.9 R1 Q0 H0 L2 E0.8\nM5\nM2\n",
                        mode, rpm));
        const auto passes = passes_at(10.1, 5);
        ASSERT_EQ(passes.size(), 1U);
        const Judged j = judge(passes[0], 1.5);
        EXPECT_GE(j.length, 24.2 - v * T) << "full depth up to the pull-out, except the last cycle";
        EXPECT_LE(j.length, 24.7) << "and not much farther";
        EXPECT_LE(j.stop, 2 * v * T) << "the lead is kept up to there";
        EXPECT_LE(j.run_in, allowed(GetParam(), 2 * shortest_way(v)));
        const auto lowest = std::min_element(trace_.begin(), trace_.end(),
                                             [](const Sample &a, const Sample &b) { return a.z < b.z; });
        EXPECT_NEAR(lowest->z, -20, 1e-9);
    }
}

TEST_P(ThreadModes, G95KeepsItsLead) {
    make(GetParam());
    for (const Units &unit : UNITS) {
        for (const char *mode : MODES) {
            for (const double rpm : RPMS) {
                SCOPED_TRACE(fmt::format("{} {} S{}", unit.code, mode, rpm));
                const double u = 1 / unit.mm;
                run(fmt::format(
                    "{} G90 G18 G40 G49 G94 {}\nM3 S{}\nG0 X{:.10f} Z{:.10f}\nG0 X{:.10f}\nG4 P1\n"
                    "G95 F{:.10f} G1 Z{:.10f}\nG0 X{:.10f}\nG0 Z{:.10f}\nG94 M5\nM2\n",
                    unit.code, mode, rpm, 14 * u, 5 * u, 10 * u, 0.4 * u, -20 * u, 14 * u, 5 * u));
                const auto passes = passes_at(10, 5);
                ASSERT_EQ(passes.size(), 1U);
                const double v = 0.4 * rpm / 60;
                const Judged j = judge(passes[0], 0.4, FEED_TOLERANCE);
                std::printf("G95 %s %s S%g%s: run-in %.4f, stop %.4f of %.4f\n", unit.code, mode, rpm,
                            GetParam() ? " jerk" : "", j.run_in, j.stop, shortest_way(v));
                EXPECT_LE(j.run_in, allowed(GetParam(), shortest_way(v)));
                EXPECT_LE(j.stop, allowed(GetParam(), shortest_way(v)));
                // X may begin in the cycle in which Z stops.
                EXPECT_NEAR(j.length, 25, 0.5 * ACCELERATION * T * T)
                    << "depth is kept to the programmed end";
            }
        }
    }
}

constexpr const char *THREAD = "G21 G90 G18 G40 G49 G94 G64\nM3 S600\nG0 X14 Z5\nG0 X10\n"
                               "G33 Z-20 K1.5\nG0 X14\nG0 Z5\nM2\n";

TEST_P(ThreadModes, AFeedHoldWaitsForTheEndOfTheThread) {
    make(GetParam());
    start(THREAD);
    trace_.clear();
    for (int i = 0; i < 20000 && (trace_.empty() || trace_.back().z > -5); ++i) {
        cycle();
    }
    ask(task::PauseProgram{});
    for (int i = 0; i < 3000; ++i) {
        cycle();
    }
    EXPECT_NEAR(motion().carte_pos_cmd.z(), -20, 1e-9) << "the pass is whole";
    EXPECT_NEAR(motion().carte_pos_cmd.x(), 10, 1e-9) << "and what follows waits";
    const auto passes = passes_at(10, 5);
    ASSERT_EQ(passes.size(), 1U);
    EXPECT_LE(judge(passes[0], 1.5).stop, allowed(GetParam(), shortest_way(15)));
    ask(task::ResumeProgram{});
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
}

TEST_P(ThreadModes, AnAbortBrakesInTheThreadWithinTheLimits) {
    make(GetParam());
    start(THREAD);
    trace_.clear();
    for (int i = 0; i < 20000 && (trace_.empty() || trace_.back().z > -5); ++i) {
        cycle();
    }
    const double z = trace_.back().z;
    post(task::AbortAll{});
    for (int i = 0; i < 1000; ++i) {
        cycle();
    }
    EXPECT_TRUE(motion().isInPosition);
    EXPECT_GT(motion().carte_pos_cmd.z(), z - 3);
    check_limits();
    EXPECT_EQ(mdi("G0 X14 Z5"), task::Progress::DONE) << messages();
}

/// The averaging time of this machine follows from its speed, sqrt(2 V / J): full acceleration cannot be
/// reversed within it. An abort comes while the tool accelerates.
TEST_P(ThreadModes, AnAbortWhileTheToolGainsSpeedKeepsTheLimits) {
    make(GetParam(), 40);
    for (const int later : {2, 6, 12, 20, 30, 40}) {
        start(THREAD);
        trace_.clear();
        const auto isAtDepth = [&] { return std::abs(trace_.back().x - 10) < 1e-9; };
        for (int i = 0; i < 20000 && (trace_.empty() || !isAtDepth() || trace_.back().z > 4.99); ++i) {
            cycle();
        }
        ASSERT_TRUE(isAtDepth() && trace_.back().z > 3) << "it has just begun";
        for (int i = 0; i < later; ++i) {
            cycle();
        }
        post(task::AbortAll{});
        for (int i = 0; i < 1000; ++i) {
            cycle();
        }
        EXPECT_TRUE(motion().isInPosition) << later;
        check_limits();
        EXPECT_EQ(mdi("G0 X14 Z5"), task::Progress::DONE) << messages();
    }
}

TEST_P(ThreadModes, TheToolFollowsASpindleThatIsSlowedByTheCut) {
    make(GetParam());
    hal::Instance &hal = machine_->hal();
    start(THREAD);
    trace_.clear();
    for (int i = 0; i < 20000 && (trace_.empty() || trace_.back().z > -5); ++i) {
        cycle();
    }
    // Slows to two thirds within about a tenth of a second.
    ASSERT_TRUE(hal.values().set("spindle-rps.gain", std::to_string(2.0 / 180)).has_value());
    ASSERT_TRUE(hal.values().set("sim-spindle.scale", std::to_string(2.0 / 180)).has_value());
    for (int i = 0; i < 200000 && progress(run_) == task::Progress::STARTED; ++i) {
        cycle();
    }
    EXPECT_EQ(progress(run_), task::Progress::DONE) << messages();
    check_limits();
    const auto passes = passes_at(10, 5);
    ASSERT_EQ(passes.size(), 1U);
    const Judged j = judge(passes[0], 1.5);
    EXPECT_NEAR(j.length, 25, 1e-9);
    // Returns to the same helix well before the end; the samples before the step are judged as run-in.
    EXPECT_LE(j.run_in, 13);
    EXPECT_LE(j.stop, allowed(GetParam(), shortest_way(15)));
}

TEST_P(ThreadModes, AThreadThatIsTooFastIsRefusedBeforeItBegins) {
    make(GetParam());
    // At the programmed speed the travel would be sufficient, but the operator has increased the spindle
    // speed.
    ask(task::SetSpindleOverride{1.2, 0});
    start("G21 G90 G18 G94 G64\nM3 S1500\nG0 X14 Z5\nG0 X10\nG33 Z-20 K6\nG0 X14\nM2\n");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    const std::string all = messages();
    EXPECT_NE(all.find("p.ngc:5"), std::string::npos) << all;
    EXPECT_NE(all.find("1.20 times"), std::string::npos) << all;
    EXPECT_NEAR(motion().carte_pos_cmd.z(), 5, 1e-9) << "nothing has been cut";
}

INSTANTIATE_TEST_SUITE_P(Planners, ThreadModes, ::testing::Bool(),
                         [](const auto &which) { return which.param ? "JerkLimited" : "Trapezoidal"; });

}  // namespace
}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// The programs of nc_files/probing on a complete machine in virtual time. The part is an independent model:
// solids, and a ball whose distance from them determines contact; the results are compared with the
// dimensions of the solids (I1).
#include <algorithm>
#include <cmath>
#include <regex>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

struct Point {
    double x, y, z;
};

/// Distance of a point outside a solid; 0 inside. [mm]
using Solid = std::function<double(const Point &)>;

Solid box(Point low, Point high) {
    return [=](const Point &p) {
        const auto over = [](double v, double a, double b) { return std::max({a - v, v - b, 0.0}); };
        return std::hypot(over(p.x, low.x, high.x), over(p.y, low.y, high.y), over(p.z, low.z, high.z));
    };
}

/// A block with a bore through it.
Solid bore(double cx, double cy, double radius) {
    return [=](const Point &p) {
        return std::hypot(std::max(radius - std::hypot(p.x - cx, p.y - cy), 0.0), std::max(p.z, 0.0));
    };
}

Solid cylinder(double cx, double cy, double radius, double top) {
    return [=](const Point &p) {
        return std::hypot(std::max(std::hypot(p.x - cx, p.y - cy) - radius, 0.0), std::max(p.z - top, 0.0));
    };
}

/// Slow feed times the servo period, the rounding of numbers, and the printed digits.
constexpr double CLOSE_MM = 0.003;
constexpr double TIP_MM = 4;

class ProbingTest : public VirtualMachineTest {
  protected:
    void SetUp() override { switch_on(); }
    /// The controlled point is the lowest point of the ball; without a ball, that of the tool.
    task::Progress probe(const std::string &text, const Solid &solid, double tip = TIP_MM) {
        start(text);
        double deepest = 0;
        for (int i = 0; i < 600000; ++i) {
            cycles(1);
            const auto &place = motion().carte_pos_cmd;
            const Point middle{place.x(), place.y(), place.z() + tip / 2};
            const double gap = solid(middle) - tip / 2;
            deepest = std::min(deepest, gap);
            set_pin("motion.probe-input", gap <= 0 ? "TRUE" : "FALSE");
            if (i > 3 && progress(run_) != task::Progress::STARTED) {
                break;
            }
        }
        // Braking from 300 mm/min at 1000 mm/s2 takes 0.0125 mm.
        EXPECT_GT(deepest, -0.05) << "the probe is pushed into the part";
        text_ = messages();
        return progress(run_);
    }
    double told(const std::string &name) const {
        std::smatch found;
        const std::regex pattern(name + R"( ?(-?[\d.]+))");
        return std::regex_search(text_, found, pattern) ? std::stod(found[1]) : std::nan("");
    }

    std::string text_;
};

constexpr const char *BEGIN = "G21 G90 G94\nG49\n";

TEST_F(ProbingTest, FacesAreFoundFromEachSide) {
    const Solid block = box({10, 20, -50}, {40, 60, -5});
    struct Case {
        const char *place, *call, *name;
        double truth;
    };
    const Case cases[] = {
        {"X2 Y30 Z-10", "[1] [15] [4] [300] [60] [0]", "face at X", 10},
        {"X48 Y30 Z-10", "[-1] [15] [4] [300] [60] [0]", "face at X", 40},
        {"X20 Y11.5 Z-10", "[2] [15] [4] [300] [60] [0]", "face at Y", 20},
        {"X20 Y70.25 Z-10", "[-2] [15] [4] [300] [60] [0]", "face at Y", 60},
        {"X20 Y30 Z3.7", "[-3] [15] [4] [300] [60] [0]", "face at Z", -5},
    };
    for (const Case &one : cases) {
        EXPECT_EQ(probe(std::string(BEGIN) + "G0 Z20\nG0 " +
                            std::string(one.place).substr(0, std::string(one.place).find(" Z")) + "\nG0 " +
                            one.place + "\no<probe_edge> call " + one.call + "\nG0 Z20\nM2\n",
                        block),
                  task::Progress::DONE)
            << text_;
        EXPECT_NEAR(told(one.name), one.truth, CLOSE_MM) << one.call << '\n' << text_;
    }
}

TEST_F(ProbingTest, WhatIsNotThereIsToldAndTheProbeGoesBack) {
    EXPECT_EQ(probe(std::string(BEGIN) + "G0 X5 Y5 Z5\no<probe_edge> call [1] [15] [4] [300] [60] [1]\nM2\n",
                    box({100, 0, -50}, {110, 10, 0})),
              task::Progress::FAILED);
    EXPECT_NE(text_.find("nothing is there within 15"), std::string::npos) << text_;
    EXPECT_NEAR(x(), 5, 1e-6);
    const Solid nothing = box({500, 0, 0}, {501, 1, 1});
    const char *const calls[] = {"o<probe_corner> call [1] [1] [0] [5] [15] [4] [300] [60] [1]",
                                 "o<probe_bore> call [15] [4] [300] [60] [1]",
                                 "o<probe_boss> call [20] [5] [8] [4] [300] [60] [1]",
                                 "T1 M6\nG0 X5 Y5 Z25\no<probe_tool_length> call [0] [0] [20] [300] [60]"};
    for (const char *call : calls) {
        EXPECT_EQ(probe(std::string(BEGIN) + "G0 X5 Y5 Z25\n" + call + "\nM2\n", nothing),
                  task::Progress::FAILED)
            << call;
        EXPECT_NE(text_.find("back where it began"), std::string::npos) << text_;
        EXPECT_NEAR(x(), 5, 1e-6) << call;
        EXPECT_NEAR(motion().carte_pos_cmd.y(), 5, 1e-6) << call;
        EXPECT_NEAR(motion().carte_pos_cmd.z(), 25, 1e-6) << call;
    }
}

TEST_F(ProbingTest, WrongNumbersAreRefusedBeforeAnythingMoves) {
    const char *const calls[] = {
        "o<probe_edge> call [3] [15] [4] [300] [60] [0]",
        "o<probe_edge> call [1] [0] [4] [300] [60] [0]",
        "o<probe_edge> call [1] [101] [4] [300] [60] [0]",
        "o<probe_edge> call [1] [15] [-1] [300] [60] [0]",
        "o<probe_edge> call [1] [15] [4] [30] [60] [0]",
        "o<probe_edge> call [1] [15] [4] [300] [0] [0]",
        "o<probe_edge> call [1] [15] [4] [300] [60] [10]",
        "o<probe_edge> call [1] [15] [4] [300] [60] [1.5]",
        "o<probe_corner> call [0] [1] [0] [5] [15] [4] [300] [60] [0]",
        "o<probe_corner> call [1] [1] [0] [0] [15] [4] [300] [60] [0]",
        "o<probe_boss> call [0] [5] [8] [4] [300] [60] [0]",
        "o<probe_bore> call [0] [4] [300] [60] [0]",
        "o<probe_tool_length> call [0] [0] [30] [300] [60]",
        "M3 S1000\no<probe_edge> call [1] [15] [4] [300] [60] [0]",
    };
    for (const char *call : calls) {
        EXPECT_EQ(probe(std::string("G21 G90 G94\n") + call + "\nM2\n", box({500, 0, 0}, {501, 1, 1})),
                  task::Progress::FAILED)
            << call;
        EXPECT_NEAR(x(), 0, 1e-9) << call;
    }
}

TEST_F(ProbingTest, OuterAndInnerCornersAreFound) {
    EXPECT_EQ(probe(std::string(BEGIN) +
                        "G0 X4 Y13 Z-10\no<probe_corner> call [1] [1] [0] [12] [20] [4] [300] [60] [0]\nM2\n",
                    box({10.25, 20.5, -50}, {40, 60, -5})),
              task::Progress::DONE)
        << text_;
    EXPECT_NEAR(told("corner at X"), 10.25, CLOSE_MM);
    EXPECT_NEAR(told("corner at X[-\\d.]+ Y"), 20.5, CLOSE_MM) << text_;
    const Solid walls = [](const Point &p) {
        return std::min(std::max(p.x + 30, 0.0), std::max(40 - p.y, 0.0));
    };
    EXPECT_EQ(
        probe(std::string(BEGIN) +
                  "G0 X-20 Y31 Z-10\no<probe_corner> call [-1] [1] [1] [0] [20] [4] [300] [60] [0]\nM2\n",
              walls),
        task::Progress::DONE)
        << text_;
    EXPECT_NEAR(told("corner at X"), -30, CLOSE_MM) << text_;
    EXPECT_NEAR(told("corner at X[-\\d.]+ Y"), 40, CLOSE_MM) << text_;
}

TEST_F(ProbingTest, ABoreIsFoundFromBesideItsCentre) {
    EXPECT_EQ(
        probe(std::string(BEGIN) + "G0 X23 Y-8 Z20\nG0 Z-6\no<probe_bore> call [40] [4] [300] [60] [2]\nM2\n",
              bore(21.2, -5.6, 17.35)),
        task::Progress::DONE)
        << text_;
    EXPECT_NEAR(told("centre at X"), 21.2, CLOSE_MM) << text_;
    EXPECT_NEAR(told("centre at X[-\\d.]+ Y"), -5.6, CLOSE_MM) << text_;
    EXPECT_NEAR(told("width X"), 34.7, 2 * CLOSE_MM);
    EXPECT_NEAR(told("width X [-\\d.]+ Y"), 34.7, 2 * CLOSE_MM);
    EXPECT_NEAR(x(), 21.2, CLOSE_MM) << "it ends at the centre";
    // G55 has its zero at this position.
    EXPECT_EQ(probe("G21 G90 G55\n(debug,here #5420 #5421)\nG54\nM2\n", bore(21.2, -5.6, 17.35)),
              task::Progress::DONE);
    EXPECT_NEAR(told("here"), 0, 1e-6) << text_;
    EXPECT_NEAR(told("here [-\\d.]+"), 0, 1e-6) << text_;
}

TEST_F(ProbingTest, ABossIsFoundFromAbove) {
    const Solid boss = cylinder(-12.5, 31.75, 14.1, -2);
    EXPECT_EQ(probe(std::string(BEGIN) +
                        "G0 X-11 Y30 Z5\no<probe_boss> call [28] [6] [15] [4] [300] [60] [0]\nM2\n",
                    boss),
              task::Progress::DONE)
        << text_;
    EXPECT_NEAR(told("centre at X"), -12.5, CLOSE_MM) << text_;
    EXPECT_NEAR(told("centre at X[-\\d.]+ Y"), 31.75, CLOSE_MM) << text_;
    EXPECT_NEAR(told("width X"), 28.2, 2 * CLOSE_MM) << text_;
}

TEST_F(ProbingTest, SomethingInTheWayStopsTheProbe) {
    const Solid boss = cylinder(0, 0, 14, -2), clamp = box({15, -10, -50}, {60, 10, 20});
    const Solid both = [=](const Point &p) { return std::min(boss(p), clamp(p)); };
    EXPECT_EQ(
        probe(std::string(BEGIN) + "G0 Z5\no<probe_boss> call [28] [6] [15] [4] [300] [60] [0]\nM2\n", both),
        task::Progress::FAILED);
    EXPECT_NE(text_.find("something is in the way at X13"), std::string::npos) << text_;
    EXPECT_NEAR(x(), 13, 0.05) << "it has stopped at the touch";
}

TEST_F(ProbingTest, AToolIsMeasuredAtTheSetter) {
    // Tool 1 of the mill is 40 mm long, the setter 12.5 mm high: at contact the controlled point is that much
    // above the setter.
    const Solid setter = [](const Point &p) { return std::max(p.z - (12.5 + 33.25), 0.0); };
    EXPECT_EQ(probe("G21 G90 G94\nT1 M6\nG0 Z60\no<probe_tool_length> call [0] [12.5] [30] [300] [60]\nM2\n",
                    setter, 0),
              task::Progress::DONE)
        << text_;
    EXPECT_NEAR(told("tool 1.0+ has the length"), 33.25, CLOSE_MM) << text_;
}

}  // namespace
}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// Arcs as CAM systems write them, with rounded ends and centres, on machines with two and three axes. Each
// runs, and the motion is compared with the program.
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

struct Plane {
    const char *code;
    int first, second;
    char first_letter, second_letter, first_centre, second_centre;
};
constexpr Plane XY{"G17", 0, 1, 'X', 'Y', 'I', 'J'};
constexpr Plane ZX{"G18", 2, 0, 'Z', 'X', 'K', 'I'};
constexpr Plane YZ{"G19", 1, 2, 'Y', 'Z', 'J', 'K'};

double rounded(double x, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::round(x * scale) / scale;
}

class RoundedArcsTest : public VirtualMachineTest {
  protected:
    struct Expected {
        double centre[2] = {}, radius = 0;
    };
    /// A chain of arcs, each from the end of the previous arc; line numbers start at 2.
    std::string program(unsigned seed, const Plane &plane, int decimals, bool isRadius, int count) {
        std::mt19937 random(seed);
        const auto real = [&](double low, double high) {
            return std::uniform_real_distribution(low, high)(random);
        };
        expected_.assign(2, {});
        std::string text = fmt::format("G21 G90 G40 G49 G80 G94 {} G61 G1{} F6000\n", plane.code, origin_);
        double at[2] = {0, 0};
        for (int n = 0; n < count; ++n) {
            const double radius = real(1, 8);
            const double from = real(-std::numbers::pi, std::numbers::pi);
            const double sweep = isRadius ? real(0.3, 2.8) : real(0.3, 6.0);
            const bool isLeft = real(0, 1) < 0.5;
            double offset[2] = {rounded(-radius * std::cos(from), decimals),
                                rounded(-radius * std::sin(from), decimals)};
            const double to = from + (isLeft ? sweep : -sweep);
            // Turns back towards the centre when it is far away.
            for (int i = 0; i < 2; ++i) {
                const double end = at[i] + offset[i] + radius * (i == 0 ? std::cos(to) : std::sin(to));
                if (std::abs(end) > 40) {
                    offset[0] = 0;
                }
            }
            double end[2] = {rounded(at[0] + offset[0] + radius * std::cos(to), decimals),
                             rounded(at[1] + offset[1] + radius * std::sin(to), decimals)};
            const bool isFar = offset[0] == 0;
            if (isFar) {
                text += fmt::format("G1 {}0 {}0\n", plane.first_letter, plane.second_letter);
                expected_.push_back({});
                at[0] = at[1] = 0;
                continue;
            }
            const std::string where = fmt::format("{}{:.{}f} {}{:.{}f}", plane.first_letter, end[0], decimals,
                                                  plane.second_letter, end[1], decimals);
            // In G18 the first axis is Z and the second X, so G3 still turns to the left.
            const char *code = isLeft ? "G3" : "G2";
            const double r = rounded(std::hypot(offset[0], offset[1]), decimals);
            text += isRadius ? fmt::format("{} {} R{:.{}f}\n", code, where, r, decimals)
                             : fmt::format("{} {} {}{:.{}f} {}{:.{}f}\n", code, where, plane.first_centre,
                                           offset[0], decimals, plane.second_centre, offset[1], decimals);
            Expected e;
            e.radius = isRadius ? 0 : std::hypot(offset[0], offset[1]);
            e.centre[0] = at[0] + offset[0];
            e.centre[1] = at[1] + offset[1];
            expected_.push_back(e);
            at[0] = end[0];
            at[1] = end[1];
        }
        last_[0] = at[0];
        last_[1] = at[1];
        return text + "M2\n";
    }
    void run(const SimMachine &machine, const std::vector<Plane> &planes) {
        switch_on_config(machine.write(folder_));
        origin_.clear();
        for (const char axis : machine.coordinates) {
            origin_ += fmt::format(" {}0", axis);
        }
        unsigned seed = 1;
        for (const Plane &plane : planes) {
            for (const int decimals : {3, 4, 7}) {
                for (const bool isRadius : {false, true}) {
                    SCOPED_TRACE(fmt::format("{} {} decimals {} seed {}", plane.code, decimals,
                                             isRadius ? "R" : "centres", seed));
                    samples_.clear();
                    start(program(seed++, plane, decimals, isRadius, COUNT));
                    ASSERT_EQ(finish(2000000), task::Progress::DONE) << messages();
                    judge(plane, decimals);
                }
            }
        }
    }
    void judge(const Plane &plane, int decimals) {
        const geometry::Pose at = motion().carte_pos_cmd;
        EXPECT_NEAR(at[plane.first], last_[0], 1e-9);
        EXPECT_NEAR(at[plane.second], last_[1], 1e-9);
        // Ends and centre are each off by up to half a digit in each coordinate, and G61 passes within 1e-6.
        const double tolerance = 3 * std::pow(10.0, -decimals) + 2e-6;
        const int other = 3 - plane.first - plane.second;
        std::size_t on_arcs = 0;
        for (const motion::TraceSample &s : samples_) {
            const auto line = static_cast<std::size_t>(s.line);
            if (line < 2 || line >= expected_.size() || expected_[line].radius == 0) {
                continue;
            }
            ++on_arcs;
            ASSERT_NEAR(s.carte_pos_cmd[other], 0.0, 1e-9) << "line " << line;
            const Expected &e = expected_[line];
            const double r = std::hypot(s.carte_pos_cmd[plane.first] - e.centre[0],
                                        s.carte_pos_cmd[plane.second] - e.centre[1]);
            ASSERT_NEAR(r, e.radius, tolerance) << "line " << line;
        }
        const bool hasCentres = expected_.back().radius > 0;
        EXPECT_TRUE(!hasCentres || on_arcs > 10U * COUNT);
    }

    static constexpr int COUNT = 250;
    std::string origin_;
    std::vector<Expected> expected_;
    double last_[2] = {};
};

TEST_F(RoundedArcsTest, RunOnALatheWithoutY) {
    SimMachine lathe;
    lathe.coordinates = "XZ";
    lathe.kinematics = "trivkins coordinates=XZ";
    lathe.joints.resize(2);
    run(lathe, {ZX});
}

TEST_F(RoundedArcsTest, RunOnALaserWithoutZ) {
    SimMachine laser;
    laser.coordinates = "XY";
    laser.kinematics = "trivkins coordinates=XY";
    laser.joints.resize(2);
    run(laser, {XY});
}

TEST_F(RoundedArcsTest, RunOnAMill) {
    run(SimMachine{}, {XY, ZX, YZ});
}

TEST_F(RoundedArcsTest, AnArcOutOfThePlaneOfALaserIsRefused) {
    SimMachine laser;
    laser.coordinates = "XY";
    laser.kinematics = "trivkins coordinates=XY";
    laser.joints.resize(2);
    switch_on_config(laser.write(folder_));
    EXPECT_EQ(mdi("G21 G18 G2 X10 Z0 I5 K0 F600"), task::Progress::FAILED);
    const std::string told = messages();
    EXPECT_NE(told.find("axis Z"), std::string::npos) << told;
}

}  // namespace
}  // namespace mw::machine

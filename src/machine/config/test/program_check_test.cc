// SPDX-License-Identifier: GPL-2.0-or-later
// Errors that a check finds in a program before a machine moves.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "machine/config/loaded_config.hh"
#include "machine/config/program_analysis.hh"

namespace mw::machine {
namespace {

class NoTools : public gcode::ToolSource, public gcode::ParameterSource {
  public:
    int count() const override { return 1; }
    gcode::ToolEntry entry(int) const override { return {}; }
    int index_of_tool(int) const override { return -1; }
    bool isRandom() const override { return false; }
    std::optional<double> ini_value(std::string_view, std::string_view) const override {
        return std::nullopt;
    }
    std::optional<double> hal_value(std::string_view) const override { return std::nullopt; }
};

class ProgramCheck : public testing::Test {
  protected:
    ProgramCheck() {
        std::filesystem::create_directories(folder_);
        diagnostics::Sink loading;
        config_ = LoadedConfig::load(MW_SOURCE_DIR "/configs/sim/mill_mm.ini", loading);
    }
    ~ProgramCheck() override { std::filesystem::remove_all(folder_); }

    gcode::CheckResult check(const std::string &text) {
        const std::string path = (folder_ / "program.ngc").string();
        std::ofstream(path) << text;
        NoTools tools;
        return gcode::check_program(checked_machine(config_->machine), path, {tools, tools}, sink_);
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("mw_check_" + std::to_string(::getpid()));
    std::unique_ptr<LoadedConfig> config_;
    diagnostics::Sink sink_;
};

TEST_F(ProgramCheck, LimitsOfAJointThatMovesAnAxisHoldForTheAxis) {
    ASSERT_NE(config_, nullptr);
    const auto number = static_cast<std::uint16_t>(motion::Parameter::JOINT_MAX_LIMIT);
    config_->machine.parameters.push_back({number, 0, 30});
    check("G21 G90 G17\nG0 X29\nG0 X31\nM2\n");
    ASSERT_EQ(sink_.count_errors(), 1);
    const Error &error = sink_.all()[0].what;
    EXPECT_EQ(error.place.line, 3);
    EXPECT_NE(error.hint.find("[JOINT_0]MAX_LIMIT"), std::string::npos) << error.hint;
}

TEST_F(ProgramCheck, LimitsOfJointsAreNoneOfAxesWhereKinematicsAreBetween) {
    ASSERT_NE(config_, nullptr);
    const auto number = static_cast<std::uint16_t>(motion::Parameter::JOINT_MAX_LIMIT);
    config_->machine.parameters.push_back({number, 0, 30});
    config_->machine.isTrivial = false;
    check("G21 G90 G17\nG0 X31\nM2\n");
    EXPECT_EQ(sink_.count_errors(), 0);
}

TEST_F(ProgramCheck, WhereKinematicsAreBetweenOnlyMovesThatAreBeyondFromAnywhereAreTold) {
    ASSERT_NE(config_, nullptr);
    config_->machine.isTrivial = false;
    check("G21 G90 G17\nG92 X200\nG0 X-10\nG92.1\nG0 X9999\nM2\n");
    ASSERT_EQ(sink_.count_errors(), 1) << "the position of X-10 is unknown";
    EXPECT_EQ(sink_.all()[0].what.place.line, 5);
    config_->machine.isTrivial = true;
    check("G21 G90 G17\nG92 X400\nG0 X-10\nG92.1\nM2\n");
    EXPECT_EQ(sink_.count_errors(), 2) << "here X0 is home";
}

TEST_F(ProgramCheck, ThreadsAndTapsAreTakenWhetherJointsAreAxesOrNot) {
    ASSERT_NE(config_, nullptr);
    check("G21 G90 G17 S100 M3\nG0 X10 Y10\nG33 Z-5 K1\nG0 Z0\nG33.1 Z-5 K1\nM2\n");
    config_->machine.isTrivial = false;
    check("G21 G90 G17 S100 M3\nG0 X10 Y10\nG33 Z-5 K1\nG0 Z0\nG33.1 Z-5 K1\nM2\n");
    EXPECT_EQ(sink_.count_errors(), 0);
}

TEST_F(ProgramCheck, WhatBoundsALongMoveIsWhatBoundsMostOfIt) {
    ASSERT_NE(config_, nullptr);
    const gcode::CheckResult result = check("G21 G90 G17 G61\nG1 X-200 F60000\nX200\nX199.9\nM2\n");
    ASSERT_EQ(sink_.count_errors(), 0);
    ASSERT_TRUE(result.time.has_value());
    ASSERT_FALSE(result.time->slowest.empty());
    const gcode::SlowPlace &worst = result.time->slowest.front();
    EXPECT_EQ(worst.line, 3);
    EXPECT_NE(worst.limit.find("velocity"), std::string::npos) << worst.limit;
    const gcode::SlowPlace &last = result.time->slowest.back();
    EXPECT_EQ(last.line, 4);
    EXPECT_NE(last.limit.find("acceleration"), std::string::npos) << last.limit;
}

/// The time of one move from 0.
class MoveTime {
  public:
    explicit MoveTime(const MachineConfig &machine) : estimate_(timed_machine(machine)) {
        estimate_.start({});
    }
    double line(double x, double feed) {
        geometry::Pose end;
        end[0] = x;
        estimate_.line(end, settings(feed));
        return finish();
    }
    double circles(double radius, double turns, double feed) {
        gcode::ArcMove arc;
        arc.centre[0] = radius;
        arc.normal[2] = 1;
        arc.angle_rad = 2 * std::numbers::pi * turns;
        arc.end[0] = radius * (1 - std::cos(arc.angle_rad));
        arc.end[1] = -radius * std::sin(arc.angle_rad);
        arc.settings = settings(feed);
        estimate_.arc(arc);
        return finish();
    }

  private:
    static geometry::MoveSettings settings(double feed) {
        geometry::MoveSettings out;
        out.feed = feed;
        out.isRapid = feed == 0;
        return out;
    }
    double finish() {
        const gcode::TimeFigures &figures = estimate_.finish();
        EXPECT_TRUE(figures.isComplete);
        return figures.total_s;
    }
    gcode::TimeEstimate estimate_;
};

TEST_F(ProgramCheck, TheEstimateOfAnyMoveEndsAndIsItsLengthOverItsSpeed) {
    ASSERT_NE(config_, nullptr);
    const MachineConfig &machine = config_->machine;
    const auto isNear = [](double seconds, double expected) {
        return std::fabs(seconds - expected) < 0.01 * expected;
    };
    for (const double seconds : {40.0, 59.0, 61.0, 1e3, 1e6, 1e12, 1e18}) {
        SCOPED_TRACE(seconds);
        EXPECT_TRUE(isNear(MoveTime(machine).line(10 * seconds, 10), seconds)) << "long";
        EXPECT_TRUE(isNear(MoveTime(machine).line(1, 1 / seconds), seconds)) << "slow";
        EXPECT_TRUE(isNear(MoveTime(machine).circles(1e3 * seconds, 0.01, 20 * std::numbers::pi), seconds))
            << "wide";
        EXPECT_TRUE(isNear(MoveTime(machine).circles(1, seconds, 2 * std::numbers::pi), seconds)) << "turns";
    }
    const double driven = MoveTime(machine).line(5000, 0);
    EXPECT_LT(driven, trajectory::Estimator::DRIVEN_S);
    EXPECT_TRUE(isNear(MoveTime(machine).line(5e9, 0), driven * 1e6)) << driven;
    EXPECT_TRUE(isNear(MoveTime(machine).line(5e9, 1e6), driven * 1e6)) << "the machine's speed";
}

TEST_F(ProgramCheck, TheTimeKnowsThatACutThatWaitsForTheSpindleBeginsAtRest) {
    ASSERT_NE(config_, nullptr);
    const auto seconds = [&](const std::string &spindle) {
        const gcode::CheckResult result =
            check("G21 G90 G17 G64 P0.05\n" + spindle + "G0 X-100\nG1 X-200 F60000\nM2\n");
        EXPECT_EQ(sink_.count_errors(), 0);
        return result.time ? result.time->total_s : 0.0;
    };
    const double blended_s = seconds("");
    const double from_rest_s = seconds("S500 M3\n");
    EXPECT_GT(from_rest_s, blended_s * 1.05);
    EXPECT_EQ(seconds("S500 M3\nM5\n"), blended_s);
    EXPECT_GT(seconds("S500 M3\nM5\nM3\n"), blended_s * 1.05);
}

}  // namespace
}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// Tests errors that are rejected before the start, and warnings (D1).
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "machine/config/ini_parameters.hh"
#include "machine/config/loaded_config.hh"
#include "machine/tools/tool_data.hh"
#include "programs/run/start_check.hh"

namespace mw::programs {
namespace {

class StartCheckTest : public testing::Test {
  protected:
    StartCheckTest() {
        folder_ = std::filesystem::temp_directory_path() / ("mw_start_" + std::to_string(::getpid()));
        std::filesystem::create_directory(folder_);
        loaded_ = machine::LoadedConfig::load(MW_SOURCE_DIR "/configs/sim/mill_mm.ini", sink_);
        loaded_->machine.task.parameter_file.clear();
    }
    ~StartCheckTest() override { std::filesystem::remove_all(folder_); }

    StartCheck check(const std::string &program, const StartCheckOptions &options = {}) {
        const std::string path = (folder_ / "p.ngc").string();
        std::ofstream(path) << program;
        auto tools = machine::read_tools(loaded_->machine, sink_);
        machine::IniParameters values(loaded_->ini, nullptr);
        sink_.clear();
        return check_before_start(loaded_->machine, path, **tools, values, sink_, options);
    }
    std::string said() const {
        std::string all;
        for (const diagnostics::Diagnostic &one : sink_.all()) {
            all += one.str() + '\n';
        }
        return all;
    }

    std::filesystem::path folder_;
    diagnostics::Sink sink_;
    std::unique_ptr<machine::LoadedConfig> loaded_;
};

TEST_F(StartCheckTest, AProgramWithoutErrorsStarts) {
    const StartCheck found = check("G21 G90 F600\nG1 X10\nM2\n");
    EXPECT_FALSE(found.isRefused) << said();
    EXPECT_TRUE(found.whole);
    ASSERT_TRUE(found.time.has_value());
    EXPECT_NEAR(found.time->total_s, 1.0, 0.05);
}

TEST_F(StartCheckTest, AnErrorFarAheadRefuses) {
    std::string program = "G21 G90 F600\n";
    for (int i = 0; i < 3000; ++i) {
        program += i % 2 == 0 ? "G1 X10\n" : "G1 X0\n";
    }
    EXPECT_TRUE(check(program + "G1 X1 X2\nM2\n").isRefused);
    EXPECT_NE(said().find("p.ngc:3002:"), std::string::npos) << said();
    EXPECT_TRUE(check(program + "G1 X1000\nM2\n").isRefused);
    EXPECT_NE(said().find("outside the upper limit"), std::string::npos) << said();
}

TEST_F(StartCheckTest, WhatDependsOnTheMachineIsSaidNotRefused) {
    for (const char *unknown : {"M66 P0 L0", "G38.3 Z-1", "#1=#<_hal[spindle.0.at-speed]>"}) {
        const StartCheck found = check("G21 G90 F600\n" + std::string(unknown) + "\nG1 X1000\nM2\n");
        EXPECT_FALSE(found.isRefused) << unknown << '\n' << said();
        EXPECT_NE(said().find("p.ngc:2"), std::string::npos) << unknown << '\n' << said();
        EXPECT_NE(said().find("warning: "), std::string::npos) << unknown << '\n' << said();
        EXPECT_TRUE(check("G21 G90 F600\nG1 X1000\n" + std::string(unknown) + "\nM2\n").isRefused) << unknown;
    }
}

TEST_F(StartCheckTest, PythonIsNotRun) {
    std::ofstream(folder_ / "top.py") << "raise SystemExit('this must not run')\n";
    loaded_->machine.task.interpreter.scripts.top_level = (folder_ / "top.py").string();
    EXPECT_FALSE(check("G21 G90 F600\n;py,raise ValueError\nG1 X1000\nM2\n").isRefused) << said();
    EXPECT_NE(said().find("Python"), std::string::npos) << said();
    EXPECT_FALSE(check("G21 G90 F600\nG1 X#<_of_python>\nM2\n").isRefused) << said();
    EXPECT_TRUE(check("G21 G90 F600\nG1 X1000\nM2\n").isRefused) << said();
}

TEST_F(StartCheckTest, UserCodesAreNotRun) {
    const std::filesystem::path code = folder_ / "M101";
    std::ofstream(code) << "#!/bin/sh\ntouch " << (folder_ / "ran").string() << "\n";
    std::filesystem::permissions(code, std::filesystem::perms::owner_all);
    loaded_->machine.task.interpreter.user_m_path = {folder_.string()};
    EXPECT_FALSE(check("M101\nM2\n").isRefused) << said();
    EXPECT_FALSE(std::filesystem::exists(folder_ / "ran"));
    EXPECT_TRUE(check("M102\nM2\n").isRefused);
}

TEST_F(StartCheckTest, ProgramsWithoutEndAreReadUpToTheLimit) {
    StartCheckOptions options;
    options.most_seconds = 1000;  // the other limit
    options.most_blocks = 20000;
    const StartCheck found = check("G21 G90 F600\no1 while [1]\nG1 X10\nG1 X0\no1 endwhile\nM2\n", options);
    EXPECT_FALSE(found.isRefused) << said();
    EXPECT_FALSE(found.whole);
    EXPECT_GE(found.blocks, options.most_blocks);
    EXPECT_LT(found.blocks, options.most_blocks + 10000);
}

TEST_F(StartCheckTest, BlockDeleteIsAsTheRunHasIt) {
    EXPECT_FALSE(check("G21 G90 F600\n/G1 X1000\nM2\n").isRefused);
    StartCheckOptions off;
    off.block_delete_on = false;
    EXPECT_TRUE(check("G21 G90 F600\n/G1 X1000\nM2\n", off).isRefused);
}

TEST_F(StartCheckTest, ItBeginsWhereTheMachineStandsAfterHoming) {
    for (motion::SetParameter &parameter : loaded_->machine.parameters) {
        if (parameter.parameter == static_cast<std::uint16_t>(motion::Parameter::JOINT_HOME) &&
            parameter.index == 0) {
            parameter.value = 200;
        }
    }
    EXPECT_TRUE(check("G21 G91 F600\nG1 X60\nM2\n").isRefused);
    EXPECT_FALSE(check("G21 G91 F600\nG1 X-60\nM2\n").isRefused) << said();
    // A half circle about X190, relative to the machine's start position.
    EXPECT_FALSE(check("G21 G90 G17 F600\nG2 X180 Y0 I-10 J0\nM2\n").isRefused) << said();
}

}  // namespace
}  // namespace mw::programs

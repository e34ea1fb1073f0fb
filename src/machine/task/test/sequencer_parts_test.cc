// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of the sequencer, each tested alone.
#include <unistd.h>

#include <filesystem>
#include <latch>
#include <memory>
#include <numbers>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "machine/task/sequencer/planner_mode.hh"
#include "machine/task/sequencer/program_spindles.hh"
#include "machine/task/sequencer/tool_change.hh"
#include "machine/task/sequencer/user_program.hh"
#include "machine/task/test/folder.hh"
#include "machine/task/test/tools.hh"

namespace mw::task {
namespace {

using test::Folder;
using test::text_of;

class ProgramSpindlesTest : public testing::Test {
  protected:
    /// The commands that motion has received since the last call.
    std::vector<motion::CommandBody> sent() {
        std::vector<motion::CommandBody> all;
        motion::Command command;
        while (channels->immediate.pop(command)) {
            all.push_back(command.body);
        }
        return all;
    }
    motion::SpindleOn one_on() {
        const auto all = sent();
        EXPECT_EQ(all.size(), 1U);
        const auto *on = all.size() == 1 ? std::get_if<motion::SpindleOn>(&all[0]) : nullptr;
        EXPECT_NE(on, nullptr);
        return on != nullptr ? *on : motion::SpindleOn{};
    }

    std::unique_ptr<motion::Channels> channels = std::make_unique_for_overwrite<motion::Channels>();
    MotionLink link{*channels};
    ProgramSpindles spindles;
};

TEST_F(ProgramSpindlesTest, StartWithTheSpeedThatWasSetAndFollowANewOne) {
    spindles.set_speed({0, 1000, 0}, link);
    EXPECT_TRUE(sent().empty()) << "S alone turns nothing";
    spindles.start({0, false, true}, link);
    const motion::SpindleOn on = one_on();
    EXPECT_EQ(on.speed_rpm, -1000);
    EXPECT_TRUE(on.isWaitingForSpeed);
    EXPECT_TRUE(spindles.isNextCutWaiting());
    EXPECT_EQ(spindles.direction(0), -1);
    spindles.set_speed({0, 1000, 0}, link);
    EXPECT_TRUE(sent().empty()) << "the same speed again";
    spindles.set_speed({0, 1500, 0}, link);
    EXPECT_EQ(one_on().speed_rpm, -1500);
    spindles.end_wait();
    EXPECT_FALSE(spindles.isNextCutWaiting());
    spindles.stop({0}, link);
    ASSERT_EQ(sent().size(), 1U);
    spindles.set_speed({0, 700, 0}, link);
    EXPECT_TRUE(sent().empty()) << "it is stopped";
    EXPECT_EQ(spindles.speed(0), 700);
}

/// A move that waits for the spindle begins from standstill. After G97 S300 and M5 such a stop in a corner
/// would be unnecessary.
TEST_F(ProgramSpindlesTest, NobodyWaitsForOneThatWasStopped) {
    spindles.set_speed({0, 300, 0}, link);
    spindles.start({0, true, true}, link);
    spindles.stop({0}, link);
    EXPECT_FALSE(spindles.isNextCutWaiting());
    spindles.command(0, 500, true, link);
    EXPECT_TRUE(spindles.isNextCutWaiting());
    spindles.command(0, 0, true, link);
    EXPECT_FALSE(spindles.isNextCutWaiting());
}

TEST_F(ProgramSpindlesTest, EachIsWaitedForWhateverOthersAreTold) {
    spindles.command(0, 500, true, link);
    spindles.command(1, 800, false, link);
    EXPECT_TRUE(spindles.isNextCutWaiting());
    spindles.stop({1}, link);
    EXPECT_TRUE(spindles.isNextCutWaiting());
    spindles.stop({0}, link);
    EXPECT_FALSE(spindles.isNextCutWaiting());
}

TEST_F(ProgramSpindlesTest, WithConstantSurfaceSpeedFollowTheirCentreLine) {
    constexpr double EXACT = 1e-9;
    spindles.set_mode({0, 3000});
    spindles.set_speed({0, 200, 1000}, link);
    spindles.start({0, true, true}, link);
    const motion::SpindleOn on = one_on();
    EXPECT_EQ(on.css_max_rpm, 3000);
    EXPECT_EQ(on.speed_rpm, 3000) << "at the centre line";
    EXPECT_NEAR(on.css_factor, 200 * 1000 / (2 * std::numbers::pi), EXACT);
    EXPECT_EQ(on.css_x_offset, 0);
    gcode::UseOffsets offsets;
    offsets.g5x[geometry::AXIS_X] = 40;
    spindles.use(offsets, link);
    EXPECT_NEAR(one_on().css_x_offset, 40, EXACT);
    gcode::UseToolOffset tool;
    tool.offset[geometry::AXIS_X] = 2.5;
    spindles.use(tool, link);
    EXPECT_NEAR(one_on().css_x_offset, 42.5, EXACT);
    spindles.use(tool, link);
    EXPECT_TRUE(sent().empty()) << "nothing has moved";
}

TEST_F(ProgramSpindlesTest, TheOperatorsSpeedIsAtOnceAndZeroStops) {
    spindles.command(1, -800, false, link);
    const motion::SpindleOn on = one_on();
    EXPECT_EQ(on.spindle, 1);
    EXPECT_EQ(on.speed_rpm, -800);
    EXPECT_FALSE(spindles.isNextCutWaiting());
    spindles.command(1, 0, false, link);
    const auto off = sent();
    ASSERT_EQ(off.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<motion::SpindleOff>(off[0]));
    EXPECT_EQ(spindles.speed(1), 800) << "M3 without S takes it up again";
}

class ToolChangeTest : public testing::Test {
  protected:
    /// The changer answers its requests until it is idle; returns the events.
    Result<> work() {
        Result<> result;
        for (int i = 0; i < 10 && result.has_value() && io.action() != io::ToolAction::IDLE; ++i) {
            io::Inputs in;
            in.tool_prepared = io.outputs.tool_prepare;
            in.tool_changed = io.outputs.tool_change;
            in.toolchanger_fault = isFaulted;
            in.toolchanger_reason = 17;
            result = change.on_event(io.step(in), tools, io);
        }
        return result;
    }
    test::OneTool tools;
    io::DiscreteIo io;
    ToolChange change;
    bool isFaulted = false;
};

TEST_F(ToolChangeTest, PreparesThenBringsTheToolIntoTheSpindle) {
    ASSERT_TRUE(change.select({5}, tools, io).has_value());
    EXPECT_EQ(io.outputs.tool_prep_pocket, 3);
    EXPECT_EQ(change.selected_index(tools), 1);
    ASSERT_TRUE(work().has_value());
    EXPECT_EQ(tools.in_spindle, 0) << "only made ready";
    EXPECT_TRUE(change.start(tools, io));
    ASSERT_TRUE(work().has_value());
    EXPECT_EQ(tools.in_spindle, 5);
    EXPECT_EQ(io.outputs.tool_number, 5);
    EXPECT_EQ(io.outputs.tool_from_pocket, 3);
    EXPECT_FALSE(change.isSelected());
}

TEST_F(ToolChangeTest, AToolThatIsNotInTheTableIsRefused) {
    const auto selected = change.select({9}, tools, io);
    ASSERT_FALSE(selected.has_value());
    EXPECT_EQ(selected.error().message, "tool 9 is not in the tool table");
    EXPECT_EQ(io.action(), io::ToolAction::IDLE);
    EXPECT_FALSE(change.isSelected());
}

TEST_F(ToolChangeTest, AFaultOfTheChangerIsToldWithItsReasonUntilItWorksAgain) {
    ASSERT_TRUE(change.select({5}, tools, io).has_value());
    ASSERT_TRUE(work().has_value());
    isFaulted = true;
    EXPECT_TRUE(change.start(tools, io));
    const auto failed = work();
    ASSERT_FALSE(failed.has_value());
    EXPECT_NE(failed.error().message.find("toolchanger-reason 17"), std::string::npos);
    EXPECT_EQ(change.fault_reason(), 17);
    EXPECT_EQ(tools.in_spindle, 0);
    change.abort(io);
    io.abort(8);
    isFaulted = false;
    EXPECT_EQ(change.fault_reason(), 17) << "an abort does not repair the changer";
    ASSERT_TRUE(change.select({5}, tools, io).has_value());
    ASSERT_TRUE(work().has_value());
    EXPECT_FALSE(change.fault_reason().has_value());
}

TEST_F(ToolChangeTest, TheToolThatIsInIsNotChangedForItself) {
    tools.in_spindle = 5;
    ASSERT_TRUE(change.select({5}, tools, io).has_value());
    ASSERT_TRUE(work().has_value());
    EXPECT_FALSE(change.start(tools, io));
    EXPECT_EQ(io.action(), io::ToolAction::IDLE);
    EXPECT_TRUE(change.isSelected()) << "it is still the one that was asked for";
}

TEST_F(ToolChangeTest, AnAbortKeepsAToolThatIsReadyAndForgetsOneOnItsWay) {
    ASSERT_TRUE(change.select({5}, tools, io).has_value());
    change.abort(io);
    EXPECT_FALSE(change.isSelected()) << "it is unknown which tool the changer has prepared";
    io.abort(8);
    ASSERT_TRUE(change.select({5}, tools, io).has_value());
    ASSERT_TRUE(work().has_value());
    change.abort(io);
    EXPECT_TRUE(change.isSelected());
    EXPECT_TRUE(change.start(tools, io));
    change.abort(io);
    io.abort(8);
    EXPECT_FALSE(change.isSelected());
    ASSERT_TRUE(work().has_value());
    EXPECT_EQ(tools.in_spindle, 0);
}

TEST_F(ToolChangeTest, AChangeClearsWhatWasPrepared) {
    ASSERT_TRUE(change.select({5}, tools, io).has_value());
    ASSERT_TRUE(work().has_value());
    EXPECT_EQ(io.outputs.tool_prep_number, 5);
    EXPECT_TRUE(change.start(tools, io));
    ASSERT_TRUE(work().has_value());
    EXPECT_EQ(io.outputs.tool_prep_number, 0);
    EXPECT_EQ(io.outputs.tool_prep_pocket, 0);
    EXPECT_EQ(io.outputs.tool_prep_index, 0);
}

TEST_F(ToolChangeTest, AReasonBelowZeroIsToldInTheWordsOfTheIniFile) {
    ToolChange worded("Changer says %d!");
    io.start_change();
    io::Inputs in;
    in.toolchanger_fault = true;
    in.toolchanger_reason = -2;
    const auto told = worded.on_event(io.step(in), tools, io);
    ASSERT_FALSE(told.has_value());
    EXPECT_EQ(told.error().message, "Changer says -2!");
}

TEST_F(ToolChangeTest, M61NamesTheToolWithoutAChange) {
    ASSERT_TRUE(change.set_number({5}, tools, io).has_value());
    EXPECT_EQ(tools.in_spindle, 5);
    EXPECT_EQ(io.outputs.tool_number, 5);
    EXPECT_EQ(io.action(), io::ToolAction::IDLE);
    ASSERT_TRUE(change.set_number({0}, tools, io).has_value());
    EXPECT_EQ(tools.in_spindle, 0);
}

UserProgram::Find path_of(const std::string &path) {
    return [path] { return Result<std::string>(path); };
}

TEST(UserProgram, TellsHowItEnded) {
    const Folder folder;
    UserProgram program(UserProgram::Waits::IN_CALL);
    program.start("M101", path_of(folder.program("good", "echo \"$1 $2\" > \"${0%/*}/said\"\n")), 2.5, -1);
    EXPECT_FALSE(program.isRunning());
    EXPECT_TRUE(program.take_result().has_value());
    EXPECT_EQ(text_of(folder / "said"), "2.500000 -1.000000\n");
    program.start("M101", path_of(folder.program("bad", "exit 3\n")), -1, -1);
    EXPECT_FALSE(program.isRunning());
    EXPECT_NE(program.take_result().error().message.find("ended with status 3"), std::string::npos);
    EXPECT_TRUE(program.take_result().has_value()) << "once";
    program.start("M101", path_of(folder.program("shot", "kill -9 $$\n")), -1, -1);
    EXPECT_FALSE(program.isRunning());
    EXPECT_NE(program.take_result().error().message.find("ended by signal 9"), std::string::npos);
    program.start("M101", path_of(folder / "none"), 1, 2);
    EXPECT_FALSE(program.isRunning());
    EXPECT_NE(program.take_result().error().message.find("cannot start user M code"), std::string::npos);
    program.start("M101", [] { return Result<std::string>(fail("its program no longer exists")); }, 1, 2);
    EXPECT_FALSE(program.isRunning());
    EXPECT_EQ(program.take_result().error().message, "its program no longer exists");
}

TEST(UserProgram, IsEndedWithAllThatItStarted) {
    const Folder folder;
    const std::string path = folder.program("long", "sleep 1000 & echo $! > \"${0%/*}/child\"; sleep 1000\n");
    UserProgram program(UserProgram::Waits::NEVER);
    program.start("M101", path_of(path), 1, 2);
    while (text_of(folder / "child").find('\n') == std::string::npos) {  // otherwise this test times out
        ASSERT_TRUE(program.isRunning());
    }
    program.stop();
    EXPECT_FALSE(program.isRunning());
    const std::string process = "/proc/" + std::to_string(std::stoi(text_of(folder / "child"))) + "/cmdline";
    while (text_of(process).find("sleep") != std::string::npos) {
        std::this_thread::yield();
    }
}

/// A search that waits until the test releases it.
struct HungLookUp {
    std::latch isCalled{1}, isReleased{1};
};

UserProgram::Find find_hung(const std::shared_ptr<HungLookUp> &hung, const std::string &path) {
    return [hung, path] {
        hung->isCalled.count_down();
        hung->isReleased.wait();
        return Result<std::string>(path);
    };
}

TEST(UserProgram, ADiskThatDoesNotAnswerHoldsUpNobody) {
    const Folder folder;
    const auto hung = std::make_shared<HungLookUp>();
    UserProgram program(UserProgram::Waits::NEVER);
    program.start("M101", find_hung(hung, folder.program("code", "echo run > \"${0%/*}/said\"\n")), 1, 2);
    hung->isCalled.wait();
    EXPECT_TRUE(program.isRunning());
    EXPECT_EQ(program.take_delay(5), std::nullopt);
    EXPECT_EQ(program.take_delay(999999999), std::nullopt);
    EXPECT_EQ(program.take_delay(1000000005), "the disk of M101 has not answered for 1 s");
    EXPECT_EQ(program.take_delay(3000000000), std::nullopt) << "it is reported once";
    hung->isReleased.count_down();
    while (program.isRunning()) {
        std::this_thread::yield();
    }
    EXPECT_TRUE(program.take_result().has_value());
    EXPECT_EQ(text_of(folder / "said"), "run\n");
}

TEST(UserProgram, AStopBeforeTheDiskAnswersIsFollowedByNoStart) {
    const Folder folder;
    auto hung = std::make_shared<HungLookUp>();
    {
        UserProgram program(UserProgram::Waits::NEVER);
        program.start("M101", find_hung(hung, folder.program("code", "echo run > \"${0%/*}/said\"\n")), 1, 2);
        hung->isCalled.wait();
        program.stop();
        EXPECT_FALSE(program.isRunning());
        EXPECT_TRUE(program.take_result().has_value());
        program.start("M102", path_of(folder.program("next", "exit 0\n")), 1, 2);
        while (program.isRunning()) {
            std::this_thread::yield();
        }
        EXPECT_TRUE(program.take_result().has_value()) << "the next one runs meanwhile";
    }
    hung->isReleased.count_down();
    const std::weak_ptr<HungLookUp> thread = std::exchange(hung, nullptr);
    while (!thread.expired()) {  // otherwise this test times out
        std::this_thread::yield();
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "said"));
}

class PlannerModeTest : public testing::Test {
  protected:
    static motion::SetParameter parameter(motion::Parameter which, double value) {
        return {static_cast<std::uint16_t>(which), 0, value};
    }
    std::vector<double> sent;
    std::vector<std::string> posted;
    PlannerMode mode{{[this](const motion::SetParameter &p) {
                          sent.push_back(p.value);
                          return motion::CommandId{40 + sent.size()};
                      },
                      [this](MessageKind, const std::string &text) { posted.push_back(text); }}};
};

TEST_F(PlannerModeTest, AProgramChangesItAtRestAndTheSameTypeChangesNothing) {
    mode.configure({parameter(motion::Parameter::TRAJ_MAX_JERK, 1e5)});
    EXPECT_EQ(mode.set(0), 0U);
    EXPECT_EQ(mode.set(1), 41U);
    EXPECT_EQ(mode.type(), 1);
    EXPECT_EQ(mode.set(1), 0U);
    EXPECT_EQ(sent, std::vector<double>{1});
    EXPECT_TRUE(posted.empty());
}

TEST_F(PlannerModeTest, AWishWaitsUntilAllIsIdleAndIsToldOnce) {
    mode.configure({parameter(motion::Parameter::TRAJ_MAX_JERK, 1e5)});
    mode.wish(1);
    mode.step(false);
    mode.step(false);
    EXPECT_TRUE(sent.empty());
    EXPECT_EQ(posted.size(), 1U);
    mode.step(true);
    EXPECT_EQ(sent, std::vector<double>{1});
    mode.wish(7);
    mode.step(true);
    EXPECT_EQ(mode.type(), 1);
    EXPECT_NE(posted.back().find("0 (trapezoidal) or 1 (jerk-limited) expected"), std::string::npos);
}

TEST_F(PlannerModeTest, SaysThatTheJerkLimitedPlannerNeedsLimits) {
    mode.configure({parameter(motion::Parameter::TRAJ_PLANNER_TYPE, 1)});
    mode.announce();
    ASSERT_EQ(posted.size(), 1U);
    EXPECT_NE(posted[0].find("MAX_LINEAR_JERK"), std::string::npos);
}

TEST_F(PlannerModeTest, TheCornerScaleStaysWithinItsRange) {
    mode.set_corner_scale(0.01);
    mode.set_corner_scale(7);
    mode.set_corner_scale(std::nan(""));
    EXPECT_EQ(sent, (std::vector<double>{0.1, 1}));
    EXPECT_EQ(mode.corner_scale(), 1);
}

TEST_F(PlannerModeTest, SaysOnceWhatIsWrongWithTheCornerScaleAndWhatIsInForce) {
    mode.set_corner_scale(0.5);
    EXPECT_TRUE(posted.empty()) << "a good value is no message";
    for (int cycle = 0; cycle < 100; ++cycle) {
        mode.set_corner_scale(std::nan(""));
    }
    ASSERT_EQ(posted.size(), 1U);
    EXPECT_EQ(posted[0], "ini.traj-scurve-peak-scale is nan: a number from 0.1 to 1 expected; 0.5 is used");
    for (int cycle = 0; cycle < 100; ++cycle) {
        mode.set_corner_scale(7 + cycle);  // a signal whose value changes
    }
    ASSERT_EQ(posted.size(), 2U);
    EXPECT_EQ(posted[1], "ini.traj-scurve-peak-scale is 7: a number from 0.1 to 1 expected; 1 is used");
    mode.set_corner_scale(-2);
    ASSERT_EQ(posted.size(), 3U) << "another value is active now";
    EXPECT_EQ(posted[2], "ini.traj-scurve-peak-scale is -2: a number from 0.1 to 1 expected; 0.1 is used");
    mode.set_corner_scale(0.1);
    mode.set_corner_scale(1);
    EXPECT_EQ(posted.size(), 3U) << "the ends of the range belong to it";
    mode.set_corner_scale(7);
    EXPECT_EQ(posted.size(), 4U) << "wrong again, reported again";
}

}  // namespace
}  // namespace mw::task

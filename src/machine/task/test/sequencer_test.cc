// SPDX-License-Identifier: GPL-2.0-or-later
// The sequencer alone, with a queue, the channels of motion and the I/O controller.
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "machine/task/sequencer/sequencer.hh"
#include "machine/task/test/hung_disk.hh"
#include "machine/task/test/tools.hh"

namespace mw::task {
namespace {

constexpr std::int64_t MS = 1000000, S = 1000 * MS;

class SequencerTest : public testing::Test {
  protected:
    void add(const gcode::MachineCall &call, std::uint32_t block = 1) {
        motion::SourceTag tag{};
        tag.line = static_cast<int>(block);
        tag.block = block;
        queue.push_back({tag, call, block});
    }
    void add_line(double x, std::uint32_t block = 1) {
        gcode::LineMove line;
        line.end[geometry::AXIS_X] = x;
        add(line, block);
    }
    /// Runs a task cycle. Motion answers its commands, and moves only if permitted.
    void cycle(bool moving = true) {
        now_ns += MS;
        motion::Command command;
        while (channels->immediate.pop(command)) {
            told.emplace_back(command.body);
            status.last_immediate_id = command.id;
            channels->servo_answers.push({command.id});
        }
        motion::PathCommand move;
        while (moving && channels->path.pop(move)) {
            moves += std::holds_alternative<motion::Line>(move.body) ? 1 : 0;
            motion::Answer answer{move.id, motion::AnswerKind::DONE};
            answer.isPath = true;
            channels->planner_answers.push(answer);
        }
        ++status.cycle;
        channels->status.write(status);
        link.update();
        sequencer.step(now_ns);
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) {
            cycle();
        }
    }
    template <class Body>
    int count() const {
        return static_cast<int>(std::count_if(
            told.begin(), told.end(), [](const auto &body) { return std::holds_alternative<Body>(body); }));
    }
    SequencerEvents events() {
        SequencerEvents e;
        e.message = [this](MessageKind, const std::string &text) { texts.push_back(text); };
        e.print = [this](const std::string &text) { texts.push_back(text); };
        e.stop = [this](const gcode::ProgramStop &, int line) {
            stop_line = line;
            return isStopping;
        };
        e.end = [this] { ++ends; };
        e.fail = [this](const std::string &text) { failures.push_back(text); };
        e.offsets = [](const gcode::UseOffsets &) {};
        e.tool_offset = [this](const gcode::UseToolOffset &item) {
            io.set_tool_offset(item.offset);
            return link.send(motion::SetToolOffset{item.offset});
        };
        e.planner_mode = [](const gcode::UsePlanner &) -> std::optional<motion::CommandId> { return 0; };
        e.start_user_code = [this](const gcode::UserCode &) {
            ++user_codes;
            user_code = std::nullopt;
        };
        e.user_code_result = [this] { return user_code; };
        return e;
    }

    std::unique_ptr<motion::Channels> channels = std::make_unique_for_overwrite<motion::Channels>();
    motion::Status status{};
    MotionLink link{*channels};
    ItemQueue queue;
    io::DiscreteIo io;
    test::OneTool tools;
    std::shared_ptr<test::HungDisk> disk = std::make_shared<test::HungDisk>();
    Sequencer sequencer{queue, link, io, tools, events(), {.log_works = LogWorks::ALONE, .log_disk = disk}};
    std::vector<motion::CommandBody> told;
    std::vector<std::string> texts, failures;
    std::optional<Result<>> user_code;
    int moves = 0, ends = 0, stop_line = 0, user_codes = 0;
    bool isStopping = true;
    std::int64_t now_ns = 0;
};

TEST_F(SequencerTest, MovesGoOnAtOnceAndASpindleWaitsUntilTheyAreDone) {
    add_line(1);
    add_line(2);
    add(gcode::StartSpindle{});
    add_line(3);
    cycle();
    EXPECT_EQ(queue.size(), 2U) << "the spindle is at the front";
    cycle(false);
    cycle(false);
    EXPECT_EQ(count<motion::SpindleOn>(), 0);
    cycles(4);
    EXPECT_EQ(moves, 3);
    EXPECT_EQ(count<motion::SpindleOn>(), 1);
    cycle();
    EXPECT_TRUE(sequencer.isIdle());
    EXPECT_TRUE(failures.empty());
}

/// Kinematics may read the pins, so no move begins with the pins of the previous block.
TEST_F(SequencerTest, AMoveBehindAToolOffsetWaitsUntilThePinsShowIt) {
    add_line(1);
    add(gcode::UseToolOffset{{{0, 0, 5}}});
    add_line(2);
    cycle();
    cycle(false);
    EXPECT_EQ(io.outputs.tool_offset.z(), 0) << "the move before it is not done";
    cycles(2);
    EXPECT_EQ(io.outputs.tool_offset.z(), 5);
    io::Inputs inputs;
    inputs.tool_offset_shown = false;
    for (int i = 0; i < 5; ++i) {
        io.step(inputs);
        cycle();
        EXPECT_EQ(sequencer.waiting_for().what, WaitFor::SETTING);
    }
    EXPECT_EQ(moves, 1);
    inputs.tool_offset_shown = true;
    io.step(inputs);
    cycles(2);
    EXPECT_EQ(moves, 2);
}

TEST_F(SequencerTest, ADwellLastsItsTimeAndIsToldAsWhatIsWaitedFor) {
    add(gcode::Dwell{0.25});
    add_line(1);
    cycle();
    const std::int64_t begin_ns = now_ns;
    EXPECT_EQ(sequencer.waiting_for().what, WaitFor::DWELL);
    while (!queue.empty() && now_ns < 2 * S) {
        cycle();
    }
    EXPECT_EQ(now_ns - begin_ns, 250 * MS);
}

TEST_F(SequencerTest, AnInputIsWaitedForUntilItRisesOrItsTimeIsOver) {
    gcode::WaitInput rise;
    rise.index = 3;
    rise.kind = gcode::WaitKind::RISE;
    rise.timeout_s = 1;
    add(rise);
    cycles(5);
    EXPECT_EQ(sequencer.waiting_for().what, WaitFor::DIGITAL_INPUT);
    EXPECT_EQ(sequencer.waiting_for().index, 3);
    status.digital_in = 1U << 3;
    cycles(2);
    EXPECT_EQ(sequencer.input().value, 1);
    EXPECT_FALSE(sequencer.input().timed_out);
    add(rise);
    cycles(1005);
    EXPECT_TRUE(sequencer.input().timed_out) << "it was high all the time";
    EXPECT_EQ(sequencer.input().value, -1);
}

TEST_F(SequencerTest, NothingBehindAStopBeginsInItsCycle) {
    add(gcode::ProgramStop{}, 4);
    add(gcode::PrintLine{"behind"}, 5);
    cycle();
    EXPECT_EQ(stop_line, 4);
    EXPECT_TRUE(texts.empty());
    cycle();
    EXPECT_EQ(texts, std::vector<std::string>{"behind"}) << "its owner decides whether it continues";
}

TEST_F(SequencerTest, AStepEndsAtTheNextBlockWithMotionAtRest) {
    add_line(1, 7);
    add_line(2, 8);
    sequencer.set_stepping(true);
    cycle(false);
    EXPECT_FALSE(sequencer.isStepDone());
    cycles(3);
    EXPECT_TRUE(sequencer.isStepDone());
    EXPECT_EQ(moves, 1);
    EXPECT_EQ(queue.size(), 1U);
    sequencer.set_stepping(true);
    cycles(4);
    EXPECT_EQ(moves, 2);
}

TEST_F(SequencerTest, AToolChangeStopsTheSpindleAndIsWaitedFor) {
    status.num_spindles = 1;
    add(gcode::SelectTool{5});
    add(gcode::ChangeTool{});
    add_line(1);
    for (int i = 0; i < 20; ++i) {
        cycle();
        io::Inputs in;
        in.tool_prepared = io.outputs.tool_prepare;
        in.tool_changed = io.outputs.tool_change && i > 10;
        sequencer.on_tool_event(io.step(in));
        if (i == 9) {
            EXPECT_EQ(count<motion::SpindleOff>(), 1);
            EXPECT_EQ(moves, 0);
            EXPECT_EQ(sequencer.waiting_for().what, WaitFor::TOOL_CHANGED);
        }
    }
    EXPECT_EQ(tools.in_spindle, 5);
    EXPECT_EQ(moves, 1);
}

TEST_F(SequencerTest, AfterAFailureNothingBeginsUntilTheAbort) {
    add(gcode::SelectTool{9});
    add(gcode::PrintLine{"behind"});
    cycles(5);
    EXPECT_EQ(failures.size(), 1U);
    EXPECT_TRUE(texts.empty());
    sequencer.abort(8);
    EXPECT_TRUE(queue.empty());
    add(gcode::PrintLine{"after"});
    cycle();
    EXPECT_EQ(texts, std::vector<std::string>{"after"});
}

TEST_F(SequencerTest, AUserCodeIsWaitedForAndItsFailureTold) {
    add(gcode::UserCode{101, 1, 2});
    add_line(1);
    cycles(10);
    EXPECT_EQ(sequencer.waiting_for().what, WaitFor::USER_CODE);
    EXPECT_EQ(moves, 0);
    user_code = fail("ended with status 3");
    cycles(3);
    ASSERT_EQ(failures.size(), 1U);
    EXPECT_EQ(failures[0], "ended with status 3");
    EXPECT_EQ(moves, 0);
}

TEST_F(SequencerTest, AUserCodeBeginsWhenTheToolTableIsWritten) {
    tools.is_written = false;
    add(gcode::UserCode{101, 1, 2});
    cycles(5);
    EXPECT_EQ(user_codes, 0) << "its program may read the file";
    tools.is_written = true;
    cycle();
    EXPECT_EQ(user_codes, 1);
}

TEST_F(SequencerTest, AnAbortDropsAReadingOfTheToolTable) {
    tools.is_read = false;
    add(gcode::ReloadTools{});
    add_line(1);
    cycles(5);
    EXPECT_EQ(sequencer.waiting_for().what, WaitFor::TOOL_DATA);
    EXPECT_EQ(moves, 0);
    sequencer.abort(0);
    EXPECT_EQ(tools.reloads_dropped, 1) << "what is read later must not change the tools of another run";
    EXPECT_TRUE(sequencer.isIdle());
    sequencer.abort(0);
    EXPECT_EQ(tools.reloads_dropped, 1) << "a reading that clients have requested";
}

TEST_F(SequencerTest, TheEndOfAProgramIsToldWhenAllBeforeItIsDone) {
    add_line(1);
    add(gcode::ProgramEnd{});
    cycle(false);
    cycle(false);
    EXPECT_EQ(ends, 0);
    cycles(4);
    EXPECT_EQ(ends, 1);
    EXPECT_TRUE(sequencer.isIdle());
}

TEST_F(SequencerTest, AHungDiskOfALogHoldsUpNoCycle) {
    const std::string path = testing::TempDir() + "mw_hung_log_" + std::to_string(::getpid());
    add(gcode::OpenLog{path, false});
    add(gcode::LogLine{"one"});
    add_line(1);
    const auto begin = std::chrono::steady_clock::now();
    cycles(20);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
    EXPECT_EQ(sequencer.exec_state(), ExecState::WAITING_FOR_IO);
    EXPECT_EQ(moves, 0) << "whether the file can be written is known before the next block";
    sequencer.abort(0);
    EXPECT_TRUE(sequencer.isIdle());
    add_line(2);
    cycles(3);
    EXPECT_EQ(moves, 1) << "the machine takes the next run";
    add(gcode::OpenLog{path, false});
    add(gcode::LogLine{"two"});
    add(gcode::CloseLog{});
    disk->release();
    while (!queue.empty() || !sequencer.logs().isSettled()) {
        cycle();
    }
    EXPECT_EQ(read_file(path).value(), "two\n");
    EXPECT_TRUE(failures.empty());
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of a run, each tested alone: the run, the reader, the actions after an abort, the view of
// programs.
#include <gtest/gtest.h>

#include "gcode/interpreter/test/mill.hh"
#include "machine/task/run/machine_world.hh"
#include "machine/task/run/modal_code_history.hh"
#include "machine/task/run/on_abort.hh"
#include "machine/task/run/program_run.hh"
#include "machine/task/test/tools.hh"

namespace mw::task {
namespace {

TEST(ProgramRun, EndsItsCommandAndKeepsTheErrorUntilTheNextStart) {
    ProgramRun run;
    ASSERT_EQ(run.start(RunKind::MDI, 3, "G0 X1"), Progress::STARTED);
    EXPECT_EQ(run.line(), "G0 X1");
    EXPECT_FALSE(run.isProgram());
    EXPECT_EQ(run.start(RunKind::PROGRAM, 4).error().message, "a program or MDI line is already running");
    EXPECT_EQ(run.kind(), RunKind::MDI) << "the rejected one changes nothing";
    run.set_error({diagnostics::Severity::ERROR, {"beyond a limit"}});
    const auto ended = run.end(Progress::FAILED, "beyond a limit");
    ASSERT_TRUE(ended.has_value());
    EXPECT_EQ(ended->command, 3U);
    EXPECT_FALSE(run.isRunning());
    EXPECT_FALSE(run.end(Progress::DONE, "").has_value());
    ASSERT_NE(run.error(), nullptr);
    ASSERT_EQ(run.start(RunKind::PROGRAM, 5), Progress::STARTED);
    EXPECT_EQ(run.error(), nullptr);
    EXPECT_TRUE(run.isProgram());
}

TEST(ProgramRun, TheFirstFailureCounts) {
    ProgramRun run;
    EXPECT_FALSE(run.take_failure().has_value());
    run.note_failure("the first");
    run.note_failure("what follows from it");
    EXPECT_EQ(run.take_failure(), "the first");
    EXPECT_FALSE(run.take_failure().has_value());
    run.note_failure("of work that was aborted");
    run.forget_failure();
    EXPECT_FALSE(run.take_failure().has_value());
}

TEST(ProgramRun, IsShownAsIdleReadingWaitingOrPaused) {
    ProgramRun run;
    EXPECT_EQ(run.shown(), InterpState::IDLE);
    ASSERT_TRUE(run.start(RunKind::PROGRAM, 1).has_value());
    run.change(RunEvent::BEGUN);
    EXPECT_EQ(run.shown(), InterpState::READING);
    ASSERT_TRUE(run.take(RunEvent::PAUSE).has_value());
    EXPECT_EQ(run.shown(), InterpState::PAUSED);
    ASSERT_TRUE(run.take(RunEvent::RESUME).has_value());
    run.change(RunEvent::READ);
    EXPECT_EQ(run.shown(), InterpState::WAITING);
}

gcode::ActiveCodes with_feed(double feed, int line) {
    gcode::ActiveCodes codes;
    codes.g[0] = line;
    codes.settings[1] = feed;
    return codes;
}

TEST(ModalCodeHistory, TellsWhatHoldsInTheBlockUnderWay) {
    ModalCodeHistory trail;
    EXPECT_TRUE(trail.isEmpty());
    trail.note(0, with_feed(100, 0));
    trail.note(3, with_feed(100, 3));
    trail.note(4, with_feed(200, 4));
    trail.note(4, with_feed(300, 4));  // the block waits for the machine and is noted again
    trail.note(7, with_feed(400, 9));
    EXPECT_EQ(trail.at(0, 1).settings[1], 100);
    EXPECT_EQ(trail.at(3, 3).settings[1], 100);
    EXPECT_EQ(trail.at(4, 4).settings[1], 200);
    EXPECT_EQ(trail.at(6, 6).settings[1], 200);
    EXPECT_EQ(trail.at(9, 8).settings[1], 400);
    EXPECT_EQ(trail.at(9, 8).g[0], 8) << "the number is that of the line under way";
    EXPECT_EQ(trail.at(3, 3).settings[1], 100) << "a path can be gone back along";
    trail.clear();
    EXPECT_TRUE(trail.isEmpty());
}

/// A reader on a mill in memory.
class ReaderTest : public testing::Test {
  protected:
    ReaderTest() {
        EXPECT_TRUE(reader.load().has_value());
        reader.synch({});
        EXPECT_TRUE(reader.interpreter().begin().has_value());
        reader.queue().clear();
    }
    template <class Call>
    int count() {
        return static_cast<int>(
            std::count_if(reader.queue().begin(), reader.queue().end(),
                          [](const Item &item) { return std::holds_alternative<Call>(item.call); }));
    }
    gcode::test::Mill mill;
    ProgramReader reader{{mill, mill, mill}, {}};
};

TEST_F(ReaderTest, WritesWhatALineAsksForIntoItsQueueInOrder) {
    EXPECT_EQ(reader.interpreter().execute("G21 F600 G1 X3 M3 S100"), gcode::Step::FILE_END);
    EXPECT_EQ(count<gcode::LineMove>(), 1);
    EXPECT_EQ(count<gcode::StartSpindle>(), 1);
    const auto &items = reader.queue();
    EXPECT_TRUE(std::holds_alternative<gcode::LineMove>(items.back().call)) << "M3 before the move";
    EXPECT_EQ(std::get<gcode::LineMove>(items.back().call).end.x(), 3);
    EXPECT_EQ(items.back().source.block, reader.canon().blocks());
}

TEST_F(ReaderTest, BeginsWhereTheMachineStands) {
    mill.state.position = geometry::Pose{};
    mill.state.position[geometry::AXIS_Y] = 7;
    reader.synch(mill.state.position);
    EXPECT_EQ(reader.interpreter().execute("G21 G0 X1"), gcode::Step::FILE_END);
    ASSERT_EQ(count<gcode::LineMove>(), 1);
    EXPECT_EQ(std::get<gcode::LineMove>(reader.queue().back().call).end.y(), 7);
}

TEST_F(ReaderTest, AnAbortReturnsToTheExecutedBlockAndAnnouncesItsOffsets) {
    reader.begin_history();
    EXPECT_EQ(reader.execute("G21 G10 L2 P1 X5"), gcode::Step::FILE_END);
    reader.mark_executed(reader.canon().reads());
    EXPECT_EQ(reader.execute("G10 L2 P1 X7"), gcode::Step::FILE_END);
    EXPECT_EQ(reader.execute("G20 G91 F3 S100"), gcode::Step::FILE_END);
    EXPECT_EQ(reader.execute("#31=7"), gcode::Step::FILE_END);
    reader.queue().clear();
    reader.return_to_executed();
    reader.announce();
    ASSERT_GE(count<gcode::UseOffsets>(), 1);
    EXPECT_EQ(count<gcode::LineMove>(), 0);
    for (const Item &item : reader.queue()) {
        if (const auto *offsets = std::get_if<gcode::UseOffsets>(&item.call)) {
            EXPECT_EQ(offsets->g5x.x(), 5);
        }
    }
    EXPECT_EQ(reader.interpreter().parameter(31), 0);
    EXPECT_EQ(reader.interpreter().parameter(5221), 5);
    const gcode::ActiveCodes codes = reader.interpreter().active_codes();
    EXPECT_EQ(codes.g[5], 210) << "units";
    EXPECT_EQ(codes.g[6], 900) << "distance mode";
    EXPECT_EQ(codes.settings[1], 0) << "F";
    EXPECT_EQ(codes.settings[2], 0) << "S";
}

TEST_F(ReaderTest, BlocksThatAskForNothingKeepTheirPlaceInTheOrder) {
    reader.begin_history();
    EXPECT_EQ(reader.execute("#31=1"), gcode::Step::FILE_END);
    EXPECT_EQ(reader.execute("(a comment)"), gcode::Step::FILE_END);
    EXPECT_EQ(reader.execute("#31=2"), gcode::Step::FILE_END);
    ASSERT_EQ(reader.queue().size(), 2U);
    reader.mark_executed(reader.queue().front().read);
    reader.return_to_executed();
    EXPECT_EQ(reader.interpreter().parameter(31), 1);
}

TEST_F(ReaderTest, EveryStepAheadCountsSoThatReadingHasABound) {
    reader.begin_history();
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(reader.execute("(nothing to do)"), gcode::Step::FILE_END);
    }
    EXPECT_EQ(reader.count_ahead(), 10U);
    reader.mark_executed(reader.canon().reads());
    EXPECT_EQ(reader.count_ahead(), 0U);
}

TEST_F(ReaderTest, AProbeThatHasNotTrippedHasNoLine) {
    EXPECT_EQ(reader.probe_line(), "");
}

TEST_F(ReaderTest, TheOnAbortCommandIsReadAtOnceWithTheReasonAsItsArgument) {
    const OnAbort none(""), digital("M65 P0");
    EXPECT_FALSE(none.isAsked());
    EXPECT_TRUE(digital.isAsked());
    // Without its own program a reason that is not a word is reported, and nothing is queued.
    const auto read = digital.read(reader, AbortReason::ABORT);
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(count<gcode::LineMove>(), 0);
    EXPECT_EQ(digital.told("why").substr(0, 44), "[RS274NGC]ON_ABORT_COMMAND = M65 P0: why");
}

TEST(OnAbort, RemembersWhetherAnythingHasRunSince) {
    OnAbort on_abort("O<tidy> call");
    EXPECT_FALSE(on_abort.isCleanedUp());
    on_abort.note_abort();
    EXPECT_TRUE(on_abort.isCleanedUp());
    on_abort.note_work();
    EXPECT_FALSE(on_abort.isCleanedUp());
}

TEST(OnAbort, NothingThatMovesStartsOrWaitsIsAllowed) {
    EXPECT_TRUE(isForbiddenAfterAbort(gcode::LineMove{}));
    EXPECT_TRUE(isForbiddenAfterAbort(gcode::StartSpindle{}));
    EXPECT_TRUE(isForbiddenAfterAbort(gcode::SwitchMist{true}));
    EXPECT_TRUE(isForbiddenAfterAbort(gcode::WaitInput{}));
    EXPECT_FALSE(isForbiddenAfterAbort(gcode::SwitchMist{false}));
    EXPECT_FALSE(isForbiddenAfterAbort(gcode::StopSpindle{}));
    EXPECT_FALSE(isForbiddenAfterAbort(gcode::SetDigitalOutput{}));
}

TEST(MachineWorld, ShowsWhatItWasShown) {
    MachineWorld world({gcode::LengthUnits::INCH, 5, 2});
    EXPECT_EQ(world.machine_units(), gcode::LengthUnits::INCH);
    EXPECT_EQ(world.axis_mask(), 5U);
    EXPECT_EQ(world.count_spindles(), 2);
    EXPECT_TRUE(world.isOptionalStopOn());
    world.set_optional_stop(false);
    world.set_block_delete(false);
    EXPECT_FALSE(world.isOptionalStopOn());
    EXPECT_FALSE(world.isBlockDeleteOn());
    gcode::MachineSnapshot seen;
    seen.tool_in_spindle = 9;
    world.show(seen);
    EXPECT_EQ(world.snapshot().tool_in_spindle, 9);
}

}  // namespace
}  // namespace mw::task

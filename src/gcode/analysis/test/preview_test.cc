// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "gcode/analysis/preview.hh"
#include "gcode/interpreter/standalone.hh"

namespace mw::gcode {
namespace {

using namespace gcode;

/// Keeps all events of a program.
class PreviewRun : public testing::Test {
  protected:
    PreviewEnd run(const std::string &program, PreviewOptions options = {}) {
        PreviewMachine machine;
        machine.tool_change_moves = tool_change_moves;
        machine.axis_mask = axis_mask;
        preview = std::make_unique<Preview>(
            machine, world, world, options,
            Preview::Listener{[this](std::span<const PreviewEvent> batch) {
                                  largest_batch = std::max(largest_batch, batch.size());
                                  events.insert(events.end(), batch.begin(), batch.end());
                              },
                              progress});
        return preview->run_text("part.ngc", program, sink);
    }

    Standalone world;
    diagnostics::Sink sink;
    std::vector<PreviewEvent> events;
    std::size_t largest_batch = 0;
    std::function<bool(const PreviewProgress &)> progress;
    std::function<std::vector<Pose>(const Pose &)> tool_change_moves;
    std::unique_ptr<Preview> preview;
    unsigned axis_mask = 0x1ff;
};

TEST_F(PreviewRun, YieldsMovesWithTheirPlaces) {
    ASSERT_EQ(run("G21 G90 F60\nN7 G0 X1\nG1 Y2\n(section, pocket)\nG2 X3 I1\nG4 P0.5\nM2\n"),
              PreviewEnd::DONE)
        << sink.all().front().str();
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events[0].kind, PreviewKind::RAPID);
    EXPECT_EQ(events[0].line, 2);
    EXPECT_EQ(events[0].sequence, 7);
    EXPECT_EQ(preview->file(events[0].file), "part.ngc");
    EXPECT_EQ(preview->line_text(events[0].file, 2), "N7 G0 X1");
    EXPECT_EQ(events[1].kind, PreviewKind::FEED);
    EXPECT_DOUBLE_EQ(events[1].settings.feed, 1.0);
    EXPECT_DOUBLE_EQ(events[1].start.x(), 1.0);
    EXPECT_EQ(preview->section(events[1].section), "");
    EXPECT_EQ(events[2].kind, PreviewKind::ARC);
    EXPECT_DOUBLE_EQ(events[2].centre.x(), 2.0);
    EXPECT_NEAR(events[2].angle_rad, -3.14159265358979, 1e-9);
    EXPECT_EQ(preview->section(events[2].section), "pocket");
    EXPECT_EQ(events[3].kind, PreviewKind::DWELL);
    EXPECT_DOUBLE_EQ(events[3].value, 0.5);
}

TEST_F(PreviewRun, GivesMachineTipOrProgramCoordinates) {
    const std::string program = "G21 G90\nG10 L2 P1 X10 Y0 R90\nG54\nG43.1 Z5\nG0 X1 Y2 Z3\nM2\n";
    ASSERT_EQ(run(program), PreviewEnd::DONE);
    const Pose machine = events.back().end;
    EXPECT_NEAR(machine.x(), 8.0, 1e-12);
    EXPECT_NEAR(machine.y(), 1.0, 1e-12);
    EXPECT_NEAR(machine.z(), 8.0, 1e-12);
    PreviewOptions options;
    options.coordinates = PreviewCoordinates::TIP;
    ASSERT_EQ(run(program, options), PreviewEnd::DONE);
    EXPECT_NEAR(events.back().end.z(), 3.0, 1e-12);
    options.coordinates = PreviewCoordinates::PROGRAM;
    ASSERT_EQ(run(program, options), PreviewEnd::DONE);
    EXPECT_NEAR(events.back().end.x(), 1.0, 1e-12);
    EXPECT_NEAR(events.back().end.y(), 2.0, 1e-12);
    EXPECT_NEAR(events.back().end.z(), 3.0, 1e-12);
}

TEST_F(PreviewRun, NamesSubroutinesAsSections) {
    ASSERT_EQ(run("G21\no<hole> sub\nG0 Z#1\no<hole> endsub\nG0 X1\no<hole> call [5]\nM2\n"),
              PreviewEnd::DONE);
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(preview->section(events[0].section), "");
    EXPECT_EQ(preview->section(events[1].section), "hole");
    EXPECT_EQ(events[1].line, 3);
    EXPECT_EQ(events[1].call_level, 1);
}

TEST_F(PreviewRun, AddsTheMovesOfTheMachineAtAToolChange) {
    world.table = built_in_tools();
    tool_change_moves = [](const Pose &from) {
        Pose up = from;
        up[geometry::AXIS_Z] = 100;
        return std::vector<Pose>{up};
    };
    ASSERT_EQ(run("G21 G90\nG0 X3\nT2 M6\nG0 X4\nM2\n"), PreviewEnd::DONE);
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events[1].kind, PreviewKind::TOOL_CHANGE);
    EXPECT_EQ(events[1].number, 2);
    EXPECT_TRUE(events[2].by_machine);
    EXPECT_DOUBLE_EQ(events[3].end.z(), 100.0);
    EXPECT_DOUBLE_EQ(events[3].end.x(), 4.0);
}

TEST_F(PreviewRun, TellsHowFastTheSpindleTurnsThatAMoveFollows) {
    ASSERT_EQ(
        run("G21 G90 G10 L2 P1 X-5 G54\nG96 D1000 S31.41592653589793 M3\nG95 F0.1\nG0 X30\nG1 X10\nG1 X1\n"
            "G97 S500\nG1 X20\nG94 G1 X30 F100\nM2\n"),
        PreviewEnd::DONE);
    std::vector<double> speeds;
    for (const PreviewEvent &event : events) {
        if (event.kind == PreviewKind::FEED) {
            speeds.push_back(event.spindle_rpm);
        }
    }
    ASSERT_EQ(speeds.size(), 4U);
    EXPECT_NEAR(speeds[0], 5000.0 / 20.0, 1e-9);
    EXPECT_NEAR(speeds[1], 5000.0 / 5.5, 1e-9);
    EXPECT_EQ(speeds[2], 500);
    EXPECT_EQ(speeds[3], 0);
}

TEST_F(PreviewRun, TellsWhichMovesWaitForTheSpindle) {
    ASSERT_EQ(run("G21 G90 G94 F100\nG1 X1\nS500 M3\nG0 X2\nG1 X3\nG1 X4\nS600\nG1 X5\nS600\nG1 "
                  "X6\nS700\nM5\nG1 X7\nM2\n"),
              PreviewEnd::DONE);
    std::vector<double> waiting;
    for (const PreviewEvent &event : events) {
        if (event.spindle_awaited) {
            waiting.push_back(event.end.x());
        }
    }
    EXPECT_EQ(waiting, (std::vector<double>{3, 5}));
}

TEST_F(PreviewRun, RefusesAxesThatTheMachineDoesNotHave) {
    axis_mask = 7;
    EXPECT_EQ(run("G21\nG0 X1\nG0 X2 A10\nM2\n"), PreviewEnd::FAILED);
    ASSERT_EQ(sink.count_errors(), 1);
    EXPECT_EQ(sink.all()[0].what.message, "Bad character 'a' used");
    EXPECT_EQ(sink.all()[0].what.place.line, 3);
    EXPECT_EQ(sink.all()[0].what.place.column, 7);
    EXPECT_EQ(events.size(), 1U);
}

TEST_F(PreviewRun, GoesOnBehindErrorsAndTellsThemAll) {
    EXPECT_EQ(run("G21\nG1 X1\nG0 X2\nG99 Q\nG0 X3\nM2\n"), PreviewEnd::FAILED);
    ASSERT_EQ(sink.count_errors(), 2);
    EXPECT_EQ(sink.all()[0].what.place.line, 2);
    EXPECT_EQ(sink.all()[1].what.place.line, 4);
    EXPECT_EQ(events.size(), 2U);
}

TEST_F(PreviewRun, TellsSyntaxErrorsBehindAnErrorThatEndsIt) {
    EXPECT_EQ(run("G21\nG0 X1\no1 endif\nG0 X[1\nG999\no2 while [1\nG1 X1\nG0 X\nM2\n"), PreviewEnd::FAILED);
    std::vector<int> lines;
    for (const diagnostics::Diagnostic &one : sink.all()) {
        lines.push_back(one.what.place.line);
    }
    EXPECT_EQ(lines, (std::vector<int>{3, 4, 6, 8}));
}

TEST_F(PreviewRun, EndsEndlessLoopsWithAnError) {
    PreviewOptions options;
    options.statement_budget = 10000;
    EXPECT_EQ(run("o1 while [1]\n#1=[#1+1]\no1 endwhile\nM2\n", options), PreviewEnd::FAILED);
    ASSERT_EQ(sink.count_errors(), 1);
    EXPECT_NE(sink.all()[0].what.message.find("it may be endless"), std::string::npos);
}

/// Endless loops are found at once, with or without motion, because nothing changes between passes.
TEST_F(PreviewRun, FindsLoopsThatRepeatThemselves) {
    const struct {
        const char *program;
        int line;
    } cases[] = {
        {"G21 G90 F600\no1 while [1]\nG1 X10\nX0\nM0\no1 endwhile\nM2\n", 2},
        {"G21 G90 F600\no1 while [1]\n#1=0\no2 while [#1 lt 5]\nG1 X#1\n#1=[#1+1]\no2 endwhile\no1 "
         "endwhile\n",
         2},
        {"G21\no9 sub\no1 do\nM66 P0 L0\n#<a>=#5399\no1 while [#<a> eq 0]\no9 endsub\no9 call\nM2\n", 3},
    };
    for (const auto &one : cases) {
        PreviewOptions options;
        options.statement_budget = 100000;
        options.idle_budget = 0;
        diagnostics::Sink errors;
        Preview check(PreviewMachine{}, world, world, options, {});
        EXPECT_EQ(check.run_text("part.ngc", one.program, errors), PreviewEnd::FAILED);
        ASSERT_EQ(errors.count_errors(), 1) << one.program;
        EXPECT_NE(errors.all()[0].what.message.find("nothing changes"), std::string::npos);
        EXPECT_EQ(errors.all()[0].what.place.line, one.line);
        EXPECT_LT(check.progress().blocks, 5000U);
    }
    EXPECT_EQ(run("G21 F600\no1 while [#1 lt 100000]\nG91 G1 X0\n#1=[#1+1]\no1 endwhile\n"
                  "o2 do\nG91 G1 X1\no2 while [#5420 lt 5000]\nM2\n"),
              PreviewEnd::DONE)
        << sink.all().back().str();
}

/// The error names the endless loop: not an inner loop that ends, not an earlier loop, and in a subroutine
/// with its callers.
TEST_F(PreviewRun, NamesTheLoopThatDoesNotEnd) {
    const struct {
        const char *program;
        int line, callers;
    } cases[] = {
        {"#1=0\no1 while [#1 lt 900]\n#1=[#1+1]\no1 endwhile\no2 while [1]\n#2=[#2+1]\no2 endwhile\nM2\n", 5,
         0},
        {"\no1 do\no2 repeat [3]\n#1=[#1+1]\no2 endrepeat\n(msg,on)\n#5=[#5+1]\no1 while [1]\nM2\n", 2, 0},
        {"o1 while [#1 lt 5]\no2 while [1]\n#3=[#3+1]\no2 endwhile\n#1=[#1+1]\no1 endwhile\nM2\n", 2, 0},
        {"o9 sub\no3 while [1]\no8 call\n#3=[#3+1]\no3 endwhile\no9 endsub\no8 sub\no4 repeat [2]\no4 "
         "endrepeat\n"
         "o8 endsub\no7 repeat [2]\no9 call\no7 endrepeat\nM2\n",
         2, 1},
        {"M98 P5 L1000000\nM2\nO5\n#1=2\nM99\n", 3, 1},
    };
    for (const auto &one : cases) {
        PreviewOptions options;
        options.idle_budget = 5000;
        diagnostics::Sink errors;
        PreviewMachine machine;
        Preview check(machine, world, world, options, {});
        EXPECT_EQ(check.run_text("part.ngc", one.program, errors), PreviewEnd::FAILED);
        ASSERT_EQ(errors.count_errors(), 1) << one.program;
        const diagnostics::Diagnostic &error = errors.all()[0];
        EXPECT_NE(error.what.message.find("5000 statements without a machine action"), std::string::npos)
            << error.str();
        EXPECT_EQ(error.what.place.line, one.line) << error.str();
        EXPECT_EQ(error.called_from.size(), static_cast<std::size_t>(one.callers)) << error.str();
        EXPECT_NE(error.what.hint.find("--statements"), std::string::npos);
    }
}

TEST_F(PreviewRun, LongHonestProgramsAreNoEndlessLoops) {
    PreviewOptions options;
    options.idle_budget = 200;
    options.statement_budget = 2000;
    std::string straight = "G21 F6000\n";
    for (int i = 0; i < 5000; ++i) {
        straight += i % 2 == 0 ? "#1=[#1+1]\n" : "o1 call\n";
    }
    EXPECT_EQ(run("o1 sub\n#2=1\n#3=1\no1 endsub\n" + straight + "M2\n", options), PreviewEnd::DONE)
        << sink.all().back().str();
    options.statement_budget = 0;
    EXPECT_EQ(run("G21 G91 F6000\no1 repeat [5000]\no2 repeat [20]\no2 endrepeat\nG1 X1\nX-1\n"
                  "o1 endrepeat\nM2\n",
                  options),
              PreviewEnd::DONE)
        << sink.all().back().str();
    EXPECT_FALSE(sink.hasErrors());
}

TEST_F(PreviewRun, LoopsThatMoveWithoutEndAreFoundByTheirTime) {
    PreviewOptions options;
    options.time_budget_s = 3600;
    EXPECT_EQ(
        run("G21 G90 F60\n(a part)\no1 while [1]\n#1=[#1+1]\nG1 X10\nG0 X0\nG2 I1\nM0\no1 endwhile\nM2\n",
            options),
        PreviewEnd::FAILED);
    ASSERT_EQ(sink.count_errors(), 1);
    EXPECT_EQ(sink.all()[0].what.place.line, 3);
    EXPECT_NE(sink.all()[0].what.message.find("1 hours of machine time"), std::string::npos);
    EXPECT_LT(events.size(), 2000U);
    EXPECT_GT(events.size(), 500U);
}

TEST_F(PreviewRun, CanBeCancelledAndSaysHowFarItIs) {
    std::string program = "G21\n";
    for (int i = 0; i < 1000; ++i) {
        program += "G0 X" + std::to_string(i) + "\n";
    }
    program += "M2\n";
    PreviewOptions options;
    options.blocks_per_report = 100;
    options.batch = 16;
    PreviewProgress last;
    int reports = 0;
    progress = [&](const PreviewProgress &now) {
        last = now;
        return ++reports < 3;
    };
    EXPECT_EQ(run(program, options), PreviewEnd::CANCELLED);
    EXPECT_EQ(last.bytes_in_all, program.size());
    EXPECT_GT(last.bytes, program.size() / 5);
    EXPECT_LT(last.bytes, program.size() / 2);
    EXPECT_LE(events.size(), 300U);
    EXPECT_EQ(largest_batch, 16U);
}

/// Resident memory of the process [bytes].
std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t all = 0, resident = 0;
    statm >> all >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

TEST(PreviewMemory, DoesNotGrowWithTheProgram) {
    constexpr int LINES = 1000000;
    constexpr std::size_t BOUND = 8U << 20U;
    std::string path = (std::filesystem::temp_directory_path() / "preview-XXXXXX").string();
    ::close(::mkstemp(path.data()));
    {
        std::ofstream out(path);
        out << "G21 G90 F1000\n";
        for (int i = 0; i < LINES; ++i) {
            out << "G1 X" << i % 1000 << ".125 Y" << i / 1000 << "\n";
        }
        out << "M2\n";
    }
    Standalone world;
    diagnostics::Sink sink;
    std::size_t largest = 0;
    const std::size_t before = resident_bytes();
    Preview preview({}, world, world, {},
                    {[](std::span<const PreviewEvent>) {},
                     [&](const PreviewProgress &) {
                         largest = std::max(largest, resident_bytes());
                         return true;
                     }});
    EXPECT_EQ(preview.run(path, sink), PreviewEnd::DONE);
    EXPECT_EQ(preview.progress().events, static_cast<std::uint64_t>(LINES));
    EXPECT_LT(largest, before + BOUND);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace mw::gcode

// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "interp/preview.hh"
#include "interp/standalone.hh"

namespace mw::interp {
namespace {

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
    diag::Sink sink;
    std::vector<PreviewEvent> events;
    std::size_t largest_batch = 0;
    std::function<bool(const PreviewProgress &)> progress;
    std::function<std::vector<Pose>(const Pose &)> tool_change_moves;
    std::unique_ptr<Preview> preview;
    unsigned axis_mask = 0x1ff;
};

TEST_F(PreviewRun, yields_moves_with_their_places_I1) {
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

TEST_F(PreviewRun, gives_machine_tip_or_program_coordinates_I1) {
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

TEST_F(PreviewRun, names_subroutines_as_sections_I1) {
    ASSERT_EQ(run("G21\no<hole> sub\nG0 Z#1\no<hole> endsub\nG0 X1\no<hole> call [5]\nM2\n"),
              PreviewEnd::DONE);
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(preview->section(events[0].section), "");
    EXPECT_EQ(preview->section(events[1].section), "hole");
    EXPECT_EQ(events[1].line, 3);
    EXPECT_EQ(events[1].call_level, 1);
}

TEST_F(PreviewRun, adds_the_moves_of_the_machine_at_a_tool_change_I1) {
    world.table = built_in_tools();
    tool_change_moves = [](const Pose &from) {
        Pose up = from;
        up[geom::AXIS_Z] = 100;
        return std::vector<Pose>{up};
    };
    ASSERT_EQ(run("G21 G90\nG0 X3\nT2 M6\nG0 X4\nM2\n"), PreviewEnd::DONE);
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events[1].kind, PreviewKind::TOOL_CHANGE);
    EXPECT_EQ(events[1].number, 2);
    EXPECT_TRUE(events[2].isByMachine);
    EXPECT_DOUBLE_EQ(events[3].end.z(), 100.0);
    EXPECT_DOUBLE_EQ(events[3].end.x(), 4.0);
}

TEST_F(PreviewRun, refuses_axes_that_the_machine_does_not_have_I3) {
    axis_mask = 7;
    EXPECT_EQ(run("G21\nG0 X1\nG0 X2 A10\nM2\n"), PreviewEnd::FAILED);
    ASSERT_EQ(sink.count_errors(), 1);
    EXPECT_EQ(sink.all()[0].what.message, "Bad character 'a' used");
    EXPECT_EQ(sink.all()[0].what.place.line, 3);
    EXPECT_EQ(sink.all()[0].what.place.column, 7);
    EXPECT_EQ(events.size(), 1U);
}

TEST_F(PreviewRun, goes_on_behind_errors_and_tells_them_all_I3) {
    EXPECT_EQ(run("G21\nG1 X1\nG0 X2\nG99 Q\nG0 X3\nM2\n"), PreviewEnd::FAILED);
    ASSERT_EQ(sink.count_errors(), 2);
    EXPECT_EQ(sink.all()[0].what.place.line, 2);
    EXPECT_EQ(sink.all()[1].what.place.line, 4);
    EXPECT_EQ(events.size(), 2U);
}

TEST_F(PreviewRun, ends_endless_loops_with_an_error_I1) {
    PreviewOptions options;
    options.statement_budget = 10000;
    EXPECT_EQ(run("o1 while [1]\nG4 P0\no1 endwhile\nM2\n", options), PreviewEnd::FAILED);
    ASSERT_EQ(sink.count_errors(), 1);
    EXPECT_NE(sink.all()[0].what.message.find("loop without end"), std::string::npos);
}

TEST_F(PreviewRun, can_be_cancelled_and_says_how_far_it_is_I1) {
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

/// The process's memory that is in use now. [bytes]
std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t all = 0, resident = 0;
    statm >> all >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

TEST(PreviewMemory, does_not_grow_with_the_program_I1) {
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
    diag::Sink sink;
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
}  // namespace mw::interp

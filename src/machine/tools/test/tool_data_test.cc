// SPDX-License-Identifier: GPL-2.0-or-later
// The tools of a machine in a file and in a database program.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "machine/journal/test/hung_disk.hh"
#include "machine/tools/tool_data.hh"
#include "machine/tools/tool_database.hh"

namespace mw::machine {
namespace {

class ToolDataTest : public ::testing::Test {
  protected:
    ToolDataTest()
        : folder_(std::filesystem::temp_directory_path() / ("mw_tools_" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directory(folder_);
        config_.ini_folder = folder_.string();
    }
    ~ToolDataTest() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string &name) const { return (folder_ / name).string(); }
    void write(const std::string &name, const std::string &text) { std::ofstream(path(name)) << text; }
    std::string text(const std::string &name) const { return read_file(path(name)).value_or("none"); }
    /// Opens a file with these lines.
    task::ToolStore &open_file(const std::string &lines, bool random = false) {
        write("tool.tbl", lines);
        config_.tool_table_file = path("tool.tbl");
        config_.is_random_toolchanger = random;
        return open();
    }
    /// Opens a database program: this shell script, which logs its input.
    task::ToolStore &open_database(const std::string &script, bool random = false) {
        write("db", "#!/bin/sh\n" + script);
        std::filesystem::permissions(path("db"), std::filesystem::perms::owner_all);
        config_.tool_database = "./db one two";
        config_.is_random_toolchanger = random;
        return open();
    }
    task::ToolStore &open() {
        auto made = open_tools(config_, sink_, {&keeper_, true});
        error_ = made.has_value() ? "" : made.error().message;
        tools_ = made.has_value() ? std::move(*made) : nullptr;
        return *tools_;
    }
    std::string told() {
        std::string all;
        for (const diagnostics::Diagnostic &one : sink_.all()) {
            all += one.what.message + '\n';
        }
        while (const auto warning = tools_->take_warning()) {
            all += *warning + '\n';
        }
        return all;
    }

    std::filesystem::path folder_;
    MachineConfig config_;
    diagnostics::Sink sink_;
    journal::Writer keeper_{journal::system_disk(), "", journal::Works::ON_CALL};
    std::unique_ptr<task::ToolStore> tools_;
    std::string error_;
};

/// Answers g with two tools and everything else with FINI, and writes a log.
constexpr const char *GOOD = R"sh(echo v2.1
echo "$1 $2" > log
while read -r line; do
    echo "$line" >> log
    case "$line" in
    g) echo "T10 P110 Z0.1 D0.1"; echo "T11 P111 Z0.2 D0.2"; echo "FINI (get_cmd)";;
    *) echo "FINI (update recvd)";;
    esac
done
)sh";

TEST_F(ToolDataTest, AMissingFileStartsEmptyWithAWarning) {
    config_.tool_table_file = path("none.tbl");
    EXPECT_EQ(open().count(), 1);
    EXPECT_NE(told().find("there is no tool table"), std::string::npos);
}

TEST_F(ToolDataTest, EachBadLineIsToldAlsoWhenTheFileIsReadAgain) {
    task::ToolStore &tools = open_file("T1 P1\n!what\nT2 P2 K9\n");
    const std::string first = told();
    EXPECT_NE(first.find("'!' is not a word"), std::string::npos) << first;
    EXPECT_NE(first.find("'K' is not a word"), std::string::npos) << first;
    sink_.clear();
    write("tool.tbl", "T1 P1\nT3 P3 Z3\nT9\nT4 P4 X\n");
    ASSERT_TRUE(tools.reload().has_value());
    EXPECT_EQ(tools.index_of_tool(3), 2);
    const std::string again = told();
    EXPECT_NE(again.find("tool 9 has no P word"), std::string::npos) << again;
    EXPECT_NE(again.find("X needs a number"), std::string::npos) << again;
}

TEST_F(ToolDataTest, AFixedChangerNeverWritesTheSpindle) {
    const std::string lines = "; mine\nT5 P3 Z5\nT7 P4 Z7\n";
    task::ToolStore &tools = open_file(lines);
    ASSERT_TRUE(tools.load_spindle(1).has_value());
    EXPECT_EQ(tools.entry(0).toolno, 5);
    EXPECT_EQ(text("tool.tbl"), lines);
    gcode::ToolEntry entry = tools.entry(2);
    entry.offset[2] = 8;
    ASSERT_TRUE(tools.set_entry(2, entry).has_value());
    EXPECT_EQ(text("tool.tbl"), "; mine\nT5 P3 Z5\nT7 P4 Z8\n");
    ASSERT_TRUE(tools.reload().has_value());
    EXPECT_EQ(tools.entry(0).toolno, 5) << "reading the table does not empty the spindle";
}

TEST_F(ToolDataTest, ARandomChangerSavesEachSwap) {
    task::ToolStore &tools = open_file("T0 P0\nT5 P3 Z5\n", true);
    ASSERT_TRUE(tools.load_spindle(3).has_value());
    EXPECT_EQ(text("tool.tbl"), "T0 P3\nT5 P0 Z5\n");
    gcode::ToolEntry entry = tools.entry(0);
    entry.diameter = 2;
    ASSERT_TRUE(tools.set_entry(3, entry).has_value()) << "where it was when the program read it";
    EXPECT_EQ(text("tool.tbl"), "T0 P3\nT5 P0 Z5 D2\n") << "a tool is changed by its number";
    EXPECT_EQ(open().entry(0).toolno, 5) << "it is in the spindle at the next start";
}

TEST_F(ToolDataTest, AToolThatIsGoneIsNotChangedForAnother) {
    task::ToolStore &tools = open_file("T5 P3 Z5\nT7 P4 Z7\n");
    gcode::ToolEntry entry = tools.entry(1);
    entry.toolno = 6;
    EXPECT_FALSE(tools.set_entry(1, entry).has_value());
    EXPECT_EQ(tools.entry(1).offset[2], 5);
}

gcode::ToolEntry tool_of(int toolno, int pocketno, double z = 0) {
    gcode::ToolEntry entry;
    entry.toolno = toolno;
    entry.pocketno = pocketno;
    entry.offset[geometry::AXIS_Z] = z;
    return entry;
}

TEST_F(ToolDataTest, ToolsAreAddedAndRemovedAndTheRestOfTheFileStays) {
    const std::string before = "; our tools\nT1 P1 D3 Z10 ; drill\n\nT2 P2 D6 ;mill\n";
    task::ToolStore &tools = open_file(before);
    gcode::ToolEntry entry = tool_of(5, 0, 12.5);
    entry.diameter = 8;
    entry.comment = "new one";
    const std::uint64_t version = tools.version();
    ASSERT_TRUE(tools.add(entry).has_value());
    EXPECT_NE(tools.version(), version);
    EXPECT_EQ(text("tool.tbl"), before + "T5 P5 Z12.5 D8 ;new one\n");
    EXPECT_EQ(tools.index_of_tool(5), 3);
    ASSERT_TRUE(tools.remove(tools.index_of_tool(1)).has_value());
    EXPECT_EQ(text("tool.tbl"), "; our tools\n\nT2 P2 D6 ;mill\nT5 P5 Z12.5 D8 ;new one\n");
    EXPECT_EQ(tools.index_of_tool(1), -1);
    EXPECT_EQ(tools.index_of_tool(2), 2) << "a tool with an index keeps it";
    EXPECT_EQ(tools.index_of_tool(5), 3);
    task::ToolStore &again = open();
    EXPECT_EQ(again.entry(again.index_of_tool(5)).diameter, 8);
    EXPECT_EQ(again.index_of_tool(1), -1);
    EXPECT_EQ(told(), "");
}

TEST_F(ToolDataTest, WhatCannotBeAddedOrRemovedIsRefusedAndTheFileStays) {
    const std::string before = "T1 P1\nT2 P7\n";
    task::ToolStore &tools = open_file(before);
    EXPECT_EQ(tools.add(tool_of(1, 9)).error().message, "tool 1 is in the tool table already");
    EXPECT_EQ(tools.add(tool_of(3, 7)).error().message, "pocket 7 is occupied by tool 2");
    EXPECT_FALSE(tools.add(tool_of(0, 9)).has_value());
    EXPECT_FALSE(tools.add(tool_of(3, 1001)).has_value());
    ASSERT_TRUE(tools.load_spindle(1).has_value());
    EXPECT_EQ(tools.remove(1).error().message,
              "tool 1 is in the spindle: it is removed after the next tool change");
    EXPECT_FALSE(tools.remove(0).has_value());
    EXPECT_FALSE(tools.remove(9).has_value());
    EXPECT_EQ(text("tool.tbl"), before);
    ASSERT_TRUE(tools.load_spindle(0).has_value());
    EXPECT_TRUE(tools.remove(1).has_value());
    EXPECT_EQ(text("tool.tbl"), "T2 P7\n");
    ASSERT_TRUE(tools.add(tool_of(7, 0)).has_value());
    EXPECT_EQ(text("tool.tbl"), "T2 P7\nT7 P1\n") << "its own pocket is taken: the lowest that is free";
}

TEST_F(ToolDataTest, ARandomChangersPocketsAreOneToolEach) {
    task::ToolStore &tools = open_file("T1 P0\nT2 P1\nT3 P2\n", true);
    EXPECT_EQ(tools.add(tool_of(9, 2)).error().message, "pocket 2 is occupied by tool 3");
    EXPECT_EQ(tools.add(tool_of(9, 1001)).error().message, "tool 9 has pocket 1001: pockets are 1 to 1000");
    EXPECT_EQ(tools.remove(0).error().message,
              "tool 1 is in the spindle: it is removed after the next tool change");
    ASSERT_TRUE(tools.remove(tools.index_of_tool(2)).has_value());
    ASSERT_TRUE(tools.add(tool_of(9, 0)).has_value());
    EXPECT_EQ(tools.entry(9).toolno, 9) << "the pocket of its number";
    ASSERT_TRUE(tools.add(tool_of(2000, 0)).has_value());
    EXPECT_EQ(tools.entry(1).toolno, 2000);
    EXPECT_EQ(text("tool.tbl"), "T1 P0\nT3 P2\nT9 P9\nT2000 P1\n");
    for (int pocket = 3; pocket <= tools::MAX_POCKET; ++pocket) {
        if (pocket != 9) {
            ASSERT_TRUE(tools.add(tool_of(10000 + pocket, pocket)).has_value());
        }
    }
    EXPECT_EQ(tools.add(tool_of(5000, 0)).error().message,
              "there is no free pocket for tool 5000: the last pocket is 1000");
}

TEST_F(ToolDataTest, LinesThatContradictEachOtherAreNotAddedToNorLeftBehind) {
    const std::string before = "T1 P1 D3\nT1 P2 D4\nT2 P3 D5 ;first\nT2 P3 D5 ;again\nT3 P4\n";
    task::ToolStore &tools = open_file(before);
    EXPECT_EQ(tools.add(tool_of(1, 9)).error().message, "the tool table has contradictory lines for tool 1");
    EXPECT_EQ(tools.add(tool_of(8, 2)).error().message, "pocket 2 is occupied by tool 1");
    EXPECT_EQ(text("tool.tbl"), before);
    ASSERT_TRUE(tools.remove(tools.index_of_tool(2)).has_value());
    EXPECT_EQ(text("tool.tbl"), "T1 P1 D3\nT1 P2 D4\nT3 P4\n") << "its second line would bring it back";
    EXPECT_EQ(open().index_of_tool(2), -1);
}

TEST_F(ToolDataTest, AChangeThatCannotBeKeptHasNotHappened) {
    task::ToolStore &tools = open_file("T1 P1\nT2 P2\n");
    std::filesystem::remove_all(folder_);  // the folder is missing, so the file cannot be written
    EXPECT_FALSE(tools.add(tool_of(3, 3)).has_value());
    EXPECT_EQ(tools.index_of_tool(3), -1);
    EXPECT_FALSE(tools.remove(1).has_value());
    EXPECT_EQ(tools.index_of_tool(1), 1);
    std::filesystem::create_directory(folder_);
    EXPECT_TRUE(tools.remove(1).has_value());
    EXPECT_EQ(text("tool.tbl"), "T2 P2\n");
}

/// Tools with a writing thread, on a disk that does not answer before release().
class HungToolDiskTest : public ToolDataTest {
  protected:
    task::ToolStore &open_hung(const std::string &lines, bool random = false) {
        write("tool.tbl", lines);
        config_.tool_table_file = path("tool.tbl");
        config_.is_random_toolchanger = random;
        tools_ = *open_tools(config_, sink_, {writer_.get(), false});
        return *tools_;
    }
    void release_and_finish() {
        if (!calls_->isReleased.try_wait()) {
            calls_->isReleased.count_down();
        }
        writer_->finish();
    }
    /// Runs cycles until the table has been read.
    Result<> end_reading() {
        std::optional<Result<>> result;
        while (!(result = tools_->reload_result()).has_value()) {  // otherwise the test times out
            tools_->step();
        }
        return *result;
    }

    std::shared_ptr<journal::test::HungCalls> calls_ = std::make_shared<journal::test::HungCalls>();
    std::unique_ptr<journal::Writer> writer_ = std::make_unique<journal::Writer>(
        std::make_unique<journal::test::HungDisk>(calls_), "", journal::Works::ALONE);
};

TEST_F(HungToolDiskTest, AChangeIsInForceAtOnceAndWrittenWhenTheDiskAnswers) {
    task::ToolStore &tools = open_hung("T0 P0\nT5 P3 Z5\n", true);
    ASSERT_TRUE(tools.load_spindle(3).has_value());
    calls_->isCalled.wait();
    gcode::ToolEntry entry = tools.entry(0);
    for (int i = 1; i <= 3; ++i) {
        entry.offset[geometry::AXIS_Z] = i;
        ASSERT_TRUE(tools.set_entry(0, entry).has_value());
    }
    EXPECT_EQ(tools.entry(0).offset[geometry::AXIS_Z], 3);
    EXPECT_FALSE(tools.isSettled());
    EXPECT_EQ(text("tool.tbl"), "T0 P0\nT5 P3 Z5\n");
    EXPECT_EQ(writer_->take_delay(0), std::nullopt);
    EXPECT_EQ(writer_->take_delay(1000000000),
              "the disk of " + path("tool.tbl") + " has not answered for 1 s");
    EXPECT_EQ(writer_->take_delay(9000000000), std::nullopt) << "it is reported once";
    EXPECT_TRUE(tools.isSettled()) << "a program does not wait for it any longer";
    release_and_finish();
    EXPECT_EQ(text("tool.tbl"), "T0 P3\nT5 P0 Z3\n");
    EXPECT_TRUE(tools.isSettled());
}

TEST_F(HungToolDiskTest, TheTableIsReadAfterItsLastChangeIsWritten) {
    task::ToolStore &tools = open_hung("T1 P1 Z1\n");
    gcode::ToolEntry entry = tools.entry(1);
    entry.offset[geometry::AXIS_Z] = 2;
    ASSERT_TRUE(tools.set_entry(1, entry).has_value());
    ASSERT_TRUE(tools.reload().has_value());
    tools.step();
    EXPECT_FALSE(tools.reload_result().has_value());
    entry.offset[geometry::AXIS_Z] = 3;
    ASSERT_TRUE(tools.set_entry(1, entry).has_value()) << "a change while the table is read";
    calls_->isReleased.count_down();
    EXPECT_TRUE(end_reading().has_value());
    EXPECT_EQ(tools.entry(1).offset[geometry::AXIS_Z], 3) << "is not lost";
    release_and_finish();
    EXPECT_EQ(text("tool.tbl"), "T1 P1 Z3\n");
}

TEST_F(HungToolDiskTest, AReadingThatIsDroppedChangesNothing) {
    task::ToolStore &tools = open_hung("T1 P1 Z1\n");
    write("tool.tbl", "T1 P1 Z9\n");
    ASSERT_TRUE(tools.reload().has_value());
    tools.drop_reload();
    ASSERT_TRUE(tools.reload_result().has_value());
    EXPECT_FALSE(tools.reload_result()->has_value());
    release_and_finish();
    tools.step();
    EXPECT_EQ(tools.entry(1).offset[geometry::AXIS_Z], 1);
}

TEST_F(HungToolDiskTest, AnOperatorsChangeThatIsNotWrittenIn1sHasNotHappened) {
    task::ToolStore &tools = open_hung("T1 P1\nT2 P2\n");
    EXPECT_NE(tools.remove(1).error().message.find("has not answered for 1 s"), std::string::npos);
    EXPECT_EQ(tools.index_of_tool(1), 1);
    release_and_finish();
    EXPECT_EQ(text("tool.tbl"), "T1 P1\nT2 P2\n") << "nor when the disk answers later";
}

TEST_F(ToolDataTest, AFailedWriteIsReportedAndWrittenAgain) {
    const std::filesystem::path away = path("away");
    std::filesystem::create_directory(path("m"));
    write("m/tool.tbl", "T1 P1 Z1\n");
    config_.tool_table_file = path("m/tool.tbl");
    for (const bool is_changed_again : {true, false}) {
        journal::Writer writer(journal::system_disk(), "", journal::Works::ALONE);
        tools_ = *open_tools(config_, sink_, {&writer, false});
        std::filesystem::rename(path("m"), away);  // the folder is missing, so the file cannot be written
        gcode::ToolEntry entry = tools_->entry(1);
        entry.offset[geometry::AXIS_Z] = 2;
        EXPECT_TRUE(tools_->set_entry(1, entry).has_value()) << "the program continues";
        while (!tools_->isSettled()) {  // otherwise this test times out
            std::this_thread::yield();
        }
        const std::string trouble = writer.take_trouble().value_or("");
        EXPECT_NE(trouble.find(config_.tool_table_file), std::string::npos) << trouble;
        EXPECT_NE(trouble.find("written with the next change"), std::string::npos) << trouble;
        EXPECT_EQ(tools_->entry(1).offset[geometry::AXIS_Z], 2);
        ASSERT_TRUE(tools_->reload().has_value());
        while (!tools_->reload_result().has_value()) {
            tools_->step();
        }
        EXPECT_FALSE(tools_->reload_result()->has_value()) << "reading would lose the change";
        EXPECT_EQ(tools_->entry(1).offset[geometry::AXIS_Z], 2);
        std::filesystem::rename(away, path("m"));
        if (is_changed_again) {
            entry.offset[geometry::AXIS_X] = 7;
            ASSERT_TRUE(tools_->set_entry(1, entry).has_value());
        }
        writer.finish();
        EXPECT_EQ(text("m/tool.tbl"), "T1 P1 X7 Z2\n");
        tools_.reset();
        write("m/tool.tbl", "T1 P1 X7 Z1\n");
    }
}

TEST_F(ToolDataTest, ADatabaseAddsAndRemovesByItself) {
    task::ToolStore &tools = open_database(GOOD);
    EXPECT_NE(tools.add(tool_of(3, 3)).error().message.find("tool database"), std::string::npos);
    EXPECT_NE(tools.remove(tools.index_of_tool(10)).error().message.find("tool 10"), std::string::npos);
    EXPECT_EQ(tools.index_of_tool(10), 1);
}

TEST_F(ToolDataTest, TheLifeOfToolsIsKeptBesideTheirTable) {
    task::ToolStore &tools = open_file("T5 P1\nT6 P2\n");
    tools.note_cut(5, {30, 100});
    keeper_.work();
    EXPECT_EQ(text("tool.tbl.life"), "none") << "not yet a minute";
    tools.note_cut(5, {31, 100});
    EXPECT_EQ(text("tool.tbl.life"), "none") << "cutting does not wait for the disk";
    keeper_.work();
    EXPECT_NE(text("tool.tbl.life").find("T5 61.000 200.0000\n"), std::string::npos);
    tools.note_cut(6, {1, 2});
    ASSERT_TRUE(tools.load_spindle(1).has_value());
    keeper_.work();
    EXPECT_NE(text("tool.tbl.life").find("T6 1.000 2.0000\n"), std::string::npos) << "at a change";
    tools.note_cut(6, {1, 2});
    tools_.reset();
    keeper_.work();
    EXPECT_EQ(open().life(6).time_s, 2) << "and at the end";
    tools_.reset();
    write("tool.tbl.life", "broken\n");
    open();
    EXPECT_NE(told().find("tool life is not saved"), std::string::npos);
    tools_->note_cut(5, {100, 1});
    tools_.reset();
    keeper_.work();
    EXPECT_EQ(text("tool.tbl.life"), "broken\n") << "what cannot be read is not written over";
}

TEST_F(ToolDataTest, ADatabaseTellsItsToolsAndIsToldOfChanges) {
    task::ToolStore &tools = open_database(GOOD);
    ASSERT_EQ(error_, "");
    ASSERT_EQ(tools.count(), 3);
    EXPECT_EQ(tools.entry(1).toolno, 10);
    EXPECT_EQ(tools.entry(2).offset[2], 0.2);
    ASSERT_TRUE(tools.load_spindle(2).has_value());
    gcode::ToolEntry entry = tools.entry(1);
    entry.offset[0] = 1.5;
    ASSERT_TRUE(tools.set_entry(1, entry).has_value());
    ASSERT_TRUE(tools.set_entry(0, tools.entry(2)).has_value());
    ASSERT_TRUE(tools.load_spindle(0).has_value());
    ASSERT_TRUE(tools.reload().has_value());
    EXPECT_EQ(text("log"), "one two\ng\nl T11  P0\np T10 P110 X1.5 Z0.1 D0.1\nu T0   P0\ng\n");
    EXPECT_EQ(told(), "");
}

TEST_F(ToolDataTest, ARandomChangersDatabaseIsToldBothMoves) {
    task::ToolStore &tools = open_database(GOOD, true);
    ASSERT_TRUE(tools.load_spindle(110).has_value());
    ASSERT_TRUE(tools.load_spindle(111).has_value());
    EXPECT_EQ(text("log"), "one two\ng\nl T10  P0\nu T10  P111\nl T11  P0\n");
    EXPECT_EQ(text("db_spindle.tbl"), "T11 P0 Z0.2 D0.2\n");
    EXPECT_EQ(open().entry(0).toolno, 11) << "kept beside the database, which knows nothing of it";
}

TEST_F(ToolDataTest, ADatabaseThatDoesNotAgreeIsHeard) {
    task::ToolStore &tools = open_database("echo v2.1\nread -r x\necho T1 P1\necho FINI\n"
                                           "while read -r x; do echo \"NAK no such tool\"; done\n");
    ASSERT_EQ(error_, "");
    EXPECT_TRUE(tools.load_spindle(1).has_value()) << "the tool is loaded, independent of the database";
    EXPECT_NE(told().find("rejects 'l T1   P0  ': NAK no such tool"), std::string::npos);
}

TEST_F(ToolDataTest, ADatabaseThatCannotWorkStopsTheStartByName) {
    const auto error_of = [this](const std::string &script) {
        write("db", "#!/bin/sh\n" + script);
        std::filesystem::permissions(path("db"), std::filesystem::perms::owner_all);
        ToolDatabase::Setup setup{"./db", folder_.string(), tools::Changer::FIXED, true, nullptr, 0.3};
        const auto made = ToolDatabase::start(setup, sink_);
        return made.has_value() ? std::string() : made.error().message;
    };
    EXPECT_NE(error_of("exit 3\n").find("'./db' cannot be queried: it has ended with status 3"),
              std::string::npos);
    EXPECT_NE(error_of("sleep 9\n").find("does not report its version within 0.3 s"), std::string::npos);
    EXPECT_NE(error_of("echo v1.0\nsleep 9\n").find("has protocol version 'v1.0', not v2.1"),
              std::string::npos);
    EXPECT_NE(
        error_of("echo v2.1\nread x\necho T1 P1\nsleep 9\n").find("does not answer to 'g' within 0.3 s"),
        std::string::npos);
    EXPECT_NE(
        error_of("echo v2.1\nread x\necho NAK busy\nsleep 9\n").find("does not report its tools: NAK busy"),
        std::string::npos);
    config_.tool_database = "/no/such/program";
    EXPECT_FALSE(open_tools(config_, sink_, {nullptr, true}).has_value());
}

TEST_F(ToolDataTest, ADatabaseThatDiesLaterIsToldAndNothingWaits) {
    task::ToolStore &tools = open_database("echo v2.1\nread x\necho T1 P1\necho FINI\nread x\nexit 5\n");
    ASSERT_EQ(error_, "");
    static_cast<void>(tools.load_spindle(1));
    EXPECT_EQ(tools.entry(0).toolno, 1) << "the table follows the machine";
    EXPECT_NE(told().find("it has ended with status 5"), std::string::npos);
    EXPECT_FALSE(tools.reload().has_value());
    EXPECT_FALSE(tools.load_spindle(0).has_value());
    EXPECT_EQ(tools.entry(0).toolno, 0);
}

}  // namespace
}  // namespace mw::machine

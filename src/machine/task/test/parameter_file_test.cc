// SPDX-License-Identifier: GPL-2.0-or-later
// A parameter set by an MDI line is on the disk soon afterwards.
#include "machine/journal/test/hung_disk.hh"
#include "machine/journal/test/torn_disk.hh"
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

constexpr const char *FILE_NAME = "/m/p.var", *BACKUP_NAME = "/m/p.var.bak";

struct KeptOnDisk {
    journal::test::TornDisk disk;
    journal::Writer writer{std::make_unique<journal::test::TornDiskView>(disk), "", journal::Works::ON_CALL};
};

Settings with_parameter_file() {
    Settings settings;
    settings.parameter_file = FILE_NAME;
    return settings;
}

class ParameterFileTest : private KeptOnDisk, public TaskTest {
  protected:
    ParameterFileTest() : TaskTest(with_parameter_file(), &writer) {}

    /// The value after a restart that follows a power failure; none: there is no file.
    std::optional<double> value_after_power_cut(int number) {
        std::mt19937_64 random(1);
        journal::test::TornDisk after = disk;
        after.cut_power(random);
        if (!after.names.contains(FILE_NAME)) {
            return std::nullopt;
        }
        std::istringstream lines(after.files[after.names[FILE_NAME]].now);
        int found = 0;
        for (double value = 0; lines >> found >> value;) {
            if (found == number) {
                return value;
            }
        }
        return std::nullopt;
    }
    Progress mdi(const std::string &line) {
        EXPECT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
        return ask(Mdi{line});
    }
    void make_sub(const std::string &text) const { std::ofstream(folder / "touch.ngc") << text; }
    using KeptOnDisk::disk;
    using KeptOnDisk::writer;
};

TEST_F(ParameterFileTest, WhatALineOfMdiSetsOutlivesACrashThatFollows) {
    ASSERT_EQ(mdi("G10 L20 P1 X-12.5"), Progress::DONE) << reason(request);
    EXPECT_TRUE(writer.work());
    EXPECT_EQ(value_after_power_cut(5221), 12.5);
    ASSERT_EQ(mdi("G92 Y3"), Progress::DONE) << reason(request);
    writer.work();
    EXPECT_EQ(value_after_power_cut(5212), -3.0);
    ASSERT_EQ(mdi("#5163 = 7.25"), Progress::DONE) << reason(request);
    writer.work();
    EXPECT_EQ(value_after_power_cut(5163), 7.25);
    ASSERT_EQ(mdi("G55"), Progress::DONE) << reason(request);
    writer.work();
    EXPECT_EQ(value_after_power_cut(5220), 2.0);
    EXPECT_EQ(value_after_power_cut(5221), 12.5);
}

TEST_F(ParameterFileTest, ALineThatSetsNothingWritesNothing) {
    ASSERT_EQ(mdi("G91"), Progress::DONE);
    ASSERT_EQ(mdi("#100 = 4"), Progress::DONE);
    EXPECT_FALSE(writer.work());
    EXPECT_FALSE(disk.names.contains(FILE_NAME));
}

/// Values that a line set before its error are active, and therefore kept.
TEST_F(ParameterFileTest, AStopAndAnErrorKeepWhatIsInForce) {
    ASSERT_EQ(mdi("G10 L2 P2 X1"), Progress::DONE);
    EXPECT_EQ(mdi("#5241 = 2 G1 X5 F0"), Progress::FAILED);
    writer.work();
    EXPECT_EQ(value_after_power_cut(5241), 1.0);
    make_sub("o<touch> sub\n#5242 = 4\nG4 P100\n#5243 = 5\no<touch> endsub\n");
    const client::Serial touch = post(Mdi{"o<touch> call"});
    cycles(50);
    ASSERT_EQ(progress(touch), Progress::STARTED) << reason(touch);
    ASSERT_EQ(ask(AbortAll{}), Progress::DONE);
    writer.work();
    EXPECT_EQ(value_after_power_cut(5242), 4.0);
}

/// The awaited write is newer than the text that waits in the writer.
TEST_F(ParameterFileTest, AnOlderTextNeverComesOverANewerOne) {
    ASSERT_EQ(mdi("G10 L2 P1 X1"), Progress::DONE);
    ASSERT_EQ(mdi("G10 L2 P1 X2"), Progress::DONE);
    ASSERT_EQ(ask(SynchInterpreter{}), Progress::DONE);
    EXPECT_EQ(value_after_power_cut(5221), 2.0);
    writer.work();
    EXPECT_EQ(value_after_power_cut(5221), 2.0);
    ASSERT_EQ(mdi("G10 L2 P1 X3"), Progress::DONE);
    writer.work();
    EXPECT_EQ(value_after_power_cut(5221), 3.0);
}

TEST_F(ParameterFileTest, TheBackupHasWhatTheFileHadBefore) {
    ASSERT_EQ(mdi("G10 L2 P1 X1"), Progress::DONE);
    writer.work();
    EXPECT_FALSE(disk.names.contains(BACKUP_NAME));
    const std::string before = disk.files[disk.names[FILE_NAME]].now;
    ASSERT_EQ(mdi("G10 L2 P1 X2"), Progress::DONE);
    writer.work();
    EXPECT_EQ(disk.files[disk.names[BACKUP_NAME]].now, before);
    EXPECT_EQ(value_after_power_cut(5221), 2.0);
    ASSERT_TRUE(task.save_parameters().has_value());
    EXPECT_EQ(disk.files[disk.names[BACKUP_NAME]].now, before);
}

TEST_F(ParameterFileTest, WhatAProgramHasSetIsWrittenAtItsEnd) {
    open("G21 F600\nG10 L2 P1 X9\nG1 X1\nM2\n");
    ASSERT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
    EXPECT_TRUE(writer.work());
    EXPECT_EQ(value_after_power_cut(5221), 9.0);
}

struct OnAHungDisk {
    std::shared_ptr<journal::test::HungCalls> calls = std::make_shared<journal::test::HungCalls>();
    journal::Writer writer{std::make_unique<journal::test::HungDisk>(calls), "", journal::Works::ALONE};
    ~OnAHungDisk() { calls->isReleased.count_down(); }
};

class HungDiskTest : private OnAHungDisk, public TaskTest {
  protected:
    HungDiskTest() : TaskTest(settings(), &writer) {}
    static Settings settings() {
        Settings settings;
        settings.parameter_file = (made_folder() / "p.var").string();
        return settings;
    }
    using OnAHungDisk::calls;
};

TEST_F(HungDiskTest, TheOperatorReadsWhichFileAfter1sAndStopsWork) {
    ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    ASSERT_EQ(ask(Mdi{"G10 L2 P1 X1"}), Progress::DONE) << reason(request);
    calls->isCalled.wait();
    messages();
    cycles(900);
    EXPECT_EQ(messages(), "");
    cycles(150);
    EXPECT_EQ(messages(), "the disk of " + (folder / "p.var").string() + " has not answered for 1 s\n");
    cycles(3000);
    EXPECT_EQ(messages(), "") << "it is reported once";
    EXPECT_EQ(ask(AbortAll{}, 5), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G10 L2 P1 X2"}, 50), Progress::DONE) << reason(request);
}

TEST_F(TaskTest, ProgramsAndLinesOfMdiEndWhenTheToolTableIsWritten) {
    ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    tools.is_written = false;
    EXPECT_EQ(ask(Mdi{"G10 L1 P5 Z1"}, 100), Progress::STARTED)
        << "a client that reads the file then sees it";
    tools.is_written = true;
    cycles(2);
    EXPECT_EQ(progress(request), Progress::DONE) << reason(request);
    open("G21\nG10 L1 P5 Z2\nM2\n");
    tools.is_written = false;
    EXPECT_EQ(ask(RunProgram{}, 100), Progress::STARTED);
    EXPECT_EQ(ask(AbortAll{}, 5), Progress::DONE);
}

}  // namespace
}  // namespace mw::task

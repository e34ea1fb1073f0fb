// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "machine/journal/test/hung_disk.hh"
#include "machine/journal/test/torn_disk.hh"
#include "machine/journal/writer.hh"

namespace mw::journal {
namespace {

constexpr const char *PATH = "/m/sim.var.journal", *PROGRAM = "/m/p.ngc";

std::string content(const std::filesystem::path &path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

Progress at_block(std::uint64_t block) {
    Progress progress;
    progress.block = block;
    return progress;
}

class JournalWriter : public testing::Test {
  protected:
    JournalWriter() { disk.write_outside(PROGRAM, "G0 X1\n"); }
    std::unique_ptr<Writer> open() {
        return std::make_unique<Writer>(std::make_unique<test::TornDiskView>(disk), PATH, Works::ON_CALL);
    }
    test::TornDisk disk;
};

TEST_F(JournalWriter, ARunThatHasNotEndedIsFound) {
    auto writer = open();
    EXPECT_FALSE(writer->found().run.has_value());
    writer->begin({0, PROGRAM, {}, "state"});
    writer->note(at_block(3));
    writer->note(at_block(4));
    EXPECT_TRUE(writer->work());
    EXPECT_FALSE(writer->work());
    writer->note(at_block(5));
    writer.reset();
    writer = open();
    ASSERT_TRUE(writer->found().run.has_value());
    EXPECT_EQ(writer->found().run->progress->block, 5U);
    EXPECT_EQ(writer->found().run->start.state, "state");
    EXPECT_EQ(writer->found().refusal, "");
    disk.write_outside(PROGRAM, "G0 X2\n");
    EXPECT_EQ(open()->found().refusal, "its file has changed since the program was started");
    disk.names.erase(PROGRAM);
    EXPECT_EQ(open()->found().refusal, "its file no longer exists");
}

TEST_F(JournalWriter, ARunThatHasEndedOrIsForgottenIsNot) {
    auto writer = open();
    writer->begin({0, PROGRAM, {}, "state"});
    writer->note(at_block(3));
    writer->end();
    writer.reset();
    writer = open();
    EXPECT_FALSE(writer->found().run.has_value());
    writer->begin({0, PROGRAM, {}, "state"});
    writer->note(at_block(3));
    writer->work();
    writer->forget();
    writer.reset();
    EXPECT_FALSE(open()->found().run.has_value());
    EXPECT_FALSE(disk.names.contains(PATH));
}

TEST_F(JournalWriter, AFileThatIsNoJournalIsTold) {
    disk.write_outside(PATH, "rubbish");
    const auto trouble = open()->take_trouble();
    ASSERT_TRUE(trouble.has_value());
    EXPECT_EQ(*trouble, "/m/sim.var.journal: the file is not a journal, or has another version: an "
                        "interrupted program cannot be continued");
}

TEST_F(JournalWriter, AFileThatIsWaitedForIsNewerThanWhatWasAskedBefore) {
    auto writer = open();
    writer->keep_file("/m/p.var", "older");
    ASSERT_TRUE(writer->write_file("/m/p.var", "newer").has_value());
    EXPECT_EQ(disk.files[disk.names["/m/p.var"]].synced, "newer");
    EXPECT_FALSE(writer->work());
    writer->keep_file("/m/p.var", "newest");
    writer->keep_file("/m/other", "other");
    writer->work();
    EXPECT_EQ(disk.files[disk.names["/m/p.var"]].synced, "newest");
}

TEST_F(JournalWriter, ItDoesNotGrowWithoutEnd) {
    auto writer = open();
    writer->begin({0, PROGRAM, {}, "state"});
    for (std::uint64_t block = 1; block < 30000; ++block) {
        writer->note(at_block(block));
        writer->work();
    }
    EXPECT_LT(disk.files[disk.names[PATH]].now.size(), 2000000U);
    writer.reset();
    EXPECT_EQ(open()->found().run->progress->block, 29999U);
}

/// The power fails at each step of a disk that loses unsynced data. Completed work survives; files are old or
/// new.
TEST_F(JournalWriter, WhateverThePowerCutTakesWhatWasWorkedOffIsThere) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(seed);
        test::TornDisk fresh;
        fresh.write_outside(PROGRAM, "G0 X1\n");
        fresh.write_outside("/m/life", "old");
        disk = fresh;
        auto writer = open();
        writer->begin({0, PROGRAM, {}, std::string(random() % 3000, 's')});
        std::uint64_t sure = 0, asked = 0;
        disk.steps_left = static_cast<long>(random() % 60);
        while (!disk.isDead) {
            const int notes = static_cast<int>(random() % 4);
            for (int i = 0; i < notes; ++i) {
                writer->note(at_block(++asked));
            }
            if (random() % 5 == 0) {
                writer->keep_file("/m/life", std::string(random() % 2000, 'n'));
            }
            writer->work();
            sure = disk.isDead ? sure : asked;
        }
        writer.reset();
        disk.cut_power(random);
        writer = open();
        EXPECT_FALSE(writer->take_trouble().has_value());
        const auto &found = writer->found().run;
        const std::uint64_t block = found.has_value() ? found->progress->block : 0;
        EXPECT_GE(block, sure);
        EXPECT_LE(block, asked);
        const std::string life = disk.files[disk.names["/m/life"]].now;
        EXPECT_TRUE(life == "old" || life == std::string(life.size(), 'n')) << life;
    }
}

/// Texts with increasing numbers: a power failure at any step leaves a complete file and a complete backup.
TEST_F(JournalWriter, WhateverThePowerCutTakesNeitherFileNorBackupIsLostOrHalf) {
    const auto text_of = [](int number) { return std::string(1500, static_cast<char>('a' + number)); };
    const auto number_in = [](const std::string &text) {
        EXPECT_EQ(text.size(), 1500U);
        EXPECT_EQ(text.find_first_not_of(text.front()), std::string::npos);
        return text.front() - 'a';
    };
    int with_backup = 0;
    for (unsigned seed = 0; seed < 2000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(seed);
        disk = {};
        disk.write_outside("/m/p.var", text_of(0));
        auto writer = open();
        disk.steps_left = static_cast<long>(random() % 40);
        int sure = 0, last = 0;
        while (!disk.isDead) {
            writer->keep_file("/m/p.var", text_of(++last), Old::BACKED_UP);
            writer->work();
            sure = disk.isDead ? sure : last;
        }
        writer.reset();
        disk.cut_power(random);
        const int now = number_in(disk.files[disk.names["/m/p.var"]].now);
        EXPECT_GE(now, sure);
        EXPECT_LE(now, last);
        if (disk.names.contains("/m/p.var.bak")) {
            ++with_backup;
            const int before = number_in(disk.files[disk.names["/m/p.var.bak"]].now);
            EXPECT_TRUE(before == now - 1 || before == now) << before << " beside " << now;
        } else {
            EXPECT_EQ(sure, 0);
        }
    }
    EXPECT_GT(with_backup, 1000);
}

TEST(JournalWriterThread, ADiskThatDoesNotAnswerHoldsUpNobodyForLong) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("mw_journal_hung_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    const std::string path = folder / "p.var";
    const auto calls = std::make_shared<test::HungCalls>();
    {
        Writer writer(std::make_unique<test::HungDisk>(calls), "", Works::ALONE);
        EXPECT_TRUE(writer.isSettled(path)) << "nothing was asked";
        writer.keep_file(path, "one");
        calls->isCalled.wait();
        EXPECT_FALSE(writer.isSettled(path));
        EXPECT_EQ(writer.take_delay(1), std::nullopt);
        EXPECT_EQ(writer.take_delay(1000000000), std::nullopt);
        EXPECT_EQ(writer.take_delay(1000000001), "the disk of " + path + " has not answered for 1 s");
        EXPECT_EQ(writer.take_delay(5000000000), std::nullopt) << "it is reported once";
        EXPECT_TRUE(writer.isSettled(path));
        EXPECT_EQ(writer.write_file(path, "two").error().message,
                  "the disk of " + path + " has not answered for 1 s");
        testing::internal::CaptureStderr();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), path + " is not written: its disk does not answer\n");
    calls->isReleased.count_down();
    while (content(path) != "two") {  // otherwise this test times out
        std::this_thread::yield();
    }
    fs::remove_all(folder);
}

TEST(JournalWriterThread, WritesToARealDiskBesideWhoAsks) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("mw_journal_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    std::ofstream(folder / "p.ngc") << "G0 X1\n";
    const std::string path = folder / "j";
    {
        Writer writer(system_disk(), path, Works::ALONE);
        writer.begin({0, folder / "p.ngc", {}, "state"});
        for (std::uint64_t block = 1; block <= 500; ++block) {
            writer.note(at_block(block));
        }
        writer.keep_file(folder / "life", "T1 1 1\n");
    }
    {
        Writer writer(system_disk(), path, Works::ALONE);
        EXPECT_EQ(writer.take_trouble(), std::nullopt);
        ASSERT_TRUE(writer.found().run.has_value());
        EXPECT_EQ(writer.found().run->progress->block, 500U);
        EXPECT_EQ(writer.found().refusal, "");
    }
    EXPECT_EQ(content(folder / "life"), "T1 1 1\n");
    {
        Writer writer(system_disk(), "", Works::ALONE);
        for (int i = 0; i < 200; ++i) {  // an earlier text in the thread must not overwrite it
            writer.keep_file(folder / "p.var", "older");
            ASSERT_TRUE(writer.write_file(folder / "p.var", std::to_string(i)).has_value());
            EXPECT_EQ(content(folder / "p.var"), std::to_string(i));
        }
    }
    EXPECT_EQ(content(folder / "p.var"), "199");
    Writer lost(system_disk(), folder / "none" / "j", Works::ON_CALL);
    lost.begin({0, folder / "p.ngc", {}, "state"});
    lost.work();
    const auto trouble = lost.take_trouble();
    ASSERT_TRUE(trouble.has_value());
    EXPECT_NE(trouble->find("cannot open"), std::string::npos) << *trouble;
    fs::remove_all(folder);
}

}  // namespace
}  // namespace mw::journal

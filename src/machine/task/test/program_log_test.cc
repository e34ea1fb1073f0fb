// SPDX-License-Identifier: GPL-2.0-or-later
// Tests logs of programs on disks that work, are full, or do not answer.
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "machine/task/test/folder.hh"
#include "machine/task/test/hung_disk.hh"

namespace mw::task {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::text_of;

/// Waits until the log has executed its jobs.
void settle(const ProgramLog &log) {
    while (!log.isSettled()) {
        std::this_thread::yield();
    }
}

TEST(ProgramLog, EachLineIsInTheFileAtOnceAndAppendingKeepsWhatIsThere) {
    for (const LogWorks works : {LogWorks::ON_CALL, LogWorks::ALONE}) {
        const Folder folder;
        ProgramLog log(works);
        EXPECT_TRUE(log.write("nowhere").has_value()) << "none is open";
        log.open(folder / "log", false);
        ASSERT_TRUE(log.write("one").has_value());
        settle(log);
        ASSERT_TRUE(log.opened().value().has_value());
        EXPECT_EQ(text_of(folder / "log"), "one\n");
        log.close();
        ASSERT_TRUE(log.write("lost").has_value());
        log.open(folder / "log", true);
        ASSERT_TRUE(log.write("two").has_value());
        settle(log);
        EXPECT_EQ(text_of(folder / "log"), "one\ntwo\n");
        log.open(folder / "log", false);
        settle(log);
        EXPECT_EQ(text_of(folder / "log"), "");
        log.open(folder / "no/such/folder", false);
        settle(log);
        const auto bad = log.opened().value();
        ASSERT_FALSE(bad.has_value());
        EXPECT_NE(bad.error().message.find("cannot write"), std::string::npos);
    }
}

TEST(ProgramLog, AFullDiskIsToldOnce) {
    const Folder folder;
    ProgramLog log(LogWorks::ON_CALL);
    log.open(folder / "log", false);
    ASSERT_TRUE(log.opened().value().has_value());
    // A limit of the process has the same effect as a full disk.
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit none{0, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &none), 0);
    EXPECT_TRUE(log.write("x").has_value());
    EXPECT_TRUE(log.take_failure().has_value());
    EXPECT_TRUE(log.write("y").has_value());
    EXPECT_FALSE(log.take_failure().has_value());
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
}

TEST(ProgramLog, AHungDiskHoldsUpNobodyAndNoLineIsLost) {
    const Folder folder;
    const auto disk = std::make_shared<test::HungDisk>();
    ProgramLog log(LogWorks::ALONE, disk);
    log.open(folder / "log", false);
    std::string expected;
    for (int i = 0; i < 1000; ++i) {
        ASSERT_TRUE(log.write(std::to_string(i)).has_value());
        expected += std::to_string(i) + "\n";
    }
    log.close();
    EXPECT_FALSE(log.opened().has_value());
    EXPECT_FALSE(log.isSettled());
    while (!log.isSettled()) {  // the disk is late
        std::this_thread::yield();
    }
    EXPECT_NE(log.take_delay().value().find("has not answered for 1 s"), std::string::npos);
    EXPECT_FALSE(log.take_delay().has_value()) << "it is reported once";
    disk->release();
    while (text_of(folder / "log") != expected) {  // otherwise this test ends with a timeout
        std::this_thread::yield();
    }
    EXPECT_FALSE(log.take_failure().has_value());
}

TEST(ProgramLog, WhatWaitsForAHungDiskHasALimitAndSoHasItsEnd) {
    const Folder folder;
    const auto disk = std::make_shared<test::HungDisk>();
    const auto begin = std::chrono::steady_clock::now();
    std::size_t bytes = 0;
    {
        ProgramLog log(LogWorks::ALONE, disk);
        log.open(folder / "log", false);
        const std::string line(1000, 'x');
        int taken = 0;
        while (log.write(line).has_value() && taken < 10000) {
            ++taken;
        }
        bytes = static_cast<std::size_t>(taken) * (line.size() + 1);
        EXPECT_LT(taken, 1100) << "1 MB";
        EXPECT_TRUE(log.write(line).has_value()) << "after the error none is open";
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    disk->release();
    while (!fs::exists(folder / "log") ||
           fs::file_size(folder / "log") != bytes) {  // accepted lines are written
        std::this_thread::yield();
    }
}

}  // namespace
}  // namespace mw::task

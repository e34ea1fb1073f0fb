// SPDX-License-Identifier: GPL-2.0-or-later
// Tests records on disk: accepted records survive a kill, torn ends and full disks are handled, the size is
// limited.
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "clients/publish/test/node_world.hh"

namespace mw::publish {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> all_of(const DataLog &log) {
    std::vector<std::string> bytes;
    for (const Record &record : log.read(0, 1'000'000)) {
        bytes.push_back(record.bytes);
    }
    return bytes;
}

TEST(DataLog, KeepsWhatIsNotConfirmedOverAStart) {
    const OwnFolder folder;
    {
        auto log = DataLog::open(folder.path()).value();
        EXPECT_EQ(log.append("a"), 1U);
        log.append("b");
        log.append("c");
        log.confirm(2);
    }
    auto log = DataLog::open(folder.path()).value();
    EXPECT_EQ(all_of(log), (std::vector<std::string>{"b", "c"}));
    EXPECT_EQ(log.newest(), "c");
    log.confirm(4);
    EXPECT_TRUE(all_of(log).empty());
    EXPECT_EQ(log.append("d"), 4U) << "a number is never used again";
    EXPECT_EQ(log.newest(), "d");
}

TEST(DataLog, NeverUsesANumberAgainWhenAllIsConfirmed) {
    const OwnFolder folder;
    for (RecordId expected = 1; expected < 5; ++expected) {
        auto log = DataLog::open(folder.path()).value();
        EXPECT_EQ(log.append("x"), expected);
        log.confirm(expected + 1);
    }
}

TEST(DataLog, EndsBeforeATornRecord) {
    const OwnFolder folder;
    {
        auto log = DataLog::open(folder.path()).value();
        log.append("whole");
        log.append("torn");
    }
    for (const auto &entry : fs::directory_iterator(folder.path())) {
        if (entry.path().extension() == ".log") {
            fs::resize_file(entry.path(), fs::file_size(entry.path()) - 1);
        }
    }
    auto log = DataLog::open(folder.path()).value();
    EXPECT_EQ(all_of(log), std::vector<std::string>{"whole"});
    EXPECT_EQ(log.damaged(), 1U);
    EXPECT_EQ(log.append("next"), 2U);
    EXPECT_EQ(all_of(log), (std::vector<std::string>{"whole", "next"}));
}

TEST(DataLog, FindsADamagedRecordByItsChecksum) {
    const OwnFolder folder;
    {
        auto log = DataLog::open(folder.path()).value();
        log.append("first");
        log.append("second");
    }
    for (const auto &entry : fs::directory_iterator(folder.path())) {
        if (entry.path().extension() == ".log") {
            std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
            file.seekp(-1, std::ios::end);
            file.put('X');
        }
    }
    EXPECT_EQ(all_of(DataLog::open(folder.path()).value()), std::vector<std::string>{"first"});
}

TEST(DataLog, DropsTheOldestBeyondItsSize) {
    const OwnFolder folder;
    auto log = DataLog::open(folder.path(), {.bytes = 4000, .segment_bytes = 1000}).value();
    for (int i = 0; i < 100; ++i) {
        log.append(fmt::format("{:0100}", i));
    }
    const auto left = log.read(0, 1000);
    ASSERT_FALSE(left.empty());
    EXPECT_EQ(left.back().id, 100U);
    EXPECT_EQ(log.dropped(), left.front().id - 1);
    std::uintmax_t size = 0;
    for (const auto &entry : fs::directory_iterator(folder.path())) {
        size += fs::file_size(entry.path());
    }
    EXPECT_LT(size, 6000U);
}

TEST(DataLog, FreesTheDiskOfConfirmedRecords) {
    const OwnFolder folder;
    auto log = DataLog::open(folder.path(), {.bytes = 1'000'000, .segment_bytes = 1000}).value();
    for (int i = 0; i < 100; ++i) {
        log.confirm(log.append(std::string(100, 'x')) + 1);
    }
    const auto files = std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
    EXPECT_LE(files, 4) << "lock, confirmed and the newest files";
    EXPECT_EQ(log.dropped(), 0U);
}

TEST(DataLog, ReadsFromTheDiskWhatIsNoLongerInMemory) {
    const OwnFolder folder;
    auto log = DataLog::open(folder.path(), {.bytes = 100'000'000, .segment_bytes = 100'000}).value();
    const std::size_t count = DataLog::MOST_IN_MEMORY + 500;
    for (std::size_t i = 1; i <= count; ++i) {
        log.append(fmt::format("record {}", i));
    }
    const auto all = log.read(1, count);
    ASSERT_EQ(all.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(all[i].bytes, fmt::format("record {}", i + 1));
    }
}

TEST(DataLog, BelongsToOneProcess) {
    const OwnFolder folder;
    auto log = DataLog::open(folder.path()).value();
    const auto second = DataLog::open(folder.path());
    ASSERT_FALSE(second.has_value());
    EXPECT_NE(second.error().str().find("another publisher uses"), std::string::npos) << second.error().str();
}

TEST(DataLog, KeepsRecordsInMemoryWhenTheDiskTakesNone) {
    const OwnFolder folder;
    auto log = DataLog::open(folder.path(), {.bytes = 1'000'000, .segment_bytes = 10}).value();
    log.append("on the disk, and larger than a file");
    fs::remove_all(folder.path());
    for (int i = 0; i < 20; ++i) {
        log.append("not on the disk");
    }
    EXPECT_NE(log.trouble(), "");
    EXPECT_EQ(all_of(log).back(), "not on the disk");
    fs::create_directories(folder.path());
    log.append("on the disk again");
    EXPECT_EQ(log.trouble(), "");
    EXPECT_EQ(all_of(log).size(), 22U);
}

TEST(LiveData, GivesEachRecordALaterTime) {
    const OwnFolder folder;
    constexpr TimeMs NOW = 1'700'000'000'000;
    {
        LiveData data(DataLog::open(folder.path()).value());
        data.born(played_metrics(), {1.0, std::string("ON"), std::int64_t{0}}, NOW);
        data.add({{0, 2.0}}, NOW);
        data.add({{0, 3.0}}, NOW - 5000);
        const auto records = data.read(1, 10);
        ASSERT_EQ(records.size(), 3U);
        EXPECT_EQ(decode_payload(records[2].bytes)->at, NOW + 2);
        data.confirm(4);
    }
    LiveData data(DataLog::open(folder.path()).value());
    data.born(played_metrics(), {1.0, std::string("ON"), std::int64_t{0}}, NOW - 100'000);
    EXPECT_EQ(data.picture().times[0], NOW + 3) << "also after a start with a clock that was set back";
    EXPECT_EQ(data.ahead_ms(NOW - 100'000), 100'003U);
    EXPECT_EQ(data.ahead_ms(NOW + 5), 0U);
}

}  // namespace
}  // namespace mw::publish

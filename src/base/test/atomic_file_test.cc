// SPDX-License-Identifier: GPL-2.0-or-later
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"

namespace mw {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("mw_atomic_" + std::to_string(::getpid()));
        fs::create_directory(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string path(const char *name) const { return (folder_ / name).string(); }

    fs::path folder_;
};

TEST_F(AtomicFile, WritesWhatIsReadBack) {
    ASSERT_TRUE(write_file_atomically(path("a"), "one").has_value());
    ASSERT_TRUE(write_file_atomically(path("a"), "two").has_value());
    EXPECT_EQ(read_file(path("a")).value(), "two");
}

TEST_F(AtomicFile, KeepsPermissionsAndLeavesNothingBehind) {
    ASSERT_TRUE(write_file_atomically(path("a"), "one").has_value());
    fs::permissions(path("a"), fs::perms::owner_read | fs::perms::owner_write);
    ASSERT_TRUE(write_file_atomically(path("a"), "two").has_value());
    EXPECT_EQ(fs::status(path("a")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(AtomicFile, APipeADeviceAndAFolderAreErrorsAtOnce) {
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    const std::pair<std::string, std::string> places[] = {
        {path("pipe"), "a pipe"}, {"/dev/zero", "a device"}, {folder_.string(), "a folder"}};
    for (const auto &[place, kind] : places) {
        const auto text = read_file(place);
        ASSERT_FALSE(text.has_value()) << place;
        EXPECT_EQ(text.error().message, "'" + place + "' is " + kind + ", not a file");
        const auto written = write_file_atomically(place, "x");
        ASSERT_FALSE(written.has_value()) << place;
        EXPECT_EQ(written.error().message, text.error().message);
        EXPECT_FALSE(open_regular_file(place, O_WRONLY | O_CREAT | O_TRUNC).has_value()) << place;
    }
    fs::create_symlink(path("pipe"), path("link"));
    EXPECT_FALSE(read_file(path("link")).has_value());
}

TEST_F(AtomicFile, AFileThatIsTooLargeIsNotRead) {
    ASSERT_TRUE(write_file_atomically(path("a"), "12345").has_value());
    EXPECT_TRUE(read_file(path("a"), 5).has_value());
    EXPECT_FALSE(read_file(path("a"), 4).has_value());
    fs::resize_file(path("a"), std::uintmax_t{1} << 40);
    const auto text = read_file(path("a"));
    ASSERT_FALSE(text.has_value());
    EXPECT_EQ(text.error().message, path("a") + " is too large: it has more than 512 MB");
}

TEST_F(AtomicFile, AFailureNamesTheFile) {
    const auto result = write_file_atomically(path("missing/a"), "x");
    ASSERT_FALSE(result.has_value());
    EXPECT_NE(result.error().message.find("missing/a"), std::string::npos);
}

TEST_F(AtomicFile, WhatItHadIsInTheBackup_D3) {
    ASSERT_TRUE(write_file_with_backup(path("a"), "one").has_value());
    EXPECT_FALSE(fs::exists(path("a.bak")));
    ASSERT_TRUE(write_file_with_backup(path("a"), "two").has_value());
    EXPECT_EQ(read_file(path("a.bak")).value(), "one");
    ASSERT_TRUE(write_file_with_backup(path("a"), "two").has_value());
    EXPECT_EQ(read_file(path("a.bak")).value(), "one");
    fs::remove(path("a.bak"));
    ASSERT_TRUE(write_file_with_backup(path("a"), "two").has_value());
    EXPECT_EQ(read_file(path("a.bak")).value(), "two");
}

TEST_F(AtomicFile, WithoutAPlaceForTheBackupTheFileIsWrittenAndItIsTold) {
    ASSERT_TRUE(write_file_with_backup(path("a"), "one").has_value());
    fs::create_directory(path("a.bak"));
    const auto result = write_file_with_backup(path("a"), "two");
    ASSERT_FALSE(result.has_value());
    EXPECT_NE(result.error().message.find("a.bak"), std::string::npos) << result.error().message;
    EXPECT_EQ(read_file(path("a")).value(), "two");
}

}  // namespace
}  // namespace mw

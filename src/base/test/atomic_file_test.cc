// SPDX-License-Identifier: GPL-2.0-or-later
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
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

    static std::ptrdiff_t count(const fs::path &folder) {
        return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    }
    /// True while the folder has a temporary file with content, which its writer has locked. An empty file
    /// may not be locked yet, and another writer may remove it.
    bool hasTemporaryFileWithContent() const {
        return std::ranges::any_of(fs::directory_iterator(folder_), [](const fs::directory_entry &entry) {
            std::error_code gone;  // the writer may have renamed it
            const auto size = entry.file_size(gone);
            return entry.path().filename().string().starts_with(".a.millwright-") && !gone && size > 0 &&
                   entry.path().filename() != ".a.millwright-notes";
        });
    }
    /// A process that receives `signal` while it writes content to its temporary file.
    pid_t interrupted_writer(int signal, bool endless) {
        const std::string target = path("a");
        for (int i = 0; i < 200; ++i) {
            const pid_t writer = ::fork();
            if (writer == 0) {
                const std::string content(std::size_t{32} << 20, 'x');
                bool good = true;
                do {
                    good = write_file_atomically(target, content).has_value();
                } while (endless);
                ::_exit(good ? 0 : 1);
            }
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
            while (!hasTemporaryFileWithContent() && std::chrono::steady_clock::now() < end) {
            }
            ::kill(writer, signal);
            int status = 0;
            ::waitpid(writer, &status, WUNTRACED);
            if (hasTemporaryFileWithContent()) {
                return writer;
            }
            ::kill(writer, SIGKILL);
            ::waitpid(writer, &status, 0);
        }
        return 0;
    }

    fs::path folder_;
};

TEST_F(AtomicFile, WhatAKilledWriterLeftIsRemovedByTheNextWrite) {
    ASSERT_TRUE(write_file_atomically(path("a"), "old").has_value());
    for (const char *own : {"a.backup", "a.abc123", ".a.new", ".a.millwright-notes", "b"}) {
        ASSERT_TRUE(write_file_atomically(path(own), "of the user").has_value());
    }
    const auto whole = count(folder_);
    ASSERT_NE(interrupted_writer(SIGKILL, true), 0);
    ASSERT_GT(count(folder_), whole);
    ASSERT_TRUE(write_file_atomically(path("a"), "new").has_value());
    EXPECT_EQ(count(folder_), whole) << "files of the user stay, those of the killed writer do not";
    EXPECT_EQ(read_file(path("a")).value(), "new");
}

TEST_F(AtomicFile, TheFileOfALivingWriterStays) {
    ASSERT_TRUE(write_file_atomically(path("a"), "old").has_value());
    const pid_t writer = interrupted_writer(SIGSTOP, false);
    ASSERT_NE(writer, 0);
    ASSERT_TRUE(write_file_atomically(path("a"), "new").has_value());
    EXPECT_EQ(count(folder_), 2);
    ::kill(writer, SIGCONT);
    int status = -1;
    ::waitpid(writer, &status, 0);
    EXPECT_EQ(status, 0) << "it ends";
    EXPECT_EQ(count(folder_), 1);
    EXPECT_EQ(fs::file_size(path("a")), std::size_t{32} << 20);
}

TEST_F(AtomicFile, AFolderThatIsRenamedMeanwhileHasNothingLeftInIt) {
    ASSERT_TRUE(write_file_atomically(path("a"), "old").has_value());
    const pid_t writer = interrupted_writer(SIGSTOP, false);
    ASSERT_NE(writer, 0);
    const fs::path moved = folder_.string() + "_moved";
    fs::rename(folder_, moved);
    ::kill(writer, SIGCONT);
    int status = -1;
    ::waitpid(writer, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(count(moved), 1);
    EXPECT_EQ(fs::file_size(moved / "a"), std::size_t{32} << 20);
    fs::remove_all(moved);
}

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

TEST_F(AtomicFile, WhatItHadIsInTheBackup) {
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

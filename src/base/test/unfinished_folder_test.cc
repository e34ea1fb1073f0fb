// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/unfinished_folder.hh"

namespace mw {
namespace {

namespace fs = std::filesystem;

struct Place {
    fs::path folder;
    Place() {
        std::string name = (fs::temp_directory_path() / "unfinished-XXXXXX").string();
        EXPECT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
    }
    ~Place() { fs::remove_all(folder); }
    std::string target() const { return (folder / "mill").string(); }
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }
};

TEST(UnfinishedFolder, BecomesTheTargetWithItsContent) {
    const Place place;
    {
        auto folder = UnfinishedFolder::create(place.target());
        ASSERT_TRUE(folder.has_value());
        std::ofstream(folder->path() + "/mill.ini") << "[EMC]\n";
        EXPECT_FALSE(fs::exists(place.target()));
        EXPECT_TRUE(folder->become_target());
    }
    EXPECT_TRUE(fs::exists(place.target() + "/mill.ini"));
    EXPECT_EQ(place.entries(), 1U);
}

TEST(UnfinishedFolder, IsRemovedWithoutBecomingTheTarget) {
    const Place place;
    {
        const auto folder = UnfinishedFolder::create(place.target());
        std::ofstream(folder->path() + "/mill.ini") << "[EMC]\n";
    }
    EXPECT_EQ(place.entries(), 0U);
}

TEST(UnfinishedFolder, OfAKilledProcessIsRemovedByTheNextOne) {
    const Place place;
    const pid_t child = ::fork();
    if (child == 0) {
        const auto folder = UnfinishedFolder::create(place.target());
        std::ofstream(folder->path() + "/mill.ini") << "[EMC]\n" << std::flush;
        ::_exit(0);  // ends without destructors, as after SIGKILL
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(place.entries(), 1U);
    auto folder = UnfinishedFolder::create(place.target());
    ASSERT_TRUE(folder.has_value());
    EXPECT_TRUE(folder->become_target());
    EXPECT_EQ(place.entries(), 1U);
}

TEST(UnfinishedFolder, OfALivingProcessStays) {
    const Place place;
    const auto first = UnfinishedFolder::create(place.target());
    const auto second = UnfinishedFolder::create(place.target());
    ASSERT_TRUE(second.has_value());
    EXPECT_TRUE(fs::exists(first->path()));
    EXPECT_NE(first->path(), second->path());
}

TEST(UnfinishedFolder, ATargetWithContentIsNotReplaced) {
    const Place place;
    fs::create_directory(place.target());
    std::ofstream(place.target() + "/old.ini") << "[EMC]\n";
    auto folder = UnfinishedFolder::create(place.target());
    EXPECT_FALSE(folder->become_target());
    EXPECT_TRUE(fs::exists(place.target() + "/old.ini"));
}

}  // namespace
}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/whole_path.hh"

namespace mw {
namespace {

namespace fs = std::filesystem;

TEST(WholePath, AFileThatIsALinkKeepsItsFolder) {
    std::string name = fs::canonical(fs::temp_directory_path()).string() + "/whole_pathXXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    const fs::path folder(name);
    fs::create_directories(folder / "machine");
    std::ofstream(folder / "shared.ini") << "[EMC]\n";
    fs::create_symlink("../shared.ini", folder / "machine" / "own.ini");
    fs::create_directory_symlink("machine", folder / "other");
    EXPECT_EQ(whole_path(name + "/machine/own.ini"), name + "/machine/own.ini");
    EXPECT_EQ(whole_path(name + "/other/own.ini"), name + "/machine/own.ini");
    EXPECT_EQ(whole_path(name + "/other/../shared.ini"), name + "/shared.ini");
    EXPECT_EQ(whole_path(name + "/none.ini"), name + "/none.ini");
    fs::remove_all(folder);
}

}  // namespace
}  // namespace mw

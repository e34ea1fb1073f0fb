// SPDX-License-Identifier: GPL-2.0-or-later
// Tests [DISPLAY]LOG_FILE (J1).
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "clients/screen/files/message_log.hh"

namespace mw::screen {
namespace {

std::string content(const std::string &path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string stamp(std::time_t when) {
    std::tm local{};
    ::localtime_r(&when, &local);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &local)};
}

class MessageLogTest : public testing::Test {
  protected:
    MessageLogTest() {
        const auto *info = testing::UnitTest::GetInstance()->current_test_info();
        folder = std::filesystem::temp_directory_path() /
                 (std::string("mw_log_") + info->name() + std::to_string(::getpid()));
        std::filesystem::create_directories(folder);
        path = (folder / "machine.log").string();
    }
    ~MessageLogTest() override { std::filesystem::remove_all(folder); }

    std::filesystem::path folder;
    std::string path;
};

TEST_F(MessageLogTest, EachMessageIsALineBehindThoseOfBefore) {
    std::ofstream(path) << "of another day\n";
    MessageLog log(path);
    ASSERT_TRUE(log.add(1700000000, "ERROR: joint 0 following error").has_value());
    ASSERT_TRUE(log.add(1700000001, "TEXT: two\nlines\n").has_value());
    EXPECT_EQ(content(path), "of another day\n" + stamp(1700000000) + " ERROR: joint 0 following error\n" +
                                 stamp(1700000001) + " TEXT: two / lines\n");
}

TEST_F(MessageLogTest, ALongFileBecomesTheOneOfBefore) {
    MessageLog log(path, 100);
    for (int i = 0; i < 7; ++i) {
        ASSERT_TRUE(log.add(i, "message " + std::to_string(i)).has_value());
    }
    EXPECT_EQ(content(path), stamp(6) + " message 6\n");
    EXPECT_EQ(content(path + ".1"),
              stamp(3) + " message 3\n" + stamp(4) + " message 4\n" + stamp(5) + " message 5\n");
}

TEST_F(MessageLogTest, AFileThatCannotBeWrittenIsTold) {
    MessageLog log("/nowhere/at/all.log");
    const auto added = log.add(0, "x");
    ASSERT_FALSE(added.has_value());
    EXPECT_NE(added.error().message.find("/nowhere/at/all.log: No such file or directory"), std::string::npos)
        << added.error().message;
}

}  // namespace
}  // namespace mw::screen

// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "hal/include/inifile.h"

extern "C" {
int level_of_name(const char *name, int *level);
int level_of_stream(FILE *stream, int *level);
int text_of_name(char *name, char *text, size_t n);
const char *find_in_name(const char *name);
}

namespace {

class IniApi : public testing::Test {
  protected:
    IniApi() {
        name = (std::filesystem::temp_directory_path() / "ini-api-XXXXXX").string();
        ::close(::mkstemp(name.data()));
        std::ofstream(name) << "[A]\nLEVEL = 17\nWIDE = 5000000000\nTEXT = seven c\nON = yes\nREAL = 2.5\n";
    }
    ~IniApi() override { std::filesystem::remove(name); }

    std::string name;
};

TEST_F(IniApi, AFileIsAStreamOrANameInC) {
    int level = 0;
    EXPECT_EQ(level_of_name(name.c_str(), &level), 0);
    EXPECT_EQ(level, 17);
    level = 0;
    const std::unique_ptr<FILE, int (*)(FILE *)> stream(std::fopen(name.c_str(), "r"), std::fclose);
    ASSERT_TRUE(stream);
    EXPECT_EQ(level_of_stream(stream.get(), &level), 0);
    EXPECT_EQ(level, 17);
    char text[8] = "";
    EXPECT_EQ(text_of_name(name.data(), text, sizeof text), 0);
    EXPECT_STREQ(text, "seven c");
    EXPECT_EQ(text_of_name(name.data(), text, sizeof text - 1), -ENOSPC);
    EXPECT_STREQ(find_in_name(name.c_str()), "seven c");
}

TEST_F(IniApi, ValuesByNameAreTyped) {
    int level = 3;
    EXPECT_EQ(iniFindInt(name.c_str(), "WIDE", "A", &level), -EINVAL);
    EXPECT_EQ(iniFindInt(name.c_str(), "TEXT", "A", &level), -EINVAL);
    EXPECT_EQ(iniFindInt(name.c_str(), "LEVEL", "B", &level), -ENOENT);
    EXPECT_EQ(iniFindInt((name + ".none").c_str(), "LEVEL", "A", &level), -ENOENT);
    EXPECT_EQ(level, 3) << "left alone";
    rtapi_sint wide = 0;
    EXPECT_EQ(iniFindSInt(name.c_str(), "WIDE", nullptr, &wide), 0);
    EXPECT_EQ(wide, 5000000000);
    rtapi_uint positive = 0;
    EXPECT_EQ(iniFindUInt(name.c_str(), "LEVEL", "A", &positive), 0);
    EXPECT_EQ(positive, 17U);
    bool on = false;
    EXPECT_EQ(iniFindBool(name.c_str(), "ON", "A", &on), 0);
    EXPECT_TRUE(on);
    double real = 0.0;
    EXPECT_EQ(iniFindDouble(name.c_str(), "REAL", "A", &real), 0);
    EXPECT_EQ(real, 2.5);
    EXPECT_EQ(iniFind((name + ".none").c_str(), "LEVEL", "A"), nullptr);
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "base/text.hh"
#include "motion/interface/screw_file.hh"

namespace mw::motion {
namespace {

auto parsed(const std::string &text, ScrewFileType type = ScrewFileType::OFFSET) {
    return parse_screw_file(text, "x.comp", 2, type);
}
std::string error_of(const std::string &text, ScrewFileType type = ScrewFileType::OFFSET) {
    const auto points = parsed(text, type);
    return points.has_value() ? "none" : points.error().str();
}

TEST(ScrewFile, BothFileTypesAreRead) {
    const auto actual =
        parsed("-1.000 -1.005 -0.995\n0.000 0.002 -0.003\n1.000 1.003 0.998\n", ScrewFileType::ACTUAL);
    ASSERT_TRUE(actual.has_value());
    ASSERT_EQ(actual->size(), 3U);
    EXPECT_NEAR((*actual)[0].forward, 0.005, 1e-12) << "it comes out too low: more is added";
    EXPECT_NEAR((*actual)[0].reverse, -0.005, 1e-12);
    EXPECT_NEAR((*actual)[2].reverse, 0.002, 1e-12);
    EXPECT_EQ((*actual)[2].joint, 2);
    EXPECT_EQ((*actual)[2].index, 2);
    EXPECT_EQ((*actual)[0].count, 3);
    const auto offset =
        parsed("# X, laser of May\r\n\n  -1\t0.005 -0.005\r\n0 0.002 -0.003 # middle\n1 0.003 -0.004");
    ASSERT_TRUE(offset.has_value());
    EXPECT_EQ((*offset)[0].forward, 0.005);
    EXPECT_EQ((*offset)[2].reverse, -0.004);
}

TEST(ScrewFile, ErrorsAreReportedWithLineAndColumn) {
    EXPECT_NE(error_of("0 0 0\n1 0.1 x7\n").find("x.comp:2:7: 'x7' is not a number"), std::string::npos);
    EXPECT_NE(error_of("0 0 0\n1 nan 0\n").find("x.comp:2:3: 'nan' is not a number"), std::string::npos);
    EXPECT_NE(error_of("0,0,0\n").find("x.comp:1:1: '0,0,0' is not a number"), std::string::npos);
    EXPECT_NE(error_of("0 0 0\n\n1 0\n").find("x.comp:3:4: 2 of three numbers"), std::string::npos);
    EXPECT_NE(error_of("0 0 0 0\n").find("x.comp:1:7: more than three numbers"), std::string::npos);
    EXPECT_NE(error_of("0 0 0\n0 0 0\n").find("x.comp:2:1: the position 0 is not above 0"),
              std::string::npos);
    EXPECT_NE(error_of("0 0 0\n-1 0 0\n").find("x.comp:2:1: the position -1 is not above 0"),
              std::string::npos);
    EXPECT_NE(error_of("# nothing\n").find("no point"), std::string::npos);
    EXPECT_NE(error_of("").find("no point"), std::string::npos);
}

TEST(ScrewFile, AFileOfTheOtherTypeIsDetectedByItsSlope) {
    EXPECT_NE(error_of("0 0 0\n10 10.001 9.999\n", ScrewFileType::OFFSET).find("x.comp:2:4: the correction"),
              std::string::npos);
    EXPECT_NE(error_of("0 0 0\n10 0.001 9.999\n").find("x.comp:2:10: the correction"), std::string::npos)
        << "only the reverse column";
    EXPECT_NE(error_of("0 0 0\n10 0.001 -0.001\n", ScrewFileType::ACTUAL).find("COMP_FILE_TYPE"),
              std::string::npos);
}

TEST(ScrewFile, TenThousandPointsAreAcceptedAndNoMore) {
    std::string text;
    for (int n = 0; n < MAX_SCREW_POINTS; ++n) {
        text += std::to_string(n) + " 0.01 -0.01\n";
    }
    ASSERT_TRUE(parsed(text).has_value());
    EXPECT_EQ(parsed(text)->size(), 10000U);
    EXPECT_NE(error_of(text + "10000 0.01 -0.01\n").find("x.comp:10001: more than 10000 points"),
              std::string::npos);
}

TEST(ScrewFile, AMissingFileIsReportedWithoutWaiting) {
    EXPECT_FALSE(read_screw_file("/dev/zero", 0, ScrewFileType::ACTUAL).has_value());
    EXPECT_FALSE(read_screw_file(std::filesystem::temp_directory_path().string(), 0, ScrewFileType::ACTUAL)
                     .has_value());
    const auto missing = read_screw_file("not-there.comp", 0, ScrewFileType::ACTUAL);
    ASSERT_FALSE(missing.has_value());
    EXPECT_NE(missing.error().str().find("not-there.comp"), std::string::npos);
}

}  // namespace
}  // namespace mw::motion

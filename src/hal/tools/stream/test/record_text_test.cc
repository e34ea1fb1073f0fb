// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "hal/tools/stream/record_text.hh"

namespace mw::hal::stream_tools {
namespace {

const std::vector<hal_type_t> TYPES{HAL_FLOAT, HAL_BIT, HAL_S32, HAL_U32};

TEST(RecordText, WritesSixDecimalsAndABlankBehindEachField) {
    hal_stream_data_u record[4]{};
    record[0].f = -0.25;
    record[1].b = true;
    record[2].s = -7;
    record[3].u = 4294967295U;
    EXPECT_EQ(format_record(TYPES, record), "-0.250000 1 -7 4294967295 ");
}

TEST(RecordText, ReadsWhatItWritesAndIgnoresTheRest) {
    const auto record = parse_record(TYPES, "  4.2e1\t0 0x10 7   # a comment");
    ASSERT_TRUE(record.has_value());
    EXPECT_EQ((*record)[0].f, 42.0);
    EXPECT_FALSE((*record)[1].b);
    EXPECT_EQ((*record)[2].s, 16);
    EXPECT_EQ((*record)[3].u, 7U);
}

TEST(RecordText, SaysWhichFieldIsWrong) {
    EXPECT_EQ(parse_record(TYPES, "1 0 2").error().message, "expected 4 fields, found 3");
    EXPECT_EQ(parse_record(TYPES, "1,5 0 2 3").error().message, "field 1: '1,5' is not a number");
    EXPECT_EQ(parse_record(TYPES, "1 2 2 3").error().message, "field 2: '2' is not 0 or 1");
    EXPECT_EQ(parse_record(TYPES, "1 1 3000000000 3").error().message,
              "field 3: '3000000000' is not an integer");
    EXPECT_FALSE(parse_record(TYPES, "1 1 3 -3").has_value());
}

TEST(RecordText, SkipsCommentsAndEmptyLines) {
    EXPECT_TRUE(isSkipped("# 1 2"));
    EXPECT_TRUE(isSkipped(" \t"));
    EXPECT_FALSE(isSkipped("1 # 2"));
}

}  // namespace
}  // namespace mw::hal::stream_tools

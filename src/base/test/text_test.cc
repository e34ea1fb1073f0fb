// SPDX-License-Identifier: GPL-2.0-or-later
#include <clocale>

#include <gtest/gtest.h>

#include "base/text.hh"

namespace mw {
namespace {

TEST(Text, NumbersAreReadWholeOrNotAtAll) {
    EXPECT_EQ(parse_double(".15"), 0.15);
    EXPECT_EQ(parse_double("4.2e1"), 42.0);
    EXPECT_EQ(parse_double("+3"), 3.0);
    for (const char *bad : {"", "1,5", "1.5mm", "nan", "inf", "1e999", "+-1", "0x"}) {
        EXPECT_FALSE(parse_double(bad).has_value()) << bad;
    }
    EXPECT_EQ(parse_int("0x10"), 16);
    EXPECT_EQ(parse_uint("18446744073709551615"), 18446744073709551615ULL);
    EXPECT_FALSE(parse_int("9223372036854775808").has_value());
    EXPECT_FALSE(parse_uint("-1").has_value());
}

TEST(Text, TheLocaleDoesNotMatter_A8) {
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    EXPECT_EQ(parse_double("1.5"), 1.5);
    EXPECT_EQ(to_text(1.5), "1.5");
    std::setlocale(LC_ALL, "C");
}

TEST(Text, NearestNameIsOfferedOnlyWhenNear) {
    EXPECT_EQ(nearest_name("MAX_VELOCTY", {"MIN_LIMIT", "MAX_VELOCITY"}), "MAX_VELOCITY");
    EXPECT_EQ(nearest_name("ABC", {"MIN_LIMIT", "MAX_VELOCITY"}), "");
}

}  // namespace
}  // namespace mw

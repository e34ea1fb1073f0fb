// SPDX-License-Identifier: GPL-2.0-or-later
#include <array>
#include <bit>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "base/own_place.hh"
#include "base/short_text.hh"
#include "base/text.hh"
#include "base/utf8.hh"

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
    EXPECT_EQ(parse_int("-0x10"), -16);
    EXPECT_EQ(parse_int("+0X1f"), 31);
    EXPECT_EQ(parse_int("010"), 10);
    EXPECT_EQ(parse_int("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
    for (const char *bad : {"", "+", "-", "+-1", "--1", "0x", "0x-1", "0xg", "1 ", "-9223372036854775809"}) {
        EXPECT_FALSE(parse_int(bad).has_value()) << bad;
        EXPECT_FALSE(parse_c_int(bad).has_value()) << bad;
        EXPECT_FALSE(parse_c_uint(bad).has_value()) << bad;
        EXPECT_EQ(parse_uint(bad), std::nullopt) << bad;
    }
}

TEST(Text, NumbersAsInCMayBeHexadecimalOrOctal) {
    EXPECT_EQ(parse_c_int("-010"), -8);
    EXPECT_EQ(parse_c_int("-0x10"), -16);
    EXPECT_EQ(parse_c_uint("-0"), 0U);
    EXPECT_EQ(parse_c_uint("0xffffffffffffffff"), ~0ULL);
    EXPECT_FALSE(parse_c_int("08").has_value());
    EXPECT_EQ(parse_c_double("-0x10"), -16.0);
    EXPECT_EQ(parse_c_double("0x1.8p1"), 3.0);
    EXPECT_EQ(parse_c_double("010"), 10.0);
    EXPECT_EQ(parse_c_double("1e-400"), 0.0);
    for (const char *bad :
         {"", "-", "+-1", "0x", "0x-1", "-0x-1", "1e400", "-1e400", "0x1p4000", "inf", "-nan"}) {
        EXPECT_FALSE(parse_c_double(bad).has_value()) << bad;
    }
}

TEST(Text, AWordOfAShellIsQuotedWhereItMustBe) {
    EXPECT_EQ(shell_word("/home/me/mill_2.ini"), "/home/me/mill_2.ini");
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_EQ(shell_word("my mill"), "'my mill'");
    EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
}

TEST(Text, TheLocaleDoesNotMatter) {
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    EXPECT_EQ(parse_double("1.5"), 1.5);
    EXPECT_EQ(to_text(1.5), "1.5");
    std::setlocale(LC_ALL, "C");
}

std::string fixed4(double value) {
    std::array<char, FIXED4_SIZE> text{};
    return {text.data(), write_fixed4(text, value)};
}

std::string printf_fixed4(double value) {
    std::array<char, FIXED4_SIZE> text{};
    return {text.data(), static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.4f", value))};
}

TEST(Text, FourDecimalsOfSpecialValuesAreThoseOfPrintf) {
    using Limits = std::numeric_limits<double>;
    for (const double value : {0.0,
                               0.5,
                               0.00005,
                               0.00015,
                               0.03125,
                               0.5 / 65536,
                               1.00005,
                               12345.67895,
                               9999.99995,
                               99999.99999,
                               1e9,
                               9999999999.9999,
                               9999999999.99995,
                               1e10,
                               1e14,
                               1e15,
                               1e16,
                               1e18,
                               1e19,
                               1e22,
                               1e300,
                               Limits::max(),
                               Limits::min(),
                               Limits::denorm_min(),
                               Limits::infinity(),
                               Limits::quiet_NaN()}) {
        for (const double one :
             {value, -value, std::nextafter(value, 1e308), std::nextafter(value, -1e308)}) {
            EXPECT_EQ(fixed4(one), printf_fixed4(one));
        }
    }
}

TEST(Text, FourDecimalsOfAnyValueAreThoseOfPrintf) {
    static constexpr unsigned SEED = 4;
    constexpr int COUNT = 300000;
    std::mt19937_64 random(SEED);
    const auto pick = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto check = [](double value) {
        // EXPECT_EQ on each value would take most of the time.
        if (fixed4(value) != printf_fixed4(value)) {
            ADD_FAILURE() << "seed " << SEED << ": " << to_text(value) << " is " << fixed4(value);
        }
    };
    for (int i = 0; i < COUNT; ++i) {
        const double size = std::pow(10.0, pick(-6.0, 16.0));
        check(pick(-size, size));
        check(std::round(pick(-1e6, 1e6)) / 1000.0);  // typical values of programs
        // The doubles nearest to ties of the fifth decimal, and their neighbours on both sides.
        const double tie = (std::floor(pick(0.0, std::fmin(size * 1e4, 4e15))) + 0.5) / 1e4;
        check(tie);
        check(std::nextafter(tie, 0.0));
        check(-std::nextafter(tie, 1e300));
        check(tie + pick(-2e-7, 2e-7));
        // Exact ties: odd multiples of 1/32, which end in 5 at the fifth decimal.
        check(std::floor(pick(-1e9, 1e9)) / 32.0);
        check(std::bit_cast<double>(random()));
    }
}

TEST(Text, PrintableTextSteersNoTerminal) {
    using namespace std::string_literals;
    EXPECT_EQ(printable("a\x1b[2J\tb\n\x7f\r\0c"s), "a?[2J\tb\n???c");
    EXPECT_EQ(printable("gr\xC3\xB6\xC3\x9F"
                        "e \xC2\x9B"
                        "1m"),
              "gr\xC3\xB6\xC3\x9F"
              "e ??1m");
    EXPECT_EQ(printable("\xC2"), "\xC2");
}

TEST(Text, NearestNameIsOfferedOnlyWhenNear) {
    EXPECT_EQ(nearest_name("MAX_VELOCTY", {"MIN_LIMIT", "MAX_VELOCITY"}), "MAX_VELOCITY");
    EXPECT_EQ(nearest_name("ABC", {"MIN_LIMIT", "MAX_VELOCITY"}), "");
}

TEST(Memory, ItsEndIsToldAndNoCrash) {
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    GTEST_SKIP() << "the sanitizer has a separate heap, which calls no handler";
#endif
#endif
    EXPECT_EXIT(
        {
            tell_when_memory_ends();
            // More than any address space.
            volatile std::size_t size = static_cast<std::size_t>(-1) / 4;
            ::operator delete(::operator new(size));
        },
        testing::ExitedWithCode(1), "no memory left");
}

TEST(Text, AMessageQuotesTheStartOfALongTextOnly) {
    EXPECT_EQ(short_text(std::string(1000, 'x')), std::string(1000, 'x'));
    EXPECT_EQ(short_text(std::string(1001, 'x')), std::string(300, 'x') + "...");
    EXPECT_EQ(short_text(std::string(299, 'x') + "\xc3\xa4" + std::string(1000, 'y')),
              std::string(299, 'x') + "...");
}

TEST(Utf8, FindsTheFirstCharacter) {
    const std::pair<std::string_view, std::pair<std::size_t, char32_t>> cases[] = {
        {"a\xC3", {1, U'a'}},
        {"\xC3\xA4x", {2, 0xE4}},
        {"\xE2\x82\xAC", {3, 0x20AC}},
        {"\xF0\x9F\x94\xA9", {4, 0x1F529}},
        {"\xC3", {0, 0}},
        {"\xC0\xAF", {0, 0}},
        {"\xE0\x80\x80", {0, 0}},
        {"\xED\xA0\x80", {0, 0}},
        {"\xF4\x90\x80\x80", {0, 0}},
        {"\x80", {0, 0}},
        {"\xC3(", {0, 0}}};
    for (const auto &[text, expected] : cases) {
        const Utf8Character found = first_character(text);
        EXPECT_EQ(found.size, expected.first) << text;
        EXPECT_EQ(found.code, expected.second) << text;
    }
}

}  // namespace
}  // namespace mw

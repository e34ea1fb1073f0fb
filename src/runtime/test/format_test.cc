// SPDX-License-Identifier: GPL-2.0-or-later
#include <clocale>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "runtime/format.hh"

namespace mw::runtime {
namespace {

std::string ours(const char *format, ...) {
    char text[600];
    va_list args;
    va_start(args, format);
    format_text(text, sizeof text, format, args);
    va_end(args);
    return text;
}

#define EXPECT_SAME(...)                                                                                     \
    do {                                                                                                     \
        char text[600];                                                                                      \
        std::snprintf(text, sizeof text, __VA_ARGS__);                                                       \
        EXPECT_EQ(ours(__VA_ARGS__), text);                                                                  \
    } while (false)

TEST(Format, PrintsAsPrintfDoes) {
    EXPECT_SAME("plain %% text");
    EXPECT_SAME("%d %i %5d|%-5d|%05d|%+d|% d|%.3d", 1, -2, 3, 4, -5, 6, 7, 8);
    EXPECT_SAME("%u %x %X %#x %#o %08x", 1U, 0xabcU, 0xabcU, 0xabcU, 8U, 0x12U);
    EXPECT_SAME("%ld %lld %lu %llx %zu %hd %hhd", -1L, -2LL, 3UL, 4ULL, std::size_t{5}, 6, 7);
    EXPECT_SAME("%lld", std::numeric_limits<long long>::min());
    EXPECT_SAME("%s|%10s|%-10s|%.2s|%c|%3c", "abc", "abc", "abc", "abc", 'x', 'y');
    EXPECT_SAME("%*d|%-*d|%.*f", 6, 1, 6, 2, 3, 1.5);
    EXPECT_SAME("%f %.3f %10.2f|%-10.2f|%010.2f|%+f", 1.5, 2.25, -3.125, 4.5, -5.5, 6.5);
    EXPECT_SAME("%e %.2E %g %G %.10g", 12345.678, 0.00012, 1e-5, 1e10, 0.1);
    EXPECT_SAME("%f %g %5.1f", HUGE_VAL, -HUGE_VAL, -HUGE_VAL);
    EXPECT_EQ(ours("%s", static_cast<const char *>(nullptr)), "(null)");
}

TEST(Format, AgreesOnRandomNumbers) {
    const unsigned seed = 20;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (int i = 0; i < 2000; ++i) {
        const double value = std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())),
                                        static_cast<int>(random() % 60) - 90);
        const int precision = static_cast<int>(random() % 12);
        EXPECT_SAME("%.*f|%.*g|%.*e", precision, value, precision, value, precision, value);
        const auto bits = static_cast<unsigned long long>(random());
        EXPECT_SAME("%llx %lld", bits, static_cast<long long>(bits));
    }
}

TEST(Format, CutsAndTellsTheWholeLength) {
    char text[6] = "xxxxx";
    const auto put = [&](std::size_t size, const char *format, ...) {
        va_list args;
        va_start(args, format);
        const int length = format_text(text, size, format, args);
        va_end(args);
        return length;
    };
    EXPECT_EQ(put(4, "%s", "abcdef"), 6);
    EXPECT_STREQ(text, "abc");
    EXPECT_EQ(text[4], 'x');
    EXPECT_EQ(put(0, "%d", 12), 2);
    EXPECT_STREQ(text, "abc");
}

TEST(Format, KnowsNoLocale) {
    // A system may not have this locale; the test then checks less.
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    EXPECT_EQ(ours("%.1f", 1.5), "1.5");
    std::setlocale(LC_ALL, "C");
}

}  // namespace
}  // namespace mw::runtime

// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "gcode/interpreter/expressions/degrees.hh"

namespace mw::gcode::detail {
namespace {

constexpr long double DEGREE = std::numbers::pi_v<long double> / 180.0L;

TEST(Degrees, ExactValuesAreExact) {
    EXPECT_EQ(sine_of_degrees(30), 0.5);
    EXPECT_EQ(sine_of_degrees(-150), -0.5);
    EXPECT_EQ(cosine_of_degrees(60), 0.5);
    EXPECT_EQ(cosine_of_degrees(120), -0.5);
    EXPECT_EQ(tangent_of_degrees(45), 1.0);
    EXPECT_EQ(tangent_of_degrees(-45), -1.0);
    EXPECT_EQ(sine_of_degrees(90), 1.0);
    EXPECT_EQ(cosine_of_degrees(720), 1.0);
}

TEST(Degrees, FollowTheLibraryInLongDouble) {
    std::mt19937 random(7);
    // One unit in the last place, plus the library's rounding of the angle.
    const auto isNear = [](double found, long double wanted, long double angle) {
        const long double allowed = std::numeric_limits<double>::epsilon() * std::fabs(wanted) +
                                    std::numeric_limits<long double>::epsilon() * std::fabs(angle);
        return std::fabs(found - wanted) <= allowed;
    };
    for (int i = 0; i < 200000; ++i) {
        const double size = i % 4 == 0 ? 5e6 : i % 4 == 1 ? 720.0 : i % 4 == 2 ? 90.0 : 1e-3;
        const double degrees = std::uniform_real_distribution<double>(-size, size)(random);
        const long double angle = degrees * DEGREE;
        EXPECT_TRUE(isNear(sine_of_degrees(degrees), std::sin(angle), angle)) << degrees;
        EXPECT_TRUE(isNear(cosine_of_degrees(degrees), std::cos(angle), angle)) << degrees;
    }
    for (const double degrees : {180.0, -180.0, 90.0, 270.0, 450.0, 3600000.0}) {
        EXPECT_EQ(sine_of_degrees(degrees), static_cast<double>(std::sin(degrees * DEGREE)));
        EXPECT_EQ(cosine_of_degrees(degrees), static_cast<double>(std::cos(degrees * DEGREE)));
        EXPECT_EQ(tangent_of_degrees(degrees), static_cast<double>(std::tan(degrees * DEGREE)));
    }
    EXPECT_TRUE(std::isnan(sine_of_degrees(std::numeric_limits<double>::quiet_NaN())));
    EXPECT_TRUE(std::isnan(cosine_of_degrees(std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/expressions/degrees.hh"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace mw::gcode::detail {
namespace {

constexpr long double DEGREE = std::numbers::pi_v<long double> / 180.0L;
// degrees; full revolutions of smaller angles are removed without rounding
constexpr double LARGEST_REDUCED = 1e6;
constexpr long double NEAR_ZERO = 1e-3L;  // below this the rounding of the angle matters
constexpr std::size_t TERMS = 10;         // up to 45 degrees the next term is below 1e-20

/// Coefficients of the Taylor series in x^2: 1/first!, -1/(first + 2)!, ...
constexpr std::array<long double, TERMS> taylor(int first) {
    std::array<long double, TERMS> out{};
    long double term = 1.0L;
    for (std::size_t i = 0; i < TERMS; ++i) {
        out[i] = term;
        const long double k = first + 2.0L * static_cast<long double>(i);
        term /= -(k + 1.0L) * (k + 2.0L);
    }
    return out;
}

/// Even and odd terms separately, so that they do not depend on each other.
long double sum(const std::array<long double, TERMS> &factors, long double square) {
    static_assert(TERMS % 2 == 0);
    const long double fourth = square * square;
    long double even = factors[TERMS - 2], odd = factors[TERMS - 1];
    for (std::size_t i = TERMS - 2; i > 0; i -= 2) {
        even = even * fourth + factors[i - 2];
        odd = odd * fourth + factors[i - 1];
    }
    return even + odd * square;
}

/// Sine of the angle plus `right_angles` * 90 degrees.
long double sine(double degrees, int right_angles) {
    static constexpr auto SINE = taylor(1), COSINE = taylor(0);
    constexpr double RIGHT_ANGLE = 90.0;
    constexpr double ROUNDER =
        0x1.8p52;  // doubles of this size are whole numbers, so adding it rounds to a whole number
    const double turns = (degrees / RIGHT_ANGLE + ROUNDER) - ROUNDER;
    const long double x = (degrees - turns * RIGHT_ANGLE) * DEGREE;
    const int quadrant = (static_cast<int>(turns) + right_angles) & 3;
    const long double value = (quadrant & 1) != 0 ? sum(COSINE, x * x) : sum(SINE, x * x) * x;
    return (quadrant & 2) != 0 ? -value : value;
}

bool isReducible(double degrees) {
    return std::fabs(degrees) < LARGEST_REDUCED;
}

}  // namespace

double sine_of_degrees(double degrees) {
    const long double value = isReducible(degrees) ? sine(degrees, 0) : 0.0L;
    return static_cast<double>(std::fabs(value) < NEAR_ZERO ? std::sin(degrees * DEGREE) : value);
}

double cosine_of_degrees(double degrees) {
    const long double value = isReducible(degrees) ? sine(degrees, 1) : 0.0L;
    return static_cast<double>(std::fabs(value) < NEAR_ZERO ? std::cos(degrees * DEGREE) : value);
}

double tangent_of_degrees(double degrees) {
    const long double s = isReducible(degrees) ? sine(degrees, 0) : 0.0L;
    const long double c = isReducible(degrees) ? sine(degrees, 1) : 0.0L;
    const bool near = std::fabs(s) < NEAR_ZERO || std::fabs(c) < NEAR_ZERO;
    return static_cast<double>(near ? std::tan(degrees * DEGREE) : s / c);
}

}  // namespace mw::gcode::detail

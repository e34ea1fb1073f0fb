// SPDX-License-Identifier: GPL-2.0-or-later
// Temperatures of type K thermocouples. Polynomials: NIST ITS-90 Thermocouple Database (SRD 60), with errors
// below 0.06 degrees. Realtime-safe.
#pragma once

#include <cmath>
#include <span>

namespace mw::thermocouple {

constexpr double LOWEST_C = -200.0;  ///< valid range of the inverse polynomials
constexpr double HIGHEST_C = 1350.0;

inline double polynomial(std::span<const double> coefficients, double x) noexcept {
    double sum = 0.0;
    for (std::size_t i = coefficients.size(); i > 0; --i) {
        sum = sum * x + coefficients[i - 1];
    }
    return sum;
}

/// The voltage of a thermocouple at `celsius` with its reference junction at 0 degrees [mV].
inline double type_k_mv(double celsius) noexcept {
    constexpr double BELOW[] = {0.0,
                                0.394501280250e-01,
                                0.236223735980e-04,
                                -0.328589067840e-06,
                                -0.499048287770e-08,
                                -0.675090591730e-10,
                                -0.574103274280e-12,
                                -0.310888728940e-14,
                                -0.104516093650e-16,
                                -0.198892668780e-19,
                                -0.163226974860e-22};
    constexpr double ABOVE[] = {-0.176004136860e-01, 0.389212049750e-01,  0.185587700320e-04,
                                -0.994575928740e-07, 0.318409457190e-09,  -0.560728448890e-12,
                                0.560750590590e-15,  -0.320207200030e-18, 0.971511471520e-22,
                                -0.121047212750e-25};
    if (celsius < 0.0) {
        return polynomial(BELOW, celsius);
    }
    const double distance = celsius - 126.9686;
    return polynomial(ABOVE, celsius) + 0.118597600000 * std::exp(-0.118343200000e-03 * distance * distance);
}

/// The temperature that gives `mv`; NaN outside LOWEST_C to HIGHEST_C.
inline double type_k_celsius(double mv) noexcept {
    constexpr double COLD[] = {0.0,           2.5173462e1,   -1.1662878,    -1.0833638,   -8.9773540e-1,
                               -3.7342377e-1, -8.6632643e-2, -1.0450598e-2, -5.1920577e-4};
    constexpr double WARM[] = {0.0,          2.508355e1,  7.860106e-2,  -2.503131e-1, 8.315270e-2,
                               -1.228034e-2, 9.804036e-4, -4.413030e-5, 1.057734e-6,  -1.052755e-8};
    constexpr double HOT[] = {-1.318058e2,  4.830222e1,  -1.646031,   5.464731e-2,
                              -9.650715e-4, 8.802193e-6, -3.110810e-8};
    constexpr double LOWEST_MV = -5.891;
    constexpr double WARM_MV = 20.644;
    constexpr double HIGHEST_MV = 54.138;
    if (!(mv >= LOWEST_MV && mv <= HIGHEST_MV)) {
        return NAN;
    }
    return mv < 0.0 ? polynomial(COLD, mv) : (mv < WARM_MV ? polynomial(WARM, mv) : polynomial(HOT, mv));
}

}  // namespace mw::thermocouple

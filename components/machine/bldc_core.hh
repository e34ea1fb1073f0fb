// SPDX-License-Identifier: GPL-2.0-or-later
// Commutation of three-phase motors, without HAL. Angles are electrical, in turns from 0 to 1. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::bldc {

constexpr int PATTERNS = 48;
constexpr int SECTORS = 6;

/// The fractional part of `turns` above the next lower whole number; 0 for NaN.
double fraction(double turns) noexcept;

/// The hall sensors (H1 is bit 2, H3 bit 0) in sector `sector` of commutation pattern `pattern`. As source
/// and sink, the sectors are B-A, C-A, C-B, A-B, A-C, B-C.
unsigned hall_of_sector(int pattern, int sector) noexcept;

/// The sector with these hall sensors, or -1.
int sector_of_hall(int pattern, unsigned hall) noexcept;

/// The sector for a field at the angle `phase`.
int sector_of_phase(double phase) noexcept;

struct Phases {
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
};

/// Sinusoidal phase voltages for a field at `phase`.
Phases sine(double phase, double amplitude) noexcept;
/// One phase is the source, one the sink, and one is off.
Phases trapezoid(int sector, double amplitude) noexcept;

}  // namespace mw::bldc

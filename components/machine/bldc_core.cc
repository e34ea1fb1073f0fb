// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/machine/bldc_core.hh"

#include <cmath>
#include <numbers>

namespace mw::bldc {

namespace {

// In octal: the sensors H1 H2 H3 of the six sectors in order. LinuxCNC configurations use this numbering of
// the patterns.
constexpr std::uint32_t PATTERN_TABLE[PATTERNS] = {
    0013764, 0102675, 0023754, 0132645, 0231546, 0320457, 0201576, 0310467, 0015762, 0104673,
    0026751, 0137640, 0237540, 0326451, 0204573, 0315462, 0045732, 0154623, 0046731, 0157620,
    0267510, 0376401, 0264513, 0375402, 0457320, 0546231, 0467310, 0576201, 0675102, 0764013,
    0645132, 0754023, 0451326, 0540237, 0462315, 0573204, 0673104, 0762015, 0640137, 0751026,
    0401376, 0510267, 0402375, 0513264, 0623154, 0732045, 0620157, 0731046};

}  // namespace

double fraction(double turns) noexcept {
    const double part = turns - std::floor(turns);
    return part >= 0.0 && part < 1.0 ? part : 0.0;
}

unsigned hall_of_sector(int pattern, int sector) noexcept {
    const int shift = 3 * (SECTORS - 1 - sector);
    return PATTERN_TABLE[pattern] >> shift & 7U;
}

int sector_of_hall(int pattern, unsigned hall) noexcept {
    for (int sector = 0; sector < SECTORS; ++sector) {
        if (hall_of_sector(pattern, sector) == hall) {
            return sector;
        }
    }
    return -1;
}

int sector_of_phase(double phase) noexcept {
    // B-A is the field around 150 degrees and C-A the field around 210 degrees: with the lead of 90 degrees
    // they start at 1/6 turn.
    const int sixth = static_cast<int>(fraction(phase) * SECTORS);
    return (sixth + SECTORS - 1) % SECTORS;
}

Phases sine(double phase, double amplitude) noexcept {
    const double angle = 2.0 * std::numbers::pi * phase;
    const double third = 2.0 * std::numbers::pi / 3.0;
    return {amplitude * std::cos(angle), amplitude * std::cos(angle - third),
            amplitude * std::cos(angle + third)};
}

Phases trapezoid(int sector, double amplitude) noexcept {
    constexpr int SOURCE[SECTORS] = {1, 2, 2, 0, 0, 1};
    constexpr int SINK[SECTORS] = {0, 0, 1, 1, 2, 2};
    double phase[3] = {0.0, 0.0, 0.0};
    phase[SOURCE[sector]] = amplitude;
    phase[SINK[sector]] = -amplitude;
    return {phase[0], phase[1], phase[2]};
}

}  // namespace mw::bldc

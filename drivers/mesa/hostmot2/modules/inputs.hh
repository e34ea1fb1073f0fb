// SPDX-License-Identifier: GPL-2.0-or-later
// Input modules with filters and hand wheel counters: InMux scans external multiplexers, InM scans pins. Both
// have the same registers: shared/hardware.md, part B7.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

constexpr std::size_t MAX_SCANNED = 32, HAND_WHEELS = 4;

/// Values of one module. Only the first scan_width inputs exist.
struct InputsPins {
    std::array<bool, MAX_SCANNED> input{}, input_not{}, raw{}, raw_not{}, slow{};
    std::array<std::int32_t, HAND_WHEELS> count{};
    std::array<bool, HAND_WHEELS> reset{}, four_x{};
    std::uint32_t scan_rate = 20'000;                ///< of all inputs [Hz]
    std::uint32_t fast_scans = 5, slow_scans = 500;  ///< filter times [scans]
    std::uint32_t scan_width = 0;
};

constexpr PinRow<InputsPins> INPUTS_PARAMS[] = {
    {"scan_rate", Access::RW, &InputsPins::scan_rate},
    {"fast_scans", Access::RW, &InputsPins::fast_scans},
    {"slow_scans", Access::RW, &InputsPins::slow_scans},
    {"scan_width", Access::RO, &InputsPins::scan_width},
};

/// The last read counts of the hand wheels.
struct InputsState {
    std::uint32_t counters = 0;
    bool known = false;
};

/// The width that the control register shows, from 1 to 32.
std::uint32_t inputs_width(std::uint32_t control_register) noexcept;
/// The control register. Parameters outside the range of the module are limited.
std::uint32_t inputs_control(InputsPins &pins, std::uint32_t clock_hz) noexcept;
/// A bit for each input with the slow filter.
std::uint32_t inputs_filter(const InputsPins &pins) noexcept;
/// A byte for each hand wheel: 1 counts each edge.
std::uint32_t inputs_wheel_modes(const InputsPins &pins) noexcept;

/// Processes the registers of filtered and raw inputs.
void inputs_show(InputsPins &pins, std::uint32_t filtered, std::uint32_t raw) noexcept;
/// Processes the register of four 8-bit counters. A wheel may make up to 127 counts in a cycle.
void inputs_count(InputsState &state, InputsPins &pins, std::uint32_t counters) noexcept;

}  // namespace mw::mesa

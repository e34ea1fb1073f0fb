// SPDX-License-Identifier: GPL-2.0-or-later
// InM and InMux: inputs with filters and MPG counters. Source: shared/hardware.md, part B7. The scan rate is
// derived from the values that LinuxCNC's hm2_eth writes: ClockLow / (4 * (divisor + 1) * inputs).
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

constexpr unsigned MPG_COUNTERS = 4;

/// The registers that set the filters.
struct InputSettings {
    std::uint32_t control = 0;  ///< 15 to 6 divisor, 21 to 16 fast scans, 31 to 22 slow scans
    std::uint32_t slow = 0;     ///< the inputs that use the slow scans
};

/// Time for which a level must be stable before an input takes it.
std::int64_t filter_ns(const InputSettings &settings, unsigned input, unsigned inputs,
                       std::uint32_t clock_hz);

/// A counter of two inputs A and B, 8 bits.
struct MpgCounter {
    std::uint8_t count = 0;
    bool counts_all_edges = false;  ///< counts all edges (4x); else the edges of A while B is low
};
/// A changes ahead of B when it counts upwards.
void move_mpg(MpgCounter &counter, unsigned from_ab, unsigned to_ab);

/// Registers: control (bits 4 to 0 highest input), inputs with the slow filter, filtered levels, raw levels,
/// MPG counters (a byte each; bit 0 of the byte written: 4x). Counter n has inputs 2n and 2n + 1, after their
/// filters.
class InputModule final : public Module {
  public:
    /// The levels of all inputs, one bit each.
    using Levels = std::function<std::uint32_t()>;
    InputModule(unsigned inputs, std::uint32_t clock_hz) : inputs_(inputs), clock_hz_(clock_hz) {}
    void connect(Levels levels) { levels_ = std::move(levels); }

    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override;
    void sample() override { sample_levels(); }
    unsigned registers() const override { return 5; }

  private:
    static constexpr unsigned MAX_INPUTS = 32;
    void sample_levels();
    void take_filtered(std::uint32_t levels);

    unsigned inputs_;
    std::uint32_t clock_hz_;
    InputSettings settings_;
    std::uint32_t filtered_ = 0;
    std::array<std::optional<std::int64_t>, MAX_INPUTS> differs_since_ns_{};
    std::array<MpgCounter, MPG_COUNTERS> counters_{};
    bool sampled_ = false;
    std::int64_t time_ns_ = 0;
    Levels levels_;
};

}  // namespace mw::mesa::board

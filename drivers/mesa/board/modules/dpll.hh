// SPDX-License-Identifier: GPL-2.0-or-later
// The digital phase-locked loop that follows the reads of the host, and its four timers. Source:
// shared/hardware.md, part B8. The filter of the real loop is not described there: this one is a proportional
// and integral controller that settles within some tens of cycles.
#pragma once

#include <array>
#include <optional>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

/// The phase counts periods: at whole numbers the loop expects a read of the sync register.
struct Dpll {
    std::uint32_t base_rate = 0, control0 = 0, control1 = 0;
    std::array<std::uint16_t, 4> timers{};
    double phase = 0;       ///< at `time_ns` [periods]
    double correction = 0;  ///< correction of the frequency, as a fraction of it
    std::int64_t time_ns = 0;
    std::int32_t phase_error = 0;  ///< at the last sync [periods / 2^32]
};

/// [Hz]; 0: off
double base_frequency(const Dpll &dpll, std::uint32_t clock_hz);

/// Registers: base rate, phase error, control 0 (prescale, limit), control 1 (time constant), timers 2:1,
/// timers 4:3, sync.
class DpllModule final : public Module {
  public:
    explicit DpllModule(std::uint32_t clock_hz) : clock_hz_(clock_hz) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override;
    unsigned registers() const override { return 7; }

    /// The last time in (from_ns, to_ns] at which timer 1 to 4 fires.
    std::optional<std::int64_t> last_fire_ns(unsigned timer, std::int64_t to_ns) const;
    /// True once after each read of the sync register.
    bool take_sync();

  private:
    double frequency_hz() const;

    Dpll dpll_;
    std::uint32_t clock_hz_;
    bool synced_ = false;
};

}  // namespace mw::mesa::board

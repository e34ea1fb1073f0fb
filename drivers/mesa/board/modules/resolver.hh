// SPDX-License-Identifier: GPL-2.0-or-later
// Resolver inputs: the angle of each of six channels and its change. Sources: shared/hardware.md, part B10;
// the scales are those by which LinuxCNC's hm2_eth reads the registers.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

constexpr unsigned RESOLVER_CHANNELS = 6;

/// Registers: command (0x800 + 1 to 3 sets the excitation to ClockLow / 20000, 10000, 5000; reads 0 when
/// done), data, status (bit n: channel n has no signal), then of each channel velocity (part of a revolution
/// in one period of the excitation, in 2^-32) and position (part of a revolution, in 2^-32). Both are sampled
/// with each period.
class ResolverModule final : public Module {
  public:
    explicit ResolverModule(std::uint32_t clock_hz) : clock_hz_(clock_hz) {}
    /// Electrical revolutions of a channel at the current time; empty: not connected.
    using Angle = std::function<std::optional<double>(unsigned channel)>;
    void connect(Angle angle) { angle_ = std::move(angle); }

    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    void sample() override;
    unsigned registers() const override { return 5; }
    unsigned words(unsigned reg) const override { return reg < 3 ? 1 : RESOLVER_CHANNELS; }

    std::int64_t excitation_period_ns() const;

  private:
    struct Channel {
        double rev = 0;
        std::uint32_t position = 0, velocity = 0;
    };
    std::array<Channel, RESOLVER_CHANNELS> channels_{};
    Angle angle_;
    std::uint32_t clock_hz_, command_ = 0, data_ = 0, status_ = (1U << RESOLVER_CHANNELS) - 1,
                             divider_ = 10'000;
    std::int64_t time_ns_ = 0, sampled_ns_ = 0, done_ns_ = 0;
};

}  // namespace mw::mesa::board

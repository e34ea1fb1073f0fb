// SPDX-License-Identifier: GPL-2.0-or-later
// Encoder counters. Source: shared/hardware.md, part B5, with the control bits as measured on the RTL. The
// index is high for one count in each revolution. Index mask, gating by A and B, filter and counter mode have
// no effect.
#pragma once

#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

constexpr unsigned ENCODER_REGISTERS = 6;

/// The bits of the control register.
struct EncoderControl {
    static constexpr std::uint32_t QUADRATURE_ERROR = 1U << 15U, LATCH_ON_PROBE = 1U << 13U,
                                   PROBE_POLARITY = 1U << 12U, ONCE = 1U << 6U, CLEAR_ON_INDEX = 1U << 5U,
                                   LATCH_ON_INDEX = 1U << 4U, INDEX_POLARITY = 1U << 3U, INDEX_LEVEL = 4,
                                   B_LEVEL = 2, A_LEVEL = 1;
    /// The bits that a host writes; the other bits are levels.
    static constexpr std::uint32_t WRITABLE = 0x7FF8;
};

/// The position of the shaft in counts; the index is at `index_count` + n * `counts_per_rev`.
struct Shaft {
    std::int64_t count = 0;
    std::int64_t index_count = 0;
    std::int64_t counts_per_rev = 0;  ///< 0: no index
};

/// A uniform movement of the shaft.
struct ShaftMove {
    std::int64_t from_count = 0, to_count = 0;
    std::int64_t from_ns = 0, to_ns = 0;
};

/// One counter.
struct Encoder {
    std::uint32_t control = 0;
    std::int64_t zero = 0;  ///< the shaft count at which the counter reads 0
    Shaft shaft;
    std::uint16_t latch = 0;
    std::int64_t last_edge_ns = 0;
    bool probe = false;  ///< level of the probe input
};

bool index_level(const Shaft &shaft, std::int64_t count);
std::uint16_t counter_of(const Encoder &encoder);
/// The value of the counter when the shaft was at `count`.
std::uint16_t counter_at(const Encoder &encoder, std::int64_t count);
/// Moves the shaft; the index latches or clears the counter during the move. The run time does not depend on
/// the length of the move.
void move_shaft(Encoder &encoder, const ShaftMove &move);
/// Sets the level of the probe input; its active edge latches the counter.
void set_probe(Encoder &encoder, bool level);
/// Bits 2 to 0 of the control register.
std::uint32_t input_levels(const Encoder &encoder);

/// All encoders of a firmware. Registers: count and time stamp, latch and control, divider of the time stamp,
/// time stamp, filter rate, DPLL timer; the last four exist once.
class EncoderModule final : public Module {
  public:
    EncoderModule(unsigned instances, std::uint32_t clock_hz);
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    void latch(unsigned timer) override;
    void input(unsigned unit, std::uint8_t function, bool level) override;
    unsigned registers() const override { return ENCODER_REGISTERS; }

    std::vector<Encoder> &encoders() { return encoders_; }
    const std::vector<Encoder> &encoders() const { return encoders_; }

  private:
    std::uint32_t count_register(const Encoder &encoder) const;
    std::uint32_t time_stamp(std::int64_t time_ns) const;

    std::vector<Encoder> encoders_;
    std::vector<std::uint32_t> latched_counts_;
    std::uint32_t clock_hz_;
    std::uint32_t divider_ = 0, filter_rate_ = 0;
    LatchTimer timer_;
    std::int64_t time_ns_ = 0;
};

}  // namespace mw::mesa::board

// SPDX-License-Identifier: GPL-2.0-or-later
// Fields in the answer of a serial absolute encoder, and an encoder in one of them.
#pragma once

#include <cstdint>
#include <span>

namespace mw::mesa {

constexpr int MAX_FIELD_BITS = 64;

enum class BitFieldType : std::uint8_t {
    PADDING,
    BIT,
    UNSIGNED,
    SIGNED,
    BITS,
    ENCODER,
    ENCODER_LOW,
    ENCODER_HIGH
};

struct BitField {
    BitFieldType type = BitFieldType::PADDING;
    int first = 0, bits = 0;
    bool gray = false, multi_turn = false;
};

/// The bits of a field in words, the first word with the lowest bits; Gray code is converted.
std::uint64_t bits_of(const BitField &field, std::span<const std::uint32_t> words) noexcept;
/// The two's complement number of a field.
std::int64_t signed_bits(std::uint64_t value, int bits) noexcept;

/// An absolute encoder with the behaviour of an incremental one.
struct AbsoluteEncoder {
    std::int32_t count = 0, rawcounts = 0;
    double position = 0.0;  ///< [position units]
    bool index_enable = false, reset = false;
    double scale = 1.0;  ///< [counts per unit]
    std::uint32_t counts_per_rev = 256;

    std::int64_t raw = 0, zero = 0;  ///< between cycles
    std::uint64_t last = 0;
    bool known = false;
};
/// Processes the value of a field. The first value is a signed number, as in LinuxCNC's driver; with
/// `isMultiTurn` all values are. Otherwise a jump of more than half of the range is a wrap. The index is at
/// multiples of counts_per_rev of the raw counts.
void absolute_encoder_read(AbsoluteEncoder &encoder, std::uint64_t value, const BitField &field) noexcept;

}  // namespace mw::mesa

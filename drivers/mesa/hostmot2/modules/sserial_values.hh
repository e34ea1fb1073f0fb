// SPDX-License-Identifier: GPL-2.0-or-later
// The process data of a smart serial card as pins, and the words that are exchanged with it.
// Source: shared/hardware.md, part B9.
#pragma once

#include <vector>

#include "drivers/mesa/hostmot2/modules/sserial_records.hh"
#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

/// One bit. An output is on when `value` differs from `invert`.
struct SserialBit {
    bool value = false, inverse = true, invert = false;
};
/// A number that the card stores as a fraction of its range: `scale_max` is the end of the range. An output
/// is limited to min_limit ... max_limit.
struct SserialNumber {
    double value = 0.0;
    double scale_max = 1.0, max_limit = 1.0, min_limit = 0.0;
};
/// Bits without a meaning for the driver.
struct SserialStream {
    std::uint32_t value = 0;
};
/// An encoder whose card sends the low bits of its count.
struct SserialCounter {
    std::int32_t count = 0, rawcounts = 0;
    double position = 0.0;
    bool index_enable = false, reset = false;
    double scale = 1.0;
    std::uint32_t counts_per_rev = 256;
    // State
    std::int64_t total = 0, zero = 0;
    std::uint64_t last = 0;
};
constexpr PinRow<SserialCounter> SSERIAL_COUNTER_PINS[] = {
    {"count", Access::OUT, &SserialCounter::count},
    {"rawcounts", Access::OUT, &SserialCounter::rawcounts},
    {"position", Access::OUT, &SserialCounter::position},
    {"index-enable", Access::IO, &SserialCounter::index_enable},
    {"reset", Access::IO, &SserialCounter::reset},
    {"scale", Access::RW, &SserialCounter::scale},
    {"counts-per-rev", Access::RW, &SserialCounter::counts_per_rev},
};

/// Type of the pins of a field.
enum class FieldPins : std::uint8_t { NONE, BITS, BOOLEAN, UNSIGNED, SIGNED, REAL, STREAM, COUNTER };

/// A field of process data and its values.
struct SserialField {
    FieldPins pins = FieldPins::NONE;
    FieldDirection direction = FieldDirection::INPUT;
    std::string name;  ///< in lower case
    int bits = 0;
    int low_bits = 0;        ///< low bits from the second half of an encoder, in input_low
    int input = -1;          ///< first bit in the words from the card; -1: none
    int input_low = -1;      ///< input with the second half of an encoder
    int output = -1;         ///< first bit in the words to the card; -1: none
    std::size_t index = 0;   ///< index of its first value in the list of its type
    std::uint64_t held = 0;  ///< bits that remain off until their pin was off
    float min = 0.0F, max = 0.0F;

    bool hasInput() const noexcept { return input >= 0; }
    bool hasOutput() const noexcept { return output >= 0; }
};

/// All values of a card. The lists do not grow after make_sserial_card().
struct SserialCardValues {
    std::vector<SserialField> fields;
    std::vector<SserialBit> bits;
    std::vector<SserialNumber> numbers;
    std::vector<SserialStream> streams;
    std::vector<SserialCounter> counters;
};

/// The fields of a description with their default values. [while loading]
SserialCardValues make_sserial_card(const std::vector<DataRecord> &process, const ProcessLayout &layout);
/// A name in the form of pin names. [while loading]
std::string lower_case(std::string_view text);

/// Takes the words of a card. [servo thread]
void sserial_read(SserialCardValues &card, std::span<const std::uint32_t> words) noexcept;
/// Fills the words for a card. [servo thread]
void sserial_write(SserialCardValues &card, std::span<std::uint32_t> words) noexcept;
/// Switches all outputs off. Each output follows its pin again after the pin was off once. [servo thread]
void hold_outputs(SserialCardValues &card) noexcept;
/// All outputs follow their pins again. [servo thread]
void release_outputs(SserialCardValues &card) noexcept;

/// The bits of a number with `bits` bits (1 to 64): unsigned numbers are 0 to all bits set, signed ones use
/// the highest 2^31 - 1 or the highest bits of it, so that LinuxCNC's rounding is kept. NaN and a scale of 0
/// give 0. [any thread]
std::uint64_t unsigned_bits(const SserialNumber &number, int bits) noexcept;
std::uint64_t signed_bits(const SserialNumber &number, int bits) noexcept;
/// The number of bits from a card; 0 when it is not finite. [any thread]
double unsigned_number(std::uint64_t raw, int bits, double scale_max) noexcept;
double signed_number(std::uint64_t raw, int bits, double scale_max) noexcept;
/// Extends the count from its low bits, resets the position, and processes the index: with index-enable, the
/// multiple of counts-per-rev that was passed becomes 0. [servo thread]
void count_encoder(SserialCounter &counter, std::uint64_t raw, int bits) noexcept;

}  // namespace mw::mesa

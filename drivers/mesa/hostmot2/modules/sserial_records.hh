// SPDX-License-Identifier: GPL-2.0-or-later
// The description of process data in a smart serial card: records in its memory, listed by two tables (PTOC:
// process data and modes; GTOC: all). Source: shared/hardware.md, part B9.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::mesa {

/// Reads one byte of the memory of a card. [while loading]
using ReadCardByte = std::function<Result<std::uint8_t>(std::uint16_t address)>;

enum class FieldType : std::uint8_t {
    PAD = 0,
    BITS = 1,
    UNSIGNED = 2,
    SIGNED = 3,
    NV_UNSIGNED = 4,
    NV_SIGNED = 5,
    STREAM = 6,
    BOOLEAN = 7,
    ENCODER = 8,
    FLOAT = 0x10,
    NV_FLOAT = 0x11,
    ENCODER_HIGH = 0x18,
    ENCODER_LOW = 0x28,
};
/// As seen by the host: an input is data that the card sends.
enum class FieldDirection : std::uint8_t { INPUT = 0, BOTH = 0x40, OUTPUT = 0x80 };

/// A field of process data, or a parameter.
struct DataRecord {
    int bits = 0;
    FieldType type = FieldType::PAD;
    FieldDirection direction = FieldDirection::INPUT;
    float min = 0.0F, max = 0.0F;
    std::uint16_t value_address = 0;
    std::string unit, name;     ///< as in the card
    std::uint16_t address = 0;  ///< address of the record

    bool operator==(const DataRecord &) const = default;
};
/// A set of process data that the card offers.
struct ModeRecord {
    int index = 0;
    bool is_software = false;
    std::string name;

    bool operator==(const ModeRecord &) const = default;
};

struct CardRecords {
    std::vector<DataRecord> process;     ///< in the order of the PTOC
    std::vector<DataRecord> parameters;  ///< records in the GTOC and not in the PTOC
    std::vector<ModeRecord> modes;
};

/// Reads all records of a card. An error names the address of data that cannot be read or are not a record.
/// [while loading]
Result<CardRecords> read_card_records(const ReadCardByte &read, std::uint16_t ptoc, std::uint16_t gtoc);

/// The position of a field in the words that are exchanged.
struct FieldPosition {
    int record = 0;  ///< index in CardRecords::process
    int first_bit = 0;
};
/// Positions of inputs and outputs, which are packed separately, each from bit 0 in the order of the PTOC. A
/// field in both directions has a position in both.
struct ProcessLayout {
    std::vector<FieldPosition> inputs, outputs;
    int input_bits = 0, output_bits = 0;
};
/// An error when the data do not fit into `most_bits`. [while loading]
Result<ProcessLayout> process_layout(const std::vector<DataRecord> &process, int most_bits);

/// `bits` (1 to 64) of words of 32 bit, from bit `first`. [any thread]
std::uint64_t field_bits(std::span<const std::uint32_t> words, int first, int bits) noexcept;
/// Replaces these bits. [any thread]
void set_field_bits(std::span<std::uint32_t> words, int first, int bits, std::uint64_t value) noexcept;

}  // namespace mw::mesa

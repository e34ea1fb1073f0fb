// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_records.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <variant>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

constexpr std::uint8_t DATA_MARK = 0xA0, MODE_MARK = 0xB0, SOFTWARE_MODE = 1;
constexpr int MAX_RECORDS = 256, MAX_TEXT = 64, MAX_FIELD_BITS = 64, WORD_BITS = 32;

using Record = std::variant<DataRecord, ModeRecord>;

Result<std::vector<std::uint8_t>> read_bytes(const ReadCardByte &read, std::uint16_t address, int count) {
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < count; ++i) {
        const auto byte = read(static_cast<std::uint16_t>(address + i));
        if (!byte) {
            return std::unexpected(byte.error());
        }
        bytes.push_back(*byte);
    }
    return bytes;
}

/// Reads a text that ends with 0; `address` moves after it.
Result<std::string> read_text(const ReadCardByte &read, std::uint16_t &address) {
    const std::uint16_t start = address;
    std::string text;
    while (static_cast<int>(text.size()) <= MAX_TEXT) {
        const auto byte = read(address++);
        if (!byte) {
            return std::unexpected(byte.error());
        }
        if (*byte == 0) {
            return text;
        }
        text += static_cast<char>(*byte);
    }
    return fail(fmt::format("the text at 0x{:04X} has more than {} characters", start, MAX_TEXT));
}

std::uint16_t word16(std::span<const std::uint8_t> bytes) noexcept {
    return static_cast<std::uint16_t>(bytes[0] | (bytes[1] << 8U));
}

float real32(std::span<const std::uint8_t> bytes) noexcept {
    return std::bit_cast<float>(word16(bytes) | (std::uint32_t{word16(bytes.subspan(2))} << 16U));
}

Result<Record> read_data_record(const ReadCardByte &read, std::uint16_t address) {
    constexpr int LENGTH = 14;
    const auto bytes = read_bytes(read, address, LENGTH);
    if (!bytes) {
        return std::unexpected(bytes.error());
    }
    const std::span<const std::uint8_t> all = *bytes;
    DataRecord record;
    record.address = address;
    record.bits = all[1];
    record.type = static_cast<FieldType>(all[2]);
    record.direction = static_cast<FieldDirection>(all[3]);
    record.min = real32(all.subspan(4));
    record.max = real32(all.subspan(8));
    record.value_address = word16(all.subspan(12));
    auto at = static_cast<std::uint16_t>(address + LENGTH);
    for (std::string *text : {&record.unit, &record.name}) {
        auto one = read_text(read, at);
        if (!one) {
            return std::unexpected(one.error());
        }
        *text = std::move(*one);
    }
    if (record.bits > MAX_FIELD_BITS) {
        return fail(fmt::format("the record {} at 0x{:04X} has {} bits; at most {} are possible", record.name,
                                address, record.bits, MAX_FIELD_BITS));
    }
    return record;
}

Result<Record> read_record(const ReadCardByte &read, std::uint16_t address) {
    constexpr int MODE_LENGTH = 4;
    const auto mark = read(address);
    if (!mark) {
        return std::unexpected(mark.error());
    }
    if (*mark == DATA_MARK) {
        return read_data_record(read, address);
    }
    if (*mark != MODE_MARK) {
        return fail(fmt::format("no record at 0x{:04X}: it begins with 0x{:02X}", address, *mark));
    }
    const auto bytes = read_bytes(read, address, MODE_LENGTH);
    if (!bytes) {
        return std::unexpected(bytes.error());
    }
    auto at = static_cast<std::uint16_t>(address + MODE_LENGTH);
    auto name = read_text(read, at);
    if (!name) {
        return std::unexpected(name.error());
    }
    return ModeRecord{(*bytes)[1], (*bytes)[2] == SOFTWARE_MODE, std::move(*name)};
}

/// The addresses of a table, which ends with 0.
Result<std::vector<std::uint16_t>> read_table(const ReadCardByte &read, std::uint16_t table) {
    std::vector<std::uint16_t> addresses;
    while (table != 0 && static_cast<int>(addresses.size()) < MAX_RECORDS) {
        const auto at = static_cast<std::uint16_t>(table + 2 * addresses.size());
        const auto bytes = read_bytes(read, at, 2);
        if (!bytes) {
            return std::unexpected(bytes.error());
        }
        const std::uint16_t address = word16(*bytes);
        if (address == 0) {
            return addresses;
        }
        addresses.push_back(address);
    }
    if (table != 0) {
        return fail(fmt::format("the table at 0x{:04X} has no end", table));
    }
    return addresses;
}

void keep(CardRecords &records, std::vector<DataRecord> &list, Record record) {
    if (auto *data = std::get_if<DataRecord>(&record)) {
        list.push_back(std::move(*data));
        return;
    }
    const auto &mode = std::get<ModeRecord>(record);
    if (std::ranges::find(records.modes, mode) == records.modes.end()) {
        records.modes.push_back(mode);
    }
}

}  // namespace

Result<CardRecords> read_card_records(const ReadCardByte &read, std::uint16_t ptoc, std::uint16_t gtoc) {
    CardRecords records;
    const auto process = read_table(read, ptoc);
    if (!process) {
        return std::unexpected(process.error());
    }
    const auto all = read_table(read, gtoc);
    if (!all) {
        return std::unexpected(all.error());
    }
    for (const std::uint16_t address : *process) {
        auto record = read_record(read, address);
        if (!record) {
            return std::unexpected(record.error());
        }
        keep(records, records.process, std::move(*record));
    }
    for (const std::uint16_t address : *all) {
        if (std::ranges::find(*process, address) != process->end()) {
            continue;
        }
        auto record = read_record(read, address);
        if (!record) {
            return std::unexpected(record.error());
        }
        keep(records, records.parameters, std::move(*record));
    }
    return records;
}

Result<ProcessLayout> process_layout(const std::vector<DataRecord> &process, int most_bits) {
    ProcessLayout layout;
    int number = 0;
    for (const DataRecord &record : process) {
        if (record.direction != FieldDirection::OUTPUT) {
            layout.inputs.push_back({number, layout.input_bits});
            layout.input_bits += record.bits;
        }
        if (record.direction != FieldDirection::INPUT) {
            layout.outputs.push_back({number, layout.output_bits});
            layout.output_bits += record.bits;
        }
        ++number;
    }
    if (std::max(layout.input_bits, layout.output_bits) > most_bits) {
        return fail(fmt::format("{} bits of inputs and {} of outputs; this firmware exchanges {} each way",
                                layout.input_bits, layout.output_bits, most_bits));
    }
    return layout;
}

std::uint64_t field_bits(std::span<const std::uint32_t> words, int first, int bits) noexcept {
    std::uint64_t value = 0;
    for (int i = 0; i < bits; ++i) {
        const int at = first + i;
        const auto word = static_cast<std::size_t>(at / WORD_BITS);
        if (word < words.size()) {
            value |= std::uint64_t{(words[word] >> static_cast<unsigned>(at % WORD_BITS)) & 1U}
                     << static_cast<unsigned>(i);
        }
    }
    return value;
}

void set_field_bits(std::span<std::uint32_t> words, int first, int bits, std::uint64_t value) noexcept {
    for (int i = 0; i < bits; ++i) {
        const int at = first + i;
        const auto word = static_cast<std::size_t>(at / WORD_BITS);
        if (word < words.size()) {
            const std::uint32_t bit = 1U << static_cast<unsigned>(at % WORD_BITS);
            const bool set = ((value >> static_cast<unsigned>(i)) & 1U) != 0;
            words[word] = set ? words[word] | bit : words[word] & ~bit;
        }
    }
}

}  // namespace mw::mesa

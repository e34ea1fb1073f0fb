// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/remote.hh"

#include <algorithm>
#include <bit>

#include "base/text.hh"

namespace mw::mesa::board {

namespace {

using enum FieldType;
using enum FieldDirection;

constexpr std::uint8_t DATA_RECORD = 0xA0, MODE_RECORD = 0xB0, SOFTWARE_MODE = 1;
/// Address of the description; the values are at lower addresses.
constexpr std::uint16_t DESCRIPTION = 0x100;
/// Address of the globals, and the size of each [bytes].
constexpr std::uint16_t GLOBAL_VALUES = 0x80, GLOBAL_BYTES = 4;

constexpr RemoteField FIELDS_7I76[] = {
    {"Output", "None", 16, BITS, OUTPUT, 0, 0},
    {"Input", "None", 32, BITS, INPUT, 0, 0},
    {"SpinOut", "Percent", 16, UNSIGNED, OUTPUT, 0, 100},
    {"SpinEna", "None", 1, BOOLEAN, OUTPUT, 0, 0},
    {"SpinDir", "None", 1, BOOLEAN, OUTPUT, 0, 0},
    {"AnalogIn0", "Volts", 12, UNSIGNED, INPUT, 0, 36.3F, 1},
    {"AnalogIn1", "Volts", 12, UNSIGNED, INPUT, 0, 36.3F, 1},
    {"AnalogIn2", "Volts", 12, UNSIGNED, INPUT, 0, 36.3F, 1},
    {"AnalogIn3", "Volts", 12, UNSIGNED, INPUT, 0, 36.3F, 1},
    {"Enc0", "None", 8, ENCODER, INPUT, 0, 0, 2},
    {"Enc1", "None", 8, ENCODER, INPUT, 0, 0, 2},
};
constexpr RemoteMode MODES_7I76[] = {{"I/O_Spin", 0}, {"I/O_Spin_Ana", 1}, {"I/O_Spin_Ana_Enc", 2}};

/// The 7I77 has two channels: field inputs and outputs, and analog outputs.
constexpr RemoteField FIELDS_7I77[] = {
    {"Output", "None", 16, BITS, OUTPUT, 0, 0},
    {"Input", "None", 32, BITS, INPUT, 0, 0},
};
constexpr RemoteField FIELDS_7I77_ANALOG[] = {
    {"AnalogOut0", "Volts", 12, SIGNED, OUTPUT, -10, 10},
    {"AnalogOut1", "Volts", 12, SIGNED, OUTPUT, -10, 10},
    {"AnalogOut2", "Volts", 12, SIGNED, OUTPUT, -10, 10},
    {"AnalogOut3", "Volts", 12, SIGNED, OUTPUT, -10, 10},
    {"AnalogOut4", "Volts", 12, SIGNED, OUTPUT, -10, 10},
    {"AnalogOut5", "Volts", 12, SIGNED, OUTPUT, -10, 10},
    {"AnalogEna", "None", 1, BOOLEAN, OUTPUT, 0, 0},
    {"SpinEna", "None", 1, BOOLEAN, OUTPUT, 0, 0},
};
constexpr RemoteMode MODES_IO[] = {{"I/O", 0}};
constexpr RemoteMode MODES_ANALOG[] = {{"Analog", 0}};

constexpr RemoteField FIELDS_7I73[] = {
    {"Output", "None", 22, BITS, OUTPUT, 0, 0},
    {"Input", "None", 24, BITS, INPUT, 0, 0},
    {"Enc0", "None", 8, ENCODER, INPUT, 0, 0},
    {"Enc1", "None", 8, ENCODER, INPUT, 0, 0},
    {"Enc2", "None", 8, ENCODER, INPUT, 0, 0},
    {"Enc3", "None", 8, ENCODER, INPUT, 0, 0},
    {"AnalogIn0", "Volts", 10, UNSIGNED, INPUT, 0, 3.3F, 1},
    {"AnalogIn1", "Volts", 10, UNSIGNED, INPUT, 0, 3.3F, 1},
    {"AnalogIn2", "Volts", 10, UNSIGNED, INPUT, 0, 3.3F, 1},
    {"AnalogIn3", "Volts", 10, UNSIGNED, INPUT, 0, 3.3F, 1},
    {"Display", "None", 8, STREAM, OUTPUT, 0, 0, 1, 1},
    {"Display32", "None", 32, STREAM, OUTPUT, 0, 0, 2},
};
constexpr RemoteMode MODES_7I73[] = {{"I/O_Enc", 0}, {"I/O_Enc_Ana", 1}, {"I/O_Enc_Ana_FD", 2}};

constexpr RemoteField FIELDS_7I84[] = {
    {"Output", "None", 16, BITS, OUTPUT, 0, 0},
    {"Input", "None", 32, BITS, INPUT, 0, 0},
};

/// Parameters common to the field cards.
constexpr RemoteGlobal GLOBALS[] = {
    {"SwRevision", 16, UNSIGNED, 14},
    {"NVBaudRate", 8, NON_VOLATILE_UNSIGNED, 9},
    {"NVUnitNumber", 32, NON_VOLATILE_UNSIGNED, 0},
    {"NVWatchDogTimeout", 16, NON_VOLATILE_UNSIGNED, 50},
};

constexpr RemoteCard CARDS[] = {
    {"7i73", "7I73", FIELDS_7I73, MODES_7I73, GLOBALS, {}},
    {"7i76", "7I76", FIELDS_7I76, MODES_7I76, GLOBALS, {}},
    {"7i77", "7I77", FIELDS_7I77, MODES_IO, GLOBALS, "7i77-analog"},
    {"7i77-analog", "7I77", FIELDS_7I77_ANALOG, MODES_ANALOG, GLOBALS, {}},
    {"7i84", "7I84", FIELDS_7I84, MODES_IO, GLOBALS, {}},
};

/// Reads or sets `bits` bits at `position` of the user words.
std::uint32_t bits_of(const UserWords &words, unsigned position, unsigned bits) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < bits && (position + i) / 32 < words.size(); ++i) {
        value |= ((words[(position + i) / 32] >> ((position + i) % 32)) & 1U) << i;
    }
    return value;
}

void put_bits(UserWords &words, unsigned position, unsigned bits, std::uint32_t value) {
    for (unsigned i = 0; i < bits && (position + i) / 32 < words.size(); ++i) {
        words[(position + i) / 32] |= ((value >> i) & 1U) << ((position + i) % 32);
    }
}

void append_word(std::vector<std::uint8_t> &memory, std::uint16_t value) {
    memory.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    memory.push_back(static_cast<std::uint8_t>(value >> 8U));
}

void append_float(std::vector<std::uint8_t> &memory, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    append_word(memory, static_cast<std::uint16_t>(bits & 0xFFFFU));
    append_word(memory, static_cast<std::uint16_t>(bits >> 16U));
}

}  // namespace

const RemoteCard *find_remote_card(std::string_view name) {
    const auto *card = std::ranges::find_if(
        CARDS, [&](const RemoteCard &one) { return equals_ignoring_case(one.key, name); });
    return card == std::end(CARDS) ? nullptr : card;
}

std::vector<std::string_view> remote_card_names() {
    std::vector<std::string_view> names;
    for (const RemoteCard &card : CARDS) {
        names.push_back(card.key);
    }
    return names;
}

Remote::Remote(const RemoteCard &card, std::uint32_t serial_number)
    : card_(&card), serial_number_(serial_number), values_(card.fields.size(), 0) {
    memory_.assign(GLOBAL_VALUES, 0);
    for (const RemoteGlobal &one : card.globals) {
        const std::uint32_t value = one.value != 0 ? one.value : serial_number;
        append_word(memory_, static_cast<std::uint16_t>(value & 0xFFFFU));
        append_word(memory_, static_cast<std::uint16_t>(value >> 16U));
    }
    describe();
}

bool Remote::isInMode(const RemoteField &field) const {
    return mode_ >= field.first_mode && mode_ <= field.last_mode;
}

void Remote::append_text(std::string_view text) {
    memory_.insert(memory_.end(), text.begin(), text.end());
    memory_.push_back(0);
}

std::uint16_t Remote::append_field(const RemoteField &field, std::uint16_t value_address) {
    const auto address = static_cast<std::uint16_t>(memory_.size());
    memory_.insert(memory_.end(), {DATA_RECORD, field.bits, static_cast<std::uint8_t>(field.type),
                                   static_cast<std::uint8_t>(field.direction)});
    append_float(memory_, field.min);
    append_float(memory_, field.max);
    append_word(memory_, value_address);
    append_text(field.unit);
    append_text(field.name);
    return address;
}

void Remote::append_list(const std::vector<std::uint16_t> &addresses) {
    for (const std::uint16_t address : addresses) {
        append_word(memory_, address);
    }
    append_word(memory_, 0);
}

void Remote::describe() {
    // The values are below the description and keep the data of the host.
    memory_.resize(DESCRIPTION);
    std::vector<std::uint16_t> process, global;
    std::uint16_t value_address = GLOBAL_VALUES;
    for (const RemoteGlobal &one : card_->globals) {
        const RemoteField field{.name = one.name,
                                .unit = "None",
                                .bits = one.bits,
                                .type = one.type,
                                .direction = INPUT,
                                .min = 0,
                                .max = 0};
        global.push_back(append_field(field, value_address));
        value_address = static_cast<std::uint16_t>(value_address + GLOBAL_BYTES);
    }
    value_address = 0;
    for (const RemoteField &field : card_->fields) {
        if (isInMode(field)) {
            process.push_back(append_field(field, value_address));
        }
        value_address = static_cast<std::uint16_t>(value_address + (field.bits + 7) / 8);
    }
    for (const RemoteMode &mode : card_->modes) {
        global.push_back(static_cast<std::uint16_t>(memory_.size()));
        memory_.insert(memory_.end(), {MODE_RECORD, mode.index, SOFTWARE_MODE, 0});
        append_text(mode.name);
    }
    process_list_ = static_cast<std::uint16_t>(memory_.size());
    append_list(process);
    global_list_ = static_cast<std::uint16_t>(memory_.size());
    append_list(global);
}

UserWords Remote::identity() const {
    std::uint32_t name = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        name |= static_cast<std::uint32_t>(static_cast<unsigned char>(card_->name[i])) << (8 * i);
    }
    return {serial_number_, name, process_list_ | (std::uint32_t{global_list_} << 16U)};
}

void Remote::set_mode(std::uint8_t mode) {
    mode_ = mode;
    describe();
}

std::uint8_t Remote::read_byte(std::uint16_t address) const {
    return address < memory_.size() ? memory_[address] : 0;
}

void Remote::write_byte(std::uint16_t address, std::uint8_t value) {
    if (address < DESCRIPTION) {
        memory_[address] = value;
    }
}

UserWords Remote::exchange(const UserWords &from_host) {
    UserWords to_host{};
    unsigned out = 0, in = 0;
    for (std::size_t i = 0; i < card_->fields.size(); ++i) {
        const RemoteField &field = card_->fields[i];
        if (!isInMode(field)) {
            continue;
        }
        if (field.direction != INPUT) {
            values_[i] = bits_of(from_host, out, field.bits);
            out += field.bits;
        }
        if (field.direction != OUTPUT) {
            put_bits(to_host, in, field.bits, values_[i]);
            in += field.bits;
        }
    }
    return to_host;
}

void Remote::set_value(std::string_view field, std::uint32_t value) {
    for (std::size_t i = 0; i < card_->fields.size(); ++i) {
        if (card_->fields[i].name == field) {
            values_[i] = value;
        }
    }
}

std::uint32_t Remote::value(std::string_view field) const {
    for (std::size_t i = 0; i < card_->fields.size(); ++i) {
        if (card_->fields[i].name == field) {
            return values_[i];
        }
    }
    return 0;
}

}  // namespace mw::mesa::board

// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_values.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::mesa {

namespace {

constexpr int REAL_BITS = 32, WORD_BITS = 32, ALL_BITS = 64, MAX_COUNTER_BITS = 32;
constexpr double SIGNED_END = 2147483647.0;

std::uint64_t mask_of(int bits) noexcept {
    return bits >= ALL_BITS ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1;
}

std::int64_t sign_extended(std::uint64_t raw, int bits) noexcept {
    const auto shift = static_cast<unsigned>(ALL_BITS - bits);
    return static_cast<std::int64_t>(raw << shift) >> shift;
}

/// Returns 0 for a value that is not finite, for example with a wrong scale.
double finite(double value) noexcept {
    return std::isfinite(value) ? value : 0.0;
}

/// The limited value as a fraction of the scale, within -1 ... 1.
double fraction_of(const SserialNumber &number) noexcept {
    const double low = std::min(number.min_limit, number.max_limit);
    const double high = std::max(number.min_limit, number.max_limit);
    const double fraction = std::clamp(number.value, low, high) / number.scale_max;
    return std::isfinite(fraction) ? std::clamp(fraction, -1.0, 1.0) : 0.0;
}

/// The bits that the pins of an output request.
std::uint64_t requested_bits(const SserialCardValues &card, const SserialField &field) noexcept {
    switch (field.pins) {
    case FieldPins::BITS: {
        std::uint64_t bits = 0;
        for (int i = 0; i < field.bits; ++i) {
            const SserialBit &bit = card.bits[field.index + static_cast<std::size_t>(i)];
            bits |= std::uint64_t{bit.value != bit.invert} << static_cast<unsigned>(i);
        }
        return bits;
    }
    case FieldPins::BOOLEAN: {
        const SserialBit &bit = card.bits[field.index];
        return bit.value != bit.invert ? mask_of(field.bits) : 0;
    }
    case FieldPins::UNSIGNED: return unsigned_bits(card.numbers[field.index], field.bits);
    case FieldPins::SIGNED: return signed_bits(card.numbers[field.index], field.bits);
    case FieldPins::REAL: {
        const double value = card.numbers[field.index].value;
        return std::bit_cast<std::uint32_t>(std::isfinite(value) ? static_cast<float>(value) : 0.0F);
    }
    case FieldPins::STREAM: return card.streams[field.index].value & mask_of(field.bits);
    case FieldPins::COUNTER:
    case FieldPins::NONE: break;
    }
    return 0;
}

/// True for a single number, whose bits are released together.
bool isOneValue(FieldPins pins) noexcept {
    return pins != FieldPins::BITS;
}

void read_field(SserialCardValues &card, const SserialField &field,
                std::span<const std::uint32_t> words) noexcept {
    const std::uint64_t raw = field_bits(words, field.input, field.bits);
    const auto set = [](SserialBit &bit, bool on) {
        bit.value = on;
        bit.inverse = !on;
    };
    switch (field.pins) {
    case FieldPins::BITS:
        for (int i = 0; i < field.bits; ++i) {
            set(card.bits[field.index + static_cast<std::size_t>(i)],
                ((raw >> static_cast<unsigned>(i)) & 1U) != 0);
        }
        return;
    case FieldPins::BOOLEAN: set(card.bits[field.index], raw != 0); return;
    case FieldPins::UNSIGNED: {
        SserialNumber &number = card.numbers[field.index];
        number.value = unsigned_number(raw, field.bits, number.scale_max);
        return;
    }
    case FieldPins::SIGNED: {
        SserialNumber &number = card.numbers[field.index];
        number.value = signed_number(raw, field.bits, number.scale_max);
        return;
    }
    case FieldPins::REAL: {
        const float value = std::bit_cast<float>(static_cast<std::uint32_t>(raw));
        card.numbers[field.index].value = std::isfinite(value) ? value : 0.0F;
        return;
    }
    case FieldPins::STREAM: card.streams[field.index].value = static_cast<std::uint32_t>(raw); return;
    case FieldPins::COUNTER: {
        const std::uint64_t low =
            field.low_bits == 0 ? 0 : field_bits(words, field.input_low, field.low_bits);
        count_encoder(card.counters[field.index], (raw << static_cast<unsigned>(field.low_bits)) | low,
                      field.bits + field.low_bits);
        return;
    }
    case FieldPins::NONE: return;
    }
}

FieldPins pins_of(const DataRecord &record) noexcept {
    if (record.bits <= 0) {
        return FieldPins::NONE;
    }
    switch (record.type) {
    case FieldType::BITS: return FieldPins::BITS;
    case FieldType::BOOLEAN: return FieldPins::BOOLEAN;
    case FieldType::UNSIGNED: return FieldPins::UNSIGNED;
    case FieldType::SIGNED: return FieldPins::SIGNED;
    case FieldType::FLOAT: return record.bits == REAL_BITS ? FieldPins::REAL : FieldPins::NONE;
    case FieldType::STREAM: return FieldPins::STREAM;
    case FieldType::ENCODER:
    case FieldType::ENCODER_HIGH:
    case FieldType::ENCODER_LOW:
        return record.bits <= MAX_COUNTER_BITS ? FieldPins::COUNTER : FieldPins::NONE;
    case FieldType::PAD:
    case FieldType::NV_UNSIGNED:
    case FieldType::NV_SIGNED:
    case FieldType::NV_FLOAT: break;
    }
    return FieldPins::NONE;
}

/// Creates the values of a field; returns the index of the first.
std::size_t add_values(SserialCardValues &card, const SserialField &field) {
    const double max = field.max == 0.0F ? 1.0 : field.max;
    switch (field.pins) {
    case FieldPins::BITS: card.bits.resize(card.bits.size() + static_cast<std::size_t>(field.bits)); break;
    case FieldPins::BOOLEAN: card.bits.emplace_back(); return card.bits.size() - 1;
    case FieldPins::UNSIGNED:
    case FieldPins::SIGNED:
    case FieldPins::REAL: card.numbers.push_back({0.0, max, max, field.min}); return card.numbers.size() - 1;
    case FieldPins::STREAM: card.streams.emplace_back(); return card.streams.size() - 1;
    case FieldPins::COUNTER: card.counters.emplace_back().scale = max; return card.counters.size() - 1;
    case FieldPins::NONE: return 0;
    }
    return card.bits.size() - static_cast<std::size_t>(field.bits);
}

/// Joins the two halves of an encoder, which are records with the same name, to one field.
void join_halves(SserialCardValues &card, const std::vector<DataRecord> &process) {
    for (std::size_t i = 0; i < process.size(); ++i) {
        for (std::size_t j = 0; j < process.size(); ++j) {
            const bool is_pair =
                process[i].type == FieldType::ENCODER_HIGH && process[j].type == FieldType::ENCODER_LOW &&
                process[i].name == process[j].name && process[i].bits + process[j].bits <= MAX_COUNTER_BITS;
            if (is_pair && card.fields[i].hasInput() && card.fields[j].hasInput()) {
                card.fields[i].input_low = card.fields[j].input;
                card.fields[i].low_bits = card.fields[j].bits;
                card.fields[j].pins = FieldPins::NONE;
            }
        }
    }
}

}  // namespace

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return lower;
}

SserialCardValues make_sserial_card(const std::vector<DataRecord> &process, const ProcessLayout &layout) {
    SserialCardValues card;
    for (const DataRecord &record : process) {
        SserialField field;
        field.pins = pins_of(record);
        field.direction = record.direction;
        field.name = lower_case(record.name);
        field.bits = record.bits;
        field.min = record.min;
        field.max = record.max;
        card.fields.push_back(std::move(field));
    }
    for (const FieldPosition &position : layout.inputs) {
        card.fields[static_cast<std::size_t>(position.record)].input = position.first_bit;
    }
    for (const FieldPosition &position : layout.outputs) {
        card.fields[static_cast<std::size_t>(position.record)].output = position.first_bit;
    }
    join_halves(card, process);
    for (SserialField &field : card.fields) {
        if (field.pins == FieldPins::COUNTER && !field.hasInput()) {
            field.pins = FieldPins::NONE;
        }
        field.index = add_values(card, field);
    }
    return card;
}

void sserial_read(SserialCardValues &card, std::span<const std::uint32_t> words) noexcept {
    for (const SserialField &field : card.fields) {
        if (field.hasInput()) {
            read_field(card, field, words);
        }
    }
}

void sserial_write(SserialCardValues &card, std::span<std::uint32_t> words) noexcept {
    for (SserialField &field : card.fields) {
        if (!field.hasOutput()) {
            continue;
        }
        const std::uint64_t requested = requested_bits(card, field);
        const bool off = requested == 0;
        field.held = isOneValue(field.pins) ? (off ? 0 : field.held) : field.held & requested;
        set_field_bits(words, field.output, field.bits, requested & ~field.held);
    }
}

void hold_outputs(SserialCardValues &card) noexcept {
    for (SserialField &field : card.fields) {
        field.held = field.hasOutput() ? mask_of(field.bits) : 0;
    }
}

void release_outputs(SserialCardValues &card) noexcept {
    for (SserialField &field : card.fields) {
        field.held = 0;
    }
}

std::uint64_t unsigned_bits(const SserialNumber &number, int bits) noexcept {
    const double fraction = std::max(fraction_of(number), 0.0);
    // With up to 53 bits, all values are exact in a double. With more bits, the maximum must not be rounded
    // up to 2^bits.
    return fraction >= 1.0 ? mask_of(bits)
                           : static_cast<std::uint64_t>(fraction * static_cast<double>(mask_of(bits)));
}

std::uint64_t signed_bits(const SserialNumber &number, int bits) noexcept {
    const auto word = static_cast<std::int64_t>(fraction_of(number) * SIGNED_END);
    const int shift = WORD_BITS - bits;
    const std::int64_t value =
        shift >= 0 ? word >> shift : word * (std::int64_t{1} << std::min(-shift, WORD_BITS));
    return static_cast<std::uint64_t>(value) & mask_of(bits);
}

double unsigned_number(std::uint64_t raw, int bits, double scale_max) noexcept {
    return finite(static_cast<double>(raw) / static_cast<double>(mask_of(bits)) * scale_max);
}

double signed_number(std::uint64_t raw, int bits, double scale_max) noexcept {
    // 2^31 of a word of 32 bits, also for shorter and longer numbers.
    const double word = std::ldexp(static_cast<double>(sign_extended(raw, bits)), WORD_BITS - bits);
    return finite(word / SIGNED_END * scale_max);
}

void count_encoder(SserialCounter &counter, std::uint64_t raw, int bits) noexcept {
    const std::int64_t change = sign_extended((raw - counter.last) & mask_of(bits), bits);
    const std::int64_t before = counter.total;
    counter.last = raw;
    counter.total += change;
    if (counter.reset) {
        counter.zero = counter.total;
    }
    if (counter.index_enable && counter.counts_per_rev > 0 && change != 0) {
        const std::int64_t rev = counter.counts_per_rev;
        const auto floor_rev = [rev](std::int64_t value) {
            return value >= 0 ? value / rev : -((-value + rev - 1) / rev);
        };
        // The last index passed: at or below the count for upward motion, at or above it for downward motion.
        const std::int64_t index = (change > 0 ? floor_rev(counter.total) : -floor_rev(-counter.total)) * rev;
        const bool passed = change > 0 ? index > before : index < before;
        if (passed) {
            counter.zero = index;
            counter.index_enable = false;
        }
    }
    counter.rawcounts = static_cast<std::int32_t>(counter.total);
    counter.count = static_cast<std::int32_t>(counter.total - counter.zero);
    counter.position = finite(static_cast<double>(counter.total - counter.zero) / counter.scale);
}

}  // namespace mw::mesa

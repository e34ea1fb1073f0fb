// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_parameters.hh"

#include <algorithm>
#include <bit>

#include "drivers/mesa/hostmot2/modules/sserial_values.hh"

namespace mw::mesa {

namespace {

constexpr int BYTE_BITS = 8, WORD_BITS = 32, ALL_BITS = 64;

std::uint64_t mask_of(int bits) noexcept {
    return bits >= ALL_BITS ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1;
}

}  // namespace

void *SserialParameter::field() noexcept {
    switch (type) {
    case PinType::FLOAT: return &real;
    case PinType::S32: return &s32;
    case PinType::BIT:
    case PinType::U32: break;
    }
    return &u32;
}

std::uint64_t SserialParameter::wanted() const noexcept {
    switch (type) {
    case PinType::FLOAT:
        return bits == ALL_BITS ? std::bit_cast<std::uint64_t>(real)
                                : std::bit_cast<std::uint32_t>(static_cast<float>(real));
    case PinType::S32: return static_cast<std::uint64_t>(std::int64_t{s32}) & mask_of(bits);
    case PinType::BIT:
    case PinType::U32: break;
    }
    return u32 & mask_of(bits);
}

std::optional<SserialParameter> make_parameter(const FoundParameter &found) {
    const DataRecord &record = found.record;
    SserialParameter parameter;
    parameter.name = lower_case(record.name);
    parameter.access = record.direction == FieldDirection::INPUT ? Access::RO : Access::RW;
    parameter.bits = record.bits;
    parameter.address = record.value_address;
    parameter.non_volatile = record.type == FieldType::NV_UNSIGNED || record.type == FieldType::NV_SIGNED ||
                             record.type == FieldType::NV_FLOAT;
    switch (record.type) {
    case FieldType::UNSIGNED:
    case FieldType::NV_UNSIGNED:
        parameter.type = PinType::U32;
        parameter.u32 = static_cast<std::uint32_t>(found.value & mask_of(record.bits));
        break;
    case FieldType::SIGNED:
    case FieldType::NV_SIGNED: {
        const auto shift = static_cast<unsigned>(std::clamp(WORD_BITS - record.bits, 0, WORD_BITS - 1));
        parameter.type = PinType::S32;
        parameter.s32 = static_cast<std::int32_t>(static_cast<std::uint32_t>(found.value) << shift) >> shift;
        break;
    }
    case FieldType::FLOAT:
    case FieldType::NV_FLOAT:
        parameter.type = PinType::FLOAT;
        parameter.real = record.bits == ALL_BITS
                             ? std::bit_cast<double>(found.value)
                             : double{std::bit_cast<float>(static_cast<std::uint32_t>(found.value))};
        break;
    default: return std::nullopt;
    }
    parameter.known = parameter.wanted();
    return parameter;
}

SserialWriteStep next_step(const SserialParameter &parameter, const SserialWriteStep &last) noexcept {
    constexpr std::uint32_t ACCESS_NONVOLATILE = 0xEC000000, WRITE = 0x64000000, OPEN = 1, CLOSED = 0;
    constexpr unsigned SIZE_SHIFT = 24;
    enum Step { NONE, OPENED, WRITTEN, FINISHED };
    const auto bytes = static_cast<unsigned>((std::max(parameter.bits, 1) + BYTE_BITS - 1) / BYTE_BITS);
    const auto size = static_cast<std::uint32_t>(std::bit_width(std::bit_ceil(bytes)) - 1);
    const std::uint64_t value = last.number == NONE ? parameter.wanted() : last.value;
    switch (last.number) {
    case NONE:
        if (parameter.non_volatile) {
            return {.number = OPENED, .value = value, .status = ACCESS_NONVOLATILE, .words = {OPEN, 0}};
        }
        [[fallthrough]];
    case OPENED:
        return {.number = WRITTEN,
                .value = value,
                .status = WRITE | (size << SIZE_SHIFT) | parameter.address,
                .words = {static_cast<std::uint32_t>(value), static_cast<std::uint32_t>(value >> WORD_BITS)}};
    case WRITTEN:
        if (parameter.non_volatile) {
            return {.number = FINISHED, .value = value, .status = ACCESS_NONVOLATILE, .words = {CLOSED, 0}};
        }
        break;
    default: break;
    }
    return {};
}

}  // namespace mw::mesa

// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/value.hh"

#include <array>
#include <bit>
#include <limits>
#include <optional>

#include <fmt/core.h>

#include "base/text.hh"

namespace mw::hal {
namespace {

struct TypeRow {
    Type type;
    const char *name;
    const char *other;  ///< LinuxCNC's newer name
};
constexpr std::array TYPES{TypeRow{Type::BIT, "bit", "bool"},   TypeRow{Type::FLOAT, "float", "real"},
                           TypeRow{Type::S32, "s32", "si32"},   TypeRow{Type::U32, "u32", "ui32"},
                           TypeRow{Type::PORT, "port", "port"}, TypeRow{Type::S64, "s64", "sint"},
                           TypeRow{Type::U64, "u64", "uint"}};

std::unexpected<Error> not_a(Type type, std::string_view text, const char *expected) {
    return fail(fmt::format("'{}' is not a value of type {}: expected {}", text, type_name(type), expected));
}

std::optional<bool> parse_bit(std::string_view text) {
    const std::string lower = to_lower(text);
    if (lower == "true") {
        return true;
    }
    if (lower == "false") {
        return false;
    }
    return lower == "0" || lower == "1" ? std::optional<bool>(lower == "1") : std::nullopt;
}

}  // namespace

const char *type_name(Type type) noexcept {
    for (const TypeRow &row : TYPES) {
        if (row.type == type) {
            return row.name;
        }
    }
    return "unknown";
}

Result<Type> parse_type(std::string_view name) {
    for (const TypeRow &row : TYPES) {
        if (equals_ignoring_case(name, row.name) || equals_ignoring_case(name, row.other)) {
            return row.type;
        }
    }
    return fail(fmt::format("'{}' is not a HAL type: expected bit, float, s32, u32, s64, u64 or port", name));
}

const char *dir_name(Dir dir) noexcept {
    switch (dir) {
    case Dir::IN: return "IN";
    case Dir::OUT: return "OUT";
    case Dir::IO: return "I/O";
    case Dir::RO: return "RO";
    case Dir::RW: return "RW";
    }
    return "?";
}

Value Value::of_bit(bool v) noexcept {
    return {Type::BIT, v ? 1U : 0U};
}
Value Value::of_float(double v) noexcept {
    return {Type::FLOAT, std::bit_cast<std::uint64_t>(v)};
}
Value Value::of_s32(std::int32_t v) noexcept {
    return {Type::S32, static_cast<std::uint32_t>(v)};
}
Value Value::of_u32(std::uint32_t v) noexcept {
    return {Type::U32, v};
}
Value Value::of_s64(std::int64_t v) noexcept {
    return {Type::S64, static_cast<std::uint64_t>(v)};
}
Value Value::of_u64(std::uint64_t v) noexcept {
    return {Type::U64, v};
}

bool Value::as_bit() const noexcept {
    return type == Type::FLOAT ? as_float() != 0.0 : bits != 0;
}
double Value::as_float() const noexcept {
    return std::bit_cast<double>(bits);
}
std::int32_t Value::as_s32() const noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
}
std::uint32_t Value::as_u32() const noexcept {
    return static_cast<std::uint32_t>(bits);
}
std::int64_t Value::as_s64() const noexcept {
    return static_cast<std::int64_t>(bits);
}
std::uint64_t Value::as_u64() const noexcept {
    return bits;
}

double Value::as_number() const noexcept {
    switch (type) {
    case Type::BIT: return as_bit() ? 1.0 : 0.0;
    case Type::FLOAT: return as_float();
    case Type::S32:
    case Type::PORT: return as_s32();
    case Type::U32: return as_u32();
    case Type::S64: return static_cast<double>(as_s64());
    case Type::U64: return static_cast<double>(as_u64());
    }
    return 0.0;
}

std::string Value::str() const {
    switch (type) {
    case Type::BIT: return as_bit() ? "TRUE" : "FALSE";
    case Type::FLOAT: return fmt::format("{:.7g}", as_float());
    case Type::S32:
    case Type::PORT: return std::to_string(as_s32());
    case Type::U32: return std::to_string(as_u32());
    case Type::S64: return std::to_string(as_s64());
    case Type::U64: return std::to_string(as_u64());
    }
    return {};
}

Result<Value> parse_value(Type type, std::string_view text) {
    const auto whole = parse_c_int(text);
    switch (type) {
    case Type::BIT:
        if (const auto bit = parse_bit(text)) {
            return Value::of_bit(*bit);
        }
        return not_a(type, text, "TRUE, FALSE, 1 or 0");
    case Type::FLOAT:
        if (const auto number = parse_c_double(text)) {
            return Value::of_float(*number);
        }
        return not_a(type, text, "a number such as 1, -0.5 or 4.2e1");
    case Type::S32:
        if (whole && *whole >= std::numeric_limits<std::int32_t>::min() &&
            *whole <= std::numeric_limits<std::int32_t>::max()) {
            return Value::of_s32(static_cast<std::int32_t>(*whole));
        }
        return not_a(type, text, "a whole number from -2147483648 to 2147483647");
    case Type::PORT:
    case Type::U32:
        if (whole && *whole >= 0 && *whole <= std::numeric_limits<std::uint32_t>::max()) {
            Value value = Value::of_u32(static_cast<std::uint32_t>(*whole));
            value.type = type;
            return value;
        }
        return not_a(type, text, "a whole number from 0 to 4294967295");
    case Type::S64:
        if (whole) {
            return Value::of_s64(*whole);
        }
        return not_a(type, text, "a whole number from -9223372036854775808 to 9223372036854775807");
    case Type::U64:
        if (const auto number = parse_c_uint(text)) {
            return Value::of_u64(*number);
        }
        return not_a(type, text, "a whole number from 0 to 18446744073709551615");
    }
    return fail("unknown HAL type");
}

Value load_value(Type type, const void *address) noexcept {
    switch (type) {
    case Type::BIT:
        return Value{type, __atomic_load_n(static_cast<const std::uint8_t *>(address), __ATOMIC_RELAXED)};
    case Type::S32:
    case Type::U32:
    case Type::PORT:
        return Value{type, __atomic_load_n(static_cast<const std::uint32_t *>(address), __ATOMIC_RELAXED)};
    default:
        return Value{type, __atomic_load_n(static_cast<const std::uint64_t *>(address), __ATOMIC_RELAXED)};
    }
}

void store_value(void *address, const Value &value) noexcept {
    switch (value.type) {
    case Type::BIT:
        __atomic_store_n(static_cast<std::uint8_t *>(address), static_cast<std::uint8_t>(value.bits),
                         __ATOMIC_RELAXED);
        break;
    case Type::S32:
    case Type::U32:
    case Type::PORT:
        __atomic_store_n(static_cast<std::uint32_t *>(address), static_cast<std::uint32_t>(value.bits),
                         __ATOMIC_RELAXED);
        break;
    default: __atomic_store_n(static_cast<std::uint64_t *>(address), value.bits, __ATOMIC_RELAXED);
    }
}

}  // namespace mw::hal

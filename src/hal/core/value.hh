// SPDX-License-Identifier: GPL-2.0-or-later
// HAL values: seven distinct types, read from and written as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::hal {

/// Maximum number of characters of a name.
inline constexpr std::size_t NAME_LENGTH = 127;

/// Numbers as in hal.h (hal_type_t).
enum class Type : std::uint8_t { BIT = 1, FLOAT = 2, S32 = 3, U32 = 4, PORT = 5, S64 = 6, U64 = 7 };

/// Directions as in hal.h: the first three for pins as seen by the component, RO and RW for parameters.
enum class Dir : std::uint8_t { IN = 16, OUT = 32, IO = 48, RO = 64, RW = 192 };

/// "bit", "float", "s32", "u32", "port", "s64", "u64".
const char *type_name(Type type) noexcept;
/// The type with that name; also LinuxCNC's newer names bool, real, sint, uint.
Result<Type> parse_type(std::string_view name);
/// "IN", "OUT", "I/O", "RO", "RW".
const char *dir_name(Dir dir) noexcept;

/// One value of one type. Zero is false, 0.0 and 0.
struct Value {
    Type type = Type::BIT;
    std::uint64_t bits = 0;  ///< as in HAL memory: little-endian, unused bytes zero

    static Value of_bit(bool v) noexcept;
    static Value of_float(double v) noexcept;
    static Value of_s32(std::int32_t v) noexcept;
    static Value of_u32(std::uint32_t v) noexcept;
    static Value of_s64(std::int64_t v) noexcept;
    static Value of_u64(std::uint64_t v) noexcept;

    bool as_bit() const noexcept;
    double as_float() const noexcept;
    std::int32_t as_s32() const noexcept;
    std::uint32_t as_u32() const noexcept;
    std::int64_t as_s64() const noexcept;
    std::uint64_t as_u64() const noexcept;
    /// The value as a number, for every type (bit: 0 or 1).
    double as_number() const noexcept;

    /// "TRUE"/"FALSE", the number in decimal, a float with %.7g as getp prints it.
    std::string str() const;
    bool operator==(const Value &) const noexcept = default;
};

/// The value at an address in memory of HAL. [any thread, realtime-safe]
Value load_value(Type type, const void *address) noexcept;
/// [any thread, realtime-safe]
void store_value(void *address, const Value &value) noexcept;

/// Parses "true", "TRUE", "1", "12", "-3", "0x1F", ".15", "4.2e1" as a value of `type`; an error names the
/// expected form and range.
Result<Value> parse_value(Type type, std::string_view text);

}  // namespace mw::hal

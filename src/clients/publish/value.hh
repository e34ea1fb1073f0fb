// SPDX-License-Identifier: GPL-2.0-or-later
// A published value.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace mw::publish {

/// Nothing: the machine does not know the value.
using Value = std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string>;

/// Types of values, with their numbers in Sparkplug B.
enum class DataType : std::uint8_t { INT64 = 4, UINT64 = 8, DOUBLE = 10, BOOLEAN = 11, STRING = 12 };

const char *name_of(DataType type);

/// Valid UTF-8 without control characters, as XML and protobuf require it; other bytes become U+FFFD.
std::string clean_text(std::string_view text);

/// Milliseconds of UTC since 1970.
using TimeMs = std::uint64_t;

}  // namespace mw::publish

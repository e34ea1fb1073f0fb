// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/value.hh"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace mw::messages {
namespace {

/// A FixedText begins with its size, followed by its bytes.
constexpr std::size_t FIXED_BYTES_AT = sizeof(std::uint32_t);
constexpr std::size_t LONGEST = 1U << 20U;

template <class T>
std::int64_t read_as(const void *at) {
    T value{};
    std::memcpy(&value, at, sizeof value);
    return static_cast<std::int64_t>(value);
}
template <class T>
void write_as(void *at, std::int64_t value) {
    const T narrow = static_cast<T>(value);
    std::memcpy(at, &narrow, sizeof narrow);
}
bool isSigned(const Type &type) {
    return type.kind == Kind::INTEGER;
}

}  // namespace

bool isSeries(const Type &type) {
    return type.isArray || type.list != nullptr;
}

std::size_t count_elements(const Type &type, const void *at) {
    return type.list != nullptr ? type.list->size(at) : type.count;
}

void *element(const Type &type, void *at, std::size_t index) {
    return type.list != nullptr ? type.list->element(at, index)
                                : static_cast<char *>(at) + index * type.stride;
}

const void *element(const Type &type, const void *at, std::size_t index) {
    return element(type, const_cast<void *>(at), index);
}

std::int64_t get_integer(const Type &type, const void *at) {
    switch (type.bytes) {
    case 1: return isSigned(type) ? read_as<std::int8_t>(at) : read_as<std::uint8_t>(at);
    case 2: return isSigned(type) ? read_as<std::int16_t>(at) : read_as<std::uint16_t>(at);
    case 4: return isSigned(type) ? read_as<std::int32_t>(at) : read_as<std::uint32_t>(at);
    default: return read_as<std::int64_t>(at);
    }
}

void set_integer(const Type &type, void *at, std::int64_t value) {
    switch (type.bytes) {
    case 1: write_as<std::uint8_t>(at, value); break;
    case 2: write_as<std::uint16_t>(at, value); break;
    case 4: write_as<std::uint32_t>(at, value); break;
    default: write_as<std::int64_t>(at, value); break;
    }
}

bool isRepresentable(const Type &type, std::int64_t value) {
    switch (type.kind) {
    case Kind::BOOL: return value == 0 || value == 1;
    case Kind::NAMED: return name_of(type, value) != nullptr;
    case Kind::INTEGER: {
        const int bits = 8 * type.bytes - 1;
        return bits >= 63 || (value >= -(std::int64_t{1} << bits) && value < (std::int64_t{1} << bits));
    }
    case Kind::UNSIGNED:
        return type.bytes == 8 || (value >= 0 && value < (std::int64_t{1} << (8 * type.bytes)));
    case Kind::REAL:
    case Kind::TEXT:
    case Kind::FIXED_TEXT:
    case Kind::PARTS: break;
    }
    return false;
}

double get_real(const void *at) {
    double value = 0;
    std::memcpy(&value, at, sizeof value);
    return value;
}

void set_real(void *at, double value) {
    std::memcpy(at, &value, sizeof value);
}

std::string_view get_text(const Type &type, const void *at) {
    if (type.kind == Kind::TEXT) {
        return *static_cast<const std::string *>(at);
    }
    std::uint32_t size = 0;
    std::memcpy(&size, at, sizeof size);
    return {static_cast<const char *>(at) + FIXED_BYTES_AT, std::min(size, type.capacity)};
}

bool set_text(const Type &type, void *at, std::string_view text) {
    if (type.kind == Kind::TEXT) {
        *static_cast<std::string *>(at) = text;
        return true;
    }
    if (text.size() > type.capacity) {
        return false;
    }
    const auto size = static_cast<std::uint32_t>(text.size());
    char *bytes = static_cast<char *>(at) + FIXED_BYTES_AT;
    std::memset(bytes, 0, type.capacity);
    std::memcpy(bytes, text.data(), text.size());
    std::memcpy(at, &size, sizeof size);
    return true;
}

const char *name_of(const Type &type, std::int64_t value) {
    const auto found = std::find_if(type.names.begin(), type.names.end(),
                                    [value](const Name &name) { return name.value == value; });
    return found == type.names.end() ? nullptr : found->name;
}

std::size_t longest_text(const Field &field) {
    if (field.type.kind == Kind::FIXED_TEXT) {
        return field.type.capacity;
    }
    return std::isfinite(field.range.max) && !isSeries(field.type) ? static_cast<std::size_t>(field.range.max)
                                                                   : LONGEST;
}

}  // namespace mw::messages

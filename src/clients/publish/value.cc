// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/value.hh"

#include <array>

namespace mw::publish {
namespace {

constexpr std::string_view REPLACEMENT = "\xEF\xBF\xBD";

/// Size of the character at the front of `text`; 0 if it is not valid. [bytes]
std::size_t character_size(std::string_view text) {
    const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80U) {
        return first >= 0x20U || first == '\t' ? 1 : 0;
    }
    const std::size_t size = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
    if (first < 0xC2U || first > 0xF4U || text.size() < size) {
        return 0;
    }
    unsigned code = first & (0xFFU >> (size + 1));
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) {
            return 0;
        }
        code = (code << 6U) | (byte(i) & 0x3FU);
    }
    constexpr std::array<unsigned, 5> LEAST{0, 0, 0x80U, 0x800U, 0x10000U};
    const bool isSurrogate = code >= 0xD800U && code <= 0xDFFFU;
    const bool isUsable =
        code >= LEAST[size] && code <= 0x10FFFFU && !isSurrogate && (code & 0xFFFEU) != 0xFFFEU;
    return isUsable && code >= 0xA0U ? size : 0;
}

}  // namespace

const char *name_of(DataType type) {
    switch (type) {
    case DataType::INT64: return "Int64";
    case DataType::UINT64: return "UInt64";
    case DataType::DOUBLE: return "Double";
    case DataType::BOOLEAN: return "Boolean";
    case DataType::STRING: return "String";
    }
    return "";
}

std::string clean_text(std::string_view text) {
    std::string clean;
    clean.reserve(text.size());
    while (!text.empty()) {
        const std::size_t size = character_size(text);
        clean += size > 0 ? text.substr(0, size) : text.front() == '\n' ? std::string_view(" ") : REPLACEMENT;
        text.remove_prefix(size > 0 ? size : 1);
    }
    return clean;
}

}  // namespace mw::publish

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/value.hh"

#include "base/utf8.hh"

namespace mw::publish {
namespace {

constexpr std::string_view REPLACEMENT = "\xEF\xBF\xBD";

/// Size of the character at the front of `text`; 0 if it is not valid, or not allowed in texts of Sparkplug.
/// [bytes]
std::size_t character_size(std::string_view text) {
    const Utf8Character first = first_character(text);
    const bool isControl =
        (first.code < 0x20U && first.code != '\t') || (first.code >= 0x80U && first.code < 0xA0U);
    return isControl || (first.code & 0xFFFEU) == 0xFFFEU ? 0 : first.size;
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/odd_characters.hh"

#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>

namespace mw::gcode::detail {
namespace {

struct Named {
    std::uint32_t code;
    const char *name;
};

/// Characters that editors and word processors leave in programs.
constexpr std::array NAMED{
    Named{0x0000, "NUL"},
    Named{0x001b, "escape"},
    Named{0x001a, "DOS end-of-file character"},
    Named{0x00a0, "no-break space"},
    Named{0x00ad, "soft hyphen"},
    Named{0x00b0, "degree sign"},
    Named{0x00d7, "multiplication sign"},
    Named{0x00f7, "division sign"},
    Named{0x200b, "zero-width space"},
    Named{0x2010, "hyphen, not '-'"},
    Named{0x2011, "hyphen, not '-'"},
    Named{0x2013, "dash, not '-'"},
    Named{0x2014, "dash, not '-'"},
    Named{0x2018, "quotation mark"},
    Named{0x2019, "quotation mark"},
    Named{0x201c, "quotation mark"},
    Named{0x201d, "quotation mark"},
    Named{0x202f, "no-break space"},
    Named{0x2212, "minus sign, not '-'"},
    Named{0xfeff, "byte order mark"},
    Named{0xff0d, "minus sign, not '-'"},
};

/// The UTF-8 character at the start of `text`; nothing when it is not valid.
std::optional<std::uint32_t> decode(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) {
        return first;
    }
    const std::size_t length = first >= 0xf0 ? 4 : (first >= 0xe0 ? 3 : 2);
    if (first < 0xc2 || first > 0xf4 || text.size() < length) {
        return std::nullopt;
    }
    std::uint32_t code = first & (0xffU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0U) != 0x80U) {
            return std::nullopt;
        }
        code = code << 6U | (byte(i) & 0x3fU);
    }
    return code;
}

std::string name_of(std::string_view text) {
    const std::optional<std::uint32_t> code = decode(text);
    if (!code) {
        return fmt::format("byte 0x{:02X} (not UTF-8)", static_cast<unsigned char>(text[0]));
    }
    const auto known = std::ranges::find(NAMED, *code, &Named::code);
    return known == NAMED.end() ? fmt::format("U+{:04X}", *code)
                                : fmt::format("U+{:04X} ({})", *code, known->name);
}

}  // namespace

std::optional<OddCharacter> find_odd_character(std::string_view line) {
    char closer = '\0';  // closing character of the current comment or name
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (closer != '\0') {
            closer = c == closer ? '\0' : closer;
            continue;
        }
        if (c == ';') {
            return std::nullopt;
        }
        closer = c == '(' ? ')' : (c == '<' ? '>' : '\0');
        const auto byte = static_cast<unsigned char>(c);
        if ((byte < ' ' && c != '\t' && c != '\r') || byte >= 0x7f) {
            return OddCharacter{i, name_of(line.substr(i))};
        }
    }
    return std::nullopt;
}

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/field_format.hh"

#include <algorithm>
#include <charconv>
#include <utility>

namespace mw::mesa {

namespace {

struct TypeLetter {
    char letter;
    BitFieldType type;
};
constexpr TypeLetter TYPE_LETTERS[] = {
    {'p', BitFieldType::PADDING},     {'b', BitFieldType::BIT},          {'u', BitFieldType::UNSIGNED},
    {'s', BitFieldType::SIGNED},      {'f', BitFieldType::BITS},         {'e', BitFieldType::ENCODER},
    {'l', BitFieldType::ENCODER_LOW}, {'h', BitFieldType::ENCODER_HIGH},
};

/// 5 constant bits, battery, 2 unknown, not indexed, 9 unknown, one turn, 2, turns, 2, commutation, 7, CRC.
constexpr std::string_view AA64_FORMAT =
    "x%5pbatt_fail%1bx%2ppos_invalid%1bx%9pencoder%16lx%2pencoder%16hx%2pcomm%10ux%7pcrc%5u";

std::unexpected<Error> refuse(std::string_view format, std::size_t at, std::string_view why) {
    return fail("format " + std::string(format) + ", character " + std::to_string(at + 1) + ": " +
                std::string(why));
}

/// Parses the modifiers and the type, from `at`, after the number of bits.
Result<> read_type(BitField &field, std::string_view format, std::size_t &at) {
    for (; at < format.size() && (format[at] == 'g' || format[at] == 'm'); ++at) {
        field.gray = field.gray || format[at] == 'g';
        field.multi_turn = field.multi_turn || format[at] == 'm';
    }
    const char letter = at < format.size() ? format[at] : '\0';
    const auto *found = std::ranges::find(TYPE_LETTERS, letter, &TypeLetter::letter);
    if (found != std::end(TYPE_LETTERS)) {
        field.type = found->type;
        ++at;
        return {};
    }
    if (at == format.size() && (field.gray || field.multi_turn)) {
        field.type = BitFieldType::ENCODER;
        return {};
    }
    return refuse(format, at, "not a type. Use one of p, b, u, s, f, e, l, h, after g or m where needed.");
}

}  // namespace

Result<std::vector<NamedField>> parse_field_format(std::string_view format, int most_bits) {
    if (format == "AA64") {
        format = AA64_FORMAT;
    }
    std::vector<NamedField> fields;
    int first = 0;
    for (std::size_t at = 0; at < format.size();) {
        NamedField named;
        BitField &field = named.field;
        const std::size_t percent = format.find('%', at);
        if (percent == std::string_view::npos) {
            return refuse(format, at, "a field without % and a number of bits.");
        }
        named.name = format.substr(at, percent - at);
        at = percent + 1;
        const char *begin = format.data() + at;
        const auto [end, error] = std::from_chars(begin, format.data() + format.size(), field.bits);
        if (error != std::errc{} || field.bits < 1 || field.bits > MAX_FIELD_BITS) {
            return refuse(format, at, "the number of bits must be 1 to 64.");
        }
        at += static_cast<std::size_t>(end - begin);
        if (auto read = read_type(field, format, at); !read) {
            return std::unexpected(read.error());
        }
        field.first = first;
        first += field.bits;
        if (first > most_bits) {
            return refuse(format, percent, "more than " + std::to_string(most_bits) + " bits together.");
        }
        fields.push_back(std::move(named));
    }
    return fields;
}

}  // namespace mw::mesa

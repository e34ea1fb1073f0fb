// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/detail/remap.hh"

#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::interp::detail {
namespace {

struct GroupNumber {
    char letter;
    int number;
    Group group;
    Phase phase;
};

/// Modal groups by the numbers of the manual, for codes that have no row of their own.
constexpr GroupNumber GROUPS[] = {
    {'g', 0, Group::NON_MODAL, Phase::OFFSETS},
    {'g', 1, Group::MOTION, Phase::MOTION},
    {'g', 2, Group::PLANE, Phase::PLANE},
    {'g', 3, Group::DISTANCE, Phase::DISTANCE},
    {'g', 5, Group::FEED_MODE, Phase::FEED_MODE},
    {'g', 6, Group::UNITS, Phase::UNITS},
    {'m', 4, Group::STOP, Phase::STOP},
    {'m', 5, Group::IO, Phase::IO},
    {'m', 6, Group::TOOL_CHANGE, Phase::CHANGE_TOOL},
    {'m', 7, Group::SPINDLE, Phase::SPINDLE},
    {'m', 8, Group::COOLANT, Phase::COOLANT},
    {'m', 9, Group::OVERRIDE, Phase::OVERRIDE},
    {'m', 10, Group::USER, Phase::USER},
};

bool parse_name(std::string_view text, Remap &out) {
    if (text.empty()) {
        return false;
    }
    out.name = to_upper(text);
    out.letter = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    if (text.size() == 1) {
        return out.letter == 't' || out.letter == 's' || out.letter == 'f';
    }
    const auto number = parse_double(text.substr(1));
    if (!number || *number < 0.0 || (out.letter != 'g' && out.letter != 'm')) {
        return false;
    }
    out.number = static_cast<int>(std::lround(*number * (out.letter == 'g' ? 10.0 : 1.0)));
    return out.number < (out.letter == 'g' ? 1000 : 1000);
}

bool parse_argspec(std::string_view text, Remap &out) {
    for (const char c : text) {
        if (c == '@') {
            out.isPositional = true;
        } else if (c == '^') {
            out.needsSpeed = true;
        } else if (c == '>') {
            out.needsFeed = true;
        } else if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
            const bool isRequired = std::isupper(static_cast<unsigned char>(c)) != 0;
            const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            (isRequired ? out.required : out.optional_words).push_back(lower);
        } else {
            return false;
        }
    }
    return true;
}

bool set_group(std::int64_t number, Remap &out) {
    for (const GroupNumber &row : GROUPS) {
        if (row.letter == out.letter && row.number == number) {
            out.code.group = row.group;
            out.code.phase = row.phase;
            return true;
        }
    }
    return false;
}

bool set_option(const std::string &key, const std::string &value, Remap &out, bool &hasGroup) {
    if (key == "modalgroup") {
        const auto number = parse_int(value);
        hasGroup = number && set_group(*number, out);
        return hasGroup;
    }
    if (key == "argspec") {
        return parse_argspec(value, out);
    }
    if (key == "ngc") {
        out.ngc = to_lower(value);
        return true;
    }
    if (key == "py" || key == "python" || key == "prolog" || key == "epilog") {
        out.error =
            fmt::format("{} is remapped with {}={}: Python remaps are not supported by this build yet",
                        out.name, key, value);
        return true;
    }
    return false;
}

}  // namespace

Result<Remap> parse_remap(std::string_view text) {
    const std::vector<std::string> words = split_words(text);
    Remap out;
    if (words.empty() || !parse_name(words[0], out)) {
        return fail(fmt::format("REMAP needs a code such as M400, G88.1, T, S or F first: '{}'", text));
    }
    const Code *existing = out.letter == 'g' || out.letter == 'm' ? find_code(out.letter, out.number)
                                                                  : find_word_code(out.letter);
    bool hasGroup = false;
    for (std::size_t i = 1; i < words.size(); ++i) {
        const std::size_t equals = words[i].find('=');
        const std::string key = to_lower(words[i].substr(0, equals));
        const std::string value = equals == std::string::npos ? std::string() : words[i].substr(equals + 1);
        if (!set_option(key, value, out, hasGroup)) {
            return fail(fmt::format("REMAP={}: '{}' is not understood", text, words[i]), {},
                        "known are modalgroup=, argspec=, ngc=, py=, prolog=, epilog=");
        }
    }
    if (existing != nullptr && !hasGroup) {
        out.code.group = existing->group;
        out.code.phase = existing->phase;
    } else if (!hasGroup) {
        return fail(fmt::format("REMAP={}: a new code needs modalgroup=", text));
    }
    if (out.ngc.empty() && out.error.empty()) {
        return fail(fmt::format("REMAP={}: ngc=NAME or py=NAME is missing", text));
    }
    out.code.letter = out.letter;
    out.code.number = out.number;
    for (const std::vector<char> *list : {&out.required, &out.optional_words}) {
        for (const char c : *list) {
            out.code.words |= bit_of(letter(c));
        }
    }
    out.code.usesAxes = (out.code.words & AXES) != 0;
    out.code.words &= ~0u;
    return out;
}

}  // namespace mw::interp::detail

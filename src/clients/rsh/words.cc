// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/words.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/geometry/pose.hh"
#include "base/text.hh"

namespace mw::rsh {

bool isSameWord(std::string_view word, std::string_view name) {
    return equals_ignoring_case(word, name);
}

std::string behind_words(std::string_view line, int count) {
    constexpr std::string_view BLANKS = " \t";
    for (int i = 0; i < count; ++i) {
        line = trim(line);
        line.remove_prefix(std::min(line.find_first_of(BLANKS), line.size()));
    }
    return std::string(trim(line));
}

bool isSamePassword(std::string_view given, std::string_view wanted) {
    unsigned difference = given.size() == wanted.size() ? 0 : 1;
    for (std::size_t i = 0; i < given.size(); ++i) {
        difference |= static_cast<unsigned char>(given[i] ^ wanted[wanted.empty() ? 0 : i % wanted.size()]);
    }
    return difference == 0;
}

std::unexpected<Error> no_such_value(const std::string &word, const std::string &valid) {
    return fail(fmt::format("Invalid value '{}', valid: {}", printable(word), valid));
}

Result<bool> on_or_off(const std::string &word) {
    return one_of<bool>(word, {{"ON", true}, {"OFF", false}, {"1", true}, {"0", false}});
}

Result<double> number(const std::string &word, const char *what) {
    const auto value = parse_double(word);
    return value.has_value() ? Result<double>(*value)
                             : fail(fmt::format("Invalid {} '{}', not a number", what, printable(word)));
}

Result<int> index_of(const std::string &word, const char *what, int count) {
    const auto value = parse_int(word);
    if (!value.has_value() || *value < -1 || *value >= count) {
        return fail(fmt::format("Invalid {} '{}', valid range [-1,{}]", what, printable(word), count - 1));
    }
    return static_cast<int>(*value);
}

Result<int> axis_of(const std::string &word) {
    const auto value = parse_int(word);
    const int axis = value.has_value() && *value >= 0 && *value < geometry::AXIS_COUNT
                         ? static_cast<int>(*value)
                     : word.size() == 1 ? geometry::axis_of_letter(word[0])
                                        : -1;
    return axis >= 0
               ? Result<int>(axis)
               : fail(fmt::format("Invalid axis '{}', valid: X Y Z A B C U V W or 0 to 8", printable(word)));
}

}  // namespace mw::rsh

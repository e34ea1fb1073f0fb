// SPDX-License-Identifier: GPL-2.0-or-later
#include "ui/rsh/words.hh"

#include <fmt/format.h>

#include "base/text.hh"
#include "geom/pose.hh"

namespace mw::ui::rsh {

bool isSameWord(std::string_view word, std::string_view name) {
    return equals_ignoring_case(word, name);
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
    const int axis = value.has_value() && *value >= 0 && *value < geom::AXIS_COUNT ? static_cast<int>(*value)
                     : word.size() == 1 ? geom::axis_of_letter(word[0])
                                        : -1;
    return axis >= 0
               ? Result<int>(axis)
               : fail(fmt::format("Invalid axis '{}', valid: X Y Z A B C U V W or 0 to 8", printable(word)));
}

}  // namespace mw::ui::rsh

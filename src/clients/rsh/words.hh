// SPDX-License-Identifier: GPL-2.0-or-later
// Splits a line into words and parses them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.hh"

namespace mw::rsh {

using Words = std::vector<std::string>;

/// Parses ON or OFF; also 1 and 0.
Result<bool> on_or_off(const std::string &word);
/// A finite number; `what` names it in the error.
Result<double> number(const std::string &word, const char *what);
/// -1 for all, or 0 to `count` - 1; `what` names it in the error.
Result<int> index_of(const std::string &word, const char *what, int count);
/// The letter of an axis, or its number.
Result<int> axis_of(const std::string &word);

/// The value of a word, in upper or lower case.
template <class Value>
Result<Value> one_of(const std::string &word,
                     std::initializer_list<std::pair<std::string_view, Value>> names);
/// "invalid value 'x', valid A, B".
std::unexpected<Error> no_such_value(const std::string &word, const std::string &valid);
bool isSameWord(std::string_view word, std::string_view name);
/// Takes the same time for each wrong password.
bool isSamePassword(std::string_view given, std::string_view wanted);
/// The part of `line` after its first `count` words.
std::string behind_words(std::string_view line, int count);

template <class Value>
Result<Value> one_of(const std::string &word,
                     std::initializer_list<std::pair<std::string_view, Value>> names) {
    std::string valid;
    for (const auto &[name, value] : names) {
        if (isSameWord(word, name)) {
            return value;
        }
        valid += (valid.empty() ? "" : ", ") + std::string(name);
    }
    return no_such_value(word, valid);
}

}  // namespace mw::rsh

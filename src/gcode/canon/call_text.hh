// SPDX-License-Identifier: GPL-2.0-or-later
// Text of canon calls, generated from their declarations.
#pragma once

#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "gcode/canon/canon_calls.hh"

namespace mw::gcode {

// Arguments in the text of a call: numbers with four decimals, poses from X to C, texts in quotes.
void append_argument(std::string &text, double value);
void append_argument(std::string &text, int value);
void append_argument(std::string &text, const Pose &pose);
void append_argument(std::string &text, const std::string &value);
template <class Enum>
    requires std::is_enum_v<Enum>
void append_argument(std::string &text, Enum value) {
    text += CALL_WORDS<Enum>[static_cast<std::size_t>(value)];
}

/// NAME(first, second): the form of all calls except those with their own rule in the printer.
template <RegularCall Call>
void append_call(std::string &text, const Call &call) {
    text.append(name_of(call)).append(1, '(');
    const char *separator = "";
    const auto argument = [&](auto field) {
        text += std::exchange(separator, ", ");
        append_argument(text, call.*field);
    };
    std::apply([&](auto... fields) { (argument(fields), ...); }, Call::FIELDS);
    text += ')';
}

}  // namespace mw::gcode

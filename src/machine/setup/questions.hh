// SPDX-License-Identifier: GPL-2.0-or-later
// The questions to a person about a machine.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace mw::setup {

/// Texts by the key of their question. Missing answers use the preset.
using Answers = std::map<std::string, std::string, std::less<>>;

enum class Form : std::uint8_t { CHOICE, NUMBER, WHOLE, TEXT };

struct Question {
    std::string key;   ///< "x.max"
    std::string text;  ///< text for a person, in English
    Form form = Form::TEXT;
    std::string preset;
    std::vector<std::string> choices{};  ///< for CHOICE
    double low = 0, high = 0;            ///< for NUMBER and WHOLE
    std::string unit{};                  ///< "mm/s"; empty: none
    std::string reason{};                ///< reason why the preset is a good initial value
};

inline constexpr std::string_view KINDS[] = {"mill", "router", "gantry", "lathe",
                                             "foam", "plasma", "mill4",  "mill5"};

/// The axis letters of a machine type, in joint order: "XYZ"; empty for an unknown type.
std::string_view axes_of(std::string_view kind);
/// The motors of a machine type in joint order: "x", "y", "y2", "z".
std::vector<std::string> motors_of(std::string_view kind);

/// The questions, in this order, for the machine described by `given`; invalid answers count as their
/// presets. The answers `kind`, `units`, `drives`, `board`, `switches`, `spindle`, `spindle.drive` and those
/// of transmissions determine the other questions.
std::vector<Question> questions(const Answers &given);

/// The accepted answers: ": 1 to 20 mm" or ": yes, no"; empty for any text.
std::string range_of(const Question &question);
/// An answer, or its preset. `key` must be the key of a question.
std::string answer_of(const std::vector<Question> &asked, const Answers &given, std::string_view key);

}  // namespace mw::setup

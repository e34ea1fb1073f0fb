// SPDX-License-Identifier: GPL-2.0-or-later
// What a person is asked about a machine.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace mw::setup {

/// Texts by the key of their question. What is missing has the preset of its question.
using Answers = std::map<std::string, std::string, std::less<>>;

enum class Form : std::uint8_t { CHOICE, NUMBER, WHOLE, TEXT };

struct Question {
    std::string key;   ///< "x.max"
    std::string text;  ///< of a person's language: English
    Form form = Form::TEXT;
    std::string preset;
    std::vector<std::string> choices{};  ///< of CHOICE
    double low = 0, high = 0;            ///< of NUMBER and WHOLE
    std::string unit{};                  ///< "mm/s"; empty: none
};

inline constexpr std::string_view KINDS[] = {"mill", "router", "gantry", "lathe", "foam"};

/// The letters of the axes of a kind, in the order of their joints: "XYZ"; empty for no kind.
std::string_view axes_of(std::string_view kind);
/// Its motors in the order of their joints: "x", "y", "y2", "z".
std::vector<std::string> motors_of(std::string_view kind);

/// What is asked, in this order, of the machine that `given` describes so far: a kind that is none, a unit
/// and so on count as their presets. The answers `kind`, `units`, `drives`, `switches` and `spindle` decide
/// what else there is.
std::vector<Question> questions(const Answers &given);

/// An answer, or its preset. `key` is of a question that is asked.
std::string answer_of(const std::vector<Question> &asked, const Answers &given, std::string_view key);

}  // namespace mw::setup

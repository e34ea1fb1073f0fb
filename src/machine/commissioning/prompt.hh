// SPDX-License-Identifier: GPL-2.0-or-later
// What a step shows to the operator, and what the operator does.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mw::commissioning {

enum class Ask {
    NOTHING,  ///< the machine works by itself
    CONFIRM,  ///< that the text is done or true
    HOLD,     ///< hold a button: the machine moves only meanwhile
    ACTION,   ///< do something at the machine by hand; the step sees it
    NUMBER,   ///< a measured value
    CHOICE,   ///< what was seen
};

struct Prompt {
    std::string step;   ///< "direction"
    std::string motor;  ///< "y2"; empty: the whole machine
    std::string text;   ///< what to do, in one or two sentences
    Ask ask = Ask::NOTHING;
    std::vector<std::string> choices{};  ///< of CHOICE
    std::string unit{};                  ///< of NUMBER
    std::vector<std::string> hazards{};
    std::string watch{};  ///< what to watch meanwhile
    /// Of HOLD: the operator may end the motion before its distance, with the button released, by confirming.
    bool may_end_early = false;
};

inline Prompt make_prompt(std::string step, std::string motor, std::string text, std::string watch = "") {
    Prompt prompt;
    prompt.step = std::move(step);
    prompt.motor = std::move(motor);
    prompt.text = std::move(text);
    prompt.watch = std::move(watch);
    return prompt;
}

/// What the operator does. Each names the prompt that it answers by the number of the prompt. A button that
/// stays pressed keeps the number of the prompt for which it was pressed: the next motion needs a new press.
struct Act {
    /// HOLD: the button is pressed, renewed before it counts as released; RELEASE: at once.
    enum class Type { CONFIRM, HOLD, RELEASE, NUMBER, CHOICE, CANNOT } type = Type::CONFIRM;
    double number = 0;
    std::string choice{};
};

}  // namespace mw::commissioning

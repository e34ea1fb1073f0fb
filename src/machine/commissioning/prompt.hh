// SPDX-License-Identifier: GPL-2.0-or-later
// The prompt of a step for the operator, and the actions of the operator.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mw::commissioning {

enum class Ask {
    NOTHING,  ///< the machine works by itself
    CONFIRM,  ///< the operator confirms that the text is done or true
    HOLD,     ///< the operator holds a button, and the machine moves only while it is held
    ACTION,   ///< the operator does something at the machine by hand, and the step detects it
    NUMBER,   ///< the operator enters a measured value
    CHOICE,   ///< the operator selects what was seen
};

struct Prompt {
    std::string step;   ///< "direction"
    std::string motor;  ///< "y2"; empty: the whole machine
    std::string text;   ///< instruction in one or two sentences
    Ask ask = Ask::NOTHING;
    std::vector<std::string> choices{};  ///< for CHOICE
    std::string unit{};                  ///< for NUMBER
    std::vector<std::string> hazards{};
    std::string watch{};  ///< value to watch while the prompt is shown
    /// Only HOLD: the operator may end the motion before its distance by releasing the button and confirming.
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

/// An action of the operator. It contains the number of the prompt that it answers. A button that remains
/// pressed keeps the number of the prompt for which it was pressed, so the next motion needs a new press.
struct Act {
    /// HOLD: the button is pressed, and renewed before the lease expires; RELEASE: effective at once.
    enum class Type { CONFIRM, HOLD, RELEASE, NUMBER, CHOICE, CANNOT } type = Type::CONFIRM;
    double number = 0;
    std::string choice{};
};

}  // namespace mw::commissioning

// SPDX-License-Identifier: GPL-2.0-or-later
#include "commissioning/owner.hh"

#include <cmath>
#include <regex>

namespace mw::commissioning_campaign {

using commissioning::Act;
using commissioning::Ask;
using commissioning::Prompt;

namespace {

/// Time from a new text to the first reaction [s].
constexpr double REACTION_S = 0.3;
/// The owner releases the button when the table is so near to an end stop [mm].
constexpr double NEAR_MM = 3;

bool has(const std::string &text, const char *words) {
    return text.find(words) != std::string::npos;
}

}  // namespace

double Owner::noise(double most) {
    return most * (2 * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max()) - 1);
}

std::size_t Owner::axis_in(const std::string &text) const {
    static const std::regex LETTER("(?:^|[^A-Za-z])([XYZ])(?:[^A-Za-z]|$)");
    std::smatch found;
    return std::regex_search(text, found, LETTER) ? world_.find_axis(found[1].str()[0]) : 0;
}

std::optional<Act> Owner::look(int prompt_number, const Prompt &prompt, double now_s) {
    if (prompt_number != number_) {
        number_ = prompt_number;
        seen_s_ = now_s;
        isDone_ = isReleased_ = false;
        if (prompt.ask == Ask::HOLD) {
            held_axis_ = axis_in(prompt.text);
            held_from_ = world_.table(held_axis_);
        }
    }
    if (now_s < seen_s_ + REACTION_S) {
        return std::nullopt;
    }
    return read(prompt);
}

std::optional<Act> Owner::read(const Prompt &prompt) {
    if (prompt.ask == Ask::HOLD) {
        return hold(prompt);
    }
    if (isDone_ || prompt.ask == Ask::NOTHING) {
        return std::nullopt;
    }
    isDone_ = true;
    switch (prompt.ask) {
    case Ask::CONFIRM:
        if (has(prompt.text, "to zero")) {
            const std::size_t axis = axis_in(prompt.text);
            zero_[axis] = world_.table(axis) + noise(0.003);
        }
        if (has(prompt.text, "Release all emergency stop buttons")) {
            world_.press_estop(false);
        }
        return Act{.type = Act::Type::CONFIRM, .number = 0, .choice = ""};
    case Ask::ACTION: use_hands(prompt.text); return std::nullopt;
    case Ask::NUMBER: return measure(prompt);
    default: return say(prompt);
    }
}

std::optional<Act> Owner::hold(const Prompt &) {
    const TrueAxis &axis = world_.axis(held_axis_);
    const double table = world_.table(held_axis_), moved = table - held_from_;
    const bool is_near = (moved < -0.1 && table < axis.lower_end + NEAR_MM) ||
                         (moved > 0.1 && table > axis.upper_end - NEAR_MM);
    if (is_near || isReleased_) {
        const bool is_first = !isReleased_;
        isReleased_ = true;
        return is_first ? std::nullopt
                        : std::optional(Act{.type = Act::Type::CONFIRM, .number = 0, .choice = ""});
    }
    return Act{.type = Act::Type::HOLD, .number = 0, .choice = ""};
}

void Owner::use_hands(const std::string &text) {
    if (has(text, "emergency stop")) {
        world_.press_estop(has(text, "Press"));
    } else if (has(text, "home switch")) {
        world_.press_switch(axis_in(text), has(text, "Press"));
    } else if (has(text, "probe")) {
        world_.touch_probe(has(text, "Touch"));
    }
}

Act Owner::measure(const Prompt &prompt) {
    if (has(prompt.text, "tachometer")) {
        return {.type = Act::Type::NUMBER, .number = world_.spindle_rpm() * (1 + noise(0.001)), .choice = ""};
    }
    const std::size_t axis = axis_in(prompt.text);
    const double resolution = has(prompt.text, "indicator") ? 0.002 : 0.01;
    const double value = world_.table(axis) - zero_[axis] + noise(resolution / 2);
    return {.type = Act::Type::NUMBER, .number = std::round(value / resolution) * resolution, .choice = ""};
}

Act Owner::say(const Prompt &prompt) {
    if (has(prompt.text, "swap its wires")) {
        return {.type = Act::Type::CHOICE, .number = 0, .choice = isRewiring_ ? "wires" : "reverse"};
    }
    const double moved = world_.table(held_axis_) - held_from_;
    constexpr double VISIBLE_MM = 0.1;
    const char *const seen = std::abs(moved) < VISIBLE_MM ? "not at all"
                             : moved > 0                  ? "positive"
                                                          : "negative";
    return {.type = Act::Type::CHOICE, .number = 0, .choice = seen};
}

}  // namespace mw::commissioning_campaign
